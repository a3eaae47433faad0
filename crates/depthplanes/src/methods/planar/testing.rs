//! For the stages' own tests: maps of known planes, a run that goes no further than a stage, and what a look at each
//! pixel finds.

use super::curved::Sensing;
use super::grid::{Cell, Grid, NONE};
use super::layout::SIDE;
use super::pipeline::Runner;
use super::region::{Planes, Region, find_boxes};
use crate::camera::ValueKind;
use crate::map::DepthView;
use crate::methods::rays::Rays;
use crate::noise::{NoiseModel, SensorNoise, Space};
use crate::sensor::Sensor;
use crate::util::random::Random;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Standard deviation of a synthetic pixel.
pub(super) const SIGMA: f64 = 0.05;
/// The inlier threshold of the tests.
pub(super) const THRESHOLD: f64 = 4.0;

/// What the synthetic maps are taken with.
pub(super) const SENSOR: Sensor =
    Sensor { value_kind: ValueKind::Disparity, intrinsics: None, distortion: None, noise: None, smooth_noise: None };

/// A synthetic map: disparity, so that q is the value.
#[derive(Clone, Debug)]
pub(super) struct Made {
    pub(super) q: Vec<f32>,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Made {
    /// A map whose pixels are exactly that.
    pub(super) fn exact([width, height]: [usize; 2], mut q: impl FnMut(usize, usize) -> f64) -> Self {
        Made { q: (0..width * height).map(|at| q(at % width, at / width) as f32).collect(), width, height }
    }

    /// The same with white noise of [`SIGMA`].
    pub(super) fn noisy(size: [usize; 2], seed: u64, q: impl Fn(f64, f64) -> f64) -> Self {
        let mut random = Random::new(seed);
        Made::exact(size, |u, v| q(u as f64, v as f64) + SIGMA * random.gaussian())
    }

    /// The same map without about so large a share of its pixels.
    pub(super) fn with_holes(mut self, seed: u64, share: f64) -> Self {
        let mut random = Random::new(seed);
        self.q.iter_mut().filter(|_| random.uniform() < share).for_each(|q| *q = f32::NAN);
        self
    }

    pub(super) fn view(&self) -> DepthView<'_, f32> {
        DepthView::new(&self.q, self.width, self.height).unwrap()
    }

    /// The pixels (u, v, q) of some columns and rows that were measured.
    pub(super) fn pixels(&self, columns: Range<usize>, rows: Range<usize>) -> Vec<[f64; 3]> {
        let places =
            rows.flat_map(|v| columns.clone().map(move |u| (u, v))).filter(|&(u, v)| u < self.width && v < self.height);
        let pixels = places.map(|(u, v)| [u as f64, v as f64, self.q[v * self.width + u].into()]);
        pixels.filter(|pixel| pixel[2].is_finite()).collect()
    }

    /// Those of the tiles of one region.
    pub(super) fn pixels_of(&self, tiles: &Grid, id: u32) -> Vec<[f64; 3]> {
        let own = (0..tiles.len()).filter(|&at| tiles.region[at] == id);
        let places = own.map(|at| [at % tiles.columns * SIDE, at / tiles.columns * SIDE]);
        places.flat_map(|[u, v]| self.pixels(u..u + SIDE, v..v + SIDE)).collect()
    }
}

/// White noise of [`SIGMA`], and a smooth part of that deviation.
pub(super) fn noise(smooth: f64) -> NoiseModel {
    let white = NoiseModel::new(ValueKind::Disparity, SensorNoise::Value { sigma: SIGMA }, 0.0).unwrap();
    white.with_smooth(SensorNoise::Value { sigma: smooth }, 0.0)
}

/// A run that a test takes from stage to stage.
pub(super) struct Stages {
    pub(super) run: Runner,
    pub(super) noise: NoiseModel,
    pub(super) rays: Rays,
}

impl Stages {
    /// Tiles, held against the noise.
    pub(super) fn tiles(made: &Made, noise: NoiseModel) -> Self {
        let mut run = Runner::default();
        run.affine.prepare(&made.view());
        run.pyramid.sum(&made.view(), Space::Value, 1, &mut run.affine);
        run.pyramid.expect(&noise, THRESHOLD, 1);
        Stages { run, noise, rays: Rays::of(&SENSOR, made.width, made.height) }
    }

    /// And regions as they grew.
    pub(super) fn grown(made: &Made, noise: NoiseModel) -> Self {
        let mut stages = Stages::tiles(made, noise);
        stages.run.regions.grow(&mut stages.run.pyramid, THRESHOLD, 1);
        stages
    }

