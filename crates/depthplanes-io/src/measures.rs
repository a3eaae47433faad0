//! The measures of a prediction against the truth as one table, which `score` and `eval` print and write.

use depthplanes::metrics::{
    Contingency, Evops, Partial, Partition, SegComp, SurfaceCounts, Tolerance, evops, partition, segcomp,
};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// What all measures say of a prediction.
pub struct Scores {
    /// Planes of the truth and of the prediction.
    pub planes: (usize, usize),
    /// SegComp's classes of planes.
    pub segcomp: SegComp,
    /// EVOPS' measures.
    pub evops: Evops,
    /// Measures of partitions, over all pixels; `None` for maps without a pixel.
    pub partition: Option<Partition>,
    /// The same over the pixels on planes of the truth; `None` if there are none.
    pub on_planes: Option<Partition>,
}

impl Scores {
    /// Of a table of labels against each other.
    pub fn of(table: &Contingency, tolerance: Tolerance) -> Self {
        Scores {
            planes: (table.truth_planes().len(), table.predicted_planes().len()),
            segcomp: segcomp(table, tolerance),
            evops: evops(table),
            partition: partition(table),
            on_planes: partition(&table.on_truth_planes()),
        }
    }
}

/// What a measure reads off the scores.
#[derive(Clone, Copy)]
enum Reading {
    Count(fn(&Scores) -> usize),
    Share(fn(&Scores) -> f64),
    /// A number that some predictions do not have.
    Known(fn(&Scores) -> Option<f64>),
}
use Reading::{Count, Known, Share};

/// One measure: a line of the table, a field of the JSON.
pub struct Measure {
    /// The JSON object that it belongs to.
    pub family: &'static str,
    /// Its name, the field of that object.
    pub name: &'static str,
    /// Heading of its column in the table of several pairs; empty if it has none.
    pub column: &'static str,
    /// What it says, in words.
    pub meaning: &'static str,
    reading: Reading,
}

impl Measure {
    /// Its value; `None` for predictions that have none.
    pub fn value(&self, scored: &Scores) -> Option<f64> {
        match self.reading {
            Count(count) => Some(count(scored) as f64),
            Share(share) => Some(share(scored)),
            Known(number) => number(scored),
        }
    }

    /// For people.
    pub fn written(&self, scored: &Scores) -> String {
        match self.reading {
            Count(count) => count(scored).to_string(),
            _ => decimal(self.value(scored)),
        }
    }

    /// Its value as JSON: counts are whole numbers.
    pub fn json(&self, scored: &Scores) -> Value {
        match self.reading {
            Count(count) => count(scored).into(),
            _ => self.value(scored).into(),
        }
    }
}

const fn measure(
    family: &'static str,
    name: &'static str,
    column: &'static str,
    meaning: &'static str,
    reading: Reading,
) -> Measure {
    Measure { family, name, column, meaning, reading }
}

