//! What comes of a tracked video: lines or messages of each frame, label images, pictures, a table in the end.
//!
//! One file for each output; [`Writer`] hands every frame to those that are wanted.

mod images;
mod lines;
mod mcap;
mod output;
mod proto;
mod scene;
mod table;

use super::follow::Followed;
use crate::args::Track;
use crate::failure::{Failure, Outcome};
use output::Output;
use std::io::Write;
use std::path::Path;

/// Writes one frame after the other.
pub(super) struct Writer<'a> {
    outputs: Vec<Box<dyn Output + 'a>>,
}

impl<'a> Writer<'a> {
    /// Makes the folders and files.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn new(wanted: &'a Track) -> Outcome<Self> {
        let mut outputs: Vec<Box<dyn Output + 'a>> = Vec::new();
        outputs.extend(wanted.out.as_deref().map(of_name).transpose()?);
        if let Some(folder) = &wanted.labels {
            outputs.push(Box::new(images::Labels::new(folder)?));
        }
        if let Some(folder) = &wanted.overlays {
            outputs.push(Box::new(images::Overlays::new(folder)?));
        }
        if !wanted.out.as_deref().is_some_and(is_standard) {
            outputs.push(Box::new(table::Table::default()));
        }
        Ok(Writer { outputs })
    }

    /// Writes a frame, at once and whole, so that whatever ends the program leaves whole ones.
    ///
    /// # Errors
    /// What the machine says, and ids that no label image holds.
    pub(super) fn write(&mut self, frame: &Followed, out: &mut dyn Write) -> Outcome {
        self.outputs.iter_mut().try_for_each(|output| output.write(frame, out))
    }

    /// Writes that a frame could not be read.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn write_failed(&mut self, index: u64, error: &str, out: &mut dyn Write) -> Outcome {
        self.outputs.iter_mut().try_for_each(|output| output.write_failed(index, error, out))
    }

    /// What comes after all frames.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn end(&mut self, out: &mut dyn Write) -> Outcome {
        self.outputs.iter_mut().try_for_each(|output| output.end(out))
    }
}

fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The output that a file's name asks for; what has no extension, such as a pipe, takes lines.
fn of_name(path: &Path) -> Outcome<Box<dyn Output>> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    Ok(match extension.as_deref() {
        _ if is_standard(path) => Box::new(lines::Lines::standard()),
        None | Some("jsonl" | "ndjson") => Box::new(lines::Lines::new(path)?),
        Some("mcap") => Box::new(mcap::Recording::new(path)?),
        Some(other) => {
            let accepted =
                ".jsonl for a JSON line for each frame, .mcap for a recording for Foxglove, - for standard output";
            return Err(Failure::request(format!("--out: {} ends in .{other}; accepted: {accepted}", path.display())));
        }
    })
}
