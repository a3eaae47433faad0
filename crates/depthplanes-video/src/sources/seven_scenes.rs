//! 7-Scenes, and others of its layout: `NAME.depth.png` with `NAME.pose.txt`, camera to world, beside it.

use super::files::{Entry, Files, PoseOf, names_in};
use crate::error::Result;
use crate::source::{Source, SourceInfo, SourceOptions};
use depthplanes::Intrinsics;
use depthplanes_io::camera_file::read_camera;
use std::path::Path;

pub(super) const SEVEN_SCENES: SourceInfo = SourceInfo {
    name: "7scenes",
    about: "a folder of NAME.depth.png with NAME.pose.txt and perhaps camera-intrinsics.txt",
    is: |word| {
        let folder = Path::new(word);
        let has_pose = |name: &String| folder.join(name.replace(DEPTH, POSE)).is_file();
        depth_names(folder).is_ok_and(|names| names.iter().any(has_pose))
    },
    open,
};

const DEPTH: &str = ".depth.png";
const POSE: &str = ".pose.txt";

/// What the pages of 7-Scenes state of its depth camera.
const CAMERA: [f64; 4] = [585.0, 585.0, 320.0, 240.0];
/// The size of its pictures.
const CAMERA_SIZE: (usize, usize) = (640, 480);
/// The value that means missing there.
const MISSING: f64 = 65_535.0;

fn open(word: &str, options: &SourceOptions) -> Result<Box<dyn Source>> {
    let folder = Path::new(word);
    let entry = |name: String| {
        let pose = folder.join(name.replace(DEPTH, POSE));
        let pose = if pose.is_file() { PoseOf::File(pose) } else { PoseOf::Unknown };
        Entry { path: folder.join(name), time_s: None, pose }
    };
    let entries = depth_names(folder)?.into_iter().map(entry).collect();
    let (mut read, mut note) = (options.read.clone(), None);
    if read.intrinsics.is_none() && read.camera_file.is_none() && read.preset.is_none() {
        let file = folder.join("camera-intrinsics.txt");
        if file.is_file() {
            read = read.camera(&read_camera(&file)?);
        } else {
            let [fx, fy, cx, cy] = CAMERA;
            note = Some(format!(
                "no camera is stated: it is taken for that of 7-Scenes, {fx},{fy},{cx},{cy} at 640 x 480; another is stated with \
                 --camera FILE or --intrinsics FX,FY,CX,CY"
            ));
            read.intrinsics = Some(Intrinsics::new(fx, fy, cx, cy)?);
            read.camera_size = read.camera_size.or(Some(CAMERA_SIZE));
        }
    }
    if read.encoding.is_none() && read.preset.is_none() {
        read.encoding = Some("millimetre".into());
    }
    read.missing = read.missing.or(Some(MISSING));
    Ok(Box::new(Files::new(entries, read).note(note)))
}

fn depth_names(folder: &Path) -> Result<Vec<String>> {
    Ok(names_in(folder)?.into_iter().filter(|name| name.ends_with(DEPTH)).collect())
}
