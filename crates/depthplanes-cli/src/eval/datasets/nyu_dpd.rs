//! NYU frames with planes drawn by the authors of DPD; grey levels, near is bright.

use super::dataset::{Dataset, Item};
use super::folder::{files, name_of, needed, options, truth};
use crate::failure::Outcome;
use depthplanes::ValueKind;
use depthplanes::noise::SensorNoise;
use depthplanes_io::{Frame, Pixels, ReadOptions};
use std::path::{Path, PathBuf};

pub(super) const DATASET: Dataset = Dataset {
    name: "nyu-dpd",
    about: "NYU frames with planes drawn by hand (Jin et al. 2018, DPD): 8-bit grey levels, near is bright.",
    folder: "gt_nyu_dpd",
    layout: "depth/NAME.png (8 bit) and labels/NAME.png (0 = no plane)",
    items,
};

/// Grey level of infinity, about: each map is stretched by itself, and planes fit best as `350 - grey`.
const FARTHEST: u16 = 350;
/// How far those values lie off planes: 0.075 of the square of the range in thousands.
const NOISE: SensorNoise = SensorNoise::Depth { base: 0.0, growth: 0.075 };

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    let depth = folder.join("depth");
    if !depth.is_dir() {
        return Ok(Vec::new());
    }
    let item = |depth: PathBuf| {
        let name = name_of(&depth).replace(".png", "");
        let labels = needed(folder.join("labels").join(name_of(&depth)), &depth)?;
        let options = options(Some("millimetre"), Some(NOISE));
        let frame = Box::new(move || turned(&depth, &options));
        Ok(Item { dataset: DATASET.name.into(), name, frame, truth: Some(truth(labels, 1)), is_sequence: false })
    };
    files(&depth, |name| name.ends_with(".png"))?.into_iter().map(item).collect()
}

/// The map with far values large, as depth has them.
fn turned(path: &Path, options: &ReadOptions) -> Outcome<Frame> {
    let mut frame = depthplanes_io::read(path, options)?;
    if let Pixels::U8(grey) = &frame.pixels {
        let depth = |&grey: &u8| if grey == 0 { 0 } else { FARTHEST - u16::from(grey) };
        frame.pixels = Pixels::U16(grey.iter().map(depth).collect());
        frame.sensor.value_kind = ValueKind::depth(0.001)?;
    }
    Ok(frame)
}
