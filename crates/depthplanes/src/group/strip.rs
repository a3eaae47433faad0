//! A strip of rows: its bit masks, its runs, and the forest that joins runs to the runs above.
//!
//! In: rows of the map. Out: for each row the masks of valid pixels and run starts, for each run its
//! first and last column and its parent. Columns of a row are bits, column u in bit u % 64 of word
//! u / 64, so "left" is one bit lower.

use super::kernels::Isa;
use super::{LinkRule, Run, forest, reserve_to};
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

/// What a strip knows after [`scan`].
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
    /// For each row the first of its runs, counted within the strip; one more at the end.
    pub(super) row_first_run: Vec<u32>,
    /// First column of each run.
    pub(super) first_column: Vec<u16>,
    /// Last column of each run.
    pub(super) last_column: Vec<u16>,
    /// Forest over the strip's own runs.
    pub(super) parent: Vec<u32>,
    /// Runs of the map before this strip's first.
    pub(super) first_run: u32,
    /// Valid pixels of the strip.
    pub(super) valid_pixels: usize,
    scratch: Scratch,
}

/// Masks that only the next row needs.
#[derive(Debug, Default)]
struct Scratch {
    left: Vec<u64>,
    left_of_row_above: Vec<u64>,
    above: Vec<u64>,
    ends: Vec<u64>,
    later_contacts: Vec<u64>,
    runs_before: Vec<u32>,
    runs_before_in_row_above: Vec<u32>,
}

impl Strip {
    /// Makes room for the strip's worst case, so that scanning allocates nothing.
    pub(super) fn prepare(&mut self, width: usize, rows: Range<usize>) {
        let words = width.div_ceil(64);
        let height = rows.len();
        (self.rows, self.width, self.words) = (rows, width, words);
        (self.first_run, self.valid_pixels) = (0, 0);
        for masks in [&mut self.valid, &mut self.starts] {
            masks.resize(height * words, 0);
        }
        let scratch = &mut self.scratch;
        let Scratch { left, left_of_row_above, above, ends, later_contacts, .. } = scratch;
        for masks in [left, left_of_row_above, above, ends, later_contacts] {
            masks.clear();
            masks.resize(words + 1, 0);
        }
        for counts in [&mut scratch.runs_before, &mut scratch.runs_before_in_row_above] {
            counts.clear();
            counts.resize(words, 0);
        }
        reserve_to(&mut self.row_first_run, height + 1);
        reserve_to(&mut self.parent, height * width);
        for columns in [&mut self.first_column, &mut self.last_column] {
            reserve_to(columns, height * width + super::kernels::SLACK);
        }
    }

    /// The strip's runs, with groups looked up in the map's flattened forest.
    pub(super) fn runs<'a>(&'a self, root: &'a [u32]) -> impl Iterator<Item = Run> + 'a {
        self.row_first_run.windows(2).zip(self.rows.clone()).flat_map(move |(bounds, v)| {
            (bounds[0] as usize..bounds[1] as usize).map(move |run| Run {
                v: v as u32,
                u_first: self.first_column[run].into(),
                u_last: self.last_column[run].into(),
                group: root[self.first_run as usize + run],
            })
        })
    }
}

/// Runs and forest of a strip, row by row: masks, runs, contacts with the row above.
#[inline(always)]
pub(super) fn scan<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip) {
    for row in 0..strip.rows.len() {
        let v = strip.rows.start + row;
        row_masks::<I, T>(map, v, rule, strip);
        row_runs::<I>(strip, row);
        if row > 0 {
            join_row_above(strip, row);
        }
        let scratch = &mut strip.scratch;
        std::mem::swap(&mut scratch.left, &mut scratch.left_of_row_above);
        std::mem::swap(&mut scratch.runs_before, &mut scratch.runs_before_in_row_above);
    }
    strip.row_first_run.push(strip.parent.len() as u32);
}

/// Masks of row v of the map, in `valid` and the scratch's `left` and `above`. The links lack the
/// validity of the other side yet. The map's first row stands in for the row above it.
#[inline(always)]
fn row_masks<I: Isa, T: Pixel>(map: &DepthView<'_, T>, v: usize, rule: &LinkRule<T>, strip: &mut Strip) {
    let words = strip.words;
    let masks = RowMasks {
        valid: &mut strip.valid[(v - strip.rows.start) * words..][..words],
        close_left: &mut strip.scratch.left[..words],
        close_up: &mut strip.scratch.above[..words],
    };
    T::masks::<I>(map.row(v), map.row(v.saturating_sub(1)), rule, masks);
}

/// Lists the runs of a row: a run starts at a valid pixel that is not linked to its left, and ends
/// before the next pixel that is not.
#[inline(always)]
fn row_runs<I: Isa>(strip: &mut Strip, row: usize) {
    let words = strip.words;
    let valid = &strip.valid[row * words..][..words];
    let starts = &mut strip.starts[row * words..][..words];
    let scratch = &mut strip.scratch;
    let left = &mut scratch.left[..words + 1];
    let ends = &mut scratch.ends[..words];
    let before = &mut scratch.runs_before[..words];
    let mut valid_left = 0;
    for w in 0..words {
        left[w] &= valid[w] & (valid[w] << 1 | valid_left);
        starts[w] = valid[w] & !left[w];
        valid_left = valid[w] >> 63;
    }
    for w in 0..words {
        ends[w] = valid[w] & !(left[w] >> 1 | left[w + 1] << 63);
    }
    let first = strip.parent.len() as u32;
    let (mut runs, mut pixels) = (first, 0);
    for w in 0..words {
        before[w] = runs;
        runs += starts[w].count_ones();
        pixels += valid[w].count_ones();
    }
    strip.valid_pixels += pixels as usize;
    strip.row_first_run.push(first);
    strip.parent.extend(first..runs);
    I::positions(starts, (runs - first) as usize, &mut strip.first_column);
    I::positions(ends, (runs - first) as usize, &mut strip.last_column);
}

