//! A strip of rows: its bit masks, its runs, and their provisional labels.
//!
//! In: rows of the map. Out: for each row the masks of valid pixels and run starts, for each run a
//! provisional label, and the forest of those labels. Columns of a row are bits, column u in bit u % 64 of word
//! u / 64, so "left" is one bit lower.

use super::kernels::{Isa, SLACK};
use super::labels::{RowLinks, Scratch, label_runs, next_bit};
use super::{LinkRule, forest, reserve_to};
use crate::map::{DepthView, Pixel};
use std::ops::Range;

/// The masks of one row, one bit a pixel, as an instruction set computes them.
pub struct RowMasks<'a> {
    /// Pixels that are valid.
    pub valid: &'a mut [u64],
    /// Pixels within theta of their left neighbour, valid or not; nothing certain of column 0.
    pub close_left: &'a mut [u64],
    /// Pixels within theta of the neighbour above, valid or not.
    pub close_up: &'a mut [u64],
}

/// A row is dense if it has more runs than one in this many pixels. Set where labelling runs many at a
/// time begins to pay; measured at 6, 10 and 16, which differ by at most 6 % on any of six frames.
pub(super) const DENSE: usize = 6;

/// What a strip knows after [`scan`].
///
/// As in any two-pass labelling, a run takes the provisional label of the first run that it touches
/// above, or a new one if it touches none; labels that meet later are united in a forest. Only new
/// labels cost an element of the forest, so it stays small even where noise makes many runs.
#[derive(Debug, Default)]
pub(super) struct Strip {
    /// Its rows in the map.
    pub(super) rows: Range<usize>,
    /// Columns of the map.
    pub(super) width: usize,
    /// Words of a row's mask.
    pub(super) words: usize,
    /// Valid pixels, `words` a row.
    pub(super) valid: Vec<u64>,
    /// First pixels of runs, `words` a row.
    pub(super) starts: Vec<u64>,
    /// For each row the first of its runs, counted within the strip from 1; one more at the end.
    pub(super) row_first_run: Vec<u32>,
    /// Provisional label of each run, counted from 1, and [`SLACK`] elements more to read and write.
    /// It only grows; what lies behind the last run is left from other maps.
    pub(super) labels: Vec<u32>,
    /// One more than the last run.
    pub(super) end_run: usize,
    /// Forest over the provisional labels.
    pub(super) forest: Vec<u32>,
    /// Pixels of each provisional label.
    pub(super) sizes: Vec<u32>,
    /// Provisional labels of the strips above.
    pub(super) first_label: usize,
    /// Valid pixels of the strip.
    pub(super) valid_pixels: usize,
    /// Whether pixels without any link may be left out of the runs.
    pub(super) leaves_out_singles: bool,
    /// How many were.
    pub(super) singles_left_out: usize,
    pub(super) scratch: Scratch,
}

impl Strip {
    /// Makes room for the strip's worst case, so that scanning allocates nothing.
    pub(super) fn prepare(&mut self, width: usize, rows: Range<usize>) {
        let words = width.div_ceil(64);
        let height = rows.len();
        (self.rows, self.width, self.words) = (rows, width, words);
        for masks in [&mut self.valid, &mut self.starts] {
            masks.resize(height * words, 0);
        }
        reserve_to(&mut self.row_first_run, height + 1);
        let most_labels = 1 + height * width + SLACK;
        self.labels.reserve(most_labels.saturating_sub(self.labels.len()));
        for per_label in [&mut self.forest, &mut self.sizes] {
            reserve_to(per_label, height * width);
        }
        self.scratch.prepare(width);
    }

    /// How many runs there are.
    pub(super) fn run_count(&self) -> usize {
        self.end_run - 1
    }

    /// Provisional label of each run in raster order.
    pub(super) fn labels(&self) -> &[u32] {
        &self.labels[1..self.end_run]
    }

    /// Calls `visit` for each run in raster order with its row, first and last column, and provisional
    /// label.
    #[inline]
    pub(super) fn each_run(&self, mut visit: impl FnMut(usize, u32, u32, u32)) {
        let mut labels = self.labels().iter();
        for (row, v) in self.rows.clone().enumerate() {
            let words = row * self.words..(row + 1) * self.words;
            let (valid, starts) = (&self.valid[words.clone()], &self.starts[words]);
            let left = |w: usize| if w < valid.len() { valid[w] & !starts[w] } else { 0 };
            let mut open = 0; // first column of the run that reaches into the word
            for w in 0..valid.len() {
                let mut ends = valid[w] & !(left(w) >> 1 | left(w + 1) << 63);
                let mut rest = starts[w];
                while ends != 0 {
                    let last = ends.trailing_zeros();
                    let before = rest & (u64::MAX >> (63 - last));
                    if before != 0 {
                        open = w as u32 * 64 + before.trailing_zeros();
                        rest &= rest - 1;
                    }
                    let &label = labels.next().expect("a label for each run");
                    visit(v, open, w as u32 * 64 + last, label);
                    ends &= ends - 1;
                }
                if rest != 0 {
                    open = w as u32 * 64 + rest.trailing_zeros();
                }
            }
        }
    }
}

/// Labels a strip, row by row: its links, its runs, their contacts, and a label for each. Links are
/// known one row ahead, to tell pixels without any.
#[inline(always)]
pub(super) fn scan<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip) {
    (strip.valid_pixels, strip.singles_left_out) = (0, 0);
    strip.end_run = 1;
    row_links::<I, T>(map, rule, strip, 0);
    for row in 0..strip.rows.len() {
        let Scratch { above, here, below, .. } = &mut strip.scratch;
        std::mem::swap(above, here);
        std::mem::swap(here, below);
        if row + 1 < strip.rows.len() {
            row_links::<I, T>(map, rule, strip, row + 1);
        }
        row_runs::<I>(strip, row);
        strip.scratch.find_contacts();
        label_runs::<I>(strip, row);
    }
    strip.row_first_run.push(strip.end_run as u32);
}

