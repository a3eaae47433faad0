//! All tasks of an evaluation: every map by every method or peer, and the rows that come of them.

use super::claim::Claim;
use super::datasets::Item;
use super::machine;
use super::peers::{Listed, Peer};
use super::rows::{Key, Store};
use super::task::{LABELS, Maker, Task};
use crate::failure::{Outcome, note};
use crate::folders::make_folder;
use crate::pool;
use crate::run::Recipe;
use crate::terminal::plain;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::Path;

/// A method with parameters, and what it is called in the report.
pub(super) struct Entry {
    pub(super) label: String,
    pub(super) recipe: Recipe,
}

/// How often and how much at a time.
#[derive(Clone, Copy)]
pub(super) struct Pace {
    /// Timed runs after a warm-up.
    pub(super) repeat: usize,
    /// Maps at the same time.
    pub(super) jobs: usize,
}

/// Every map by every method, the methods of a map together.
pub(super) fn of_entries<'a>(items: &'a [Item], entries: &'a [Entry], repeat: usize) -> Vec<Task<'a>> {
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

/// Every map by every peer.
pub(super) fn of_peers<'a>(items: &'a [Item], peers: &'a [Peer], repeat: usize) -> Vec<Task<'a>> {
    let task = |(item, peer): (&'a Item, &'a Peer)| {
        let Listed { name, version, parameters } = peer.listed.clone();
        let (dataset, map) = (item.dataset.clone(), item.name.clone());
        let key = Key { dataset, map, label: name.clone(), method: name, parameters, version, repeat };
        Task { item, maker: Maker::Peer(peer), key }
    };
    items.iter().flat_map(|item| peers.iter().map(move |peer| (item, peer))).map(task).collect()
}

/// Does the tasks that have no row yet; each row is kept as soon as it is made. The folder is claimed for this run.
///
/// # Errors
/// A folder that cannot be written to or that another run writes into, a map that cannot be read.
pub(super) fn make(tasks: &[Task<'_>], pace: Pace, folder: &Path) -> Outcome<(Claim, Store)> {
    make_folder(&folder.join(LABELS))?;
    let claim = Claim::of(folder)?;
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
        bar.set_message(plain(&format!("{} {}", open[at].key.map, open[at].key.label)).into_owned());
        bar.inc(1);
        store.add(row?)
    })?;
    bar.finish_and_clear();
    Ok((claim, store))
}