/// Unites the runs of a row with the runs above that they touch.
///
/// Only the first pixel of each touching pair of runs matters. A run's first such contact makes it
/// a child without any search, for until then it is alone; the few later ones need a union.
#[inline(always)]
fn join_row_above(strip: &mut Strip, row: usize) {
    let words = strip.words;
    let here = row * words..(row + 1) * words;
    let there = (row - 1) * words..row * words;
    let (starts, starts_above) = (&strip.starts[here.clone()], &strip.starts[there.clone()]);
    let (valid, valid_above) = (&strip.valid[here], &strip.valid[there]);
    let scratch = &mut strip.scratch;
    let (left, left_above) = (&scratch.left[..words], &scratch.left_of_row_above[..words]);
    let (before, before_above) = (&scratch.runs_before[..words], &scratch.runs_before_in_row_above[..words]);
    let (contacts, later) = (&mut scratch.above[..words], &mut scratch.later_contacts[..words]);
    find_contacts(contacts, [valid, valid_above], [left, left_above]);
    let any_later = split_contacts(contacts, later, left);
    let parent = &mut strip.parent[..];
    for w in 0..words {
        let mut first = contacts[w];
        while first != 0 {
            let (here, there) = runs_at(first, starts[w], before[w], starts_above[w], before_above[w]);
            parent[here as usize] = parent[there as usize];
            first &= first - 1;
        }
    }
    for w in 0..if any_later { words } else { 0 } {
        let mut later = later[w];
        while later != 0 {
            let (here, there) = runs_at(later, starts[w], before[w], starts_above[w], before_above[w]);
            forest::unite(parent, here, there);
            later &= later - 1;
        }
    }
}

/// Of the pixels that are close to the one above, in place those where two runs first touch: both
/// valid, and without a left neighbour in the same two runs that is linked upwards too.
#[inline(always)]
fn find_contacts(close_up: &mut [u64], valid: [&[u64]; 2], left: [&[u64]; 2]) {
    let mut up_left = 0;
    for w in 0..close_up.len() {
        let up = close_up[w] & valid[0][w] & valid[1][w];
        close_up[w] = up & !((up << 1 | up_left) & left[0][w] & left[1][w]);
        up_left = up >> 63;
    }
}

/// Leaves in `contacts` each run's first and moves the others to `later`; whether there are any.
///
/// A run's pixels behind its first are a block of ones in `left`. Adding a one to a block carries
/// through to its end, so the ones that the sum clears lie behind the contact that was added.
#[inline(always)]
fn split_contacts(contacts: &mut [u64], later: &mut [u64], left: &[u64]) -> bool {
    let (mut contact_left, mut carry, mut any_later) = (0, false, 0);
    for w in 0..contacts.len() {
        let behind = (contacts[w] << 1 | contact_left) & left[w];
        contact_left = contacts[w] >> 63;
        let (sum, carry_1) = left[w].overflowing_add(behind);
        let (sum, carry_2) = sum.overflowing_add(carry.into());
        carry = carry_1 | carry_2;
        let covered = (left[w] & !sum) | behind;
        later[w] = contacts[w] & covered;
        any_later |= later[w];
        contacts[w] &= !covered;
    }
    any_later != 0
}

/// The runs here and above at the lowest set bit of `contact`: a pixel's run is the number of run
/// starts up to it.
#[inline(always)]
fn runs_at(contact: u64, starts: u64, before: u32, starts_above: u64, before_above: u32) -> (u32, u32) {
    let up_to = contact ^ (contact - 1);
    (before + (starts & up_to).count_ones() - 1, before_above + (starts_above & up_to).count_ones() - 1)
}

/// Unites the runs on both sides of the border between two strips in the map's forest.
#[inline(always)]
pub(super) fn stitch<I: Isa, T: Pixel>(
    map: &DepthView<'_, T>,
    rule: &LinkRule<T>,
    upper: &Strip,
    lower: &mut Strip,
    parent: &mut [u32],
) {
    let v = lower.rows.start;
    row_masks::<I, T>(map, v, rule, lower);
    let last_row = upper.rows.len() - 1;
    let starts_above = &upper.starts[last_row * upper.words..];
    let valid_above = &upper.valid[last_row * upper.words..];
    let mut before = lower.first_run;
    let mut before_above = upper.first_run + upper.row_first_run[last_row];
    for w in 0..lower.words {
        let mut contact = lower.scratch.above[w] & lower.valid[w] & valid_above[w];
        while contact != 0 {
            let (here, there) = runs_at(contact, lower.starts[w], before, starts_above[w], before_above);
            forest::unite(parent, here, there);
            contact &= contact - 1;
        }
        before += lower.starts[w].count_ones();
        before_above += starts_above[w].count_ones();
    }
}