    /// And merged, those that became part of another left out.
    pub(super) fn merged(made: &Made, noise: NoiseModel) -> Self {
        let mut stages = Stages::grown(made, noise);
        let Runner { refiner, pyramid, regions, .. } = &mut stages.run;
        refiner.refine(pyramid, &mut regions.all, 1);
        stages.merge();
        stages
    }

    /// And judged; none is dropped.
    pub(super) fn judged(made: &Made, noise: NoiseModel) -> Self {
        let mut stages = Stages::merged(made, noise);
        stages.judge();
        stages
    }

    /// Merges the regions that there are.
    pub(super) fn merge(&mut self) {
        let Runner { pyramid, regions, merger, .. } = &mut self.run;
        merger.merge(&pyramid.grids[0], regions, &self.rays, 1);
        merger.drop(&mut pyramid.grids[0], regions, 1, |_| false);
    }

    /// Lists the edges between the regions that there are, and merges nothing.
    pub(super) fn list_edges(&mut self) {
        let Runner { pyramid, merger, .. } = &mut self.run;
        merger.edges.clear();
        merger.list_edges(&pyramid.grids[0], 1);
    }

    /// Judges the regions that there are.
    pub(super) fn judge(&mut self) {
        let Runner { affine, pyramid, regions, merger, curvature, redundancy, .. } = &mut self.run;
        pyramid.propagate_up(1);
        find_boxes(&pyramid.grids[0], &regions.all, &mut curvature.boxes);
        let planes = planes(&regions.all, &self.noise);
        redundancy.find(affine, &pyramid.grids[0], &planes, &merger.edges, &curvature.boxes, 1);
        curvature.bows.measure(pyramid, &regions.all);
        let sensing = Sensing { noise: &self.noise, rays: &self.rays };
        curvature.mark(pyramid, regions, &merger.edges, &redundancy.is_redundant, sensing, 1);
    }

    /// Gives each tile the region that `id` says, if it has a pixel, in place of those that there are.
    pub(super) fn divide(&mut self, id: impl Fn(usize, usize) -> u32) {
        let Runner { pyramid, regions, .. } = &mut self.run;
        let tiles = &mut pyramid.grids[0];
        for at in 0..tiles.len() {
            let id = id(at % tiles.columns, at / tiles.columns);
            tiles.region[at] = if tiles.pixels(at) > 0.0 { id } else { NONE };
        }
        regions.all = regions_of(tiles);
        pyramid.propagate_up(1);
    }

    pub(super) fn grid(&self) -> &Grid {
        &self.run.pyramid.grids[0]
    }

    pub(super) fn all(&self) -> &[Region] {
        &self.run.regions.all
    }

    /// The region of the tile that a pixel lies in.
    pub(super) fn region_at(&self, [u, v]: [usize; 2]) -> u32 {
        self.grid().region[v / SIDE * self.grid().columns + u / SIDE]
    }

    /// Fails unless each region's sums are those of its tiles.
    pub(super) fn check_sums(&self) {
        for (id, region) in (0..).zip(self.all()) {
            let cells: Vec<Cell> = cells_of(self.grid(), id).collect();
            let mut sums = cells[0].moments(region.origin);
            cells[1..].iter().for_each(|cell| sums.merge(&cell.moments(region.origin)));
            let own = region.sums;
            assert_eq!(own.n, sums.n, "pixels of region {id}");
            // Sums of larger cells are rounded to single precision elsewhere than those of tiles.
            let scale = sums.qq.max(1.0);
            for (what, own, by_tiles, scale) in [
                ("u", own.u, sums.u, sums.uu.sqrt()),
                ("v", own.v, sums.v, sums.vv.sqrt()),
                ("q", own.q, sums.q, (sums.n * scale).sqrt()),
                ("uu", own.uu, sums.uu, sums.uu),
                ("uv", own.uv, sums.uv, (sums.uu * sums.vv).sqrt()),
                ("vv", own.vv, sums.vv, sums.vv),
                ("uq", own.uq, sums.uq, (sums.uu * scale).sqrt()),
                ("vq", own.vq, sums.vq, (sums.vv * scale).sqrt()),
                ("qq", own.qq, sums.qq, scale),
                ("variance", region.variance, cells.iter().map(|cell| cell.variance * cell.n).sum(), region.variance),
                ("smooth", region.smooth, cells.iter().map(|cell| cell.smooth * cell.n).sum(), region.smooth),
            ] {
                assert!(
                    (own - by_tiles).abs() <= 1e-4 * scale,
                    "{what} of region {id}: {own}, {by_tiles} by its tiles"
                );
            }
        }
    }
}

