//! A strip of rows: its bit masks, its runs, and their provisional labels.
//!
//! In: rows of the map. Out: for each row the masks of valid pixels and run starts, for each run a
//! provisional label, and the forest of those labels. Columns of a row are bits, column u in bit u % 64 of word
//! u / 64, so "left" is one bit lower.

use super::kernels::{Isa, SLACK};
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

/// A row is dense if it has more runs than one in this many pixels; measured on two processors' worth
/// of frames from 5,000 to 250,000 runs, the break-even is flat around it.
const DENSE: usize = 6;

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
    labels: Vec<u32>,
    /// Forest over the provisional labels.
    pub(super) forest: Vec<u32>,
    /// Pixels of each provisional label.
    pub(super) sizes: Vec<u32>,
    /// Provisional labels of the strips above.
    pub(super) first_label: usize,
    /// Valid pixels of the strip.
    pub(super) valid_pixels: usize,
    scratch: Scratch,
}

/// What only one row and the next need.
#[derive(Debug, Default)]
struct Scratch {
    left: Vec<u64>,
    left_above: Vec<u64>,
    ends: Vec<u64>,
    contacts: Vec<u64>,
    later_contacts: Vec<u64>,
    orphans: Vec<u64>,
    runs_before: Vec<u32>,
    runs_before_above: Vec<u32>,
    first_column: Vec<u16>,
    last_column: Vec<u16>,
    inherited: Vec<u32>,
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
        reserve_to(&mut self.labels, 1 + height * width + SLACK);
        for per_label in [&mut self.forest, &mut self.sizes] {
            reserve_to(per_label, height * width);
        }
        let scratch = &mut self.scratch;
        let Scratch { left, left_above, ends, contacts, later_contacts, orphans, .. } = scratch;
        for masks in [left, left_above, ends, contacts, later_contacts, orphans] {
            masks.resize(words, 0);
        }
        for counts in [&mut scratch.runs_before, &mut scratch.runs_before_above] {
            counts.resize(words, 0);
        }
        for columns in [&mut scratch.first_column, &mut scratch.last_column] {
            reserve_to(columns, width + SLACK);
        }
        scratch.inherited.resize(width + SLACK, 0);
    }

    /// How many runs there are.
    pub(super) fn run_count(&self) -> usize {
        self.labels.len() - 1 - SLACK
    }

    /// Provisional label of each run in raster order.
    pub(super) fn labels(&self) -> &[u32] {
        &self.labels[1..1 + self.run_count()]
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

/// Labels a strip, row by row: its masks, its runs, and a label for each.
#[inline(always)]
pub(super) fn scan<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip) {
    strip.valid_pixels = 0;
    strip.labels.resize(1 + SLACK, 0);
    for row in 0..strip.rows.len() {
        row_masks::<I, T>(map, strip.rows.start + row, rule, strip);
        row_runs::<I>(strip, row);
        row_contacts(strip, row);
        row_labels::<I>(strip, row);
        let scratch = &mut strip.scratch;
        std::mem::swap(&mut scratch.left, &mut scratch.left_above);
        std::mem::swap(&mut scratch.runs_before, &mut scratch.runs_before_above);
    }
    strip.row_first_run.push(1 + strip.run_count() as u32);
}

/// Masks of row v of the map, in `valid` and the scratch's `left` and `contacts`. The links lack the
/// validity of the other side yet. The map's first row stands in for the row above it.
#[inline(always)]
fn row_masks<I: Isa, T: Pixel>(map: &DepthView<'_, T>, v: usize, rule: &LinkRule<T>, strip: &mut Strip) {
    let words = strip.words;
    let masks = RowMasks {
        valid: &mut strip.valid[(v - strip.rows.start) * words..][..words],
        close_left: &mut strip.scratch.left[..words],
        close_up: &mut strip.scratch.contacts[..words],
    };
    T::masks::<I>(map.row(v), map.row(v.saturating_sub(1)), rule, masks);
}

/// Lists the runs of a row: a run starts at a valid pixel that is not linked to its left, and ends
/// before the next pixel that is not.
#[inline(always)]
fn row_runs<I: Isa>(strip: &mut Strip, row: usize) {
    let words = strip.words;
    let first = 1 + strip.run_count() as u32;
    let valid = &strip.valid[row * words..][..words];
    let starts = &mut strip.starts[row * words..][..words];
    let scratch = &mut strip.scratch;
    let left = &mut scratch.left[..words];
    let ends = &mut scratch.ends[..words];
    let before = &mut scratch.runs_before[..words];
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
    strip.labels.resize(runs as usize + SLACK, 0);
    I::positions(starts, (runs - first) as usize, &mut scratch.first_column);
    I::positions(ends, (runs - first) as usize, &mut scratch.last_column);
}

/// Finds where the runs of a row touch those above: the first contact of each run, its later ones,
/// and the runs without any.
#[inline(always)]
fn row_contacts(strip: &mut Strip, row: usize) {
    let words = strip.words;
    let Scratch { left, left_above, ends, contacts, later_contacts, orphans, .. } = &mut strip.scratch;
    if row == 0 {
        contacts.fill(0);
    } else {
        let (above, here) = strip.valid[(row - 1) * words..][..2 * words].split_at(words);
        find_contacts(contacts, here, above, left, left_above);
    }
    split_contacts(contacts, later_contacts, left, ends, orphans);
}

