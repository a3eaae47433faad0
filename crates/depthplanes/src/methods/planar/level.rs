//! How noisy a sensor is, from one frame of it.
//!
//! In: the coarsest cells of a map. Out: its scatter, estimated from them as [`crate::noise::Estimator`] does from
//! pixels, but with what rounding does to them: the tolerance of the method is for both.

use super::grid::Grid;
use crate::noise::{Blocks, SensorNoise, Space, VALID};

/// Memory of this stage.
#[derive(Debug, Default)]
pub(super) struct Level {
    blocks: Blocks,
}

impl Level {
    /// The noise that explains the scatter of a map, rounding included.
    pub(super) fn estimate(&mut self, grid: &Grid, space: Space) -> SensorNoise {
        self.blocks.prepare(grid.len());
        let full = (grid.side * grid.side) as f64;
        for at in 0..grid.len() {
            let n = f64::from(grid.pixels(at));
            if n >= VALID * full {
                self.blocks.push(grid.q(at), f64::from(grid.squares(at)) / (n - 3.0), 0.0);
            }
        }
        self.blocks.noise(space).0
    }
}
