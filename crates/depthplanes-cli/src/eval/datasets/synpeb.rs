//! SynPEB's made-up scans, as pinhole depth.

use super::{Dataset, Item, files, name_of, needed, options, reading, truth};
use crate::failure::Outcome;
use depthplanes::Intrinsics;
use std::path::Path;

pub(super) const DATASET: Dataset = Dataset {
    name: "synpeb",
    about: "SynPEB (Schaefer et al. 2019): made-up laser scans of rooms with many planes, as pinhole depth.",
    folder: "gt_synpeb",
    layout: "NAME.pinhole_depth.png (16 bit, 1/5000 m, focal length 400) beside NAME.pinhole_labels.png",
    items,
};

/// The camera that the scans were turned into pictures of.
const CAMERA: [f64; 4] = [400.0, 400.0, 279.5, 229.5];

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    let [fx, fy, cx, cy] = CAMERA;
    let camera = Intrinsics::new(fx, fy, cx, cy)?;
    let item = |depth: std::path::PathBuf| {
        let name = name_of(&depth).replace(".pinhole_depth.png", "");
        let labels = needed(depth.with_file_name(format!("{name}.pinhole_labels.png")), &depth)?;
        let mut options = options(Some("tum"), None);
        options.intrinsics = Some(camera);
        let frame = reading(depth, options);
        Ok(Item { dataset: DATASET.name.into(), name, frame, truth: Some(truth(labels, 1)) })
    };
    files(folder, |name| name.ends_with(".pinhole_depth.png"))?.into_iter().map(item).collect()
}
