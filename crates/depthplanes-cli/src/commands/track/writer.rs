//! What comes of a tracked video: a line of JSON for each frame, label images, pictures, a table in the end.

use super::follow::Followed;
use super::record;
use crate::args::Track;
use crate::failure::{Failure, Outcome};
use crate::table::{Align, aligned, row};
use depthplanes_io::outputs::{self, grey16_png, tracked_png};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Planes in the table at the end.
const ROWS: usize = 20;

/// Writes one frame after the other.
pub(super) struct Writer<'a> {
    wanted: &'a Track,
    lines: Option<File>,
    /// What is said of each plane in the end.
    summaries: BTreeMap<u32, Summary>,
    frames: u64,
}

/// A plane over the whole video.
#[derive(Clone, Copy, Default)]
struct Summary {
    first: u64,
    last: u64,
    frames: u64,
    pixels: u64,
}

impl<'a> Writer<'a> {
    /// Makes the folders, and the file of lines.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn new(wanted: &'a Track) -> Outcome<Self> {
        for folder in wanted.labels.iter().chain(&wanted.overlays) {
            std::fs::create_dir_all(folder).map_err(|error| machine(folder, error))?;
        }
        let lines = wanted.out.as_deref().filter(|path| !is_standard(path));
        let lines = lines.map(|path| File::create(path).map_err(|error| machine(path, error))).transpose()?;
        Ok(Writer { wanted, lines, summaries: BTreeMap::new(), frames: 0 })
    }

    /// Writes a frame. A line is written at once and whole, so that whatever ends the program leaves whole lines.
    ///
    /// # Errors
    /// What the machine says, and ids that no label image holds.
    pub(super) fn write(&mut self, frame: &Followed, out: &mut dyn Write) -> Outcome {
        self.line(&record::record(frame).to_string(), out)?;
        let stem = format!("{:06}", frame.video.index);
        if let Some(folder) = &self.wanted.labels {
            let found = &frame.detection;
            let png = grey16_png(found.width, found.height, &by_id(frame)?);
            outputs::write_file(&folder.join(format!("{stem}.png")), &png)?;
        }
        if let Some(folder) = &self.wanted.overlays {
            let path = folder.join(format!("{stem}.png"));
            match frame.ground.as_ref().and_then(|ground| ground.png.as_ref()) {
                Some(png) => outputs::write_file(&path, png)?,
                None => {
                    let (view, sensor) = (frame.video.frame.view()?, &frame.video.frame.sensor);
                    outputs::write_file(&path, &tracked_png(view, sensor, &frame.detection, &frame.tracks.ids)?)?;
                }
            }
        }
        self.frames += 1;
        for plane in &frame.detection.planes {
            let Some(id) = frame.tracks.id_of(plane.label) else { continue };
            let summary =
                self.summaries.entry(id).or_insert(Summary { first: frame.video.index, ..Summary::default() });
            summary.last = frame.video.index;
            summary.frames += 1;
            summary.pixels += plane.pixel_count as u64;
            if self.summaries.len() > 4 * MOST_SUMMARIES {
                self.forget();
            }
        }
        Ok(())
    }

    /// Writes that a frame could not be read.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn write_failed(&mut self, index: u64, error: &str, out: &mut dyn Write) -> Outcome {
        self.line(&record::failed(index, error).to_string(), out)
    }

    fn line(&mut self, text: &str, out: &mut dyn Write) -> Outcome {
        match (&mut self.lines, &self.wanted.out) {
            (Some(file), Some(path)) => {
                file.write_all(format!("{text}\n").as_bytes()).map_err(|error| machine(path, error))
            }
            (None, Some(_)) => {
                out.write_all(format!("{text}\n").as_bytes())?;
                Ok(out.flush()?)
            }
            _ => Ok(()),
        }
    }

    /// Keeps the planes that were seen in most pixels: memory does not grow with the video.
    fn forget(&mut self) {
        let mut pixels: Vec<u64> = self.summaries.values().map(|summary| summary.pixels).collect();
        pixels.sort_unstable_by(|a, b| b.cmp(a));
        let least = pixels[MOST_SUMMARIES];
        self.summaries.retain(|_, summary| summary.pixels > least);
    }

    /// The table of the planes that were seen in most pixels; nothing where lines go to standard output.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn end(&mut self, out: &mut dyn Write) -> Outcome {
        if self.wanted.out.as_deref().is_some_and(is_standard) {
            return Ok(());
        }
        let mut planes: Vec<(u32, Summary)> = self.summaries.iter().map(|(id, summary)| (*id, *summary)).collect();
        planes.sort_by_key(|&(id, summary)| (std::cmp::Reverse(summary.pixels), id));
        let mut rows = vec![row(["id", "frames", "first", "last", "mean pixels"])];
        rows.extend(planes.iter().take(ROWS).map(|(id, summary)| {
            let Summary { first, last, frames, pixels } = summary;
            [u64::from(*id), *frames, *first, *last, pixels / frames].iter().map(u64::to_string).collect()
        }));
        out.write_all(aligned(&[Align::Right; 5], &rows).as_bytes())?;
        Ok(out.flush()?)
    }
}

/// Planes that are kept for the table.
const MOST_SUMMARIES: usize = 1000;

fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn machine(path: &Path, error: std::io::Error) -> Failure {
    Failure::machine(format!("{}: {error}", path.display()))
}

/// The id of each pixel.
fn by_id(frame: &Followed) -> Outcome<Vec<u16>> {
    let ids = frame.tracks.ids.iter().map(|&id| u16::try_from(id)).collect::<Result<Vec<u16>, _>>();
    let ids = ids.map_err(|_| {
        Failure::request("--labels: an id is above 65535, which 16-bit label images do not hold; --out has all ids")
    })?;
    let id = |&label: &u16| usize::from(label).checked_sub(1).map_or(0, |at| ids[at]);
    Ok(frame.detection.labels.iter().map(id).collect())
}
