//! Folders of depth frames without a truth: of a Kinect, TUM, 7-Scenes, CAPE, or one's own.

use super::{Dataset, Item, files, name_of, options, reading};
use crate::failure::Outcome;
use depthplanes_io::camera_file::read_camera;
use std::path::{Path, PathBuf};

pub(super) const DATASET: Dataset = Dataset {
    name: "kinect",
    about: "Depth frames of a Kinect or any other depth camera (TUM, 7-Scenes, CAPE, your own), without a truth.",
    folder: "kinect_v1",
    layout: "depth maps in millimetres, *depth*.png, and perhaps a camera file (camera.json, camera.yaml, camera.txt)",
    items,
};

/// Names of a camera file.
const CAMERAS: [&str; 4] = ["camera.json", "camera.yaml", "camera.yml", "camera.txt"];

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    let mut options = options(Some("millimetre"), None);
    if let Some(camera) = CAMERAS.iter().map(|name| folder.join(name)).find(|path| path.is_file()) {
        options = options.camera(&read_camera(&camera)?);
    }
    let item = |depth: PathBuf| {
        let name = name_of(&depth).replace(".png", "");
        Item { dataset: DATASET.name.into(), name, frame: reading(depth, options.clone()), truth: None }
    };
    let is_map = |name: &str| name.ends_with(".png") && name.contains("depth");
    Ok(files(folder, is_map)?.into_iter().map(item).collect())
}
