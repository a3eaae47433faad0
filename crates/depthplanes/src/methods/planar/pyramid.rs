//! Stage "tiles", second part: the grids of a map, summed and held against the noise.
//!
//! In: a map. Out: the map in q, and a pyramid of grids: tiles of [`SIDE`] x [`SIDE`] pixels, cells of 2 x 2 tiles, and
//! cells of 4 x 4, each with its own plane.

use super::grid::{Grid, GridRows, NONE};
use super::layout::{AffineMap, LEVELS, ROWS, SIDE, cut_bands, fill_row, finer};
use super::region::of_slope;
use super::tiles::{HALVES, Pixels, sum_cells, sum_tiles};
use crate::map::{DepthView, Pixel};
use crate::noise::scales::{self, Scales};
use crate::noise::{NoiseModel, Space};
use crate::util::parallel::{NumberedRows, Rows, map_reduce};
use crate::util::simd::vectorised;
use std::array::from_fn;
use std::ops::Range;

/// The grids of a map, the finest first.
#[derive(Debug)]
pub(super) struct Pyramid {
    pub(super) grids: [Grid; LEVELS],
    /// The map's bands, as rows of the coarsest cells.
    pub(super) bands: Vec<Range<usize>>,
}

impl Default for Pyramid {
    fn default() -> Self {
        Pyramid { grids: from_fn(|level| Grid::new(SIDE << level)), bands: Vec::new() }
    }
}

impl Pyramid {
    /// Turns a map into q and sums it, tile by tile, and the tiles, cell by cell.
    pub(super) fn sum<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        space: Space,
        threads: usize,
        affine: &mut AffineMap,
    ) {
        self.grids.iter_mut().for_each(|grid| grid.prepare(affine));
        self.bands.clear();
        self.bands.extend(cut_bands(self.grids[LEVELS - 1].rows, affine.q.len()));
        let AffineMap { stride, ref mut q, .. } = *affine;
        let whole = MapRows { first: 0, stride, q, cells: self.whole() };
        let sum = |part: MapRows<'_>| {
            vectorised(
                #[inline(always)]
                || part.sum(map, space),
            )
        };
        affine.valid_pixels = map_reduce(threads, whole, sum, |a, b| a + b);
    }

    /// Holds the cells against a noise model.
    pub(super) fn expect(&mut self, noise: &NoiseModel, inlier_threshold: f64, threads: usize) {
        let expect = |mut cells: Cells<'_>| {
            vectorised(
                #[inline(always)]
                || cells.expect(noise, inlier_threshold as f32),
            );
        };
        map_reduce(threads, self.whole(), expect, |(), ()| ());
    }

    /// Takes the smooth part's variance so many times.
    pub(super) fn widen_smooth(&mut self, factor: f32) {
        for grid in &mut self.grids {
            grid.smooth.iter_mut().for_each(|smooth| *smooth *= factor);
        }
    }

    /// Shows the map's errors at several scales: second differences of neighbouring cells' means, and tiles' residuals about
    /// their own planes.
    pub(super) fn show(&self, scales: &mut Scales) {
        scales.prepare();
        let tiles = &self.grids[0];
        let of_tile = |(filled, pixels), &n: &f32| (filled + u32::from(n > 0.0), pixels + n as u32);
        let (filled, pixels) = vectorised(
            #[inline(always)]
            || tiles.sums.n.iter().fold((0, 0), of_tile),
        );
        let usual = (f64::from(pixels) / f64::from(filled.max(1))) as f32;
        for (level, grid) in self.grids.iter().enumerate() {
            let sums = &grid.sums;
            scales.look_at(
                scales::Cells { level, columns: grid.columns, rows: grid.rows, usual },
                #[inline(always)]
                |at: usize| scales::Cell {
                    n: sums.n[at],
                    abc: [sums.a[at], sums.b[at], sums.c[at]],
                    squares: sums.squares[at],
                },
            );
        }
    }

    /// A band's rows of the cells of a level.
    pub(super) fn rows_of(&self, band: &Range<usize>, level: usize) -> Range<usize> {
        finer(band, 1 << (LEVELS - 1 - level))
    }

    /// Cells of a level for a row of the coarsest.
    pub(super) fn per_row(&self, level: usize) -> usize {
        self.grids[level].columns << (LEVELS - 1 - level)
    }

    fn whole(&mut self) -> Cells<'_> {
        Cells { grids: self.grids.each_mut().map(Grid::whole) }
    }

    /// Gives each coarse cell the region that its four parts agree on, on as many threads.
    pub(super) fn propagate_up(&mut self, threads: usize) {
        for level in 1..LEVELS {
            let (finer, coarser) = self.grids.split_at_mut(level);
            let (parts, grid) = (&finer[level - 1], &mut coarser[0]);
            let propagate_up = |cells: NumberedRows<'_, u32>| cells.each().for_each(|(row, to)| parts.agreed(row, to));
            let cells = NumberedRows { first: 0, per_row: grid.columns, all: &mut grid.region[..] };
            map_reduce(threads, cells, propagate_up, |(), ()| ());
        }
    }
}

