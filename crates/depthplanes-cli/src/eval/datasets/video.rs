//! Frames of a recording in their order, without a truth: how steady the planes are is measured from frame to frame.

use super::dataset::{Dataset, Item};
use super::folder::{files, name_of, options, reading};
use super::kinect::{MISSING, camera};
use crate::failure::Outcome;
use depthplanes::Intrinsics;
use std::path::{Path, PathBuf};

const LAYOUT: &str = "frame-NUMBER.depth.png (16 bit, millimetres, 65535 = missing), perhaps camera-intrinsics.txt or another \
                      camera file";

pub(super) const SEVEN_SCENES: Dataset = Dataset {
    name: "7scenes",
    about: "Consecutive frames of 7-Scenes (Kinect v1, hardly moving), without a truth; as a sequence.",
    folder: "video_7scenes",
    layout: LAYOUT,
    items: |folder| items(folder, SEVEN_SCENES.name),
};

pub(super) const TSDF: Dataset = Dataset {
    name: "tsdf",
    about: "Consecutive frames of tsdf-fusion-python (Kinect v1, moving), without a truth; as a sequence.",
    folder: "video_tsdf_fusion",
    layout: LAYOUT,
    items: |folder| items(folder, TSDF.name),
};

/// What both recordings state of their camera, where its file does not lie beside the frames.
const CAMERA: [f64; 4] = [585.0, 585.0, 320.0, 240.0];

fn items(folder: &Path, dataset: &str) -> Outcome<Vec<Item>> {
    let [fx, fy, cx, cy] = CAMERA;
    let mut options = options(Some("millimetre"), None);
    options.missing = Some(MISSING);
    options.intrinsics = Some(Intrinsics::new(fx, fy, cx, cy)?);
    if let Some(camera) = camera(folder)? {
        options = options.camera(&camera);
    }
    let item = |depth: PathBuf| {
        let name = name_of(&depth).replace(".depth.png", "");
        let frame = reading(depth, options.clone());
        Item { dataset: dataset.into(), name, frame, truth: None, is_sequence: true }
    };
    let is_frame = |name: &str| name.starts_with("frame-") && name.ends_with(".depth.png");
    Ok(files(folder, is_frame)?.into_iter().map(item).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use depthplanes_io::outputs::grey16_png;

    #[test]
    fn frames_come_in_their_order_and_the_camera_is_that_of_the_folder() {
        let folder = std::env::temp_dir().join(format!("depthplanes-video-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut pixels = vec![5000; 640 * 480];
        pixels[0] = 65_535;
        for name in ["frame-10.depth.png", "frame-9.depth.png", "other.depth.png"] {
            std::fs::write(folder.join(name), grey16_png(640, 480, &pixels)).unwrap();
        }
        let read = || {
            let items = items(&folder, "7scenes").unwrap();
            assert_eq!(items.iter().map(|item| item.name.as_str()).collect::<Vec<_>>(), ["frame-9", "frame-10"]);
            assert!(items.iter().all(|item| item.is_sequence && item.truth.is_none()));
            let frame = (items[0].frame)().unwrap();
            let valid = depthplanes::with_view!(frame.view().unwrap(), view => view.valid_pixels());
            (valid, frame.sensor.intrinsics.unwrap().fx)
        };
        assert_eq!(read(), (640 * 480 - 1, 585.0));
        std::fs::write(folder.join("camera-intrinsics.txt"), "500 0 320\n0 500 240\n0 0 1\n").unwrap();
        assert_eq!(read(), (640 * 480 - 1, 500.0));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