/// Links of a row to the left and up, left in the scratch as those of the row below. The strip's first
/// row has none upwards.
#[inline(always)]
fn row_links<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip, row: usize) {
    let (words, v) = (strip.words, strip.rows.start + row);
    let (above, here) = strip.valid[row.saturating_sub(1) * words..(row + 1) * words].split_at_mut(row.min(1) * words);
    let RowLinks { left, up, .. } = &mut strip.scratch.below;
    let left = &mut left[..words];
    let masks = RowMasks { valid: here, close_left: left, close_up: up };
    T::masks::<I>(map.row(v), map.row(v.saturating_sub(1)), rule, masks);
    // Both sides of a link are valid. Above the strip there is nothing.
    let (mut pixels, mut valid_left) = (0, 0);
    for w in 0..words {
        let above = if row == 0 { 0 } else { above[w] };
        left[w] &= here[w] & (here[w] << 1 | valid_left);
        up[w] &= here[w] & above;
        valid_left = here[w] >> 63;
        pixels += here[w].count_ones();
    }
    strip.valid_pixels += pixels as usize;
}

/// Lists the runs of a row: a run starts at a valid pixel that is not linked to its left, and ends
/// before the next pixel that is not.
#[inline(always)]
fn row_runs<I: Isa>(strip: &mut Strip, row: usize) {
    let words = strip.words;
    let first = strip.end_run as u32;
    let valid = &mut strip.valid[row * words..][..words];
    let starts = &mut strip.starts[row * words..][..words];
    let Scratch { here, below, ends, columns, .. } = &mut strip.scratch;
    let mut end = start_runs(valid, &here.left, starts, ends, &mut here.runs_before, first);
    let is_inner = row > 0 && row + 1 < strip.rows.len(); // outer rows have links to other strips
    if strip.leaves_out_singles && is_inner && (end - first) as usize * DENSE > strip.width {
        let before = end;
        leave_out_singles(valid, starts, ends, &here.up, &below.up);
        end = start_runs(valid, &here.left, starts, ends, &mut here.runs_before, first);
        strip.singles_left_out += (before - end) as usize;
    }
    strip.row_first_run.push(first);
    strip.end_run = end as usize;
    if strip.labels.len() < strip.end_run + SLACK {
        strip.labels.resize(strip.end_run + SLACK, 0);
    }
    I::positions([starts, ends], (end - first) as usize, columns);
}

/// Where runs start and end, and how many start before each word, from `first` on; one more than the
/// last run. `left` has a word 0 more.
#[inline(always)]
fn start_runs(
    valid: &[u64],
    left: &[u64],
    starts: &mut [u64],
    ends: &mut [u64],
    before: &mut [u32],
    first: u32,
) -> u32 {
    let words = valid.len();
    let (left, starts, ends, before) =
        (&left[..words + 1], &mut starts[..words], &mut ends[..words], &mut before[..words]);
    let mut end = first;
    for w in 0..words {
        starts[w] = valid[w] & !left[w];
        ends[w] = valid[w] & !(left[w] >> 1 | left[w + 1] << 63);
        before[w] = end;
        end += starts[w].count_ones();
    }
    end
}

/// Takes pixels that are a run of their own and linked neither up nor down for missing: each is a
/// group that nobody asked for, and noise makes many.
#[inline(always)]
fn leave_out_singles(valid: &mut [u64], starts: &[u64], ends: &[u64], up: &[u64], up_below: &[u64]) {
    for w in 0..valid.len() {
        valid[w] &= !(starts[w] & ends[w]) | up[w] | up_below[w];
    }
}

/// Unites the labels on both sides of the border between two strips, in the forest of all strips.
#[inline(always)]
pub(super) fn stitch<I: Isa, T: Pixel>(
    map: &DepthView<'_, T>,
    rule: &LinkRule<T>,
    upper: &Strip,
    lower: &mut Strip,
    forest: &mut [u32],
) {
    let (words, v, last_row) = (lower.words, lower.rows.start, upper.rows.len() - 1);
    let (starts, starts_above) = (&lower.starts[..words], &upper.starts[last_row * words..]);
    let (valid, valid_above) = (&lower.valid[..words], &upper.valid[last_row * words..]);
    let Scratch { above, here, ends: unused, .. } = &mut lower.scratch;
    let masks = RowMasks { valid: unused, close_left: &mut here.left[..words], close_up: &mut here.up };
    T::masks::<I>(map.row(v), map.row(v - 1), rule, masks);
    for w in 0..words {
        here.up[w] &= valid[w] & valid_above[w];
        here.left[w] = valid[w] & !starts[w];
        above.left[w] = valid_above[w] & !starts_above[w];
    }
    lower.scratch.find_contacts();
    let (mut runs, mut runs_above) = (0, upper.row_first_run[last_row] as usize - 1);
    for w in 0..words {
        let mut contacts = lower.scratch.contacts[w] | lower.scratch.later_contacts[w];
        while let Some(up_to) = next_bit(&mut contacts) {
            let run = |before: usize, starts: u64| before + (starts & up_to).count_ones() as usize;
            let here = lower.labels[run(runs, starts[w])] + lower.first_label as u32;
            let there = upper.labels[run(runs_above, starts_above[w])] + upper.first_label as u32;
            forest::unite(forest, here, there);
        }
        runs += starts[w].count_ones() as usize;
        runs_above += starts_above[w].count_ones() as usize;
    }
}
