//! Evaluation: methods over sets of maps, resumable, and a report of it.
//!
//! `words -> datasets -> tasks -> rows -> report`: a task is a map and a method; a row, once made, is on the disk, and
//! an evaluation that is started again goes on from there. The report is made of the rows alone.

pub(crate) mod datasets;
mod machine;
mod report;
mod rows;
mod task;

use crate::args::Eval;
use crate::failure::{Failure, Outcome, note};
use crate::pool;
use crate::run::Recipe;
use datasets::Item;
use indicatif::{ProgressBar, ProgressStyle};
use rows::{Key, Row, Store};
use std::io::Write;
use std::path::Path;
use task::Task;

/// Folder of the label images within the report's.
const LABELS: &str = "labels";

pub(crate) fn run(wanted: &Eval, out: &mut dyn Write) -> Outcome {
    let recipes = Recipe::several(&wanted.methods, &wanted.parameters, wanted.threads)?;
    let items = items(&wanted.datasets, wanted.data.as_deref())?;
    let folder = &wanted.report;
    crate::commands::make_folder(&folder.join(LABELS))?;
    let mut store = Store::open(&folder.join("rows.jsonl"))?;
    let tasks = tasks(&items, &recipes, wanted.repeat);
    let open: Vec<&Task<'_>> = tasks.iter().filter(|task| !task.is_done(&store, folder)).collect();
    if open.len() < tasks.len() {
        note(&format!(
            "{}: {} of {} results are there already",
            folder.display(),
            tasks.len() - open.len(),
            tasks.len()
        ));
    }
    work(&open, wanted.jobs, folder, &mut store)?;
    let rows: Vec<&Row> = tasks.iter().filter_map(|task| store.get(&task.key)).collect();
    let written = report::write(folder, &rows, &items)?;
    let refused = rows.iter().filter(|row| matches!(row.outcome, rows::Made::Refused(_))).count();
    write!(out, "{}", report::summary(&rows))?;
    if refused > 0 {
        note(&format!("{refused} of {} results are refusals; the report says why", rows.len()));
    }
    writeln!(out, "wrote {}", written.join(", "))?;
    Ok(())
}

/// The maps of all sets.
///
/// # Errors
/// A set that is unknown, not there or without maps.
fn items(words: &[String], data: Option<&Path>) -> Outcome<Vec<Item>> {
    let mut items = Vec::new();
    for word in words {
        items.extend(datasets::find(word, data)?);
    }
    Ok(items)
}

/// Every map by every method, the methods of a map together.
fn tasks<'a>(items: &'a [Item], recipes: &'a [Recipe], repeat: usize) -> Vec<Task<'a>> {
    let task = |(item, recipe): (&'a Item, &'a Recipe)| {
        let key = Key {
            dataset: item.dataset.clone(),
            map: item.name.clone(),
            method: recipe.method.name.into(),
            parameters: recipe.written(),
            version: env!("CARGO_PKG_VERSION").into(),
            repeat,
        };
        Task { item, recipe, key }
    };
    items.iter().flat_map(|item| recipes.iter().map(move |recipe| (item, recipe))).map(task).collect()
}

/// Does the tasks that are open; each row is kept as soon as it is made.
fn work(open: &[&Task<'_>], jobs: usize, folder: &Path, store: &mut Store) -> Outcome {
    let bar = ProgressBar::new(open.len() as u64);
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {eta} {msg}").expect("a fixed template");
    bar.set_style(style);
    let machine = machine::name();
    let worker = || {
        let machine = &machine;
        move |at: usize| open[at].run(folder, machine, jobs)
    };
    pool::in_order(open.len(), jobs, worker, |at, row| {
        bar.set_message(format!("{} {}", open[at].key.map, open[at].key.method));
        bar.inc(1);
        store.add(row?)
    })?;
    bar.finish_and_clear();
    Ok::<(), Failure>(())
}
