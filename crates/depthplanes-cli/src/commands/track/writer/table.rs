//! The table of the planes that were seen in most pixels.

use super::output::Output;
use crate::commands::track::follow::Followed;
use crate::failure::Outcome;
use crate::table::{Align, aligned, row};
use std::collections::BTreeMap;
use std::io::Write;

/// Planes in the table.
const ROWS: usize = 20;
/// Planes that are kept for it.
const MOST: usize = 1000;

/// Sums up each plane over the whole video.
#[derive(Default)]
pub(super) struct Table {
    /// The last id: how many planes there were in all.
    last_id: u32,
    summaries: BTreeMap<u32, Summary>,
}

#[derive(Clone, Copy, Default)]
struct Summary {
    first: u64,
    last: u64,
    frames: u64,
    pixels: u64,
}

impl Table {
    /// Keeps the planes that were seen in most pixels: memory does not grow with the video.
    fn forget(&mut self) {
        let mut pixels: Vec<u64> = self.summaries.values().map(|summary| summary.pixels).collect();
        pixels.sort_unstable_by(|a, b| b.cmp(a));
        let least = pixels[MOST];
        self.summaries.retain(|_, summary| summary.pixels > least);
    }
}

impl Output for Table {
    fn write(&mut self, frame: &Followed, _: &mut dyn Write) -> Outcome {
        self.last_id = self.last_id.max(frame.last_id());
        for plane in &frame.detection.planes {
            let Some(id) = frame.tracks.id_of(plane.label) else { continue };
            let index = frame.video.index;
            let summary = self.summaries.entry(id).or_insert(Summary { first: index, ..Summary::default() });
            summary.last = index;
            summary.frames += 1;
            summary.pixels += plane.pixel_count as u64;
            if self.summaries.len() > 4 * MOST {
                self.forget();
            }
        }
        Ok(())
    }

    fn end(&mut self, out: &mut dyn Write) -> Outcome {
        let mut planes: Vec<(u32, Summary)> = self.summaries.iter().map(|(id, summary)| (*id, *summary)).collect();
        planes.sort_by_key(|&(id, summary)| (std::cmp::Reverse(summary.pixels), id));
        let mut rows = vec![row(["id", "frames", "first", "last", "mean pixels"])];
        rows.extend(planes.iter().take(ROWS).map(|(id, summary)| {
            let Summary { first, last, frames, pixels } = summary;
            [u64::from(*id), *frames, *first, *last, pixels / frames].iter().map(u64::to_string).collect()
        }));
        out.write_all(aligned(&[Align::Right; 5], &rows).as_bytes())?;
        match (self.last_id as usize).saturating_sub(ROWS) {
            0 => (),
            1 => writeln!(out, "and 1 plane seen in fewer pixels; --out FILE.jsonl has all")?,
            more => writeln!(out, "and {more} planes seen in fewer pixels; --out FILE.jsonl has all")?,
        }
        Ok(out.flush()?)
    }
}
