//! The paper's protocol: its maps, parameters and figures, its claims, and the same methods against the truth.
//!
//! `maps -> trials -> tasks -> rows -> sections`: a trial is some maps by some methods; tasks, rows and the report are
//! those of `eval`, and so an interrupted run goes on.

mod claims;
mod figures;
mod maps;
mod truth;

use super::datasets::Item;
use super::report::plots::Plot;
use super::report::{self, strips};
use super::rows::Row;
use super::{Entry, Pace, make, tasks};
use crate::args::Paper;
use crate::failure::{Outcome, note};
use crate::run::Recipe;
use maps::{KINECT, MIDDLEBURY, Source};
use std::io::Write;
use std::iter::once;
use std::path::Path;

/// The paper's own method.
const NGAF: &str = "ngaf";
/// A plane has more pixels than this: the paper's four values, section 3d.
const MINS: [u32; 4] = [32, 64, 128, 256];
/// That of them at which methods are compared. Our choice: the paper names none.
const COMPARED: u32 = 64;

/// What has to be said of `ngaf` on depth.
const OF_DEPTH: &str = "\n\nThe steps of a Kinect's own grow with the square of the distance: about 2 mm at 0.8 m, 11 mm at 2 m \
    and 45 mm at 4 m. In millimetres a theta of 2 joins little but neighbours of equal depth, and most planes here are \
    lines of equal depth. Pixels that were filled count as the planes' own, but not as valid.";

/// The paper's parameters for a kind of maps; they go to the methods that have them.
#[derive(Clone, Copy)]
struct Settings {
    theta: f64,
    /// Side of the window that fills gaps, pixels; 0 for off.
    window: f64,
}

/// Near-perfect maps: theta 1, nothing to fill (section 3c).
const CLEAN: Settings = Settings { theta: 1.0, window: 0.0 };
/// Maps of sensors: theta 2 (section 3c), gaps filled (section 3b).
const SENSOR: Settings = Settings { theta: 2.0, window: 5.0 };

/// Maps, and what is run on them.
struct Trial {
    /// Stands for the set in the rows.
    name: &'static str,
    items: Vec<Item>,
    entries: Vec<Entry>,
}

/// What came of a trial.
struct Results<'a> {
    trial: &'a Trial,
    rows: Vec<&'a Row>,
}

pub(crate) fn run(wanted: &Paper, out: &mut dyn Write) -> Outcome {
    let data = maps::folder(wanted.data.as_deref())?;
    let sources = maps::sources(data.as_deref());
    tell_made_up(&sources, data.as_deref());
    let trials = trials(wanted, &sources, data.as_deref())?;
    let pace = Pace { repeat: wanted.repeat, jobs: wanted.jobs };
    let all: Vec<_> = trials.iter().flat_map(|trial| tasks(&trial.items, &trial.entries, pace.repeat)).collect();
    let store = make(&all, pace, &wanted.report)?;
    let rows: Vec<&Row> = all.iter().filter_map(|task| store.get(&task.key)).collect();
    let [middlebury, kinect, disparity, depth] = trials.each_ref().map(|trial| {
        let rows = rows.iter().copied().filter(|row| row.key.dataset == trial.name).collect();
        Results { trial, rows }
    });
    let folder = &wanted.report;
    let sections = [
        maps::section(&sources),
        figures::planes_on_maps("Fig. 9: ngaf on Middlebury's maps", "", folder, &middlebury)?,
        figures::planes_on_maps("Fig. 11: ngaf on frames of a Kinect", OF_DEPTH, folder, &kinect)?,
        figures::planes_by_min(&middlebury, &kinect),
        figures::side_by_side(folder, &middlebury)?,
        figures::three_measures(&[&middlebury, &kinect]),
        claims::section(&middlebury, &kinect),
        truth::section(folder, &[&disparity, &depth])?,
    ];
    report::write("The paper's protocol", folder, &rows, &sections, out)
}

/// A note if maps are not there.
fn tell_made_up(sources: &[Source], data: Option<&Path>) {
    let made_up: Vec<&str> =
        sources.iter().filter(|source| source.file.is_none()).map(|source| source.map.name).collect();
    if !made_up.is_empty() {
        let place = data.map_or("without --data".to_string(), |data| format!("not in {}", data.display()));
        note(&format!(
            "{place}: made-up maps stand in for {}; the report says which files are looked for",
            made_up.join(", ")
        ));
    }
}

/// The paper's maps by all methods with each `min`, then maps with a truth.
fn trials(wanted: &Paper, sources: &[Source], data: Option<&Path>) -> Outcome<[Trial; 4]> {
    let others = wanted.methods.iter().map(String::as_str).filter(|name| *name != NGAF);
    let methods: Vec<String> = once(NGAF).chain(others).map(str::to_string).collect();
    let entries = |settings| entries(&methods, settings, wanted.threads);
    // Each method with the `min` of the comparison, `ngaf` with all.
    let compared = |settings| -> Outcome<Vec<Entry>> {
        let is_shown = |entry: &Entry| entry.recipe.method.name == NGAF || is_compared(&entry.label);
        Ok(entries(settings)?.into_iter().filter(is_shown).collect())
    };
    Ok([
        Trial { name: MIDDLEBURY, items: maps::items(sources, MIDDLEBURY), entries: entries(CLEAN)? },
        Trial { name: KINECT, items: maps::items(sources, KINECT), entries: entries(SENSOR)? },
        Trial { name: truth::DISPARITY, items: truth::disparity(sources, data)?, entries: compared(CLEAN)? },
        Trial { name: truth::DEPTH, items: truth::depth()?, entries: compared(SENSOR)? },
    ])
}

/// Each method with each `min`, the entries of a method together.
fn entries(methods: &[String], settings: Settings, threads: usize) -> Outcome<Vec<Entry>> {
    let mut entries = Vec::new();
    for min in MINS {
        let given = [("min", f64::from(min)), ("theta", settings.theta), ("window", settings.window)];
        let entry = |recipe: Recipe| Entry { label: label(recipe.method.name, min), recipe };
        entries.extend(Recipe::several(methods, &given, threads)?.into_iter().map(entry));
    }
    entries.sort_by_key(|entry| methods.iter().position(|name| name == entry.recipe.method.name));
    Ok(entries)
}

/// What a method with a `min` is called in the report.
fn label(method: &str, min: u32) -> String {
    format!("{method} min {min}")
}

fn is_compared(label: &str) -> bool {
    label.ends_with(&format!(" min {COMPARED}"))
}

impl<'a> Results<'a> {
    /// Those of one method.
    fn of(&self, method: &str) -> Vec<&'a Row> {
        self.rows.iter().copied().filter(|row| row.key.method == method).collect()
    }

    /// Those that methods are compared by.
    fn compared(&self) -> Vec<&'a Row> {
        self.rows.iter().copied().filter(|row| is_compared(&row.key.label)).collect()
    }

    /// A strip for each map.
    fn strips(&self, folder: &Path, rows: &[&Row], rest: Option<[u8; 3]>) -> Outcome<Vec<strips::Strip>> {
        strips::of_maps(folder, rows, self.trial.items.iter(), rest)
    }

    /// A plot with the trial's name in its caption.
    fn plot(&self, plot: Option<Plot>) -> Option<Plot> {
        plot.map(|plot| plot.of(self.trial.name))
    }
}
