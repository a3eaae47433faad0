//! A line of JSON for each frame.

use super::output::{Output, machine};
use crate::commands::track::follow::Followed;
use crate::failure::Outcome;
use depthplanes_video::failed_record;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

/// A file of lines, or standard output.
pub(super) struct Lines {
    file: Option<(File, PathBuf)>,
}

impl Lines {
    pub(super) fn new(path: &std::path::Path) -> Outcome<Self> {
        let file = File::create(path).map_err(|error| machine(path, error))?;
        Ok(Lines { file: Some((file, path.into())) })
    }

    pub(super) fn standard() -> Self {
        Lines { file: None }
    }

    fn line(&mut self, text: &str, out: &mut dyn Write) -> Outcome {
        let line = format!("{text}\n");
        match &mut self.file {
            Some((file, path)) => file.write_all(line.as_bytes()).map_err(|error| machine(path, error)),
            None => {
                out.write_all(line.as_bytes())?;
                Ok(out.flush()?)
            }
        }
    }
}

impl Output for Lines {
    fn write(&mut self, frame: &Followed, out: &mut dyn Write) -> Outcome {
        self.line(&frame.tracked().record().to_string(), out)
    }

    fn write_failed(&mut self, index: u64, error: &str, out: &mut dyn Write) -> Outcome {
        self.line(&failed_record(index, error).to_string(), out)
    }
}
