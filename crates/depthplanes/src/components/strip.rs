//! A strip of rows: its bit masks, its runs, and their provisional labels.
//!
//! In: rows of the map. Out: for each row the masks of valid pixels and run starts, for each run a
//! provisional label, and the forest of those labels. Columns of a row are bits, column u in bit u % 64 of word
//! u / 64, so "left" is one bit lower.

use super::isa::SLACK;
use super::scratch::Scratch;
use crate::util::memory::reserve_to;
use std::ops::Range;

/// Words of the rows that are looked at together, about: few enough for their masks to stay in the
/// nearest cache, many enough for loops over them to be long.
const BLOCK_WORDS: usize = 256;

/// What a strip knows after `scan`.
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
    /// How many provisional labels the strips above have.
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
    pub(super) fn block_rows(&self) -> usize {
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
