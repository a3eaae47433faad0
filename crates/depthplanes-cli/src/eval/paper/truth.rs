//! What the paper's measures hide: the same methods with the same parameters, against the truth.

use super::super::datasets::{self, Item};
use super::super::report::plots;
use super::super::report::{Section, by, in_order, mean, share, strips, table};
use super::super::rows::{Found, Row};
use super::maps::{MIDDLEBURY, Source};
use super::trial::{COMPARED, MINS, NGAF, Results, label};
use crate::failure::Outcome;
use std::path::Path;

pub(super) const DISPARITY: &str = "disparity with a truth";
pub(super) const DEPTH: &str = "depth with a truth";

/// Three planes that meet, steps, balls and columns, and two rooms drawn from the seed.
const SCENES: [&str; 4] = ["planes3:", "stairs:", "curved:", "random:seed=1-2,"];
/// Strips of a trial.
const STRIPS: usize = 4;

/// Synthetic maps of a stereo pair, and those of Middlebury's maps whose planes are known, where Middlebury's are at hand.
pub(super) fn disparity(sources: &[Source], data: Option<&Path>) -> Outcome<Vec<Item>> {
    let mut items = scenes("sensor=disparity,size=450x375")?;
    if sources.iter().any(|source| source.map.set == MIDDLEBURY && source.file.is_some()) {
        items.extend(datasets::find("middlebury", data)?.into_iter().filter(|item| item.truth.is_some()));
    }
    Ok(named(items, DISPARITY))
}

/// Synthetic maps of a Kinect.
pub(super) fn depth() -> Outcome<Vec<Item>> {
    Ok(named(scenes("sensor=kinect_white")?, DEPTH))
}

fn scenes(how: &str) -> Outcome<Vec<Item>> {
    let items = SCENES.iter().map(|scene| datasets::find(&format!("scene:{scene}{how}"), None));
    Ok(items.collect::<Outcome<Vec<_>>>()?.into_iter().flatten().collect())
}

fn named(items: Vec<Item>, set: &str) -> Vec<Item> {
    items.into_iter().map(|item| Item { dataset: set.into(), ..item }).collect()
}

pub(super) fn section(folder: &Path, all: &[&Results<'_>]) -> Outcome<Section> {
    let title = "What these measures hide";
    let mut text =
        "Time, number of planes and share of valid points are all that the paper measures, and no plane needs to \
                    be right for any of them. Joining surfaces that meet brings the share up to all points; cutting \
                    surfaces into pieces brings the number up. A plane is correct here if it and one of the \
                    truth's cover 80 % of each other (SegComp)."
            .to_string();
    let (mut tables, mut plotted, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    for results in all {
        let compared = results.compared();
        text += &format!("\n\n{}", told(results, &compared));
        tables.push(table::of(results.trial.name, &results.rows));
        let plots = [plots::correct_by_count(&compared), plots::correct_by_tolerance(&compared)];
        plotted.extend(plots.into_iter().filter_map(|plot| results.plot(plot)));
        pictures.extend(strips::of_maps(folder, &compared, results.trial.items.iter().take(STRIPS), None)?);
    }
    Ok(Section { title: title.into(), text, tables, plots: plotted, strips: pictures })
}

/// A method's planes, correct ones and share on all maps of a trial.
struct Sum {
    label: String,
    planes: usize,
    correct: f64,
    truth: f64,
    /// Mean, of 100.
    share: f64,
}

impl Sum {
    fn of(rows: &[&Row], label: &str) -> Option<Self> {
        let found = by(rows, label);
        let score = |measure: &str| -> f64 { found.iter().filter_map(|(_, found)| found.scores.get(measure)).sum() };
        let of_100 = |(row, found): &(&Row, &Found)| Some(100.0 * share(row, found));
        Some(Sum {
            label: label.into(),
            planes: found.iter().map(|(_, found)| found.planes).sum(),
            correct: score("segcomp.correct"),
            truth: score("planes.truth"),
            share: mean(found.iter().map(of_100))?,
        })
    }

    fn told(&self) -> String {
        let Sum { planes, correct, share, .. } = self;
        format!("{planes} planes on {share:.1} % of the valid pixels, {correct} of them correct")
    }
}

/// What the numbers say of more planes and larger shares.
fn told(results: &Results<'_>, compared: &[&Row]) -> String {
    let labels = in_order(compared.iter().map(|row| row.key.label.as_str()));
    let sums: Vec<Sum> = labels.iter().filter_map(|label| Sum::of(compared, label)).collect();
    let most = |value: fn(&Sum) -> f64| sums.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
    let truth = sums.first().map_or(0.0, |sum| sum.truth);
    let (name, maps) = (capital(results.trial.name), results.trial.items.len());
    let mut text = format!("{name}: {maps} maps with {truth} planes.");
    let told = [
        ("", Sum::of(compared, &label(NGAF, COMPARED)).as_ref()),
        ("Most planes are those of ", most(|sum| sum.planes as f64)),
        ("The largest share is that of ", most(|sum| sum.share)),
        ("Most correct planes are those of ", most(|sum| sum.correct)),
    ]
    .map(|(what, sum)| sum.map_or(String::new(), |sum| format!(" {what}{}: {}.", sum.label, sum.told())));
    text += &told.concat();
    let [small, large] = [MINS[0], MINS[MINS.len() - 1]].map(|min| (min, Sum::of(&results.rows, &label(NGAF, min))));
    if let ((min, Some(small)), (instead, Some(large))) = (small, large) {
        let (told, told_instead) = (small.told(), large.told());
        text += &format!(" {NGAF} with min {min} instead of {instead}: {told}, instead of {told_instead}.");
    }
    text
}

fn capital(text: &str) -> String {
    text[..1].to_uppercase() + &text[1..]
}
