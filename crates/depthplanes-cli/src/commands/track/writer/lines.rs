//! A line of JSON for each frame.

use super::output::{Output, OutputInfo, machine};
use crate::commands::track::follow::Followed;
use crate::failure::Outcome;
use depthplanes_video::failed_record;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const LINES: OutputInfo =
    OutputInfo { name: "lines", file: "planes.jsonl", open: |path| Ok(Box::new(Lines::new(path)?)) };

/// A file of lines, or standard output.
pub(super) struct Lines {
    file: Option<(File, PathBuf)>,
    /// Bytes of the lines that are whole.
    whole: u64,
}

impl Lines {
    fn new(path: &Path) -> Outcome<Self> {
        let file = File::create(path).map_err(|error| machine(path, error))?;
        Ok(Lines { file: Some((file, path.into())), whole: 0 })
    }

    pub(super) fn standard() -> Self {
        Lines { file: None, whole: 0 }
    }

    fn line(&mut self, text: &str, out: &mut dyn Write) -> Outcome {
        let line = format!("{text}\n");
        match &mut self.file {
            Some((file, path)) => {
                file.write_all(line.as_bytes()).map_err(|error| {
                    // Half a line would keep the others from being read; where it cannot be taken back it stays.
                    let _ = file.set_len(self.whole);
                    machine(path, error)
                })?;
                self.whole += line.len() as u64;
                Ok(())
            }
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
