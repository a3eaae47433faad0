//! Folders in the layout of EVOPS: depth beside labels, as of ICL-NUIM and TUM.

use super::dataset::{Dataset, Item};
use super::folder::beside_labels;
use crate::failure::Outcome;
use std::path::Path;

pub(super) const DATASET: Dataset = Dataset {
    name: "evops",
    about: "EVOPS (Kornilova et al. 2022): plane labels of ICL-NUIM's rendered living room, depth in 1/5000 m.",
    folder: "gt_evops",
    layout: "NAME.depth.png (16 bit, 1/5000 m) beside NAME.labels.png (0 = no plane)",
    items,
};

/// ICL-NUIM's camera; its vertical axis points up.
const CAMERA: [f64; 4] = [481.2, -480.0, 319.5, 239.5];

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    beside_labels(DATASET.name, folder, [".depth.png", ".labels.png"], CAMERA)
}
