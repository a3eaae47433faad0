//! How noisy a sensor is, from one frame of it.
//!
//! In: the scatter of cells about their own planes. Out: a noise model. Most cells of most maps lie on one
//! smooth surface, so the lower half of the scatter in each stretch of q is noise.

use super::tiles::Grid;
use crate::group::reserve_to;
use crate::noise::{NoiseModel, Space};

/// Stretches of q, each with as many blocks.
const BINS: usize = 8;
/// Share of the blocks of a stretch that are taken to be flat.
const FLAT: f64 = 0.5;
/// Least share of a block's pixels that are valid.
const FULL: f32 = 0.8;

/// Memory of this stage.
#[derive(Debug, Default)]
pub(super) struct Level {
    /// q and scatter of each block.
    blocks: Vec<(f64, f64)>,
}

impl Level {
    /// The noise model that explains the scatter of a map whose values come in steps of so many map units. The
    /// cells should be large enough to span the steps of a sensor that rounds coarsely: within one step a
    /// cell shows no noise at all.
    pub(super) fn estimate(&mut self, grid: &Grid, space: Space, step: f64) -> NoiseModel {
        let blocks = &mut self.blocks;
        reserve_to(blocks, grid.len());
        let full = FULL * (grid.side * grid.side) as f32;
        let blocks_of = (0..grid.len()).filter(|&at| grid.pixels(at) >= full);
        blocks.extend(blocks_of.map(|at| (grid.q(at), f64::from(grid.squares(at) / grid.pixels(at)).sqrt())));
        blocks.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let size = blocks.len().div_ceil(BINS).max(1);
        let mut points = [(0.0, 0.0); BINS];
        let mut count = 0;
        for (bin, point) in blocks.chunks_mut(size).zip(&mut points) {
            let q = bin[bin.len() / 2].0;
            bin.sort_unstable_by(|a, b| a.1.total_cmp(&b.1));
            *point = (q, bin[(bin.len() as f64 * FLAT) as usize].1);
            count += 1;
        }
        let [constant, square] = non_negative(&points[..count], space);
        NoiseModel::new(space, constant, square, step)
    }
}
/// Least squares of `sigma = constant + square q^2`, neither below 0, each point weighed by its size.
fn non_negative(points: &[(f64, f64)], space: Space) -> [f64; 2] {
    if points.is_empty() {
        return [0.0; 2];
    }
    let (mut n, mut x, mut xx, mut y, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for &(q, sigma) in points {
        let (square, weight) = (q * q, 1.0 / (sigma * sigma).max(1e-12));
        n += weight;
        x += weight * square;
        xx += weight * square * square;
        y += weight * sigma;
        xy += weight * square * sigma;
    }
    if space == Space::Value {
        return [y / n, 0.0];
    }
    let det = n * xx - x * x;
    let (constant, square) = ((xx * y - x * xy) / det, (n * xy - x * y) / det);
    if det.is_nan() || det <= 1e-9 * n * xx || square < 0.0 {
        [y / n, 0.0]
    } else if constant < 0.0 {
        [0.0, xy / xx]
    } else {
        [constant, square]
    }
}
