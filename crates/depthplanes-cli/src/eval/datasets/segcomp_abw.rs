//! SegComp's ABW test images: polyhedra on a table, by a structured-light scanner.

use super::dataset::{Dataset, Item};
use super::folder::{files, name_of, needed, reading, truth};
use crate::failure::Outcome;
use depthplanes::Intrinsics;
use depthplanes_io::ReadOptions;
use depthplanes_io::presets::{PresetNoise, by_name};
use std::path::Path;

pub(super) const DATASET: Dataset = Dataset {
    name: "segcomp-abw",
    about: "SegComp ABW (Hoover et al. 1996): range images of polyhedra with regions drawn by hand; as pinhole depth.",
    folder: "gt_segcomp_abw",
    layout: "NAME.depth.png (16 bit, tenths of a millimetre) beside NAME.labels.png (planes from 10 up)",
    items,
};

/// Columns and rows per unit of the ray, of the scanner's second calibration.
const CAMERA: [f64; 4] = [1586.0728, 2301.0744, 255.0, 255.0];

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    let preset = by_name("structured-light")?;
    let of = |noise: Option<PresetNoise>| noise.and_then(|noise| noise.of());
    let (noise, smooth_noise) = (of(preset.noise), of(preset.smooth_noise));
    let [fx, fy, cx, cy] = CAMERA;
    let camera = Intrinsics::new(fx, fy, cx, cy)?;
    let item = |depth: std::path::PathBuf| {
        let name = name_of(&depth).replace(".depth.png", "");
        let labels = needed(depth.with_file_name(format!("{name}.labels.png")), &depth)?;
        let mut options = ReadOptions { noise, smooth_noise, ..ReadOptions::default() };
        (options.scale, options.intrinsics) = (Some(10_000.0), Some(camera));
        let frame = reading(depth, options);
        Ok(Item { dataset: DATASET.name.into(), name, frame, truth: Some(truth(labels, 10)), is_sequence: false })
    };
    files(folder, |name| name.ends_with(".depth.png"))?.into_iter().map(item).collect()
}
