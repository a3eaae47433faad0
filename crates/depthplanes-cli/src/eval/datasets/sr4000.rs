//! Frames of a SwissRanger SR4000 with planes drawn by the authors of DPD.

use super::dataset::{Dataset, Item, Load, TruthOf};
use super::folder::{files, name_of, options, reading};
use crate::failure::{Failure, Outcome};
use depthplanes::noise::SensorNoise;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{LabelImage, read_labels};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub(super) const DATASET: Dataset = Dataset {
    name: "sr4000",
    about: "SwissRanger SR4000 frames with planes drawn by hand (Jin et al. 2018, DPD): 176 x 144 grey levels.",
    folder: "gt_sr4000_dpd",
    layout: "NAME.bmp (8 bit) beside a picture whose name begins with NAME_GT and ends with .bmp, a colour for each plane",
    items,
};

/// Scatter of the grey levels about planes.
const NOISE: SensorNoise = SensorNoise::Value { sigma: 1.0 };
/// Fewest pixels of a colour that is a plane: edges and compression make others.
const LEAST: usize = 100;
/// Brightest grey that is no plane.
const DARK: u16 = 20;

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    let pictures = files(folder, |name| name.ends_with(".bmp") && name.contains("_GT"))?;
    let item = |map: PathBuf| {
        let name = name_of(&map).replace(".bmp", "");
        let lacks = || Failure::request(format!("{}: no {name}_GT*.bmp beside it", map.display()));
        let start = format!("{name}_GT");
        let truth = pictures.iter().find(|path| name_of(path).starts_with(&start)).ok_or_else(lacks)?.clone();
        let frame = reading(map, options(Some("grey"), Some(NOISE)));
        Ok(Item { dataset: DATASET.name.into(), name, frame, truth: Some(colours(truth)), is_sequence: false })
    };
    files(folder, |name| name.ends_with(".bmp") && !name.contains("_GT"))?.into_iter().map(item).collect()
}

/// A label for each colour that occurs often; edges are white.
fn colours(path: PathBuf) -> Load<TruthOf> {
    Box::new(move || {
        let LabelImage { width, height, labels: greys, warnings } =
            read_labels(&path, &DecodeOptions { luminance: true, ..DecodeOptions::default() })?;
        let mut counts = BTreeMap::new();
        greys.iter().for_each(|&grey| *counts.entry(grey).or_insert(0) += 1);
        let is_plane = |&(&grey, &count): &(&u16, &usize)| count >= LEAST && grey > DARK && grey < 255;
        let numbers: BTreeMap<u16, u16> = counts.iter().filter(is_plane).map(|(&grey, _)| grey).zip(1..).collect();
        let labels = greys.iter().map(|grey| numbers.get(grey).copied().unwrap_or(0)).collect();
        let labels = LabelImage { width, height, labels, warnings };
        Ok(TruthOf { labels, from: 1, planes: Vec::new(), partial: None })
    })
}
