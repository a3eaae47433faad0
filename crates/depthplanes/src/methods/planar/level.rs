//! How noisy a sensor is, from one frame of it.
//!
//! In: the tiles of a map. Out: its scatter, estimated from blocks of tiles as [`crate::noise::Estimator`] does from
//! pixels, but with what rounding does to them: the tolerance of the method is for both.

use super::tiles::{Layer, SIDE};
use crate::fit::Moments;
use crate::noise::{BLOCK_SIDE, Blocks, SensorNoise, Space};

/// Tiles of a block's side.
const TILES: usize = BLOCK_SIDE / SIDE;

/// Memory of this stage.
#[derive(Debug, Default)]
pub(super) struct Level {
    blocks: Blocks,
}

impl Level {
    /// Makes room for a map with so many tiles.
    pub(super) fn prepare(&mut self, tiles: usize) {
        self.blocks.prepare(tiles);
    }

    /// The noise that explains the scatter of a map, rounding included.
    pub(super) fn estimate(&mut self, layer: &Layer, space: Space) -> SensorNoise {
        for row in (0..layer.rows.saturating_sub(TILES - 1)).step_by(TILES) {
            for column in (0..layer.columns.saturating_sub(TILES - 1)).step_by(TILES) {
                let first = &layer.tiles[row * layer.columns + column];
                self.blocks.add(&sums(layer, column, row), first.q, space, 0.0);
            }
        }
        self.blocks.noise(space).0
    }
}

/// The sums of a block of tiles about its first tile's origin.
fn sums(layer: &Layer, column: usize, row: usize) -> Moments {
    let first = &layer.tiles[row * layer.columns + column];
    let mut sums = Moments::default();
    for y in row..row + TILES {
        for tile in &layer.tiles[y * layer.columns + column..][..TILES] {
            sums.merge(&tile.sums.moved([tile.u - first.u, tile.v - first.v, tile.q - first.q]));
        }
    }
    sums
}
