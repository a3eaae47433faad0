//! What comes of a tracked video: lines or messages of each frame, label images, pictures, a table in the end.
//!
//! One file for each output; [`OUTPUTS`] lists them, and [`Writer`] hands every frame to those that are wanted.

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
use output::{Output, OutputInfo};
use std::io::Write;
use std::path::Path;

/// The outputs that a video can have in a folder.
const OUTPUTS: &[OutputInfo] = &[lines::LINES, mcap::RECORDING, images::LABELS, images::OVERLAYS];

/// Writes one frame after the other.
pub(super) struct Writer {
    outputs: Vec<Box<dyn Output>>,
}

impl Writer {
    /// The files and folders of one video, as they are named, and a table of its planes on standard output.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn new(wanted: &Track) -> Outcome<Self> {
        let mut outputs: Vec<Box<dyn Output>> = Vec::new();
        outputs.extend(wanted.out.as_deref().map(of_name).transpose()?);
        for (info, folder) in [(images::LABELS, &wanted.labels), (images::OVERLAYS, &wanted.overlays)] {
            outputs.extend(folder.as_deref().map(info.open).transpose()?);
        }
        if !wanted.out.as_deref().is_some_and(is_standard) {
            outputs.push(Box::new(table::Table::default()));
        }
        Ok(Writer { outputs })
    }

    /// Outputs in a folder, under the names of the table.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn in_folder(folder: &Path, only: &[&'static str]) -> Outcome<Self> {
        let wanted = OUTPUTS.iter().filter(|info| only.is_empty() || only.contains(&info.name));
        let outputs = wanted.map(|info| (info.open)(&folder.join(info.file))).collect::<Outcome<_>>()?;
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
        None | Some("jsonl" | "ndjson") => (lines::LINES.open)(path)?,
        Some("mcap") => (mcap::RECORDING.open)(path)?,
        Some(other) => {
            let accepted =
                ".jsonl for a JSON line for each frame, .mcap for a recording for Foxglove, - for standard output";
            return Err(Failure::request(format!("--out: {} ends in .{other}; accepted: {accepted}", path.display())));
        }
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_knows_all_outputs() {
        assert_eq!(super::OUTPUTS.iter().map(|info| info.name).collect::<Vec<_>>(), crate::args::TRACK_OUTPUTS);
    }
}
