//! Stage "curved", first part: how much each region bows.
//!
//! In: regions of cells. Out: for each region what a quadratic of its cell means explains beyond its plane, on the coarsest
//! grid that shows its shape.

use super::grid::each_run;
use super::grow::Region;
use super::pyramid::Pyramid;
use super::quadratic::{Frame, Sums};
use crate::group::reserve_to;

/// Largest root mean square, in noise deviations of a pixel, of a plane's bow. Noise alone gives a region of
/// 240 pixels 0.11 (three terms of a quadratic).
const BOW: f64 = 0.375;
/// Pixels from which on a sensor's own distortion counts: it bows a plane the more, the larger its picture. What is so
/// large is no facet beside others either.
pub(super) const LARGE: f64 = 4000.0;

/// [`BOW`] for a region of so many pixels; it grows with the root of the region's side.
pub(super) fn most_bow(pixels: f64) -> f64 {
    BOW * (pixels / LARGE).max(1.0).sqrt().sqrt()
}

/// Fewest pixels of a region whose bow means something.
pub(super) const LEAST: f64 = 240.0;
/// Cells of a region that are enough to see its shape: where so many coarse ones lie in it, finer ones are not looked at.
const PLENTY: f64 = 40.0;

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
                        sums[id as usize].add_run(grid, row, columns, region, region, &Frame::of(region));
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

    /// Whether its bow is more than [`BOW`] allows.
    pub(super) fn is_bowed(&self, id: u32) -> bool {
        let pixels = self.sums[id as usize].pixels;
        pixels >= LEAST && self.gain(id) > most_bow(pixels).powi(2) * pixels
    }

    /// Root mean square of a plane's bow, in noise deviations of a pixel, and the most that is taken for flat; none for
    /// a region that is too small to tell.
    pub(super) fn rms(&self, id: u32) -> Option<[f64; 2]> {
        let pixels = self.sums[id as usize].pixels;
        (pixels >= LEAST).then(|| [(self.gain(id).max(0.0) / pixels).sqrt(), most_bow(pixels)])
    }
}