/// All measures, in the order of the table; a family's measures stand together.
#[rustfmt::skip]
pub const MEASURES: &[Measure] = &[
    measure("planes", "truth", "truth", "planes of the truth", Count(|s| s.planes.0)),
    measure("planes", "predicted", "pred", "predicted planes", Count(|s| s.planes.1)),
    measure("segcomp", "correct", "correct", "truth planes found by one predicted plane", Count(|s| s.segcomp.correct.len())),
    measure("segcomp", "over_segmented", "over", "truth planes cut into several", Count(|s| s.segcomp.over_segmented.len())),
    measure("segcomp", "under_segmented", "under", "predicted planes that join several", Count(|s| s.segcomp.under_segmented.len())),
    measure("segcomp", "missed", "missed", "truth planes in none of these", Count(|s| s.segcomp.missed.len())),
    measure("segcomp", "noise", "noise", "predicted planes in none of these", Count(|s| s.segcomp.noise.len())),
    measure("synpeb", "f", "f", "share of the truth planes that are correct", Known(|s| s.segcomp.f)),
    measure("synpeb", "k", "k", "the same, weighted by pixels", Known(|s| s.segcomp.k)),
    measure("evops", "precision", "prec", "share of the predicted planes with IoU >= 0.75", Share(|s| s.evops.precision)),
    measure("evops", "recall", "recall", "share of the truth planes with IoU >= 0.75", Share(|s| s.evops.recall)),
    measure("evops", "f_score", "F", "harmonic mean of both", Share(|s| s.evops.f_score)),
    measure("evops", "mean_iou", "", "mean IoU of the matched planes", Share(|s| s.evops.mean_iou)),
    measure("evops", "mean_dice", "", "their mean Dice coefficient", Share(|s| s.evops.mean_dice)),
    measure("evops", "panoptic_iou", "panoptic", "mean_iou times f_score", Share(|s| s.evops.panoptic_iou)),
    measure("evops", "panoptic_dice", "", "mean_dice times f_score", Share(|s| s.evops.panoptic_dice)),
    measure("evops", "usr", "", "share of the predicted planes that join several", Share(|s| s.evops.under_segmented)),
    measure("evops", "osr", "", "share of the truth planes cut into several", Share(|s| s.evops.over_segmented)),
    measure("evops", "missed", "", "share of the truth planes that are missed", Share(|s| s.evops.missed)),
    measure("evops", "noise", "", "share of the predicted planes that are noise", Share(|s| s.evops.noise)),
    measure("partition", "rand_index", "RI", "RI over all pixels, no plane being one more region", Known(|s| Some(s.partition?.rand_index))),
    measure("partition", "variation_of_information", "VOI", "VOI, bits; 0 is best", Known(|s| Some(s.partition?.variation_of_information))),
    measure("partition", "segmentation_covering", "SC", "SC", Known(|s| Some(s.partition?.segmentation_covering))),
    measure("on_planes", "rand_index", "", "RI over the pixels on truth planes", Known(|s| Some(s.on_planes?.rand_index))),
    measure("on_planes", "variation_of_information", "", "VOI there", Known(|s| Some(s.on_planes?.variation_of_information))),
    measure("on_planes", "segmentation_covering", "", "SC there", Known(|s| Some(s.on_planes?.segmentation_covering))),
];

/// The families of counts over labelled surfaces, and the fewest pixels of theirs. What a sensor makes of a surface depends
/// on its size: below 3,000 pixels it is mostly border, above 10,000 the smooth part of the error shows.
const SURFACES: [(&str, u64); 3] = [("surfaces", 1), ("surfaces_3000", 3000), ("surfaces_10000", 10_000)];

type OfSurfaces = fn(&SurfaceCounts) -> u64;

/// Counts of a family.
#[rustfmt::skip]
const COUNTS: [(&str, OfSurfaces); 8] = [
    ("all", |counts| counts.surfaces),
    ("correct", |counts| counts.correct),
    ("merged", |counts| counts.merged),
    ("split", |counts| counts.split),
    ("missed", |counts| counts.missed),
    ("pieces", |counts| counts.pieces),
    ("pixels", |counts| counts.pixels),
    ("correct_pixels", |counts| counts.correct_pixels),
];

/// The measures of a partial truth, by `family.name`: counts, so that those of several maps can be added up.
pub fn of_surfaces(found: &Partial) -> BTreeMap<String, f64> {
    let of_family = |(family, least): (&str, u64)| {
        let counts = found.of_at_least(least);
        COUNTS.map(|(name, count)| (format!("{family}.{name}"), count(&counts) as f64))
    };
    let not_planar = [("pixels", found.not_planar), ("covered", found.not_planar_covered)];
    let not_planar = not_planar.map(|(name, pixels)| (format!("not_planar.{name}"), pixels as f64));
    SURFACES.into_iter().flat_map(of_family).chain(not_planar).collect()
}

/// An object for each family, with a field for each of its measures.
pub fn families(value: impl Fn(&Measure) -> Value) -> Map<String, Value> {
    let mut all = Map::new();
    for measure in MEASURES {
        let family = all.entry(measure.family).or_insert_with(|| json!({}));
        family[measure.name] = value(measure);
    }
    all
}

/// Three decimals, or a dash.
pub fn decimal(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.3}"))
}
