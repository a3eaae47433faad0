//! A strip of rows: its bit masks, its runs, and their provisional labels.
//!
//! In: rows of the map. Out: for each row the masks of valid pixels and run starts, for each run a
//! provisional label, and the forest of those labels. Columns of a row are bits, column u in bit u % 64 of word
//! u / 64, so "left" is one bit lower.

use super::kernels::{Isa, SLACK};
use super::labels::{Scratch, label_block, next_bit};
use super::{LinkRule, forest, reserve_to};
use crate::map::{DepthView, Pixel};
use std::ops::Range;

/// The masks of one row, one bit a pixel, as an instruction set computes them.
pub struct RowMasks<'a> {
    /// Pixels that are valid.
    pub valid: &'a mut [u64],
    /// Pixels within theta of their left neighbour, valid or not; column 0 has none.
    pub close_left: &'a mut [u64],
    /// Pixels within theta of the neighbour above, valid or not.
    pub close_up: &'a mut [u64],
}

/// A row is dense if it has more runs than one in this many pixels. Set where labelling runs many at a
/// time begins to pay; measured at 6, 10 and 16, which differ by at most 6 % on any of six frames.
pub(super) const DENSE: usize = 6;

/// Words of the rows that are looked at together, about: few enough for their masks to stay in the
/// nearest cache, many enough for loops over them to be long.
const BLOCK_WORDS: usize = 256;

/// What a strip knows after [`scan`].
///
/// As in any two-pass labelling, a run takes the provisional label of the first run that it touches
/// above, or a new one if it touches none; labels that meet later are united in a forest. Only new
/// labels cost an element of the forest, so it stays small even where noise makes many runs.
///
/// A row without pixels stands before the first in `valid`, `starts` and `runs_before`, so that every
/// row has one above it and every word one before it.
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
    /// Runs of the strip that start before each word, `words` a row.
    pub(super) runs_before: Vec<u32>,
    /// Provisional label of each run, counted from 1, and [`SLACK`] elements more to read and write.
    /// It only grows; what lies behind the last run is left from other maps.
    pub(super) labels: Vec<u32>,
    /// How many runs there are.
    pub(super) run_count: usize,
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
            masks.resize((1 + height) * words, 0);
            masks[..words].fill(0);
        }
        self.runs_before.resize((1 + height) * words, 0);
        self.runs_before[..words].fill(0);
        let most_labels = 1 + height * width + SLACK;
        self.labels.reserve(most_labels.saturating_sub(self.labels.len()));
        for per_label in [&mut self.forest, &mut self.sizes] {
            reserve_to(per_label, height * width);
        }
        self.scratch.prepare(width, BLOCK_WORDS.max(words));
    }

    /// Rows that are looked at together.
    fn block_rows(&self) -> usize {
        (BLOCK_WORDS / self.words).max(1)
    }

    /// The words of a row, counted from 0 within the strip.
    pub(super) fn words_of(&self, row: usize) -> Range<usize> {
        (row + 1) * self.words..(row + 2) * self.words
    }

    /// The runs of a row, counted from 1 within the strip.
    pub(super) fn runs_of(&self, row: usize) -> Range<usize> {
        let words = self.words_of(row);
        1 + self.runs_before[words.start] as usize..1 + self.run_at(words.end - 1, u64::MAX)
    }

    /// The run at the highest of the bits `up_to` of a word: as many as there are run starts up to it.
    #[inline(always)]
    pub(super) fn run_at(&self, word: usize, up_to: u64) -> usize {
        (self.runs_before[word] + (self.starts[word] & up_to).count_ones()) as usize
    }

    /// Provisional label of each run in raster order.
    pub(super) fn labels(&self) -> &[u32] {
        &self.labels[1..=self.run_count]
    }

    /// Calls `visit` for each run in raster order with its row, first and last column, and provisional
    /// label.
    #[inline]
    pub(super) fn each_run(&self, mut visit: impl FnMut(usize, u32, u32, u32)) {
        let mut labels = self.labels().iter();
        for (row, v) in self.rows.clone().enumerate() {
            let (valid, starts) = (&self.valid[self.words_of(row)], &self.starts[self.words_of(row)]);
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

/// Labels a strip, block by block of rows: their links, their runs, their contacts, and a label for each.
#[inline(always)]
pub(super) fn scan<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip) {
    (strip.valid_pixels, strip.singles_left_out, strip.run_count) = (0, 0, 0);
    let (height, block_rows) = (strip.rows.len(), strip.block_rows());
    for first in (0..height).step_by(block_rows) {
        let block = first..(first + block_rows).min(height);
        find_links::<I, T>(map, rule, strip, &block);
        find_runs(strip, &block);
        strip.scratch.find_contacts::<I>(block.len() * strip.words, strip.words);
        label_block::<I>(strip, &block);
    }
}

/// Links of a block's rows, and of the row below, which tells pixels without any. Those of the block's
/// first row are known from the block above.
#[inline(always)]
fn find_links<I: Isa, T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip, block: &Range<usize>) {
    let (words, block_rows) = (strip.words, strip.block_rows());
    let Scratch { left, up, .. } = &mut strip.scratch;
    let known = block.start + usize::from(block.start > 0);
    if block.start > 0 {
        // The last two rows of the block above are the first two here.
        let last_two = block_rows * words..(block_rows + 2) * words;
        left.copy_within(last_two.clone(), 0);
        up.copy_within(last_two, 0);
    }
    let rows = known..(block.end + 1).min(strip.rows.len());
    let (start, at) = ((known + 1) * words, (known + 1 - block.start) * words);
    let (left, up) = (&mut left[at..][..rows.len() * words], &mut up[at..][..rows.len() * words]);
    let valid = &mut strip.valid[start..][..rows.len() * words];
    let rows_of_masks = valid.chunks_exact_mut(words).zip(left.chunks_exact_mut(words).zip(up.chunks_exact_mut(words)));
    for (row, (valid, (close_left, close_up))) in rows.clone().zip(rows_of_masks) {
        let v = strip.rows.start + row;
        T::masks::<I>(map.row(v), map.row(v.saturating_sub(1)), rule, RowMasks { valid, close_left, close_up });
    }
    // Both sides of a link are valid. Above the strip there is nothing.
    let all = &strip.valid[..start + left.len()];
    let (here, before, above) = (&all[start..], &all[start - 1..], &all[start - words..]);
    let (left, up) = (&mut left[..here.len()], &mut up[..here.len()]);
    let mut pixels = 0;
    for w in 0..here.len() {
        left[w] &= here[w] & (here[w] << 1 | before[w] >> 63);
        up[w] &= here[w] & above[w];
        pixels += u64::from(here[w].count_ones());
    }
    strip.valid_pixels += pixels as usize;
}

