//! How far off a map's pixels are, from the map itself.
//!
//! In: the cells of a map. Out: its errors at several scales ([`Scales`]): second differences of neighbouring cells'
//! means, and tiles' residuals about their own planes.

use super::grid::Grid;
use super::pyramid::Pyramid;
use crate::noise::scales::{Bend, SAMPLE, Scales, Scatter};

/// Share of its usual pixels that a cell has to have.
const WHOLE: f32 = 0.75;

impl Scales {
    /// Looks at the cells of a map; how many pixels a tile usually has.
    pub(super) fn look(&mut self, pyramid: &Pyramid) {
        self.prepare();
        let tiles = &pyramid.grids[0];
        let (filled, pixels) = tiles
            .sums
            .n
            .iter()
            .fold((0u32, 0.0), |(filled, pixels), &n| (filled + u32::from(n > 0.0), pixels + f64::from(n)));
        let usual = (pixels / f64::from(filled.max(1))) as f32;
        for (level, grid) in pyramid.grids.iter().enumerate() {
            let least = WHOLE * usual * (1 << (2 * level)) as f32;
            self.look_at(grid, level, least);
        }
    }

    fn look_at(&mut self, grid: &Grid, level: usize, least: f32) {
        let Grid { columns, rows, sums, .. } = grid;
        let stride = grid.len().div_ceil(SAMPLE).max(1);
        // Rows in turn begin at other columns, so that no column is left out.
        for row in 1..rows.saturating_sub(1) {
            for column in (1 + row * 7 % stride..columns.saturating_sub(1)).step_by(stride) {
                let at = row * columns + column;
                if sums.n[at] < least {
                    continue;
                }
                let (q, slope) = (sums.c[at], sums.a[at] * sums.a[at] + sums.b[at] * sums.b[at]);
                if level == 0 {
                    self.tiles.push(Scatter { q, slope, square: sums.squares[at] / (sums.n[at] - 3.0).max(1.0) });
                }
                for step in [1, *columns] {
                    let [before, behind] = [at - step, at + step];
                    if sums.n[before].min(sums.n[behind]) >= least {
                        let off = sums.c[before] - 2.0 * q + sums.c[behind];
                        self.bends[level].push(Bend { q, slope, square: off * off * (1.0 / 6.0) });
                    }
                }
            }
        }
    }
}
