//! How far off a map's pixels are, from the map itself.
//!
//! In: the cells of a map. Out: its errors at several scales ([`Scales`]): second differences of neighbouring cells'
//! means, and tiles' residuals about their own planes.

use super::pyramid::Pyramid;
use crate::noise::scales::{Cell, Cells, Scales};

impl Scales {
    /// Looks at the cells of a map.
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
            let sums = &grid.sums;
            let cell = |at: usize| Cell {
                n: sums.n[at],
                abc: [sums.a[at], sums.b[at], sums.c[at]],
                squares: sums.squares[at],
            };
            self.look_at(Cells { level, columns: grid.columns, rows: grid.rows, usual }, cell);
        }
    }
}
