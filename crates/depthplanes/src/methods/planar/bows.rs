//! Stage "curved", first part: how much each region bows.
//!
//! In: regions of cells. Out: for each region what a quadratic of its cell means explains beyond its plane, on the coarsest
//! grid that shows its shape.

use super::grid::each_run;
use super::grow::Region;
use super::pyramid::Pyramid;
use super::quadratic::{Frame, Sums};
use super::thresholds::{BOW, BOW_VARIANCES, TURN_ERROR};
use crate::fit::Moments;
use crate::group::reserve_to;
use crate::methods::rays::{Rays, dot};

/// Fewest pixels of a region whose bow means something.
pub(super) const LEAST: f64 = 240.0;
/// Cells of a region that are enough to see its shape: where so many coarse ones lie in it, finer ones are not looked at.
const PLENTY: f64 = 40.0;

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
    sums: Vec<Sums>,
    /// For each region what a quadratic explains beyond its plane, in variances of a pixel.
    gains: Vec<f64>,
    /// For each region the coarsest grid where it has plenty of cells.
    levels: Vec<u8>,
}

impl Bows {
    /// Measures all regions; the coarser grids know theirs ([`Pyramid::hand_up`]).
    pub(super) fn measure(&mut self, pyramid: &Pyramid, all: &[Region]) {
        let (cells, Bows { sums, gains, levels }) = (pyramid.grids[0].len(), self);
        reserve_to(sums, cells);
        reserve_to(gains, cells);
        reserve_to(levels, cells);
        sums.resize(all.len(), Sums::default());
        levels.resize(all.len(), OPEN);
        for (level, grid) in pyramid.grids.iter().enumerate().rev() {
            for (sums, _) in sums.iter_mut().zip(levels.iter()).filter(|(_, level)| **level == OPEN) {
                *sums = Sums::default();
            }
            for (row, ids) in grid.region.chunks_exact(grid.columns).enumerate() {
                each_run(ids, 0, |id, columns| {
                    if levels[id as usize] == OPEN {
                        let region = &all[id as usize];
                        sums[id as usize].add_run(grid, row, columns, region, None, &Frame::of(region));
                    }
                });
            }
            for (sums, seen) in sums.iter().zip(levels.iter_mut()) {
                let shows = sums.cells >= PLENTY || level == 0;
                *seen = if *seen == OPEN && shows { level as u8 } else { *seen };
            }
        }
        gains.extend(sums.iter().map(Sums::bow));
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
        (pixels >= LEAST)
            .then(|| [(self.gain(id).max(0.0) / pixels).sqrt(), BOW * (region.smooth / region.variance).sqrt()])
    }
}
