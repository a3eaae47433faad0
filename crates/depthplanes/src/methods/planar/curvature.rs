//! Evidence that a surface is curved: how regions bow, and how the surface goes on beyond their borders.
//!
//! In: regions of cells. Out: for each region, what a quadratic through its cell means explains beyond its plane, on
//! the coarsest grid that shows its shape ([`Bows`]); by which factor the smooth part of the error, as large regions
//! show it, exceeds its estimate ([`Shown`]); and beyond how much of a border the surface goes on without a step, at
//! a small angle to the region's plane ([`Border`]). Second differences over a few tiles see little of an error that
//! is smooth over hundreds of pixels; a wall that was merged bit by bit shows it. Meshes of cushions and lamps are
//! made of facets, each exactly flat, and growth makes facets of a ball whose depth has little noise; the face of a
//! box ends in steps and right angles.

use super::grid::{Grid, NONE, Place};
use super::pyramid::Pyramid;
use super::region::{CellBox, Region};
use super::thresholds::{BOW, BOW_VARIANCES, SHOWN, SHOWN_MOST, SHOWN_PIXELS, TURN, TURN_ERROR};
use crate::methods::rays::Rays;
use crate::statistics::least_squares::Moments;
use crate::statistics::quadratic::QuadraticSums;
use crate::util::memory::reserve_to;
use crate::util::runs::each_run;
use crate::util::vec3::{Vec3, dot, sub};
use std::ops::Range;

/// Where x and y of a region's quadratic are 0, and pixels per unit.
pub(super) struct Frame {
    middle: [f64; 2],
    scale: f64,
}

impl Frame {
    /// What a quadratic in it changes by per column and per row at a place, and its value there.
    pub(super) fn slopes(&self, coefficients: &[f64; 6], [u, v]: [f64; 2]) -> ([f64; 2], f64) {
        let [x, y] = [(u - self.middle[0]) * self.scale, (v - self.middle[1]) * self.scale];
        let &[c, a, b, aa, ab, bb] = coefficients;
        let slopes = [self.scale * (a + 2.0 * aa * x + ab * y), self.scale * (b + ab * x + 2.0 * bb * y)];
        (slopes, c + a * x + b * y + aa * x * x + ab * x * y + bb * y * y)
    }

    pub(super) fn of(region: &Region) -> Self {
        Frame { middle: region.middle, scale: 1.0 / region.sums.n.sqrt() }
    }
}

/// Adds a run of cells: their mean residuals about `plane`, and how far off their own region's is if that is asked for.
pub(super) fn add_run(
    sums: &mut QuadraticSums,
    grid: &Grid,
    row: usize,
    columns: Range<usize>,
    plane: &Region,
    own: Option<&Region>,
    frame: &Frame,
) {
    let (mut powers, mut right) = ([0.0; 5], [0.0; 3]);
    let mut y = 0.0;
    for column in columns {
        let cell = grid.cell(Place { row: row as u32, column: column as u32 });
        let x = (cell.middle[0] - frame.middle[0]) * frame.scale;
        y = (cell.middle[1] - frame.middle[1]) * frame.scale;
        let (per_variance, per_n) = (1.0 / cell.variance, 1.0 / cell.n);
        let weight = cell.n * per_variance;
        let residual = cell.residual_about(plane.abc, plane.origin);
        let weighed = residual * per_variance;
        let xx = x * x;
        let (wx, wxx) = (weight * x, weight * xx);
        powers = [powers[0] + weight, powers[1] + wx, powers[2] + wxx, powers[3] + wx * xx, powers[4] + wxx * xx];
        right = [right[0] + weighed, right[1] + weighed * x, right[2] + weighed * xx];
        sums.squares += weighed * residual * per_n;
        sums.pixels += cell.n;
        sums.smooth += weight * cell.smooth;
        sums.cells += 1.0;
        if let Some(own) = own {
            let by_own = cell.residual_about(own.abc, own.origin);
            sums.by_planes += by_own * by_own * per_variance * per_n;
        }
    }
    sums.add_row(y, powers, right);
}

/// Fewest pixels of a region whose bow means something.
pub(super) const BOW_PIXELS: f64 = 240.0;
/// Cells of a region that are enough to see its shape: where so many coarse ones lie in it, finer ones are not looked at.
const SHAPE_CELLS: f64 = 40.0;