/// Bands that end where the next begins.
pub(super) fn bands(ends: &[usize]) -> Vec<Range<usize>> {
    ends.windows(2).map(|ends| ends[0]..ends[1]).collect()
}

/// What pixels are held against.
pub(super) fn planes<'a>(regions: &'a [Region], noise: &'a NoiseModel) -> Planes<'a> {
    Planes { regions, noise, inlier_threshold: THRESHOLD, curved: false }
}

/// The tiles of a region.
pub(super) fn cells_of(tiles: &Grid, id: u32) -> impl Iterator<Item = Cell> {
    (0..tiles.len()).filter(move |&at| tiles.region[at] == id).map(|at| tiles.cell(tiles.place(at)))
}

/// The regions of numbered tiles; of each number up to the largest there is a tile.
pub(super) fn regions_of(tiles: &Grid) -> Vec<Region> {
    let count = tiles.region.iter().filter(|&&id| id != NONE).max().map_or(0, |id| id + 1);
    let region = |id: u32| {
        let mut cells = cells_of(tiles, id);
        let mut region = Region::of(&cells.next().expect("a tile of each region"));
        cells.for_each(|cell| region.take(&cell));
        region.refit();
        region
    };
    (0..count).map(region).collect()
}

/// Least squares by singular values: the coefficients of the columns, and the squares that they leave.
pub(super) fn least_squares(rows: &[Vec<f64>], right: &[f64]) -> (Vec<f64>, f64) {
    let matrix = DMatrix::from_row_iterator(rows.len(), rows[0].len(), rows.iter().flatten().copied());
    let right = DVector::from_column_slice(right);
    let solution = matrix.clone().svd(true, true).solve(&right, 1e-12).unwrap();
    let squares = (matrix * &solution - right).norm_squared();
    (solution.iter().copied().collect(), squares)
}

/// The plane of least squares through pixels, `q = a (u - u0) + b (v - v0) + c`, and the squares that it leaves.
pub(super) fn plane_of(pixels: &[[f64; 3]], [u0, v0]: [f64; 2]) -> ([f64; 3], f64) {
    let rows: Vec<Vec<f64>> = pixels.iter().map(|&[u, v, _]| vec![u - u0, v - v0, 1.0]).collect();
    let (plane, squares) = least_squares(&rows, &pixels.iter().map(|pixel| pixel[2]).collect::<Vec<_>>());
    ([plane[0], plane[1], plane[2]], squares)
}

/// The squares of pixels about a plane.
pub(super) fn squares_about(pixels: &[[f64; 3]], [a, b, c]: [f64; 3], [u0, v0]: [f64; 2]) -> f64 {
    pixels.iter().map(|[u, v, q]| (q - (a * (u - u0) + b * (v - v0) + c)).powi(2)).sum()
}

/// Whether pixels lie on one line, or are fewer than three.
pub(super) fn are_on_a_line(pixels: &[[f64; 3]]) -> bool {
    let Some(&[u0, v0, _]) = pixels.first() else { return true };
    let Some(&[u1, v1, _]) = pixels.get(1) else { return true };
    pixels.iter().all(|[u, v, _]| (u1 - u0) * (v - v0) == (v1 - v0) * (u - u0))
}

/// The pixels of a cell that count: those of its tiles that have three and more, not on a line.
pub(super) fn pixels_that_count(made: &Made, side: usize, [column, row]: [usize; 2]) -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for v in (row * side..(row + 1) * side).step_by(SIDE) {
        for u in (column * side..(column + 1) * side).step_by(SIDE) {
            let pixels = made.pixels(u..u + SIDE, v..v + SIDE);
            if !are_on_a_line(&pixels) {
                all.extend(pixels);
            }
        }
    }
    all
}

/// Slanted patches with noise, steps between them, and holes from a few pixels of a tile to nearly all of it.
pub(super) fn patchy(seed: u64) -> Made {
    let mut random = Random::new(seed);
    let mut patch = [0.0; 4];
    let mut patches = Vec::new();
    for _ in 0..8 * 8 {
        if random.uniform() < 0.6 {
            patch = [random.between(20.0, 60.0), random.between(-0.5, 0.5), random.between(-0.5, 0.5), 0.0];
        }
        patch[3] = [0.0, 0.0, 0.1, 0.5, 0.85][random.whole(0, 4)];
        patches.push(patch);
    }
    Made::exact([150, 90], |u, v| {
        let [q, a, b, holes] = patches[v / 12 * 8 + u / 20];
        let value = q + a * (u as f64 - 75.0) + b * (v as f64 - 45.0) + SIGMA * random.gaussian();
        if random.uniform() < holes { f64::NAN } else { value }
    })
}