/// Labels the runs of a row: from the first contact with a run above, which needs no search, or anew;
/// then unites the labels of later contacts.
#[inline(always)]
fn row_labels<I: Isa>(strip: &mut Strip, row: usize) {
    let words = strip.words;
    let (first, end) = (strip.row_first_run[row] as usize, strip.labels.len() - SLACK);
    let scratch = &mut strip.scratch;
    let (labels, forest, sizes) = (&mut strip.labels[..], &mut strip.forest, &mut strip.sizes);
    let here = Row { starts: &strip.starts[row * words..][..words], before: &scratch.runs_before };
    let above_words = row.saturating_sub(1) * words..;
    let above = Row { starts: &strip.starts[above_words][..words], before: &scratch.runs_before_above };
    let links = Links { contacts: &scratch.contacts, orphans: &scratch.orphans, ends: &scratch.ends, left: &scratch.left };
    let new_label = forest.len() as u32;
    let new_labels = if I::HAS_DENSE_LABELS && row > 0 && (end - first) * DENSE > strip.width {
        let first_above = strip.row_first_run[row - 1] as usize;
        let (labels_above, labels_here) = labels.split_at_mut(first);
        I::dense_labels(&links, above.starts, &labels_above[first_above - 1..], &mut scratch.inherited, labels_here, new_label)
    } else {
        sparse_labels(&links, &here, &above, labels, new_label)
    };
    forest.extend(new_label..new_label + new_labels);
    sizes.resize(forest.len(), 0);
    for w in 0..words {
        let mut later = scratch.later_contacts[w];
        while let Some(up_to) = next_bit(&mut later) {
            forest::unite(forest, labels[here.run_at(w, up_to)], labels[above.run_at(w, up_to)]);
        }
    }
    let columns = scratch.first_column.iter().zip(&scratch.last_column);
    for (&label, (first, last)) in labels[first..end].iter().zip(columns) {
        sizes[label as usize] += u32::from(last - first) + 1;
    }
}

/// How the runs of a row hang together with those above.
pub struct Links<'a> {
    /// First contacts.
    pub contacts: &'a [u64],
    /// Last pixels of runs without a contact.
    pub orphans: &'a [u64],
    /// Last pixels of runs.
    pub ends: &'a [u64],
    /// Pixels linked to their left neighbours.
    pub left: &'a [u64],
}

/// Where the runs of a row start.
struct Row<'a> {
    starts: &'a [u64],
    /// Runs before each word.
    before: &'a [u32],
}

impl Row<'_> {
    /// The run at the highest of the bits `up_to` of word w: as many as there are run starts up to it.
    #[inline(always)]
    fn run_at(&self, w: usize, up_to: u64) -> usize {
        (self.before[w] + (self.starts[w] & up_to).count_ones() - 1) as usize
    }
}

/// Labels runs one by one; how many labels are new.
#[inline(always)]
fn sparse_labels(links: &Links<'_>, here: &Row<'_>, above: &Row<'_>, labels: &mut [u32], new_label: u32) -> u32 {
    for w in 0..here.starts.len() {
        let mut contacts = links.contacts[w];
        while let Some(up_to) = next_bit(&mut contacts) {
            labels[here.run_at(w, up_to)] = labels[above.run_at(w, up_to)];
        }
    }
    let mut new_labels = 0;
    for w in 0..here.starts.len() {
        let mut orphans = links.orphans[w];
        while let Some(up_to) = next_bit(&mut orphans) {
            // An orphan is marked at its end. A run that reaches into the word ends in it first.
            let ended_before = here.before[w] - (links.left[w] & 1) as u32;
            let run = ended_before + (links.ends[w] & up_to).count_ones() - 1;
            labels[run as usize] = new_label + new_labels;
            new_labels += 1;
        }
    }
    new_labels
}

/// Takes the lowest set bit away; the bits up to and including it.
#[inline(always)]
fn next_bit(bits: &mut u64) -> Option<u64> {
    let up_to = *bits ^ bits.wrapping_sub(1);
    let any = *bits != 0;
    *bits &= bits.wrapping_sub(1);
    any.then_some(up_to)
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

/// Leaves in `contacts` each run's first and moves the others to `later`; marks the runs without any
/// in `orphans`, at their ends.
///
/// A run's pixels behind its first are a block of ones in `left`. Adding a one to a block carries
/// through to its end, so the ones that the sum clears lie behind the contact that was added.
#[inline(always)]
fn split_contacts(contacts: &mut [u64], later: &mut [u64], left: &[u64], ends: &[u64], orphans: &mut [u64]) {
    let (mut contact_left, mut carry) = (0, false);
    for w in 0..contacts.len() {
        let behind = (contacts[w] << 1 | contact_left) & left[w];
        contact_left = contacts[w] >> 63;
        let (sum, carry_1) = left[w].overflowing_add(behind);
        let (sum, carry_2) = sum.overflowing_add(carry.into());
        carry = carry_1 | carry_2;
        let covered = (left[w] & !sum) | behind;
        orphans[w] = ends[w] & !(contacts[w] | covered);
        later[w] = contacts[w] & covered;
        contacts[w] &= !covered;
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
    row_masks::<I, T>(map, lower.rows.start, rule, lower);
    let (words, last_row) = (lower.words, upper.rows.len() - 1);
    let (starts, starts_above) = (&lower.starts[..words], &upper.starts[last_row * words..]);
    let (valid, valid_above) = (&lower.valid[..words], &upper.valid[last_row * words..]);
    let Scratch { left, left_above, contacts, .. } = &mut lower.scratch;
    for w in 0..words {
        left[w] = valid[w] & !starts[w];
        left_above[w] = valid_above[w] & !starts_above[w];
    }
    find_contacts(contacts, valid, valid_above, left, left_above);
    let (mut runs, mut runs_above) = (0, upper.row_first_run[last_row] as usize - 1);
    for w in 0..words {
        let mut contacts = contacts[w];
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