/// Degrees between the normals of a quadratic at 1.5 standard deviations of a region's extent to either side of its middle.
fn turn_of(region: &Region, quadratic: &[f64; 6], rays: &Rays) -> f64 {
    let frame = Frame::of(region);
    let Moments { n, u, v, uu, uv, vv, .. } = region.sums;
    let (uu, uv, vv) = (uu / n - u * u / n / n, uv / n - u * v / n / n, vv / n - v * v / n / n);
    let (half, root) = ((uu + vv) / 2.0, (((uu - vv) / 2.0).powi(2) + uv * uv).sqrt());
    let angle = 0.5 * (2.0 * uv).atan2(uu - vv);
    let axes = [([angle.cos(), angle.sin()], half + root), ([-angle.sin(), angle.cos()], (half - root).max(0.0))];
    let turn = |([x, y], variance): ([f64; 2], f64)| {
        let reach = 1.5 * variance.sqrt();
        let [a, b] = [-reach, reach].map(|way| {
            let place @ [pu, pv] = [region.middle[0] + way * x, region.middle[1] + way * y];
            let (slopes, off) = frame.slopes(quadratic, place);
            let [a, b] = [region.abc[0] + slopes[0], region.abc[1] + slopes[1]];
            let q = region.at(pu, pv) + off;
            rays.inverse([a, b], |u, v| q + a * (u - pu) + b * (v - pv))
        });
        let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
        cosine.clamp(-1.0, 1.0).acos().to_degrees()
    };
    axes.map(turn).into_iter().fold(0.0, f64::max)
}

/// No level yet.
const OPEN: u8 = u8::MAX;

/// What is known of the regions' shapes; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Bows {
    sums: Vec<QuadraticSums>,
    /// For each region what a quadratic explains beyond its plane, in variances of a pixel.
    gains: Vec<f64>,
    /// For each region the coarsest grid where it has plenty of cells.
    levels: Vec<u8>,
}

impl Bows {
    /// Measures all regions; the coarser grids know theirs ([`Pyramid::propagate_up`]).
    pub(super) fn measure(&mut self, pyramid: &Pyramid, all: &[Region]) {
        let (cells, Bows { sums, gains, levels }) = (pyramid.grids[0].len(), self);
        reserve_to(sums, cells);
        reserve_to(gains, cells);
        reserve_to(levels, cells);
        sums.resize(all.len(), QuadraticSums::default());
        levels.resize(all.len(), OPEN);
        for (level, grid) in pyramid.grids.iter().enumerate().rev() {
            for (sums, _) in sums.iter_mut().zip(levels.iter()).filter(|(_, level)| **level == OPEN) {
                *sums = QuadraticSums::default();
            }
            for (row, ids) in grid.region.chunks_exact(grid.columns).enumerate() {
                each_run(ids, 0, |id, columns| {
                    if levels[id as usize] == OPEN {
                        let region = &all[id as usize];
                        add_run(&mut sums[id as usize], grid, row, columns, region, None, &Frame::of(region));
                    }
                });
            }
            for (sums, seen) in sums.iter().zip(levels.iter_mut()) {
                let shows = sums.cells >= SHAPE_CELLS || level == 0;
                *seen = if *seen == OPEN && shows { level as u8 } else { *seen };
            }
        }
        gains.extend(sums.iter().map(QuadraticSums::bow));
    }

    /// What a quadratic explains of a region beyond its plane, in variances of a pixel.
    pub(super) fn gain(&self, id: u32) -> f64 {
        self.gains[id as usize]
    }

    /// The coarsest grid where it has plenty of cells.
    pub(super) fn level(&self, id: u32) -> usize {
        self.levels[id as usize].into()
    }

    /// Whether it bows, and turns by `least` degrees, by more than the sensor's smooth error may make it.
    pub(super) fn is_bowed(&self, id: u32, region: &Region, rays: &Rays, least: f64) -> bool {
        let Some([bow, most]) = self.rms(id, region) else { return false };
        if self.gain(id) < BOW_VARIANCES || bow <= most {
            return false;
        }
        let share = 1.0 - TURN_ERROR / BOW * most / bow;
        share * turn_of(region, &self.sums[id as usize].solve::<6>(), rays) > least
    }

