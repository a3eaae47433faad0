//! TUM RGB-D, and ICL-NUIM in its layout: a list of times and files, 1/5000 m, and a list of poses.

use super::files::{Entry, Files, PoseOf, text};
use crate::error::{Error, Result};
use crate::pose_text::quaternion;
use crate::source::{Source, SourceInfo, SourceOptions};
use depthplanes::track::CameraPose;
use depthplanes_io::camera_file::read_camera;
use std::path::{Path, PathBuf};

pub(super) const TUM: SourceInfo = SourceInfo {
    name: "tum",
    about: "a folder with depth.txt, associations.txt or depth_associations.txt as TUM RGB-D has it",
    is: |word| list_in(Path::new(word)).is_some(),
    open,
};

/// Lists of depth maps: of each line the last two words are a time and a file.
const LISTS: [&str; 3] = ["depth.txt", "associations.txt", "depth_associations.txt"];
/// Lists of poses: a time and `tx ty tz qx qy qz qw`.
const POSES: [&str; 2] = ["groundtruth.txt", "poses.txt"];
/// Files of the camera.
const CAMERAS: [&str; 3] = ["calibration_matrix.txt", "camera.yaml", "camera.txt"];
/// Seconds that a pose may be away from its frame: poses come at 100 Hz and more, so that nearer ones are missing.
const NEAR_S: f64 = 0.02;

fn open(word: &str, options: &SourceOptions) -> Result<Box<dyn Source>> {
    let folder = Path::new(word);
    let list = list_in(folder).expect("it was found");
    let poses = POSES.iter().map(|name| folder.join(name)).find(|path| path.is_file());
    let poses = poses.map_or_else(|| Ok(Vec::new()), |path| poses_of(&path))?;
    let mut entries = Vec::new();
    for (at, line) in lines(&text(&list)?) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [.., time, file] = words[..] else { return Err(not_a_line(&list, at, line)) };
        let time_s: f64 = time.parse().map_err(|_| not_a_line(&list, at, line))?;
        let path = file_of(folder, file).ok_or_else(|| {
            Error::source(
                format!("{}:{at}", list.display()),
                format!("there is no file {file}"),
                "the files of the data set beside its list",
            )
        })?;
        let pose = pose_at(&poses, time_s).map_or(PoseOf::Unknown, PoseOf::Known);
        entries.push(Entry { path, time_s: Some(time_s), pose });
    }
    if entries.is_empty() {
        return Err(Error::source(list.display(), "no frame in it", "lines of a time and a file"));
    }
    let mut read = options.read.clone();
    if read.encoding.is_none() && read.preset.is_none() {
        read.encoding = Some("tum".into());
    }
    let camera = CAMERAS.iter().map(|name| folder.join(name)).find(|path| path.is_file());
    if let Some(camera) = camera.filter(|_| read.intrinsics.is_none() && read.camera_file.is_none()) {
        read = read.camera(&read_camera(&camera)?);
    }
    Ok(Box::new(Files::new(entries, read)))
}

fn list_in(folder: &Path) -> Option<PathBuf> {
    LISTS.iter().map(|name| folder.join(name)).find(|path| path.is_file())
}

/// The lines that say something, with their numbers from 1.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = text.lines().enumerate().map(|(at, line)| (at + 1, line.trim()));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

fn not_a_line(path: &Path, at: usize, line: &str) -> Error {
    let accepted = "lines of a time in seconds and a file, such as `1341848230.91 depth/1341848230.91.png`";
    Error::source(format!("{}:{at}", path.display()), format!("`{line}`"), accepted)
}

/// The file as it is named, or as ICL-NUIM shortens it: `7` for `depth/0007.png`.
fn file_of(folder: &Path, name: &str) -> Option<PathBuf> {
    let short = name.parse::<u32>().ok();
    let short = short.map(|number| [format!("depth/{number:04}.png"), format!("depth/{number}.png")]);
    let named = [folder.join(name)].into_iter();
    named.chain(short.into_iter().flatten().map(|name| folder.join(name))).find(|path| path.is_file())
}

/// Times and poses, by time.
fn poses_of(path: &Path) -> Result<Vec<(f64, CameraPose)>> {
    let mut poses = Vec::new();
    for (at, line) in lines(&text(path)?) {
        let wrong = |wrong: String| {
            Error::source(
                format!("{}:{at}", path.display()),
                wrong,
                "a time, tx ty tz in metres and a quaternion qx qy qz qw",
            )
        };
        let numbers = line.split_whitespace().map(str::parse).collect::<std::result::Result<Vec<f64>, _>>();
        let numbers: [f64; 8] =
            numbers.ok().and_then(|all| all.try_into().ok()).ok_or_else(|| wrong(format!("`{line}`")))?;
        let [time_s, pose @ ..] = numbers;
        poses.push((time_s, quaternion(pose).map_err(|error| wrong(error.to_string()))?));
    }
    poses.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(poses)
}

/// The pose nearest in time, if one is near.
fn pose_at(poses: &[(f64, CameraPose)], time_s: f64) -> Option<CameraPose> {
    let after = poses.partition_point(|(time, _)| *time < time_s);
    let around = poses[after.saturating_sub(1)..(after + 1).min(poses.len())].iter();
    let nearest = around.min_by(|a, b| (a.0 - time_s).abs().total_cmp(&(b.0 - time_s).abs()))?;
    ((nearest.0 - time_s).abs() <= NEAR_S).then_some(nearest.1)
}
