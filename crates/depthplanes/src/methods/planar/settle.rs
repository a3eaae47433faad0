//! Stage "grow", last part: tiles on borders go over to the region beside them whose plane they suit better.
//!
//! In: regions as they grew, and the tiles' region numbers. Out: the same regions with other borders. Growth goes on over a
//! shallow crease for as long as noise hides that the surface has turned off, and what began later beyond the crease is
//! left with less than its own, or with tiles of both planes, which bow. Once both planes are known they tell whose
//! a tile is.

use super::grid::{Grid, NONE, Place};
use super::grow::Regions;
use crate::group::reserve_to;

/// Variances by which the other plane has to explain a tile better, so that two pieces of one plane do not trade tiles
/// for nothing: three deviations.
const BETTER: f64 = 9.0;
/// Standard deviations of a pixel between a plane and the middle of a tile, from which on it is not asked.
const FAR: f64 = 3.0;
/// Tiles of a row that are looked at together; a row has a multiple of them.
const ABREAST: usize = 8;

impl Regions {
    /// Lets the tiles beside other regions go over.
    pub(super) fn settle(&mut self, grid: &mut Grid) {
        reserve_to(&mut self.has_changed, grid.len());
        self.has_changed.resize(self.all.len(), false);
        for row in 0..grid.rows {
            for first in (0..grid.columns).step_by(ABREAST) {
                let mut rest = u64::from_le_bytes(find_beside(grid, row * grid.columns + first));
                while rest != 0 {
                    let column = first + rest.trailing_zeros() as usize / 8;
                    rest &= rest - 1;
                    self.settle_tile(grid, Place::new(column, row));
                }
            }
        }
        let changed = self.all.iter_mut().zip(&self.has_changed).filter(|(_, has_changed)| **has_changed);
        changed.for_each(|(region, _)| region.refit());
    }

    fn settle_tile(&mut self, grid: &mut Grid, place: Place) {
        let at = grid.at(place);
        let own = grid.region[at];
        let [u, v] = grid.middle(place);
        let far = FAR * FAR * f64::from(grid.variance[at]);
        let q = grid.q(at);
        let is_near = |id: u32| id != NONE && id != own && (self.all[id as usize].at(u, v) - q).powi(2) <= far;
        let beside = grid.neighbours(place).map(|beside| grid.region[grid.at(beside)]);
        let mut others = beside.map(|id| if is_near(id) { id } else { NONE });
        (1..4).for_each(|i| others[i] = if others[..i].contains(&others[i]) { NONE } else { others[i] });
        if others == [NONE; 4] {
            return;
        }
        let cell = grid.cell(place);
        let about = |id: u32| cell.squares_about(self.all[id as usize].abc, self.all[id as usize].origin);
        let (mut best, mut least) = (own, about(own) - BETTER * cell.variance);
        for id in others.into_iter().filter(|&id| id != NONE) {
            let squares = about(id);
            (best, least) = if squares < least { (id, squares) } else { (best, least) };
        }
        if best != own {
            grid.region[at] = best;
            self.all[own as usize].give(&cell);
            self.all[best as usize].take(&cell);
            [own, best].iter().for_each(|&id| self.has_changed[id as usize] = true);
        }
    }
}

/// For each tile from `at` on 1 if it has a region and one beside it another, else 0; may say so at the ends of a row.
#[inline(always)]
fn find_beside(grid: &Grid, at: usize) -> [u8; ABREAST] {
    let part = |at: usize| grid.region.get(at..).and_then(|from| from.first_chunk::<ABREAST>());
    let own = part(at).expect("rows of whole parts");
    let (above, below) = (part(at.wrapping_sub(grid.columns)).unwrap_or(own), part(at + grid.columns).unwrap_or(own));
    let (left, right) = (part(at.wrapping_sub(1)).unwrap_or(own), part(at + 1).unwrap_or(own));
    let mut beside = [0; ABREAST];
    for i in 0..ABREAST {
        let is_other = |id: u32| (id != own[i]) & (id != NONE);
        let any = is_other(above[i]) | is_other(below[i]) | is_other(left[i]) | is_other(right[i]);
        beside[i] = u8::from((own[i] != NONE) & any);
    }
    beside
}
