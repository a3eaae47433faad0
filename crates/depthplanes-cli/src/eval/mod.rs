//! Evaluation: methods over sets of maps, resumable, and a report of it.
//!
//! `words -> datasets -> tasks -> rows -> report`: a task is a map and a method; a row, once made, is on the disk, and
//! an evaluation that is started again goes on from there. The report is made of the rows alone.

pub(crate) mod datasets;
mod machine;
pub(crate) mod paper;
mod peers;
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
use std::collections::HashSet;
use std::io::Write;
use std::path::Path;
use task::{Maker, Task};

/// Folder of the label images within the report's.
const LABELS: &str = "labels";

/// A method with parameters, and what it is called in the report.
struct Entry {
    label: String,
    recipe: Recipe,
}

/// How often and how much at a time.
#[derive(Clone, Copy)]
struct Pace {
    /// Timed runs after a warm-up.
    repeat: usize,
    /// Maps at the same time.
    jobs: usize,
}

pub(crate) fn run(wanted: &Eval, out: &mut dyn Write) -> Outcome {
    let recipes = Recipe::several(&wanted.methods, &wanted.parameters, wanted.threads)?;
    let entry = |recipe: Recipe| Entry { label: recipe.method.name.into(), recipe };
    let entries: Vec<Entry> = recipes.into_iter().map(entry).collect();
    let items = items(&wanted.datasets, wanted.data.as_deref())?;
    let pace = Pace { repeat: wanted.repeat, jobs: wanted.jobs };
    let peers = peers::find(&wanted.peers, wanted.threads)?;
    let mut tasks = tasks(&items, &entries, pace.repeat);
    tasks.extend(peers::tasks(&items, &peers, pace.repeat));
    // The methods of a map together: what else the machine does in the meantime meets all of them.
    tasks.sort_by_key(|task| std::ptr::from_ref(task.item));
    let store = make(&tasks, pace, &wanted.report)?;
    let rows: Vec<&Row> = tasks.iter().filter_map(|task| store.get(&task.key)).collect();
    let sections = report::by_dataset(&wanted.report, &rows, &items)?;
    report::write("Evaluation", &wanted.report, &rows, &sections, out)
}

/// The maps of all sets.
///
/// # Errors
/// A set that is unknown, not there or without maps; two maps of one name in one set, whose rows could not be told apart.
fn items(words: &[String], data: Option<&Path>) -> Outcome<Vec<Item>> {
    let mut items = Vec::new();
    for word in words {
        items.extend(datasets::find(word, data)?);
    }
    let mut names = HashSet::new();
    match items.iter().find(|item| !names.insert((&item.dataset, &item.name))) {
        Some(Item { dataset, name, .. }) => {
            let message =
                format!("{dataset} has a map {name} twice; give each set once, and folders of different names");
            Err(Failure::request(message))
        }
        None => Ok(items),
    }
}

/// Every map by every method, the methods of a map together.
fn tasks<'a>(items: &'a [Item], entries: &'a [Entry], repeat: usize) -> Vec<Task<'a>> {
    let task = |(item, entry): (&'a Item, &'a Entry)| {
        let key = Key {
            dataset: item.dataset.clone(),
            map: item.name.clone(),
            label: entry.label.clone(),
            method: entry.recipe.method.name.into(),
            parameters: entry.recipe.written(),
            version: env!("CARGO_PKG_VERSION").into(),
            repeat,
        };
        Task { item, maker: Maker::Recipe(&entry.recipe), key }
    };
    items.iter().flat_map(|item| entries.iter().map(move |entry| (item, entry))).map(task).collect()
}

/// Does the tasks that have no row yet; each row is kept as soon as it is made.
///
/// # Errors
/// A folder that cannot be written to, a map that cannot be read.
fn make(tasks: &[Task<'_>], pace: Pace, folder: &Path) -> Outcome<Store> {
    crate::folders::make_folder(&folder.join(LABELS))?;
    let mut store = Store::open(&folder.join("rows.jsonl"))?;
    let open: Vec<&Task<'_>> = tasks.iter().filter(|task| !task.is_done(&store, folder)).collect();
    if open.len() < tasks.len() {
        note(&format!(
            "{}: {} of {} results are there already",
            folder.display(),
            tasks.len() - open.len(),
            tasks.len()
        ));
    }
    let bar = ProgressBar::new(open.len() as u64);
    bar.set_style(ProgressStyle::with_template("{bar:30} {pos}/{len} {eta} {msg}").expect("a fixed template"));
    let machine = machine::name();
    let worker = || {
        let (machine, open) = (&machine, &open);
        move |at: usize| open[at].run(folder, machine, pace.jobs)
    };
    pool::in_order(open.len(), pace.jobs, worker, |at, row| {
        bar.set_message(format!("{} {}", open[at].key.map, open[at].key.label));
        bar.inc(1);
        store.add(row?)
    })?;
    bar.finish_and_clear();
    Ok::<Store, Failure>(store)
}
