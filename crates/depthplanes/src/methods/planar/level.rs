//! How noisy a sensor is, and how well its rays are known, from one frame of it.
//!
//! In: the cells of a map. Out: its scatter, estimated from the coarsest as [`crate::noise::Estimator`] does from
//! pixels, but with what rounding does to them: the tolerance of the method is for both. And the ray, from how the scatter
//! of those coarsest cells that are flat by their tiles grows with the slope.

use super::grid::{Grid, Place};
use super::pyramid::{LEVELS, Pyramid};
use crate::noise::{Blocks, NoiseModel, SensorNoise, Slants, Space, Tiled, VALID};

/// Memory of this stage.
#[derive(Debug, Default)]
pub(super) struct Level {
    pub(super) blocks: Blocks,
    pub(super) slants: Slants,
}

/// The noise that explains the scatter of a map, rounding included.
pub(super) fn noise(blocks: &mut Blocks, grid: &Grid, space: Space) -> SensorNoise {
    blocks.prepare(grid.len().div_ceil(Slants::stride(grid.len())));
    let full = (grid.side * grid.side) as f64;
    // As many as the ray is estimated from tell the noise as well.
    for at in (0..grid.len()).step_by(Slants::stride(grid.len())) {
        let n = f64::from(grid.pixels(at));
        if n >= VALID * full {
            blocks.push(grid.q(at), f64::from(grid.squares(at)) / (n - 3.0), 0.0);
        }
    }
    blocks.noise(space).0
}

/// How well rays are known, pixels, the noise being the stated one if there is one; `step` is that of the values, map
/// units.
pub(super) fn ray(slants: &mut Slants, pyramid: &Pyramid, stated: Option<&NoiseModel>, space: Space, step: f64) -> f64 {
    let [tiles, .., cells] = &pyramid.grids;
    let stride = Slants::stride(cells.len());
    slants.prepare(cells.len().div_ceil(stride));
    for at in (0..cells.len()).step_by(stride) {
        if f64::from(cells.pixels(at)) >= VALID * (cells.side * cells.side) as f64 {
            slants.add(&tiled(tiles, cells, at), stated, space, step);
        }
    }
    slants.ray().unwrap_or(Slants::LEAST)
}

/// A cell of the coarsest and its tiles.
fn tiled(tiles: &Grid, cells: &Grid, at: usize) -> Tiled {
    const PARTS: usize = 1 << (LEVELS - 1);
    let (row, column) = (at / cells.columns * PARTS, at % cells.columns * PARTS);
    // Tiles that lie below each other first, so that those side by side are summed side by side.
    let [mut free, mut squares] = [[0.0; PARTS]; 2];
    for row in row..row + PARTS {
        let first = tiles.at(Place::new(column, row));
        let (n, of_tile) = (&tiles.sums.n[first..][..PARTS], &tiles.sums.squares[first..][..PARTS]);
        for part in 0..PARTS {
            let is_known = n[part] > 3.0;
            free[part] += if is_known { n[part] - 3.0 } else { 0.0 };
            squares[part] += if is_known { of_tile[part] } else { 0.0 };
        }
    }
    let [free, squares] = [free, squares].map(|parts| f64::from(parts.iter().sum::<f32>()));
    Tiled {
        q: cells.q(at),
        gradient: [&cells.sums.a, &cells.sums.b].map(|slope| f64::from(slope[at])),
        n: f64::from(cells.pixels(at)),
        squares: f64::from(cells.squares(at)),
        tiles_free: free,
        tiles_squares: squares,
    }
}