/// Runs of a block: one starts at each valid pixel that is not linked to its left, and ends before the
/// next pixel that is not.
#[inline(always)]
fn find_runs(strip: &mut Strip, block: &Range<usize>) {
    let (words, count) = (strip.words, block.len() * strip.words);
    let at = (block.start + 1) * words;
    let (valid, starts) = (&mut strip.valid[at..][..count], &mut strip.starts[at..][..count]);
    let Scratch { left, ends, .. } = &mut strip.scratch;
    let (left, next, ends) = (&left[words..][..count], &left[words + 1..][..count], &mut ends[..count]);
    for w in 0..count {
        starts[w] = valid[w] & !left[w];
        ends[w] = valid[w] & !(left[w] >> 1 | next[w] << 63);
    }
    if strip.leaves_out_singles {
        leave_out_singles(strip, block);
    }
    let (starts, before) = (&strip.starts[at..][..count], &mut strip.runs_before[at..][..count]);
    let mut runs = strip.run_count as u32;
    for w in 0..count {
        before[w] = runs;
        runs += starts[w].count_ones();
    }
    strip.run_count = runs as usize;
    if strip.labels.len() < 1 + strip.run_count + SLACK {
        strip.labels.resize(1 + strip.run_count + SLACK, 0);
    }
}

/// Takes pixels that are a run of their own and linked neither up nor down for missing: each is a
/// group that nobody asked for, and noise makes many. Outer rows have links to other strips.
#[inline(always)]
fn leave_out_singles(strip: &mut Strip, block: &Range<usize>) {
    let words = strip.words;
    let inner = block.start.max(1)..block.end.min(strip.rows.len() - 1).max(1);
    let (at, from, count) = ((inner.start + 1) * words, (inner.start - block.start) * words, inner.len() * words);
    let (valid, starts) = (&mut strip.valid[at..][..count], &mut strip.starts[at..][..count]);
    let Scratch { up, ends, .. } = &mut strip.scratch;
    let (ends, up, below) =
        (&mut ends[from..][..count], &up[from + words..][..count], &up[from + 2 * words..][..count]);
    let mut singles = 0;
    for w in 0..count {
        let single = starts[w] & ends[w] & !(up[w] | below[w]);
        valid[w] ^= single;
        starts[w] ^= single;
        ends[w] ^= single;
        singles += u64::from(single.count_ones());
    }
    strip.singles_left_out += singles as usize;
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
    let (words, v) = (lower.words, lower.rows.start);
    let (here, there) = (lower.words_of(0), upper.words_of(upper.rows.len() - 1));
    let (starts, starts_above) = (&lower.starts[here.clone()], &upper.starts[there.clone()]);
    let (valid, valid_above) = (&lower.valid[here.clone()], &upper.valid[there.clone()]);
    let (here, there) = (here.start, there.start);
    // The last row of the upper strip goes to where the row above a block stands.
    let Scratch { left, up, ends: unused, .. } = &mut lower.scratch;
    let (left_above, left) = left.split_at_mut(words);
    let (left, up) = (&mut left[..words], &mut up[words..][..words]);
    let masks = RowMasks { valid: &mut unused[..words], close_left: left, close_up: up };
    T::masks::<I>(map.row(v), map.row(v - 1), rule, masks);
    for w in 0..words {
        up[w] &= valid[w] & valid_above[w];
        left[w] = valid[w] & !starts[w];
        left_above[w] = valid_above[w] & !starts_above[w];
    }
    lower.scratch.find_contacts::<I>(words, words);
    for w in 0..words {
        let mut contacts = lower.scratch.contacts[words + w];
        while let Some(up_to) = next_bit(&mut contacts) {
            let here = lower.labels[lower.run_at(here + w, up_to)] + lower.first_label as u32;
            let there = upper.labels[upper.run_at(there + w, up_to)] + upper.first_label as u32;
            forest::unite(forest, here, there);
        }
    }
}
