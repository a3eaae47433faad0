//! How a map lies in memory: q in rows with room for whole cells, tiles and larger cells, and the bands of a large map.
//!
//! In: a map and its space. Out: q for every pixel in rows of [`AffineMap::stride`], with room for whole blocks of
//! tiles around it, so that no later stage has to treat the map's edge specially; and ranges of rows ([`cut_bands`]).
//! Several stages work on each such band as if it were a map, and then along the bands' edges. Rows and bands depend
//! on the map's size alone, so that the answer is the same on any number of threads.

use crate::map::{DepthView, Pixel, Validity};
use crate::noise::{LARGEST_Q, Space};
use crate::util::parallel::{Rows, map_reduce};
use std::ops::Range;

/// Columns and rows of a tile. The smallest plane has to hold a few; a tile's own plane should still
/// mean something under noise. Of 4, 5, 6 and 8, 4 was the best on ABW and on made-up rooms.
pub(super) const SIDE: usize = 4;
/// Cells that are computed at a time; a row of any size of cells has a multiple of them.
pub(super) const LANES: usize = 8;
/// Grids of a pyramid. The sides of their cells double.
pub(super) const LEVELS: usize = 3;
/// Columns of the coarsest cells that are summed at a time.
pub(super) const COLUMNS: usize = LANES * ROWS;
/// Rows of the coarsest cells.
pub(super) const ROWS: usize = SIDE << (LEVELS - 1);

/// A map in q; NaN where nothing was measured, where q is more than [`LARGEST_Q`], and beyond the map's edge.
#[derive(Debug, Default)]
pub(super) struct AffineMap {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Columns, a multiple of [`COLUMNS`].
    pub(super) stride: usize,
    /// Rows, a multiple of [`ROWS`].
    pub(super) rows: usize,
    pub(super) q: Vec<f32>,
    pub(super) valid_pixels: usize,
}

impl AffineMap {
    /// Makes room for a map.
    pub(super) fn prepare<T: Pixel>(&mut self, map: &DepthView<'_, T>) {
        let (width, height) = (map.width(), map.height());
        if (self.width, self.height) != (width, height) {
            (self.width, self.height) = (width, height);
            (self.stride, self.rows) = (width.next_multiple_of(COLUMNS), height.next_multiple_of(ROWS));
            self.q.clear();
            self.q.resize(self.stride * self.rows, f32::NAN);
        }
    }

    /// Which pixels of the tile whose first pixel is (u, v) are no further from a plane than the root of `most`, a bit for
    /// each. The plane is `q = a du + b dv + c` about that pixel.
    #[inline(always)]
    pub(super) fn lie_on(&self, [u, v]: [usize; 2], [a, b, c]: [f32; 3], most: f32) -> u32 {
        let mut bits = 0;
        for dv in 0..SIDE {
            let q = &self.q[(v + dv) * self.stride + u..][..SIDE];
            for du in 0..SIDE {
                let off = q[du] - (a * du as f32 + b * dv as f32 + c);
                bits |= u32::from(off * off <= most) << (SIDE * dv + du); // not for NaN
            }
        }
        bits
    }
}

/// Turns a row of a map into q; how many of its pixels are valid.
#[inline(always)]
pub(super) fn fill_row<T: Pixel>(row: &[T], q: &mut [f32], validity: Validity<T>, space: Space) -> usize {
    match space {
        Space::InverseDepth { metres } => {
            let per_unit = (1.0 / metres) as f32;
            fill_with(row, q, validity, |value| per_unit / value)
        }
        Space::Value => fill_with(row, q, validity, |value| value),
    }
}

#[inline(always)]
fn fill_with<T: Pixel>(row: &[T], q: &mut [f32], validity: Validity<T>, of: impl Fn(f32) -> f32) -> usize {
    let mut valid = 0u32;
    for (q, &value) in q.iter_mut().zip(row) {
        let of_value = of(value.to_f32());
        let holds = validity.holds(value) & (of_value.abs() <= LARGEST_Q);
        *q = if holds { of_value } else { f32::NAN };
        valid += u32::from(holds);
    }
    valid as usize
}

/// Pixels of a band, about: more than most sensors' whole frames have, so that few planes are cut.
const BAND_PIXELS: usize = 1 << 19;
/// Most bands of a map.
const MOST_BANDS: usize = 8;

/// Cuts so many rows of a map of so many pixels into bands of nearly as many.
pub(super) fn cut_bands(rows: usize, pixels: usize) -> impl Iterator<Item = Range<usize>> {
    let per_band = rows.div_ceil(pixels.div_ceil(BAND_PIXELS).min(MOST_BANDS));
    (0..rows).step_by(per_band).map(move |first| first..(first + per_band).min(rows))
}

/// A band's rows of what has several for each of the coarsest cells'.
pub(super) fn finer(band: &Range<usize>, times: usize) -> Range<usize> {
    band.start * times..band.end * times
}

/// Does the work on each band, on as many threads. It is handed the band, the memory for it, and its part of each of the
/// `wholes`; beside each of these stands how much of it there is for a row of the coarsest cells.
pub(super) fn for_each_band<M: Send, T: Send, const N: usize>(
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
    map_reduce(threads, Bands { bands, memories, wholes }, work_on, |(), ()| ());
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

    fn split_rows(self, count: usize) -> (Self, Self) {
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