    /// Root mean square of a region's bow, in deviations of a pixel, and the most that is taken for flat; none for one that
    /// is too small to tell.
    pub(super) fn rms(&self, id: u32, region: &Region) -> Option<[f64; 2]> {
        let pixels = self.sums[id as usize].pixels;
        (pixels >= BOW_PIXELS)
            .then(|| [(self.gain(id).max(0.0) / pixels).sqrt(), BOW * (region.smooth / region.variance).sqrt()])
    }
}

/// Looks at regions; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Shown {
    /// Of each large region the smooth part's variance as a multiple of the estimated one, and its pixels.
    ratios: Vec<(f64, f64)>,
}

impl Shown {
    /// The deviation of the smooth part as a multiple of the estimated one, 1 or more: a share of the median of what large
    /// regions show, each counted by its pixels. Those that turn as curved surfaces do show nothing.
    pub(super) fn times(&mut self, all: &[Region], bows: &Bows, rays: &Rays, most_regions: usize) -> f64 {
        let ratios = &mut self.ratios;
        reserve_to(ratios, most_regions);
        for (id, region) in (0..).zip(all).filter(|(_, region)| region.sums.n >= SHOWN_PIXELS) {
            let is_curved = bows.is_bowed(id, region, rays, TURN);
            let ratio = if is_curved { 0.0 } else { (region.squares - region.variance) / region.smooth };
            ratios.push((ratio, region.sums.n));
        }
        ratios.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let half = ratios.iter().map(|(_, pixels)| pixels).sum::<f64>() / 2.0;
        let mut pixels_so_far = 0.0;
        let median = ratios.iter().find(|(_, pixels)| {
            pixels_so_far += pixels;
            pixels_so_far >= half
        });
        median.map_or(0.0, |(ratio, _)| SHOWN * ratio.max(0.0).sqrt()).clamp(1.0, SHOWN_MOST)
    }
}

/// Sine of the largest angle at which a surface turns gently, [`super::thresholds::GENTLE`].
const TURN_SINE: f64 = 0.399;
/// Standard deviations of a pixel by which a tile lies off the plane where the surface does turn: what rounding does, its
/// pixels may share.
const TURN_DEVIATIONS: f64 = 3.0;
/// Share of the border beyond which it turns gently: a facet on the rim of a ball has a step on its other side.
const TURNING_SHARE: f64 = 0.4;
/// Fewest places along a border that say something: those of 2 x 2 tiles.
const BORDER_PLACES: f64 = 8.0;
/// A region of so many times the pixels is no facet of the same surface: a wall beside a bevel.
const LARGER_REGION: f64 = 4.0;
/// Pixels that a region counts as having at least, when it is held against larger ones: facets come in all sizes. Of
/// regions that have so many the planes say by how much they turn.
const USUAL_PIXELS: f64 = 240.0;
/// Valid pixels of a tile whose mean says something.
const MEAN_PIXELS: f32 = 8.0;
/// Valid pixels of a tile over which a surface goes on: a gap takes a column of four from one tile, or from two.
const WHOLE_PIXELS: f32 = 13.0;

/// Whether two planes differ by a small angle.
fn is_gentle(a: Vec3, b: Vec3) -> bool {
    let (both, squares) = (dot(a, b), dot(a, a) * dot(b, b));
    both > 0.0 && squares - both * both <= TURN_SINE * TURN_SINE * squares
}

/// A region and what it is held against.
pub(super) struct Border<'a> {
    pub(super) grid: &'a Grid,
    pub(super) all: &'a [Region],
    pub(super) rays: &'a Rays,
    pub(super) id: u32,
}

