//! A map's labelled runs in parts, which threads share, and records for the labels that occur in each.
//!
//! The parts depend on the map's size alone: what is summed part by part is the same on any number of threads.

use crate::components::selection::LabelledRun;
use crate::limits::MAX_PLANES;
use std::ops::Range;

/// Pixels of a part, at most (but for a part of one row).
const PIXELS: usize = 1 << 18;
/// Records by label, in order of first sight.
#[derive(Debug)]
pub(super) struct ByLabel<T> {
    /// For each label its record's number, counted from 1; 0 for none.
    number: Vec<u32>,
    labels: Vec<u16>,
    records: Vec<T>,
}

impl<T> Default for ByLabel<T> {
    fn default() -> Self {
        ByLabel { number: Vec::new(), labels: Vec::new(), records: Vec::new() }
    }
}

impl<T> ByLabel<T> {
    /// Removes all records, and makes room for `room` of them.
    pub(super) fn clear(&mut self, room: usize) {
        self.number.resize(MAX_PLANES + 1, 0);
        for label in self.labels.drain(..) {
            self.number[usize::from(label)] = 0;
        }
        self.records.clear();
        self.labels.reserve(room);
        self.records.reserve(room);
    }

    /// A label's record, a new one at first sight.
    #[inline(always)]
    pub(super) fn of(&mut self, label: u16, new: impl FnOnce() -> T) -> &mut T {
        let number = &mut self.number[usize::from(label)];
        if *number == 0 {
            self.labels.push(label);
            self.records.push(new());
            *number = self.records.len() as u32;
        }
        &mut self.records[*number as usize - 1]
    }

    pub(super) fn each(&self) -> impl Iterator<Item = (u16, &T)> {
        self.labels.iter().copied().zip(&self.records)
    }
}

/// For each part of a map of so many columns and rows its runs.
pub(super) fn runs_of_parts(runs: &[LabelledRun], [width, height]: [usize; 2]) -> impl Iterator<Item = Range<usize>> {
    let rows = height.div_ceil((width * height).div_ceil(PIXELS).min(height));
    let first_after = move |row: usize| runs.partition_point(|run| (run.v as usize) < row);
    (0..height).step_by(rows).map(move |row| first_after(row)..first_after(row + rows))
}
