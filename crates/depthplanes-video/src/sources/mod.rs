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

/// All sources; the first that takes a word opens it.
pub const SOURCES: &[SourceInfo] =
    &[scene::SCENE, raw::RAW, mcap::MCAP, rosbag2::ROSBAG2, tum::TUM, seven_scenes::SEVEN_SCENES, folder::FOLDER];

/// Opens the source that a word stands for: a folder, a recording, `-` for raw frames on standard
/// input, `scene:SPEC`.
///
/// # Errors
/// [`Error::Source`] for a word that no source takes, and those of opening it.
pub fn open(word: &str, options: &SourceOptions) -> Result<Box<dyn Source>> {
    let Some(info) = SOURCES.iter().find(|info| (info.is)(word)) else {
        let wrong =
            if std::path::Path::new(word).exists() { "no source of frames" } else { "there is no such file or folder" };
        let accepted: Vec<String> = SOURCES.iter().map(|info| format!("{} ({})", info.name, info.about)).collect();
        return Err(Error::source(word, wrong, accepted.join("; ")));
    };
    (info.open)(word, options)
}
