//! Synthetic scenes with exact truth: `scene:SPEC`, of which `seed=A-B` makes one for each seed.

use super::dataset::{Item, TruthOf};
use crate::failure::{Failure, Outcome};
use crate::load;
use depthplanes::scene::Spec;
use depthplanes_io::LabelImage;

/// The scenes of a specification.
pub(super) fn items(spec: &str) -> Outcome<Vec<Item>> {
    let item = |spec: String| {
        spec.parse::<Spec>()?; // before anything is run
        let name = format!("scene:{spec}");
        let of_truth = spec.clone();
        let frame = Box::new(move || load::scene(&spec));
        Ok(Item {
            dataset: "scenes".into(),
            name,
            frame,
            truth: Some(Box::new(move || truth(&of_truth))),
            is_sequence: false,
        })
    };
    seeds(spec)?.into_iter().map(item).collect()
}

/// The planes where the sensor measured something: no method finds them elsewhere.
fn truth(spec: &str) -> Outcome<TruthOf> {
    let frame = spec.parse::<Spec>()?.frame()?;
    let (width, height, labels) = (frame.width, frame.height, frame.measured_labels());
    let labels = LabelImage { width, height, labels, warnings: Vec::new() };
    Ok(TruthOf { labels, from: 1, planes: frame.truth.planes, partial: None })
}

/// Most seeds of a range.
const MOST: u64 = 10_000;

/// A specification for each seed of a range, or the one that it is.
fn seeds(spec: &str) -> Outcome<Vec<String>> {
    let Some((before, rest)) = spec.split_once("seed=") else { return Ok(vec![spec.into()]) };
    let (range, after) =
        rest.split_once(',').map_or((rest, String::new()), |(range, after)| (range, format!(",{after}")));
    let Some((first, last)) = range.split_once('-') else { return Ok(vec![spec.into()]) };
    let numbers = (first.parse::<u64>(), last.parse::<u64>());
    match numbers {
        (Ok(first), Ok(last)) if first <= last && last - first < MOST => {
            Ok((first..=last).map(|seed| format!("{before}seed={seed}{after}")).collect())
        }
        _ => Err(Failure::request(format!(
            "scene:{spec}: seed={range} is no range; write seed=1-20, at most {MOST} seeds"
        ))),
    }
}