/// Gives the regions of cells to those of their parts that have a pixel; the parts begin in row `first`.
pub(super) fn propagate_down(parts: &Grid, first: usize, regions: &[u32], to: &mut [u32]) {
    let rows =
        to.chunks_exact_mut(parts.columns).zip(parts.sums.n[first * parts.columns..].chunks_exact(parts.columns));
    for (row, (to, pixels)) in rows.enumerate() {
        let above = &regions[row / 2 * (parts.columns / 2)..];
        for ((part, pixels), &region) in to.as_chunks_mut::<2>().0.iter_mut().zip(pixels.as_chunks::<2>().0).zip(above)
        {
            *part = pixels.map(|pixels| if pixels > 0.0 { region } else { NONE });
        }
    }
}

/// The cells of some rows of the coarsest ones, of all sizes.
struct Cells<'a> {
    grids: [GridRows<'a>; LEVELS],
}

impl Rows for Cells<'_> {
    fn rows(&self) -> usize {
        self.grids[LEVELS - 1].rows()
    }

    fn split_rows(self, rows: usize) -> (Self, Self) {
        let mut level = 0;
        let [a, b, c] = self.grids.map(|grid| {
            level += 1;
            grid.split_rows(rows << (LEVELS - level))
        });
        (Cells { grids: [a.0, b.0, c.0] }, Cells { grids: [a.1, b.1, c.1] })
    }
}

impl Cells<'_> {
    #[inline(always)]
    fn expect(&mut self, noise: &NoiseModel, inlier_threshold: f32) {
        let ray = noise.ray() as f32;
        for level in 0..LEVELS {
            let (finer, coarser) = self.grids.split_at_mut(level);
            let grid = &mut coarser[0];
            let planes = [&*grid.sums.c, &*grid.sums.a, &*grid.sums.b];
            noise.expect(planes, (SIDE << level) as f64, [&mut *grid.variance, &mut *grid.smooth]);
            for ((variance, &a), &b) in grid.variance.iter_mut().zip(&*grid.sums.a).zip(&*grid.sums.b) {
                *variance += of_slope(ray, a, b);
            }
            grid.hold_against_noise(finer.last(), inlier_threshold);
        }
    }
}

/// Rows of a map, as many as some of the coarsest cells have.
struct MapRows<'a> {
    /// The map's row in the first.
    first: usize,
    stride: usize,
    q: &'a mut [f32],
    cells: Cells<'a>,
}

impl Rows for MapRows<'_> {
    fn rows(&self) -> usize {
        self.cells.rows()
    }

    fn split_rows(self, rows: usize) -> (Self, Self) {
        let MapRows { first, stride, q, cells } = self;
        let (q, cells) = (q.split_at_mut(rows * ROWS * stride), cells.split_rows(rows));
        (
            MapRows { first, stride, q: q.0, cells: cells.0 },
            MapRows { first: first + rows * ROWS, stride, q: q.1, cells: cells.1 },
        )
    }
}

impl MapRows<'_> {
    /// Turns its rows into q and sums them, those of a row of the coarsest cells at a time, which the nearest cache holds;
    /// how many pixels are valid.
    #[inline(always)]
    fn sum<T: Pixel>(self, map: &DepthView<'_, T>, space: Space) -> usize {
        let MapRows { first, stride, q, cells: Cells { mut grids } } = self;
        let (mut valid, mut pixels, mut halves) = (0, Pixels::NOTHING, HALVES);
        for (row, q) in q.chunks_exact_mut(ROWS * stride).enumerate() {
            let first = first + row * ROWS;
            for (v, q) in (first..map.height()).zip(q.chunks_exact_mut(stride)) {
                valid += fill_row(map.row(v), &mut q[..map.width()], map.validity(), space);
            }
            let tiles = ROWS / SIDE;
            for (below, q) in q.chunks_exact(SIDE * stride).enumerate() {
                sum_tiles(q, row * tiles + below, &mut pixels, &mut halves, &mut grids[0]);
            }
            for level in 1..LEVELS {
                let (finer, coarser) = grids.split_at_mut(level);
                let cells = tiles >> level;
                for below in 0..cells {
                    sum_cells(&finer[level - 1], row * cells + below, SIDE << level, &mut coarser[0]);
                }
            }
        }
        valid
    }
}
