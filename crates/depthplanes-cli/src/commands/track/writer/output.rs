//! What an output of a tracked video is.

use crate::commands::track::follow::Followed;
use crate::failure::{Failure, Outcome};
use std::io::{self, Write};
use std::path::Path;

/// A kind of output, which goes to a file or a folder.
pub(super) struct OutputInfo {
    /// Its name on the command line.
    pub(super) name: &'static str,
    /// Its file or folder among the results of a video.
    pub(super) file: &'static str,
    /// Makes the file or folder.
    pub(super) open: fn(&Path) -> Outcome<Box<dyn Output>>,
}

/// An output; `out` is standard output. Errors are what the machine says, unless something else is said.
pub(super) trait Output {
    /// Writes a frame.
    fn write(&mut self, frame: &Followed, out: &mut dyn Write) -> Outcome;

    /// Writes that a frame could not be read.
    fn write_failed(&mut self, _index: u64, _error: &str, _out: &mut dyn Write) -> Outcome {
        Ok(())
    }

    /// Writes what comes after all frames.
    fn end(&mut self, _out: &mut dyn Write) -> Outcome {
        Ok(())
    }
}

/// What the machine says of a file.
pub(super) fn machine(path: &Path, error: io::Error) -> Failure {
    Failure::machine(format!("{}: {error}", path.display()))
}
