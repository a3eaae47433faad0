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
/// mean something under noise. Of 4, 5, 6 and 8, 4 was the best on ABW and on synthetic rooms.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::pyramid::Pyramid;
    use crate::util::random::Random;

    /// Fails unless every pixel's q is what the space says of its value, and is not a number where there is none.
    fn check<T: Pixel>(affine: &mut AffineMap, map: DepthView<'_, T>, space: Space) {
        affine.prepare(&map);
        Pyramid::default().sum(&map, space, 1, affine);
        let (validity, mut valid) = (map.validity(), 0);
        for (at, &q) in affine.q.iter().enumerate() {
            let [u, v] = [at % affine.stride, at / affine.stride];
            let value = (u < map.width() && v < map.height()).then(|| map.row(v)[u]).filter(|&value| {
                let number: f64 = value.into();
                let missing = [0.0, validity.sentinel.into()].contains(&number) || !number.is_finite();
                !missing && number >= validity.low.into() && number <= validity.high.into()
            });
            let expected = value.map(|value| space.q(value.into())).filter(|q| q.abs() <= f64::from(LARGEST_Q));
            match expected {
                Some(expected) => {
                    assert!((f64::from(q) - expected).abs() <= 1e-6 * expected.abs(), "{q} at {u}, {v}: {expected}");
                    valid += 1;
                }
                None => assert!(q.is_nan(), "{q} at {u}, {v}, where nothing was measured"),
            }
        }
        assert_eq!(affine.valid_pixels, valid);
    }

    #[test]
    fn q_of_every_pixel_is_what_the_space_says_and_no_number_where_nothing_was_measured() {
        let mut random = Random::new(5);
        let mut affine = AffineMap::default();
        // Twice the same size, so that memory is reused.
        for [width, height] in [[130, 37], [130, 37], [128, 16], [1, 1], [257, 5]] {
            let special = [0.0, f32::NAN, f32::INFINITY, -3.5, 1e-17, 2e-16, 9e14, 2e15, 1e20, 7.0, 1.0, 99.0];
            let floats: Vec<f32> = (0..width * height)
                .map(|_| if random.uniform() < 0.3 { special[random.whole(0, 11)] } else { random.uniform() as f32 })
                .collect();
            let counts: Vec<u16> = (0..width * height).map(|_| random.whole(0, 3000) as u16).collect();
            for space in [Space::Value, Space::InverseDepth { metres: 1.0 }, Space::InverseDepth { metres: 0.001 }] {
                let view = DepthView::new(&floats, width, height).unwrap().missing_value(7.0);
                check(&mut affine, view, space);
                check(&mut affine, view.valid_range(0.5, 50.0).unwrap(), space);
                let view = DepthView::new(&counts, width, height).unwrap().missing_value(2047);
                check(&mut affine, view, space);
                check(&mut affine, view.valid_range(500, 2500).unwrap(), space);
            }
        }
    }

    #[test]
    fn the_pixels_of_a_tile_that_lie_on_a_plane_are_those_that_a_plain_loop_finds() {
        let mut random = Random::new(6);
        let q = (0..COLUMNS * ROWS).map(|_| if random.uniform() < 0.1 { f32::NAN } else { random.uniform() as f32 });
        let affine =
            AffineMap { width: COLUMNS, height: ROWS, stride: COLUMNS, rows: ROWS, q: q.collect(), valid_pixels: 0 };
        for _ in 0..500 {
            let [u, v] = [random.whole(0, COLUMNS - SIDE), random.whole(0, ROWS - SIDE)];
            let [a, b] = [0; 2].map(|_| random.between(-0.2, 0.2));
            let (c, distance) = (random.uniform(), random.between(0.0, 0.6));
            let bits = affine.lie_on([u, v], [a, b, c].map(|x| x as f32), (distance * distance) as f32);
            for (dv, du) in (0..SIDE).flat_map(|dv| (0..SIDE).map(move |du| (dv, du))) {
                let off = f64::from(affine.q[(v + dv) * COLUMNS + u + du]) - (a * du as f64 + b * dv as f64 + c);
                let is_on = off.abs() <= distance; // never for NaN
                let is_close = (off.abs() - distance).abs() < 1e-5;
                assert!(is_close || (bits >> (SIDE * dv + du) & 1 == 1) == is_on, "{du}, {dv}: {off} of {distance}");
            }
        }
    }

    #[test]
    fn bands_cover_all_rows_once_and_are_as_many_as_the_size_asks_for() {
        let mut random = Random::new(7);
        for _ in 0..500 {
            let (rows, stride) = (random.whole(1, 300), COLUMNS * random.whole(1, 40));
            let bands: Vec<_> = cut_bands(rows, stride * rows * ROWS).collect();
            let all: Vec<usize> = bands.iter().cloned().flatten().collect();
            assert_eq!(all, (0..rows).collect::<Vec<_>>(), "{bands:?}");
            let pixels: Vec<usize> = bands.iter().map(|band| band.len() * ROWS * stride).collect();
            assert!(bands.len() <= MOST_BANDS && !pixels.contains(&0), "{bands:?}");
            // Nobody cuts what is small, and a band of several is no smaller than half of what is wanted but for the last.
            assert!(stride * rows * ROWS > BAND_PIXELS || bands.len() == 1, "{bands:?}");
            assert!(bands.len() == MOST_BANDS || pixels[0] < BAND_PIXELS + ROWS * stride, "{bands:?}");
            assert!(pixels[..bands.len() - 1].iter().all(|&pixels| 2 * pixels > BAND_PIXELS), "{bands:?}");
        }
    }

    #[test]
    fn each_band_is_handed_its_own_memory_and_its_own_rows_of_every_whole() {
        let bands = [0..3, 3..4, 4..9, 9..10, 10..17];
        for threads in [1, 2, 3] {
            let (mut one, mut two) = ([0; 17 * 5], [0; 17 * 2]);
            let mut memories = [0, 1, 2, 3, 4];
            for_each_band(&bands, &mut memories, [(&mut one, 5), (&mut two, 2)], threads, |band, memory, [a, b]| {
                assert_eq!([a.len(), b.len()], [5, 2].map(|per_row| per_row * band.len()));
                a.fill(*memory + 1);
                b.fill(*memory + 1);
                *memory += 10;
            });
            let band_of = |row: usize| 1 + bands.iter().position(|band| band.contains(&row)).unwrap();
            assert_eq!(one.to_vec(), (0..17 * 5).map(|at| band_of(at / 5)).collect::<Vec<_>>());
            assert_eq!(two.to_vec(), (0..17 * 2).map(|at| band_of(at / 2)).collect::<Vec<_>>());
            assert_eq!(memories, [10, 11, 12, 13, 14]);
        }
    }
}
