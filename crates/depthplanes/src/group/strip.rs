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
    /// Whether pixels without any link may be left out of the runs.
    pub(super) leaves_out_singles: bool,
    /// How many were.
    pub(super) singles_left_out: usize,
    scratch: Scratch,
}

/// What only a row and its neighbours need.
#[derive(Debug, Default)]
struct Scratch {
    above: RowLinks,
    here: RowLinks,
    below: RowLinks,
    ends: Vec<u64>,
    contacts: Vec<u64>,
    later_contacts: Vec<u64>,
    orphans: Vec<u64>,
    first_column: Vec<u16>,
    last_column: Vec<u16>,
    inherited: Vec<u32>,
}

/// The links of one row, one bit a pixel, and the runs before each word.
#[derive(Debug, Default)]
struct RowLinks {
    left: Vec<u64>,
    up: Vec<u64>,
    runs_before: Vec<u32>,
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
        for row in [&mut scratch.above, &mut scratch.here, &mut scratch.below] {
            row.left.resize(words + 1, 0); // the last word stays 0
            row.up.resize(words, 0);
            row.runs_before.resize(words, 0);
        }
        let Scratch { ends, contacts, later_contacts, orphans, .. } = scratch;
        for masks in [ends, contacts, later_contacts, orphans] {
            masks.resize(words, 0);
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

/// Labels a strip, row by row: its links, its runs, their contacts, and a label for each. Links are
/// known one row ahead, to tell pixels without any.
#[inline(always)]
pub(super) fn scan<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip) {
    (strip.valid_pixels, strip.singles_left_out) = (0, 0);
    strip.labels.resize(1 + SLACK, 0);
    row_links::<I, T>(map, rule, strip, 0);
    for row in 0..strip.rows.len() {
        let Scratch { above, here, below, .. } = &mut strip.scratch;
        std::mem::swap(above, here);
        std::mem::swap(here, below);
        if row + 1 < strip.rows.len() {
            row_links::<I, T>(map, rule, strip, row + 1);
        }
        row_runs::<I>(strip, row);
        let found = row_contacts(strip);
        row_labels::<I>(strip, row, &found);
    }
    strip.row_first_run.push(1 + strip.run_count() as u32);
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
    let first = 1 + strip.run_count() as u32;
    let valid = &mut strip.valid[row * words..][..words];
    let starts = &mut strip.starts[row * words..][..words];
    let Scratch { here, below, ends, first_column, last_column, .. } = &mut strip.scratch;
    let mut end = start_runs(valid, &here.left, starts, ends, &mut here.runs_before, first);
    let is_inner = row > 0 && row + 1 < strip.rows.len(); // outer rows have links to other strips
    if strip.leaves_out_singles && is_inner && (end - first) as usize * DENSE > strip.width {
        let before = end;
        leave_out_singles(valid, starts, ends, &here.up, &below.up);
        end = start_runs(valid, &here.left, starts, ends, &mut here.runs_before, first);
        strip.singles_left_out += (before - end) as usize;
    }
    strip.row_first_run.push(first);
    strip.labels.resize(end as usize + SLACK, 0);
    I::positions(starts, (end - first) as usize, first_column);
    I::positions(ends, (end - first) as usize, last_column);
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

/// Finds where the runs of a row touch those above: the first contact of each run, its later ones,
/// and the runs without any.
#[inline(always)]
fn row_contacts(strip: &mut Strip) -> Found {
    let Scratch { above, here, ends, contacts, later_contacts, orphans, .. } = &mut strip.scratch;
    find_contacts(here, &above.left, ends, [contacts, later_contacts, orphans])
}

/// Labels the runs of a row: from the first contact with a run above, which needs no search, or anew;
/// then unites the labels of later contacts.
#[inline(always)]
fn row_labels<I: Isa>(strip: &mut Strip, row: usize, found: &Found) {
    let words = strip.words;
    let (first, end) = (strip.row_first_run[row] as usize, strip.labels.len() - SLACK);
    let scratch = &mut strip.scratch;
    let (labels, forest, sizes) = (&mut strip.labels[..], &mut strip.forest, &mut strip.sizes);
    let here = Row { starts: &strip.starts[row * words..][..words], before: &scratch.here.runs_before };
    let above_words = row.saturating_sub(1) * words..;
    let above = Row { starts: &strip.starts[above_words][..words], before: &scratch.above.runs_before };
    let links =
        Links { contacts: &scratch.contacts, orphans: &scratch.orphans, ends: &scratch.ends, left: &scratch.here.left };
    let new_label = forest.len() as u32;
    let new_labels = if I::HAS_DENSE_LABELS && row > 0 && (end - first) * DENSE > strip.width {
        let first_above = strip.row_first_run[row - 1] as usize;
        let (labels_above, labels_here) = labels.split_at_mut(first);
        I::dense_labels(
            &links,
            above.starts,
            &labels_above[first_above - 1..],
            &mut scratch.inherited,
            labels_here,
            new_label,
        )
    } else {
        sparse_labels(&links, &here, &above, labels, new_label, found.orphans)
    };
    forest.extend(new_label..new_label + new_labels);
    sizes.resize(forest.len(), 0);
    for w in 0..if found.later_contacts { words } else { 0 } {
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
fn sparse_labels(
    links: &Links<'_>,
    here: &Row<'_>,
    above: &Row<'_>,
    labels: &mut [u32],
    new_label: u32,
    any_orphans: bool,
) -> u32 {
    for w in 0..here.starts.len() {
        let mut contacts = links.contacts[w];
        while let Some(up_to) = next_bit(&mut contacts) {
            labels[here.run_at(w, up_to)] = labels[above.run_at(w, up_to)];
        }
    }
    let mut new_labels = 0;
    for w in 0..if any_orphans { here.starts.len() } else { 0 } {
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

/// Finds the pixels at which two runs first touch: linked upwards, and without a left neighbour in the
/// same two runs that is too. Of these, the first of each run go to `contacts`, the others to `later`;
/// runs without any are marked in `orphans`, at their ends.
///
/// A run's pixels behind its first are a block of ones in `left`. Adding a one to a block carries
/// through to its end, so the ones that the sum clears lie behind the contact that was added.
#[inline(always)]
fn find_contacts(here: &RowLinks, left_above: &[u64], ends: &[u64], out: [&mut [u64]; 3]) -> Found {
    let words = ends.len();
    let [contacts, later, orphans] = out.map(|masks| &mut masks[..words]);
    let (up, left, left_above) = (&here.up[..words], &here.left[..words], &left_above[..words]);
    let (mut up_left, mut contact_left, mut carry) = (0, 0, false);
    let (mut any_later, mut any_orphans) = (0, 0);
    for w in 0..words {
        let contact = up[w] & !((up[w] << 1 | up_left) & left[w] & left_above[w]);
        let behind = (contact << 1 | contact_left) & left[w];
        let (sum, carry_1) = left[w].overflowing_add(behind);
        let (sum, carry_2) = sum.overflowing_add(carry.into());
        let covered = (left[w] & !sum) | behind;
        (up_left, contact_left, carry) = (up[w] >> 63, contact >> 63, carry_1 | carry_2);
        (contacts[w], later[w]) = (contact & !covered, contact & covered);
        orphans[w] = ends[w] & !(contact | covered);
        any_orphans |= orphans[w];
        any_later |= later[w];
    }
    Found { orphans: any_orphans != 0, later_contacts: any_later != 0 }
}

/// What a row has of what many rows have not.
struct Found {
    orphans: bool,
    later_contacts: bool,
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
    let Scratch { above, here, ends: unused, contacts, later_contacts, orphans, .. } = &mut lower.scratch;
    let masks = RowMasks { valid: unused, close_left: &mut here.left[..words], close_up: &mut here.up };
    T::masks::<I>(map.row(v), map.row(v - 1), rule, masks);
    for w in 0..words {
        here.up[w] &= valid[w] & valid_above[w];
        here.left[w] = valid[w] & !starts[w];
        above.left[w] = valid_above[w] & !starts_above[w];
    }
    find_contacts(here, &above.left, unused, [contacts, later_contacts, orphans]);
    let (mut runs, mut runs_above) = (0, upper.row_first_run[last_row] as usize - 1);
    for w in 0..words {
        let mut contacts = contacts[w] | later_contacts[w];
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