impl Border<'_> {
    /// Whether beyond much of the border the surface goes on and turns gently.
    pub(super) fn turns(&self, around: &CellBox) -> bool {
        let grid = self.grid;
        let normal = self.all[self.id as usize].inverse(self.rays);
        let [mut places, mut gentle] = [0.0; 2];
        for row in around.first[1]..=around.last[1] {
            for column in around.first[0]..=around.last[0] {
                let at = row * grid.columns + column;
                if grid.region[at] != self.id || self.is_inside(at) {
                    continue;
                }
                let mut look = |is_there: bool, next: usize, far: [usize; 2], step: [f64; 2]| {
                    if is_there && grid.region[next] != self.id {
                        places += 1.0;
                        let goes_on =
                            grid.pixels(next) >= WHOLE_PIXELS && self.turns_to(normal, [column, row], far, step);
                        gentle += f64::from(u8::from(goes_on));
                    }
                };
                // The next tile may lie on both sides of an edge, the one behind it is clear of it.
                look(column >= 2, at.wrapping_sub(1), [column.wrapping_sub(2), row], [-1.0, 0.0]);
                look(column + 2 < grid.columns, at + 1, [column + 2, row], [1.0, 0.0]);
                look(row >= 2, at.wrapping_sub(grid.columns), [column, row.wrapping_sub(2)], [0.0, -1.0]);
                look(row + 2 < grid.rows, at + grid.columns, [column, row + 2], [0.0, 1.0]);
            }
        }
        places >= BORDER_PLACES && gentle >= TURNING_SHARE * places
    }

    /// Whether the tiles to all four sides are the region's.
    #[inline(always)]
    fn is_inside(&self, at: usize) -> bool {
        let region = &self.grid.region;
        let is_own = |at: usize| region.get(at) == Some(&self.id);
        is_own(at.wrapping_sub(1))
            & is_own(at + 1)
            & is_own(at.wrapping_sub(self.grid.columns))
            & is_own(at + self.grid.columns)
    }

    /// Whether the surface turns gently between a tile and one two steps off.
    fn turns_to(&self, normal: Vec3, tile: [usize; 2], far: [usize; 2], step: [f64; 2]) -> bool {
        let Border { grid, all, rays, id } = self;
        let region = &all[*id as usize];
        let at = far[1] * grid.columns + far[0];
        let other = grid.region[at];
        let is_larger =
            || other != NONE && all[other as usize].sums.n > LARGER_REGION * region.sums.n.max(USUAL_PIXELS);
        if other == *id || grid.pixels(at) < MEAN_PIXELS || is_larger() {
            return false;
        }
        let side = grid.side as f64;
        let middle = |tile: [usize; 2]| tile.map(|place| (place as f64 + 0.5) * side - 0.5);
        let ([u, v], q) = (middle(far), grid.q(at));
        let on_plane = region.at(u, v);
        if (q - on_plane).powi(2) <= TURN_DEVIATIONS * TURN_DEVIATIONS * f64::from(grid.variance[at]) {
            return false;
        }
        let own = middle(tile);
        if let Some(other) = all.get(other as usize).filter(|other| other.sums.n.min(region.sums.n) >= USUAL_PIXELS) {
            // Growth may have crossed the edge; the planes themselves say where it is.
            let inner = [0, 1].map(|i| own[i] - 0.5 * side * step[i]);
            let [before, behind] = [inner, [u, v]].map(|[u, v]| other.at(u, v) - region.at(u, v));
            return before * behind < 0.0 && is_gentle(normal, other.inverse(rays));
        }
        let edge = [0, 1].map(|i| own[i] + 0.5 * side * step[i]);
        let from = rays.at(edge, region.at(edge[0], edge[1]));
        let (to, straight) = (rays.at([u, v], q), rays.at([u, v], on_plane));
        let [to, straight] = [to, straight].map(|point| sub(point, from));
        // What lies far behind an edge is many times as far off as the plane itself is there, or the other way round; what
        // folds back lies on the edge's other side.
        let apart = dot(normal, to);
        let way = dot(to, to).min(dot(straight, straight));
        dot(to, straight) > 0.0 && apart * apart <= TURN_SINE * TURN_SINE * dot(normal, normal) * way
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, least_squares, noise, plane_of};

    const SIZE: [usize; 2] = [192, 128];

    /// A wall with a bow down its columns of so many deviations, middle to end.
    fn bowed(seed: u64, deviations: f64) -> Made {
        let bow = |u: f64| deviations * SIGMA * ((u - 95.5) / 95.5).powi(2);
        Made::noisy(SIZE, seed, |u, v| 40.0 + 0.02 * u - 0.01 * v + bow(u))
    }

    /// The wall as one region, and one to its right if `column` says so.
    fn stages(made: &Made, smooth: f64, column: usize) -> Stages {
        let mut stages = Stages::tiles(made, noise(smooth));
        stages.divide(|at, _| u32::from(at >= column));
        stages.run.curvature.bows.measure(&stages.run.pyramid, &stages.run.regions.all);
        stages
    }

    #[test]
    fn the_gain_of_a_region_is_what_a_quadratic_of_its_cell_means_explains_beyond_a_plane() {
        for (seed, deviations, column) in [(1, 0.0, 40), (2, 3.0, 16), (3, 3.0, 40), (4, 20.0, 5)] {
            let made = bowed(seed, deviations).with_holes(seed, 0.02);
            let stages = stages(&made, 0.01, column);
            let bows = &stages.run.curvature.bows;
            for (id, region) in (0..).zip(stages.all()) {
                let grid = &stages.run.pyramid.grids[bows.level(id)];
                let own: Vec<usize> = (0..grid.len()).filter(|&at| grid.region[at] == id).collect();
                // It is the coarsest grid that has plenty of them.
                assert!(own.len() as f64 >= SHAPE_CELLS);
                if let Some(coarser) = stages.run.pyramid.grids.get(bows.level(id) + 1) {
                    assert!((coarser.region.iter().filter(|&&other| other == id).count() as f64) < SHAPE_CELLS);
                }
                let (mut rows, mut right) = (Vec::new(), Vec::new());
                for cell in own.iter().map(|&at| grid.cell(grid.place(at))) {
                    let [u, v] = [0, 1].map(|axis| (cell.middle[axis] - region.middle[axis]) / 50.0);
                    let root = (cell.n / cell.variance).sqrt();
                    rows.push([1.0, u, v, u * u, u * v, v * v].map(|term| root * term).to_vec());
                    right.push(root * cell.residual_about(region.abc, region.origin) / cell.n);
                }
                let of_plane: Vec<Vec<f64>> = rows.iter().map(|row| row[..3].to_vec()).collect();
                let expected = least_squares(&of_plane, &right).1 - least_squares(&rows, &right).1;
                let gain = bows.gain(id);
                assert!((gain - expected).abs() <= 1e-6 * expected + 1e-4, "{gain}, not {expected}, of region {id}");
                let [bow, most] = bows.rms(id, region).unwrap();
                let pixels: f64 = own.iter().map(|&at| f64::from(grid.pixels(at))).sum();
                assert!((bow - (expected / pixels).sqrt()).abs() < 1e-4 && (most - 1.7 * 0.01 / SIGMA).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn a_flat_wall_with_white_noise_has_no_bow_and_shows_no_more_of_the_smooth_part() {
        let mut above = 0;
        for seed in 0..40 {
            let mut stages = stages(&bowed(seed, 0.0), 0.01, 100);
            let Stages { run, rays, .. } = &mut stages;
            let gain = run.curvature.bows.gain(0);
            // Three terms of white noise: chi-squared of 3, more than 7.8 once in twenty.
            above += u32::from(gain > 7.8);
            assert!(gain < BOW_VARIANCES, "{gain} variances, seed {seed}");
            assert!(!run.curvature.bows.is_bowed(0, &run.regions.all[0], rays, 0.0));
            // Nor where no smooth part is expected: what chance explains is no bow.
            let mut without = run.regions.all[0];
            without.smooth = 0.0;
            assert!(!run.curvature.bows.is_bowed(0, &without, rays, 0.0));
            assert_eq!(run.shown.times(&run.regions.all, &run.curvature.bows, rays, 100), 1.0);
        }
        assert!((0..=6).contains(&above), "{above} of 40");
    }

    #[test]
    fn a_wall_that_bows_shows_so_many_times_the_smooth_part_as_half_its_deviation_is() {
        for (seed, deviations, smooth) in [(1, 3.0, 0.01), (2, 5.0, 0.01), (3, 8.0, 0.01), (4, 8.0, 0.002)] {
            let made = bowed(seed, deviations);
            let mut stages = stages(&made, smooth, 100);
            let Stages { run, rays, .. } = &mut stages;
            let squares = plane_of(&made.pixels(0..SIZE[0], 0..SIZE[1]), [0.0; 2]).1;
            let beyond = squares / (SIZE[0] * SIZE[1]) as f64 - SIGMA * SIGMA;
            let expected = (0.5 * beyond.sqrt() / smooth).clamp(1.0, SHOWN_MOST);
            let found = run.shown.times(&run.regions.all, &run.curvature.bows, rays, 100);
            assert!(found > 1.1 && (found / expected - 1.0).abs() < 1e-3, "{found} times, not {expected}");
            assert!(smooth > 0.002 || found == SHOWN_MOST);
        }
        // What turns as a curved surface does says nothing of the noise.
        let mut stages = stages(&bowed(5, 100.0), 0.01, 100);
        let Stages { run, rays, .. } = &mut stages;
        assert_eq!(run.shown.times(&run.regions.all, &run.curvature.bows, rays, 100), 1.0);
    }

    #[test]
    fn half_of_the_pixels_of_large_regions_say_how_much_of_the_smooth_part_is_shown() {
        // A bowed wall to the right of a flat one: the larger tells.
        for (column, expects_more) in [(16, true), (36, false)] {
            let edge = 4.0 * column as f64;
            let bow = |u: f64| 8.0 * SIGMA * ((u - 128.0) / 64.0).powi(2);
            let made = Made::noisy(SIZE, 5, |u, v| 40.0 + 0.02 * v + if u < edge { 0.0 } else { 10.0 + bow(u) });
            let mut stages = stages(&made, 0.01, column);
            let Stages { run, rays, .. } = &mut stages;
            let times = run.shown.times(&run.regions.all, &run.curvature.bows, rays, 100);
            assert_eq!(times > 1.0, expects_more, "{times} times");
        }
        // Small regions tell nothing.
        let made = Made::noisy([40, 40], 5, |u, v| 40.0 + 0.02 * v + 8.0 * SIGMA * (u / 20.0 - 1.0).powi(2));
        let mut stages = stages(&made, 0.01, 100);
        let Stages { run, rays, .. } = &mut stages;
        assert_eq!(run.shown.times(&run.regions.all, &run.curvature.bows, rays, 100), 1.0);
    }

    #[test]
    fn a_bow_turns_by_the_angle_between_its_ends() {
        // By the camera that is assumed a column is 1/192 of the depth.
        let per_column = 0.0006;
        let made = Made::exact(SIZE, |u, _| 40.0 - per_column * (u as f64 - 96.0).powi(2));
        let stages = stages(&made, 1e-9, 100);
        let (region, bows) = (&stages.all()[0], &stages.run.curvature.bows);
        // 1.5 standard deviations of place to each side, of columns 192 / sqrt(12).
        let reach = 1.5 * 192.0 / 12.0f64.sqrt();
        let normal_at = |way: f64| {
            let u = 95.5 + way * reach;
            let q = 40.0 - per_column * (u - 96.0).powi(2);
            let a = -2.0 * per_column * (u - 96.0);
            [a * 192.0, 0.0, q + a * (96.0 - u)]
        };
        let [m, n] = [normal_at(-1.0), normal_at(1.0)];
        let angle = (dot(m, n) / (dot(m, m) * dot(n, n)).sqrt()).acos().to_degrees();
        assert!(angle > 8.0, "{angle} degrees");
        assert!(bows.is_bowed(0, region, &stages.rays, 0.98 * angle), "{angle}");
        assert!(!bows.is_bowed(0, region, &stages.rays, 1.02 * angle), "{angle}");
    }

    #[test]
    fn a_border_turns_where_the_surface_goes_on_at_a_small_angle_and_not_at_a_step_or_a_right_angle() {
        // A face of 12 x 12 tiles, and beyond it a slant, a step, a right angle, or the same plane. In q, about 40, with a
        // column being 1/192 of the depth, a slope of 0.05 a column is 13 degrees.
        let beyond = |slope: f64, step: f64| {
            let made = Made::exact(SIZE, |u, v| {
                let out = [72.0 - u as f64, u as f64 - 119.0, 40.0 - v as f64, v as f64 - 87.0]
                    .into_iter()
                    .fold(0.0, f64::max);
                40.0 - slope * out - if out > 0.0 { step } else { 0.0 }
            });
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, row| if (18..30).contains(&column) && (10..22).contains(&row) { 0 } else { NONE });
            let around = CellBox { first: [18, 10], last: [29, 21] };
            Border { grid: stages.grid(), all: stages.all(), rays: &stages.rays, id: 0 }.turns(&around)
        };
        assert!(beyond(0.05, 0.0), "a slant of 13 degrees");
        assert!(!beyond(0.0, 0.0), "the same plane");
        assert!(!beyond(0.4, 0.0), "a right angle");
        assert!(!beyond(0.05, 10.0), "a step");
    }
}
