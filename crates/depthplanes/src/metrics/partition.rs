//! Two label images as partitions of the pixels: Rand index, variation of information and
//! segmentation covering, as PlaneNet, PlaneRCNN and their successors report them.
//!
//! As in PlaneRCNN's `evaluateMasksTensor` the pixels of no plane are one more region on either
//! side. Which pixels take part is the table's matter: all of them, or
//! those on truth planes ([`Contingency::on_truth_planes`]), as later papers have it.

use super::contingency::{Contingency, Overlap, Region};
use std::collections::BTreeMap;

/// The measures of two partitions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Partition {
    /// RI, 0..=1: the share of pairs of pixels on which both agree, together or apart. 1 for a
    /// single pixel.
    pub rand_index: f64,
    /// VOI, bits, 0 and up: what one partition does not tell of the other, both ways. 0 = equal.
    pub variation_of_information: f64,
    /// SC, 0..=1: the best intersection over union of each region, weighted by its pixels; mean of
    /// both directions.
    pub segmentation_covering: f64,
}

/// The measures of a table; `None` if it has no pixel.
pub fn partition(table: &Contingency) -> Option<Partition> {
    (table.pixels() > 0).then(|| Partition {
        rand_index: rand_index(table),
        variation_of_information: variation_of_information(table),
        segmentation_covering: (covering(table) + covering(&table.swapped())) / 2.0,
    })
}

/// 1 - ((sum of rows^2 + sum of columns^2) / 2 - sum of cells^2) / (n (n - 1) / 2), in integers up
/// to the division.
fn rand_index(table: &Contingency) -> f64 {
    let square = |pixels: u64| u128::from(pixels) * u128::from(pixels);
    let squares = |regions: &[Region]| regions.iter().map(|region| square(region.pixels)).sum::<u128>();
    let cells: u128 = table.overlaps().iter().map(|overlap| square(overlap.pixels)).sum();
    let disagreeing = squares(table.truth()) + squares(table.prediction()) - 2 * cells;
    let pairs = square(table.pixels()) - u128::from(table.pixels());
    1.0 - disagreeing as f64 / pairs.max(1) as f64
}

/// H(rows) + H(columns) - 2 MI = H(rows | columns) + H(columns | rows); so written, no term is
/// negative.
fn variation_of_information(table: &Contingency) -> f64 {
    let surprise = |share: f64| share.recip().log2();
    let bits = |overlap: &Overlap| {
        overlap.pixels as f64 * (surprise(overlap.share_of_truth()) + surprise(overlap.share_of_prediction()))
    };
    table.overlaps().iter().map(bits).sum::<f64>() / table.pixels() as f64
}

/// Sum over the truth's regions of their share of the pixels times their best intersection over union.
fn covering(table: &Contingency) -> f64 {
    let mut best: BTreeMap<u16, (u64, f64)> = BTreeMap::new();
    for overlap in table.overlaps() {
        let (_, iou) = best.entry(overlap.truth.label).or_insert((overlap.truth.pixels, 0.0));
        *iou = iou.max(overlap.iou());
    }
    best.into_values().map(|(pixels, iou)| pixels as f64 * iou).sum::<f64>() / table.pixels() as f64
}
