//! EVOPS: the measures of the PyPI package `evops` 1.0.0 (Kornilova et al., *EVOPS Benchmark:
//! Evaluation of Plane Segmentation from RGBD and LiDAR Data*, 2022), equal to it to rounding.

use super::contingency::{Contingency, Match, Overlap};
use std::collections::BTreeMap;

/// Two planes with at least this intersection over union are one.
pub const IOU_FULL: f64 = 0.75;

/// Two planes with at least this intersection over union overlap in part.
pub const IOU_PART: f64 = 0.2;

/// The measures, all 0..=1. As in the package a share of no planes is 0.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Evops {
    /// Planes that are one by [`IOU_FULL`], by truth label.
    pub matched: Vec<Match>,
    /// Matched planes as a share of the predicted ones.
    pub precision: f64,
    /// Matched planes as a share of the truth's.
    pub recall: f64,
    /// Harmonic mean of precision and recall.
    pub f_score: f64,
    /// Mean intersection over union of the matched planes.
    pub mean_iou: f64,
    /// Mean Dice coefficient of the matched planes.
    pub mean_dice: f64,
    /// `mean_iou * f_score`.
    pub panoptic_iou: f64,
    /// `mean_dice * f_score`.
    pub panoptic_dice: f64,
    /// `usr`: predicted planes that overlap several truth planes by [`IOU_PART`], as a share.
    pub under_segmented: f64,
    /// `osr`: truth planes that overlap several predicted planes by [`IOU_PART`], as a share.
    pub over_segmented: f64,
    /// Truth planes that overlap no predicted plane by [`IOU_PART`], or only one, which overlaps no other and is not
    /// matched; as a share.
    pub missed: f64,
    /// The same share of predicted planes.
    pub noise: f64,
}

/// The measures of a table.
pub fn evops(table: &Contingency) -> Evops {
    // At 0.75 a plane matches one other at most, so there is nothing to choose.
    let matched: Vec<&Overlap> = table.overlaps_of_planes().filter(|overlap| overlap.iou() >= IOU_FULL).collect();
    let precision = share(matched.len(), table.predicted_planes().len());
    let recall = share(matched.len(), table.truth_planes().len());
    let f_score = if matched.is_empty() { 0.0 } else { 2.0 * precision * recall / (precision + recall) };
    let sum = |of: fn(&Overlap) -> f64| matched.iter().fold(0.0, |sum, overlap| sum + of(overlap));
    let matches = matched.len().max(1) as f64;
    let (mean_iou, mean_dice) = (sum(Overlap::iou) / matches, sum(Overlap::dice) / matches);
    let (over_segmented, missed) = split_and_lost(table);
    let (under_segmented, noise) = split_and_lost(&table.swapped());
    let pair = |overlap: &&Overlap| Match { truth: overlap.truth.label, prediction: overlap.prediction.label };
    Evops {
        matched: matched.iter().map(pair).collect(),
        precision,
        recall,
        f_score,
        mean_iou,
        mean_dice,
        panoptic_iou: mean_iou * f_score,
        panoptic_dice: mean_dice * f_score,
        under_segmented,
        over_segmented,
        missed,
        noise,
    }
}

fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole.max(1) as f64
}

/// Shares of the truth planes that several predicted ones overlap in part, and of those that are
/// missed.
fn split_and_lost(table: &Contingency) -> (f64, f64) {
    let parts: Vec<&Overlap> = table.overlaps_of_planes().filter(|overlap| overlap.iou() >= IOU_PART).collect();
    let (mut of_truth, mut of_prediction) = (BTreeMap::new(), BTreeMap::new());
    for part in &parts {
        *of_truth.entry(part.truth.label).or_insert(0) += 1;
        *of_prediction.entry(part.prediction.label).or_insert(0) += 1;
    }
    // A single overlap that is no match counts as missed, unless one of its planes is split or joined: that is
    // another error, counted there.
    let holds = |part: &&&Overlap| {
        part.iou() >= IOU_FULL || of_truth[&part.truth.label] > 1 || of_prediction[&part.prediction.label] > 1
    };
    let mut held: Vec<u16> = parts.iter().filter(holds).map(|part| part.truth.label).collect();
    held.dedup(); // overlaps are sorted by truth
    let planes = table.truth_planes().len();
    let split = of_truth.values().filter(|&&count| count > 1).count();
    (share(split, planes), share(planes - held.len(), planes))
}
