//! Folders in the layout of EVOPS: depth beside labels, as of ICL-NUIM and TUM.

use super::{Dataset, Item, files, name_of, needed, options, reading, truth};
use crate::failure::Outcome;
use depthplanes::Intrinsics;
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
    let [fx, fy, cx, cy] = CAMERA;
    let camera = Intrinsics::new(fx, fy, cx, cy)?;
    let item = |depth: std::path::PathBuf| {
        let name = name_of(&depth).replace(".depth.png", "");
        let labels = needed(depth.with_file_name(format!("{name}.labels.png")), &depth)?;
        let mut options = options(Some("tum"), None);
        options.intrinsics = Some(camera);
        let frame = reading(depth, options);
        Ok(Item { dataset: DATASET.name.into(), name, frame, truth: Some(truth(labels, 1)) })
    };
    files(folder, |name| name.ends_with(".depth.png"))?.into_iter().map(item).collect()
}
