//! Where a label image changes.
//!
//! In: a label image, 0 = none. Out: the pixels without a region beside one that has one, and the pairs of neighbours
//! that have different ones. Most pixels are neither, so these are found with bit masks, 64 pixels to a word: column
//! u of a row is bit u % 64 of its word u / 64. Later steps look at the pixels found alone.

use super::connectivity::Connectivity;
use super::isa::RowMasks;
use super::kernels::best;
use crate::map::Validity;
use crate::util::bits::{behind, bits};
use crate::util::parallel::{Rows, map_reduce};
use std::ops::Range;

/// Pixels of a word.
const WORD: usize = u64::BITS as usize;

/// Masks of a region image; reuses its memory.
#[derive(Debug, Default)]
pub(crate) struct Boundary {
    /// Words of a row.
    words: usize,
    /// Pixels with a region; a row without any stands before the first and after the last.
    labelled: Vec<u64>,
    /// Pixels with the label of their left neighbour, and of their upper one.
    like_left: Vec<u64>,
    like_up: Vec<u64>,
}

impl Boundary {
    /// Looks at an image of `stride` columns, a multiple of [`WORD`], on `threads` threads.
    pub(crate) fn find(&mut self, image: &[u16], stride: usize, threads: usize) {
        let (words, count) = (stride / WORD, image.len() / WORD);
        let Boundary { labelled, like_left, like_up, .. } = self;
        labelled.clear();
        labelled.resize(count + 2 * words, 0);
        like_left.resize(count, 0);
        like_up.resize(count, 0);
        let labelled = &mut labelled[words..][..count];
        let rule = Connectivity::new(Validity::default(), 0.0).expect("theta is 0");
        let find = |part: MaskRows<'_>| part.find(image, stride, &rule);
        map_reduce(threads, MaskRows { first: 0, words, labelled, like_left, like_up }, find, |(), ()| ());
        self.words = words;
    }

    /// Calls `visit` with (u, v) of each pixel of some rows without a region that has a neighbour with one, row by row.
    pub(crate) fn each_open(&self, rows: Range<usize>, mut visit: impl FnMut([usize; 2])) {
        let words = self.words;
        for v in rows {
            let [above, here, below] = [v, v + 1, v + 2].map(|row| &self.labelled[row * words..][..words]);
            for word in 0..words {
                let from_right = here.get(word + 1).map_or(0, |next| next << (WORD - 1));
                let beside = above[word] | below[word] | behind(here, word) | here[word] >> 1 | from_right;
                bits(!here[word] & beside).for_each(|bit| visit([word * WORD + bit, v]));
            }
        }
    }

    /// Rows of the image.
    pub(crate) fn rows(&self) -> usize {
        self.like_left.len() / self.words
    }

    /// Calls `visit` with the labels of each two neighbours that have different ones; the right or lower one lies in
    /// the given rows.
    pub(crate) fn each(&self, rows: Range<usize>, image: &[u16], mut visit: impl FnMut(u16, u16)) {
        let (words, stride) = (self.words, self.words * WORD);
        for v in rows {
            let [like_left, like_up] = [&self.like_left, &self.like_up].map(|masks| &masks[v * words..][..words]);
            let [above, here] = [v, v + 1].map(|row| &self.labelled[row * words..][..words]);
            for word in 0..words {
                let mut visit_all = |mask: u64, off: usize| {
                    let first = v * stride + word * WORD;
                    bits(mask).map(|bit| first + bit).for_each(|pixel| visit(image[pixel], image[pixel - off]));
                };
                visit_all(here[word] & behind(here, word) & !like_left[word], 1);
                visit_all(here[word] & above[word] & !like_up[word], stride);
            }
        }
    }
}

/// The masks of some rows, to be written.
struct MaskRows<'a> {
    /// The image's row in the first.
    first: usize,
    words: usize,
    labelled: &'a mut [u64],
    like_left: &'a mut [u64],
    like_up: &'a mut [u64],
}

impl Rows for MaskRows<'_> {
    fn rows(&self) -> usize {
        self.labelled.len() / self.words
    }

    fn split_rows(self, rows: usize) -> (Self, Self) {
        let MaskRows { first, words, labelled, like_left, like_up } = self;
        let [a, b, c] = [labelled, like_left, like_up].map(|masks| masks.split_at_mut(rows * words));
        (
            MaskRows { first, words, labelled: a.0, like_left: b.0, like_up: c.0 },
            MaskRows { first: first + rows, words, labelled: a.1, like_left: b.1, like_up: c.1 },
        )
    }
}

impl MaskRows<'_> {
    fn find(self, image: &[u16], stride: usize, rule: &Connectivity<u16>) {
        let MaskRows { first, words, labelled, like_left, like_up } = self;
        let kernel = best();
        let row = |v: usize| &image[v * stride..][..stride];
        let likes = like_left.chunks_exact_mut(words).zip(like_up.chunks_exact_mut(words));
        for (v, (valid, (close_left, close_up))) in (first..).zip(labelled.chunks_exact_mut(words).zip(likes)) {
            kernel.masks(row(v), row(v.saturating_sub(1)), rule, RowMasks { valid, close_left, close_up });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

    /// Labels of small patches, of lone pixels and of none.
    fn image(random: &mut Random, stride: usize, rows: usize) -> Vec<u16> {
        let labels = [0, 0, 1, 2, 3, u16::MAX];
        let patches: Vec<u16> = (0..stride * rows).map(|_| labels[random.whole(0, 5)]).collect();
        let size = random.whole(1, 9);
        let mut label = |at: usize| match random.uniform() < 0.1 {
            true => labels[random.whole(0, 5)],
            false => patches[at / stride / size * stride + at % stride / size],
        };
        (0..stride * rows).map(&mut label).collect()
    }

    #[test]
    fn open_pixels_and_neighbours_of_two_labels_are_what_a_look_at_each_pixel_finds() {
        let (mut random, mut boundary) = (Random::new(4), Boundary::default());
        for (round, (stride, rows)) in
            [(64, 1), (128, 40), (192, 17), (128, 40), (64, 64)].into_iter().cycle().take(40).enumerate()
        {
            let image = image(&mut random, stride, rows);
            boundary.find(&image, stride, 1 + round % 3);
            assert_eq!(boundary.rows(), rows);
            let at = |u: usize, v: usize| if u < stride && v < rows { image[v * stride + u] } else { 0 };
            let (mut open, mut pairs) = (Vec::new(), Vec::new());
            // Some of the rows alone, too.
            let of = if round % 2 == 0 { 0..rows } else { rows / 3..rows - rows / 3 };
            for (v, u) in of.clone().flat_map(|v| (0..stride).map(move |u| (v, u))) {
                let own = at(u, v);
                let [left, up] = [at(u.wrapping_sub(1), v), at(u, v.wrapping_sub(1))];
                if own == 0 && [left, up, at(u + 1, v), at(u, v + 1)].iter().any(|&label| label > 0) {
                    open.push([u, v]);
                }
                pairs.extend(
                    [left, up]
                        .into_iter()
                        .filter(|&other| own > 0 && other > 0 && other != own)
                        .map(|other| (v, own, other)),
                );
            }
            let mut found = Vec::new();
            boundary.each_open(of.clone(), |place| found.push(place));
            assert_eq!(found, open, "{stride} columns, {rows} rows");
            let mut found = Vec::new();
            for v in of {
                boundary.each(v..v + 1, &image, |own, other| found.push((v, own, other)));
            }
            found.sort_unstable();
            pairs.sort_unstable();
            assert_eq!(found, pairs, "{stride} columns, {rows} rows");
        }
    }
}
