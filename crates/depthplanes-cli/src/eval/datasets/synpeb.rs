//! SynPEB's synthetic scans, as pinhole depth.

use super::dataset::{Dataset, Item};
use super::folder::beside_labels;
use crate::failure::Outcome;
use std::path::Path;

pub(super) const DATASET: Dataset = Dataset {
    name: "synpeb",
    about: "SynPEB (Schaefer et al. 2019): synthetic laser scans of rooms with many planes, as pinhole depth.",
    folder: "gt_synpeb",
    layout: "NAME.pinhole_depth.png (16 bit, 1/5000 m, focal length 400) beside NAME.pinhole_labels.png",
    items,
};

/// The camera that the scans were turned into pictures of.
const CAMERA: [f64; 4] = [400.0, 400.0, 279.5, 229.5];

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    beside_labels(DATASET.name, folder, [".pinhole_depth.png", ".pinhole_labels.png"], CAMERA)
}
