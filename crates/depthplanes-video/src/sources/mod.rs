//! The table of sources. A new source is one file here and one row below.

mod files;
mod folder;
mod mcap;
mod raw;
mod rosbag2;
mod scene;
mod seven_scenes;
mod topics;
mod tum;

use crate::error::{Error, Result};
use crate::source::{Source, SourceInfo, SourceOptions};
use std::path::Path;

/// All sources; the first that takes a word opens it.
pub const SOURCES: &[SourceInfo] =
    &[scene::SCENE, raw::RAW, mcap::MCAP, rosbag2::ROSBAG2, tum::TUM, seven_scenes::SEVEN_SCENES, folder::FOLDER];

/// Opens the source that a word stands for: a folder, a recording, `-` for raw frames on standard
/// input, `scene:SPEC`.
///
/// # Errors
/// [`Error::Source`] for a word that no source takes, and those of opening it.
pub fn open(word: &str, options: &SourceOptions) -> Result<Box<dyn Source>> {
    match SOURCES.iter().find(|info| (info.is)(word)) {
        Some(info) => (info.open)(word, options),
        None => Err(unknown(word)),
    }
}

/// What is wrong with a word that no source takes, and what was probably meant.
fn unknown(word: &str) -> Error {
    let path = Path::new(word);
    if path.is_file() && folder::is_map(word) {
        return Error::source(word, "one map, no video", "the folder it is in, or `depthplanes detect` for one map");
    }
    let recording = word.rsplit_once(':').filter(|(path, _)| Path::new(path).exists());
    if let Some((path, topic)) = recording {
        return Error::source(word, format!("the topic {topic} begins without a slash"), format!("{path}:/{topic}"));
    }
    let wrong = if path.exists() { "no source of frames" } else { "there is no such file or folder" };
    let accepted: Vec<&str> = SOURCES.iter().map(|info| info.about).collect();
    Error::source(word, wrong, accepted.join("; "))
}
