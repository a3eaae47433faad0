//! Folders of depth frames without a truth: of a Kinect, TUM, 7-Scenes, CAPE, or one's own.

use super::dataset::{Dataset, Item};
use super::folder::{files, name_of, options, reading};
use crate::failure::Outcome;
use depthplanes_io::camera_file::{CameraFile, read_camera};
use std::path::{Path, PathBuf};

pub(super) const DATASET: Dataset = Dataset {
    name: "kinect",
    about: "Depth frames of a Kinect or any other depth camera (TUM, 7-Scenes, CAPE, your own), without a truth.",
    folder: "kinect_v1",
    layout: "depth maps in millimetres, *depth*.png, or a folder depth with *.png in it (beside a list of TUM's, such as \
             depth.txt, in 1/5000 m), and perhaps a camera file (camera.json, camera.yaml, camera.txt)",
    items,
};

/// Names of a camera file.
const CAMERAS: [&str; 6] =
    ["camera.json", "camera.yaml", "camera.yml", "camera.txt", "camera-intrinsics.txt", "calibration_matrix.txt"];
/// Lists that stand in a folder of TUM's layout.
const LISTS: [&str; 4] = ["depth.txt", "associations.txt", "depth_associations.txt", "groundtruth.txt"];
/// What 7-Scenes writes where nothing was measured; no such camera sees 65.5 m.
pub(super) const MISSING: f64 = 65535.0;

/// The camera file of a folder, if it has one.
///
/// # Errors
/// A camera file that cannot be read.
pub(super) fn camera(folder: &Path) -> Outcome<Option<CameraFile>> {
    Ok(one_of(folder, &CAMERAS).map(read_camera).transpose()?)
}

/// The first of these files that is in a folder.
fn one_of(folder: &Path, names: &[&str]) -> Option<PathBuf> {
    names.iter().map(|name| folder.join(name)).find(|path| path.is_file())
}

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    let within = folder.join("depth");
    let is_tum = within.is_dir() && one_of(folder, &LISTS).is_some();
    let mut options = options(Some(if is_tum { "tum" } else { "millimetre" }), None);
    if let Some(camera) = camera(folder)? {
        options = options.camera(&camera);
    }
    let maps = match within.is_dir() {
        true => files(&within, |name| name.ends_with(".png"))?,
        false => files(folder, |name| name.ends_with(".png") && name.contains("depth"))?,
    };
    let item = |depth: PathBuf| {
        let file = name_of(&depth);
        let mut options = options.clone();
        options.missing = (file.starts_with("frame-") && file.ends_with(".depth.png")).then_some(MISSING);
        // Several folders may be asked for at once.
        let dataset = format!("{} {}", DATASET.name, name_of(folder));
        Item {
            dataset,
            name: file.strip_suffix(".png").unwrap_or(&file).into(),
            frame: reading(depth, options),
            truth: None,
            is_sequence: false,
        }
    };
    Ok(maps.into_iter().map(item).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use depthplanes::ValueKind;
    use depthplanes_io::outputs::grey16_png;

    /// A folder with some files; each map has the pixels 5000 and 65535.
    fn folder(name: &str, maps: &[&str], texts: &[(&str, &str)]) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("depthplanes-{name}-{}", std::process::id()));
        for map in maps {
            let path = folder.join(map);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, grey16_png(2, 1, &[5000, 65535])).unwrap();
        }
        texts.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).unwrap());
        folder
    }

    /// Metres of a unit and valid pixels of the only map.
    fn read(folder: &Path) -> (f64, usize, bool) {
        let items = items(folder).unwrap();
        assert_eq!(items.len(), 1);
        let frame = (items[0].frame)().unwrap();
        let ValueKind::Depth { metres } = frame.sensor.value_kind else { panic!("{:?}", frame.sensor) };
        let valid = depthplanes::with_view!(frame.view().unwrap(), view => view.valid_pixels());
        std::fs::remove_dir_all(folder).unwrap();
        (metres, valid, frame.sensor.intrinsics.is_some())
    }

    #[test]
    fn folders_of_tum_and_7_scenes_and_ones_own_are_read_as_they_are_meant() {
        let own = folder("own", &["depth7.png"], &[("camera.txt", "500 500 1 0.5")]);
        assert_eq!(read(&own), (0.001, 1, true));
        let scenes = folder("7-scenes", &["frame-000000.depth.png"], &[]);
        assert_eq!(read(&scenes), (0.001, 1, false));
        let tum = folder("tum", &["depth/1341.png"], &[("depth.txt", "# depth maps\n")]);
        assert_eq!(read(&tum), (0.0002, 1, false));
        let plain = folder("plain", &["depth/1.png"], &[]);
        assert_eq!(read(&plain), (0.001, 1, false));
    }
}
