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
use crate::methods::rays::{Rays, Vec3, dot, sub};
use crate::statistics::least_squares::Moments;
use crate::statistics::quadratic::QuadraticSums;
use crate::util::memory::reserve_to;
use crate::util::runs::each_run;
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

/// n of a region's plane `n . point = 1`.
fn normal_of(rays: &Rays, region: &Region) -> Vec3 {
    let [a, b, _] = region.abc;
    rays.inverse([a, b], |u, v| region.at(u, v))
}

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
        let normal = normal_of(self.rays, &self.all[self.id as usize]);
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
            return before * behind < 0.0 && is_gentle(normal, normal_of(rays, other));
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
