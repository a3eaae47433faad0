//! The paper's protocol: its maps, parameters and figures, its claims, and the same methods against the truth.
//!
//! `maps -> trials -> tasks -> rows -> sections`: a trial is some maps by some methods; tasks, rows and the report are
//! those of `eval`, and so an interrupted run goes on.

mod claims;
mod figures;
mod maps;
mod trial;
mod truth;

use super::report;
use super::rows::Row;
use super::tasks::{self, Entry, Pace};
use crate::args::Paper;
use crate::failure::{Outcome, note};
use crate::run::Recipe;
use maps::{KINECT, MIDDLEBURY, Source};
use std::io::Write;
use std::iter::once;
use std::path::Path;
use trial::{MINS, NGAF, Results, Trial, is_compared, label};

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

pub(crate) fn run(wanted: &Paper, out: &mut dyn Write) -> Outcome {
    let data = maps::folder(wanted.data.as_deref())?;
    let sources = maps::sources(data.as_deref());
    tell_synthetic(&sources, data.as_deref());
    let trials = trials(wanted, &sources, data.as_deref())?;
    let pace = Pace { repeat: wanted.repeat, jobs: wanted.jobs };
    let all: Vec<_> =
        trials.iter().flat_map(|trial| tasks::of_entries(&trial.items, &trial.entries, pace.repeat)).collect();
    let (_claim, store) = tasks::make(&all, pace, &wanted.report)?;
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
fn tell_synthetic(sources: &[Source], data: Option<&Path>) {
    let synthetic: Vec<&str> =
        sources.iter().filter(|source| source.file.is_none()).map(|source| source.map.name).collect();
    if !synthetic.is_empty() {
        let place = data.map_or("without --data".to_string(), |data| format!("not in {}", data.display()));
        note(&format!(
            "{place}: synthetic maps stand in for {}; the report says which files are looked for",
            synthetic.join(", ")
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

/// Each method with each `min`, as the paper calls `min-pixels`, the entries of a method together.
fn entries(methods: &[String], settings: Settings, threads: usize) -> Outcome<Vec<Entry>> {
    let mut entries = Vec::new();
    for min in MINS {
        let given = [("min-pixels", f64::from(min)), ("theta", settings.theta), ("window", settings.window)];
        let entry = |recipe: Recipe| Entry { label: label(recipe.method.name, min), recipe };
        entries.extend(Recipe::several(methods, &given, threads)?.into_iter().map(entry));
    }
    entries.sort_by_key(|entry| methods.iter().position(|name| name == entry.recipe.method.name));
    Ok(entries)
}
