//! How far off a map's pixels are, from the map itself.
//!
//! In: the cells of a map. Out: its errors at several scales ([`Scales`]): second differences of neighbouring cells'
//! means, and tiles' residuals about their own planes.

use super::pyramid::Pyramid;
use crate::group::vectorised;
use crate::noise::scales::{Cell, Cells, Scales};

impl Scales {
    /// Looks at the cells of a map.
    pub(super) fn look(&mut self, pyramid: &Pyramid) {
        self.prepare();
        let tiles = &pyramid.grids[0];
        let of_tile = |(filled, pixels), &n: &f32| (filled + u32::from(n > 0.0), pixels + n as u32);
        let (filled, pixels) = vectorised(
            #[inline(always)]
            || tiles.sums.n.iter().fold((0, 0), of_tile),
        );
        let usual = (f64::from(pixels) / f64::from(filled.max(1))) as f32;
        for (level, grid) in pyramid.grids.iter().enumerate() {
            let sums = &grid.sums;
            self.look_at(
                Cells { level, columns: grid.columns, rows: grid.rows, usual },
                #[inline(always)]
                |at: usize| Cell {
                    n: sums.n[at],
                    abc: [sums.a[at], sums.b[at], sums.c[at]],
                    squares: sums.squares[at],
                },
            );
        }
    }
}
