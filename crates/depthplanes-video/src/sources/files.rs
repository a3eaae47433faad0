//! Frames that are files in an order that is known beforehand: what folders and data sets have in common.

use crate::error::{Error, Result};
use crate::frame::VideoFrame;
use crate::source::Source;
use depthplanes::track::CameraPose;
use depthplanes_io::{ReadOptions, read};
use std::path::{Path, PathBuf};

/// One file, and what is known of it beforehand.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) path: PathBuf,
    pub(super) time_s: Option<f64>,
    pub(super) pose: PoseOf,
}

/// Where the pose of a frame is found.
#[derive(Clone, Debug)]
pub(super) enum PoseOf {
    Unknown,
    Known(CameraPose),
    /// A file of four rows of four numbers.
    File(PathBuf),
}

/// Files as a source.
#[derive(Debug)]
pub(super) struct Files {
    entries: Vec<Entry>,
    next: usize,
    options: ReadOptions,
    /// What a person should know of every frame beside its own warnings.
    note: Option<String>,
}

impl Files {
    pub(super) fn new(entries: Vec<Entry>, options: ReadOptions) -> Self {
        Files { entries, next: 0, options, note: None }
    }

    /// With a note on every frame.
    pub(super) fn note(self, note: Option<String>) -> Self {
        Files { note, ..self }
    }

    fn read(&self, index: usize) -> Result<VideoFrame> {
        let Entry { path, time_s, pose } = &self.entries[index];
        let pose = match pose {
            PoseOf::Unknown => None,
            PoseOf::Known(pose) => Some(*pose),
            PoseOf::File(path) => Some(crate::pose_text::matrix(&text(path)?, path)?),
        };
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut frame = read(path, &self.options)?;
        frame.warnings.extend(self.note.clone());
        Ok(VideoFrame { index: index as u64, name, time_s: *time_s, pose, up: None, frame })
    }
}

impl Source for Files {
    fn next_frame(&mut self) -> Option<Result<VideoFrame>> {
        let index = self.next;
        (index < self.entries.len()).then(|| {
            self.next += 1;
            self.read(index)
        })
    }

    fn frames(&self) -> Option<u64> {
        Some(self.entries.len() as u64)
    }

    fn seek(&mut self, index: u64) -> bool {
        self.next = index.min(self.entries.len() as u64) as usize;
        true
    }
}

/// The names of a folder's files, in natural order; hidden ones left out.
pub(super) fn names_in(folder: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in folder.read_dir().map_err(|error| Error::io(folder, error))? {
        let entry = entry.map_err(|error| Error::io(folder, error))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if !name.starts_with('.') && entry.path().is_file() {
            names.push(name);
        }
    }
    names.sort_by(|a, b| crate::natural::compare(a, b));
    Ok(names)
}

/// A text file.
pub(super) fn text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|error| Error::io(path, error))
}
