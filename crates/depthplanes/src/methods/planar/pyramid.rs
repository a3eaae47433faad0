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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::layout::COLUMNS;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, THRESHOLD, noise, patchy};
    use crate::methods::planar::thresholds::{FLAT, limit};
    use crate::noise::SensorNoise;
    use crate::util::random::Random;

    #[test]
    fn a_map_is_summed_the_same_on_any_number_of_threads_and_in_memory_of_another_map() {
        let (mut other, mut affine) = (Pyramid::default(), AffineMap::default());
        for (seed, threads) in [(1, 2), (2, 3), (3, 4)] {
            let made = patchy(seed);
            let stages = Stages::tiles(&made, noise(0.01));
            affine.prepare(&made.view());
            other.sum(&made.view(), Space::Value, threads, &mut affine);
            other.expect(&noise(0.01), THRESHOLD, threads);
            // Written out, numbers that are not numbers are equal too.
            assert_eq!(format!("{other:?}"), format!("{:?}", stages.run.pyramid));
        }
    }

    #[test]
    fn a_cell_has_the_region_that_all_its_tiles_have_and_none_if_they_differ() {
        let (made, mut random) = (Made::exact([250, 70], |_, _| 40.0), Random::new(4));
        let mut stages = Stages::tiles(&made, noise(0.0));
        for round in 0..50 {
            let Pyramid { grids, .. } = &mut stages.run.pyramid;
            // Regions of rectangles; few tiles of another one.
            for at in 0..grids[0].len() {
                let of_rectangle = [NONE, 3, 5][(at / 64 / 8 + at % 64 / 16) % 3];
                grids[0].region[at] = if random.uniform() < 0.05 { random.whole(0, 5) as u32 } else { of_rectangle };
            }
            stages.run.pyramid.propagate_up(1 + round % 3);
            let [tiles, coarser @ ..] = &stages.run.pyramid.grids;
            let mut of_one_region = 0;
            for grid in coarser {
                let times = grid.side / SIDE;
                for (row, column) in (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (row, column))) {
                    let mut own: Vec<u32> = (0..times * times)
                        .map(|part| [times * column + part % times, times * row + part / times])
                        .map(|[column, row]| tiles.region[row * tiles.columns + column])
                        .collect();
                    own.dedup();
                    let expected = if let [only] = own[..] { only } else { NONE };
                    assert_eq!(grid.region[row * grid.columns + column], expected, "{own:?}");
                    of_one_region += usize::from(expected != NONE);
                }
            }
            assert!(of_one_region > 0);
        }
    }

    #[test]
    fn the_parts_of_a_cell_that_have_pixels_get_its_region_and_the_others_none() {
        let mut random = Random::new(5);
        let made = Made::exact([COLUMNS, 64], |u, v| if (u / 4 + v / 4 * 7) % 5 == 0 { f64::NAN } else { 40.0 });
        let stages = Stages::tiles(&made, noise(0.0));
        let [tiles, cells, _] = &stages.run.pyramid.grids;
        let regions: Vec<u32> = (0..cells.len()).map(|_| [NONE, 1, 2][random.whole(0, 2)]).collect();
        // Of the cells' rows 2 to 6, as a band has them.
        let mut to = vec![77; 8 * tiles.columns];
        propagate_down(tiles, 4, &regions[2 * cells.columns..6 * cells.columns], &mut to);
        for (at, &id) in to.iter().enumerate() {
            let [column, row] = [at % tiles.columns, 4 + at / tiles.columns];
            let is_there = (column + row * 7) % 5 != 0;
            let expected = if is_there { regions[row / 2 * cells.columns + column / 2] } else { NONE };
            assert_eq!(id, expected, "at {column}, {row}");
        }
    }

    #[test]
    fn cells_expect_the_noise_and_what_their_slope_makes_of_the_ray() {
        let made = patchy(2);
        let (ray, smooth) = (0.3, 0.02);
        let model = noise(0.0).with_smooth(SensorNoise::Value { sigma: smooth }, 0.0).with_ray(ray);
        let stages = Stages::tiles(&made, model);
        for grid in &stages.run.pyramid.grids {
            for at in (0..grid.len()).filter(|&at| grid.sums.n[at] > 0.0) {
                let [a, b] = [&grid.sums.a, &grid.sums.b].map(|numbers| f64::from(numbers[at]));
                let expected = [SIGMA * SIGMA + ray * ray * (a * a + b * b), smooth * smooth];
                let found = [&grid.variance, &grid.smooth].map(|numbers| f64::from(numbers[at]));
                (0..2)
                    .for_each(|i| assert!((found[i] / expected[i] - 1.0).abs() < 1e-4, "{found:?}, not {expected:?}"));
            }
        }
    }

    #[test]
    fn a_cell_is_as_rough_as_it_or_any_of_its_parts_is_for_the_noise() {
        let smooth = 0.01;
        for seed in 1..4 {
            let stages = Stages::tiles(&patchy(seed), noise(smooth));
            let mut rough_below: Vec<f64> = Vec::new();
            for grid in &stages.run.pyramid.grids {
                let is_tile = grid.side == SIDE;
                let rough: Vec<f64> = (0..grid.len())
                    .map(|at| {
                        let cell = grid.cell(grid.place(at));
                        let (n, variance, smooth) = (cell.n, cell.variance, cell.smooth);
                        // Tiles share no smooth part beside their own plane.
                        let bend = if is_tile { 0.0 } else { FLAT.smooth * n * smooth };
                        let most = f64::from(limit(n as f32, THRESHOLD as f32)) * variance + bend;
                        let own = cell.squares / (n - 3.0).max(1.0) * n / most;
                        let misfit = f64::from(grid.sums.child_misfit[at]);
                        let by_part = misfit / (FLAT.variances * variance + FLAT.smooth * n / 4.0 * smooth);
                        let below = |part: usize| {
                            let [column, row] = [at % grid.columns * 2 + part % 2, at / grid.columns * 2 + part / 2];
                            rough_below[row * 2 * grid.columns + column]
                        };
                        let of_parts = if is_tile { 0.0 } else { (0..4).map(below).fold(0.0, f64::max) };
                        [own, by_part, of_parts].into_iter().filter(|x| !x.is_nan()).fold(0.0, f64::max)
                    })
                    .collect();
                for (at, &expected) in rough.iter().enumerate().filter(|(at, _)| grid.sums.n[*at] > 0.0) {
                    let found = f64::from(grid.roughness[at]);
                    let same = (found - expected).abs() <= 1e-4 * expected.max(1e-3) || found == expected;
                    assert!(same, "{found} for {expected} at {at} of side {}", grid.side);
                }
                rough_below = rough;
            }
        }
    }
}
