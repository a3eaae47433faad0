//! Bands: parts of a large map that several stages work on as if each were a map, and then along their edges.
//!
//! In: a map's rows of the coarsest cells. Out: ranges of them, which its size alone decides on, so that the answer is the
//! same on any number of threads.

use crate::parallel::{Rows, in_parts};
use std::ops::Range;

/// Pixels of a band, about: more than most sensors' whole frames have, so that few planes are cut.
const PIXELS: usize = 1 << 19;
/// Most bands of a map.
const MOST: usize = 8;

/// Cuts so many rows of a map of so many pixels into bands of nearly as many.
pub(super) fn cut(rows: usize, pixels: usize) -> impl Iterator<Item = Range<usize>> {
    let per_band = rows.div_ceil(pixels.div_ceil(PIXELS).min(MOST));
    (0..rows).step_by(per_band).map(move |first| first..(first + per_band).min(rows))
}

/// A band's rows of what has several for each of the coarsest cells'.
pub(super) fn finer(band: &Range<usize>, times: usize) -> Range<usize> {
    band.start * times..band.end * times
}

/// Does the work on each band, on as many threads. It is handed the band, the memory for it, and its part of each of the
/// `wholes`; beside each of these stands how much of it there is for a row of the coarsest cells.
pub(super) fn in_bands<M: Send, T: Send, const N: usize>(
    bands: &[Range<usize>],
    memories: &mut [M],
    wholes: [(&mut [T], usize); N],
    threads: usize,
    work: impl Fn(&Range<usize>, &mut M, [&mut [T]; N]) + Sync,
) {
    let work_on = |Bands { bands, memories, mut wholes }: Bands<'_, M, T, N>| {
        for (band, memory) in bands.iter().zip(memories) {
            work(band, memory, wholes.each_mut().map(|whole| split_off(whole, band.len())));
        }
    };
    in_parts(threads, Bands { bands, memories, wholes }, work_on, |(), ()| ());
}

/// What there is for the first rows; the rest is left.
fn split_off<'a, T>((whole, per_row): &mut (&'a mut [T], usize), rows: usize) -> &'a mut [T] {
    whole.split_off_mut(..rows * *per_row).expect("so many rows")
}

/// Some bands, and what there is for each.
struct Bands<'a, M, T, const N: usize> {
    bands: &'a [Range<usize>],
    memories: &'a mut [M],
    wholes: [(&'a mut [T], usize); N],
}

impl<M: Send, T: Send, const N: usize> Rows for Bands<'_, M, T, N> {
    fn rows(&self) -> usize {
        self.bands.len()
    }

    fn cut(self, count: usize) -> (Self, Self) {
        let Bands { bands, memories, mut wholes } = self;
        let (bands, memories) = (bands.split_at(count), memories.split_at_mut(count));
        let rows = bands.1[0].start - bands.0[0].start;
        let first = wholes.each_mut().map(|whole| (split_off(whole, rows), whole.1));
        (
            Bands { bands: bands.0, memories: memories.0, wholes: first },
            Bands { bands: bands.1, memories: memories.1, wholes },
        )
    }
}
