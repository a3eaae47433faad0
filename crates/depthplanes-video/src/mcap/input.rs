//! The bytes of a file, from anywhere in it.

use crate::error::{Error, Result};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// A file of a length that is known, read piece by piece.
#[derive(Debug)]
pub(super) struct Input {
    pub(super) path: PathBuf,
    pub(super) length: u64,
    file: BufReader<File>,
    at: u64,
}

impl Input {
    pub(super) fn open(path: &Path) -> Result<Self> {
        let io = |error| Error::io(path, error);
        let file = File::open(path).map_err(io)?;
        let length = file.metadata().map_err(io)?.len();
        Ok(Input { path: path.into(), length, file: BufReader::with_capacity(1 << 13, file), at: 0 })
    }

    /// The bytes at a place; fewer where the file ends before. Whoever asks for many has checked how many that may be.
    pub(super) fn read(&mut self, at: u64, count: u64) -> Result<Vec<u8>> {
        let mut bytes = vec![0; count.min(self.length.saturating_sub(at)) as usize];
        let place = |at: u64| i64::try_from(at).unwrap_or(i64::MAX);
        let mut read = || {
            // What is buffered stays, if the place is in it.
            match self.at.cmp(&at) {
                std::cmp::Ordering::Equal => (),
                _ if self.at.abs_diff(at) < 1 << 20 => self.file.seek_relative(place(at) - place(self.at))?,
                _ => _ = self.file.seek(SeekFrom::Start(at))?,
            }
            self.file.read_exact(&mut bytes)
        };
        read().map_err(|error| Error::io(&self.path, error))?;
        self.at = at + bytes.len() as u64;
        Ok(bytes)
    }

    /// What is wrong at a place of the file.
    pub(super) fn fault(&self, at: u64, wrong: impl std::fmt::Display) -> Error {
        let accepted = "a whole MCAP file; `mcap recover FILE` writes what can be saved into another one";
        Error::source(self.path.display(), format!("byte {at}: {wrong}"), accepted)
    }
}
