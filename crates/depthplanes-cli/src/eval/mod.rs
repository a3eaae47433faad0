//! Evaluation: methods over sets of maps, resumable, and a report of it.
//!
//! `words -> datasets -> tasks -> rows -> report`: a task is a map and a method; a row, once made, is on the disk, and
//! an evaluation that is started again goes on from there. The report is made of the rows alone.

mod claim;
pub(crate) mod datasets;
mod machine;
pub(crate) mod paper;
mod peers;
mod report;
mod rows;
mod task;
mod tasks;

use crate::args::Eval;
use crate::failure::{Failure, Outcome};
use crate::run::Recipe;
use datasets::Item;
use rows::Row;
use std::collections::HashSet;
use std::io::Write;
use std::path::Path;
use tasks::{Entry, Pace};

pub(crate) fn run(wanted: &Eval, out: &mut dyn Write) -> Outcome {
    let recipes = Recipe::several(&wanted.methods, &wanted.parameters, wanted.threads)?;
    let entry = |recipe: Recipe| Entry { label: recipe.method.name.into(), recipe };
    let entries: Vec<Entry> = recipes.into_iter().map(entry).collect();
    let items = items(&wanted.datasets, wanted.data.as_deref())?;
    let pace = Pace { repeat: wanted.repeat, jobs: wanted.jobs };
    let peers = peers::find(&wanted.peers, wanted.threads)?;
    let mut tasks = tasks::of_entries(&items, &entries, pace.repeat);
    tasks.extend(tasks::of_peers(&items, &peers, pace.repeat));
    // The methods of a map together: what else the machine does in the meantime meets all of them.
    tasks.sort_by_key(|task| std::ptr::from_ref(task.item));
    let (_claim, store) = tasks::make(&tasks, pace, &wanted.report)?;
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
