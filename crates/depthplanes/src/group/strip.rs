//! A strip of rows: its bit masks, its runs, and the components that they form within the strip.
//!
//! In: rows of the map. Out: for each row the masks of valid pixels and run starts, for each run its
//! component, for each component its size. Columns of a row are bits, column u in bit u % 64 of word
//! u / 64, so "left" is one bit lower.

use super::kernels::Isa;
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

/// What a strip knows after [`scan`].
///
/// Strips are low enough for their forest to stay in a core's cache until it is flattened.
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
    /// For each run, while scanning its parent, then its component, both counted within the strip.
    pub(super) forest: Vec<u32>,
    /// Pixels of each run.
    pub(super) lengths: Vec<u16>,
    /// Pixels of each component.
    pub(super) sizes: Vec<u32>,
    /// Components of the map before this strip's first.
    pub(super) first_component: usize,
    /// Valid pixels of the strip.
    pub(super) valid_pixels: usize,
    scratch: Scratch,
}

/// What only one row and the next need.
#[derive(Debug, Default)]
struct Scratch {
    left: Vec<u64>,
    left_of_row_above: Vec<u64>,
    above: Vec<u64>,
    ends: Vec<u64>,
    later_contacts: Vec<u64>,
    runs_before: Vec<u32>,
    runs_before_in_row_above: Vec<u32>,
    first_column: Vec<u16>,
    last_column: Vec<u16>,
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
        reserve_to(&mut self.forest, height * width);
        reserve_to(&mut self.lengths, height * width);
        reserve_to(&mut self.sizes, height * width);
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
        for columns in [&mut scratch.first_column, &mut scratch.last_column] {
            reserve_to(columns, width + super::kernels::SLACK);
        }
    }

    /// First and last column of each run of a row.
    pub(super) fn columns(&self, row: usize) -> impl Iterator<Item = (u32, u32)> + '_ {
        let words = row * self.words..(row + 1) * self.words;
        let (valid, starts) = (&self.valid[words.clone()], &self.starts[words]);
        let left = |w: usize| if w < valid.len() { valid[w] & !starts[w] } else { 0 };
        let ends = move |w: usize| valid[w] & !(left(w) >> 1 | left(w + 1) << 63);
        bits(starts.len(), |w| starts[w]).zip(bits(starts.len(), ends))
    }
}

/// Positions of the set bits of some words, in order.
fn bits(words: usize, word: impl Fn(usize) -> u64) -> impl Iterator<Item = u32> {
    (0..words).flat_map(move |w| {
        let mut rest = word(w);
        std::iter::from_fn(move || {
            let bit = rest.trailing_zeros();
            rest &= rest.wrapping_sub(1);
            (bit < 64).then_some(w as u32 * 64 + bit)
        })
    })
}

/// Components of a strip: row by row its masks, its runs and their contacts with the row above, then
/// the forest flattened.
#[inline(always)]
pub(super) fn scan<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip) {
    strip.valid_pixels = 0;
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
    strip.row_first_run.push(strip.forest.len() as u32);
    forest::flatten(&mut strip.forest, strip.lengths.iter().map(|&length| length.into()), &mut strip.sizes);
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
    let left = &mut scratch.left[..words];
    let ends = &mut scratch.ends[..words];
    let before = &mut scratch.runs_before[..words];
    let first = strip.forest.len() as u32;
    let (mut runs, mut pixels, mut before_word) = (first, 0, 0);
    for w in 0..words {
        // A link needs both pixels valid; a run ends where the next pixel is not linked to it.
        let linked = left[w] & valid[w] & (valid[w] << 1 | before_word >> 63);
        if w > 0 {
            ends[w - 1] = before_word & !(left[w - 1] >> 1 | linked << 63);
        }
        (left[w], starts[w], before[w]) = (linked, valid[w] & !linked, runs);
        before_word = valid[w];
        runs += starts[w].count_ones();
        pixels += valid[w].count_ones();
    }
    ends[words - 1] = before_word & !(left[words - 1] >> 1);
    strip.valid_pixels += pixels as usize;
    strip.row_first_run.push(first);
    strip.forest.extend(first..runs);
    let columns = [(&*starts, &mut scratch.first_column), (&*ends, &mut scratch.last_column)];
    for (mask, columns) in columns {
        columns.clear();
        I::positions(mask, (runs - first) as usize, columns);
    }
    let columns = scratch.first_column.iter().zip(&scratch.last_column);
    strip.lengths.extend(columns.map(|(first, last)| last - first + 1));
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
    find_contacts(contacts, valid, valid_above, left, left_above);
    let any_later = split_contacts(contacts, later, left);
    let parent = &mut strip.forest[..];
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
fn find_contacts(close_up: &mut [u64], valid: &[u64], valid_above: &[u64], left: &[u64], left_above: &[u64]) {
    let mut up_left = 0;
    for w in 0..close_up.len() {
        let up = close_up[w] & valid[w] & valid_above[w];
        close_up[w] = up & !((up << 1 | up_left) & left[w] & left_above[w]);
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

/// Unites the components on both sides of the border between two strips in the forest of the map's
/// components.
#[inline(always)]
pub(super) fn stitch<I: Isa, T: Pixel>(
    map: &DepthView<'_, T>,
    rule: &LinkRule<T>,
    upper: &Strip,
    lower: &mut Strip,
    components: &mut [u32],
) {
    row_masks::<I, T>(map, lower.rows.start, rule, lower);
    let (words, last_row) = (lower.words, upper.rows.len() - 1);
    let (starts, starts_above) = (&lower.starts[..words], &upper.starts[last_row * words..]);
    let (valid, valid_above) = (&lower.valid[..words], &upper.valid[last_row * words..]);
    let Scratch { left, left_of_row_above, above, .. } = &mut lower.scratch;
    for w in 0..words {
        left[w] = valid[w] & !starts[w];
        left_of_row_above[w] = valid_above[w] & !starts_above[w];
    }
    find_contacts(&mut above[..words], valid, valid_above, left, left_of_row_above);
    let (mut before, mut before_above) = (0, upper.row_first_run[last_row]);
    for w in 0..words {
        let mut contact = above[w];
        while contact != 0 {
            let (here, there) = runs_at(contact, starts[w], before, starts_above[w], before_above);
            let here = lower.first_component as u32 + lower.forest[here as usize];
            let there = upper.first_component as u32 + upper.forest[there as usize];
            forest::unite(components, here, there);
            contact &= contact - 1;
        }
        before += starts[w].count_ones();
        before_above += starts_above[w].count_ones();
    }
}
