//! Stage "grow", last part: tiles on borders go over to the region beside them whose plane they suit better.
//!
//! In: regions as they grew, and the tiles' region numbers. Out: the same regions with other borders. Growth goes on
//! across a shallow crease for as long as noise hides that the surface has changed direction. The region that began
//! later beyond the crease is then left with less than its own, or with tiles of both planes, which bow. Once both
//! planes are known, they tell which of them a tile lies on.

use super::grid::{Cell, Grid, NONE, Place};
use super::layout::for_each_band;
use super::pyramid::Pyramid;
use super::region::Region;
use crate::util::memory::reserve_to;
use crate::util::simd::vectorised;
use std::mem::take;
use std::ops::Range;

/// Variances by which the other plane has to explain a tile better, so that two pieces of one plane do not trade tiles
/// for nothing: three deviations.
const BETTER_VARIANCES: f64 = 9.0;
/// Standard deviations of a pixel between a plane and the middle of a tile, from which on it is not asked.
const FAR_DEVIATIONS: f64 = 3.0;
/// Tiles of a row that are looked at together; a row has a multiple of them.
const LANES: usize = 16;

/// A tile that goes from one region to another.
#[derive(Clone, Copy, Debug)]
struct Move {
    place: Place,
    from: u32,
    to: u32,
}

/// Refines borders; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Refiner {
    /// For each band the tiles that go over.
    moves: Vec<Vec<Move>>,
    /// For each region whether a tile went over to it or from it.
    has_changed: Vec<bool>,
}

impl Refiner {
    /// Lets the tiles beside other regions go over, on as many threads: band by band, and then along their edges.
    pub(super) fn refine(&mut self, pyramid: &mut Pyramid, all: &mut [Region], threads: usize) {
        let Refiner { moves, has_changed } = self;
        let mut region = take(&mut pyramid.grids[0].region);
        let (grid, bands) = (&pyramid.grids[0], &pyramid.bands);
        moves.resize_with(bands.len(), Vec::new);
        for_each_band(bands, moves, [(&mut region, pyramid.per_row(0))], threads, |band, moves, [region]| {
            let rows = pyramid.rows_of(band, 0);
            // Beside its own those of an edge.
            reserve_to(moves, region.len() + 2 * grid.columns);
            let inner = rows.start + usize::from(rows.start > 0)..rows.end - usize::from(rows.end < grid.rows);
            let mut part = TileRows { grid, first: rows.start, region, all };
            vectorised(
                #[inline(always)]
                || part.settle(inner, moves),
            );
        });
        let mut whole = TileRows { grid, first: 0, region: &mut region, all };
        for (band, moves) in bands.iter().zip(&mut *moves).skip(1) {
            let edge = pyramid.rows_of(band, 0).start;
            whole.settle(edge - 1..edge + 1, moves);
        }
        reserve_to(has_changed, grid.len());
        has_changed.resize(all.len(), false);
        for &Move { place, from, to } in moves.iter().flatten() {
            let cell = grid.cell(place);
            all[from as usize].give(&cell);
            all[to as usize].take(&cell);
            [from, to].iter().for_each(|&id| has_changed[id as usize] = true);
        }
        let changed = all.iter_mut().zip(has_changed).filter(|(_, has_changed)| **has_changed);
        changed.for_each(|(region, _)| region.refit());
        pyramid.grids[0].region = region;
    }
}

/// Some rows of tiles, of which those within may go over.
struct TileRows<'a> {
    grid: &'a Grid,
    /// The first of the rows.
    first: usize,
    region: &'a mut [u32],
    all: &'a [Region],
}

impl TileRows<'_> {
    /// Lets the tiles of some rows go over; those of the rows beside them are known.
    #[inline(always)]
    fn settle(&mut self, rows: Range<usize>, moves: &mut Vec<Move>) {
        let columns = self.grid.columns;
        for row in rows {
            for first in (0..columns).step_by(LANES) {
                let beside = find_beside(self.region, columns, (row - self.first) * columns + first);
                let mut rest = u128::from_le_bytes(beside);
                while rest != 0 {
                    let column = first + rest.trailing_zeros() as usize / 8;
                    rest &= rest - 1;
                    if let Some(step) = self.settle_tile(Place::new(column, row)) {
                        moves.push(step);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn settle_tile(&mut self, place: Place) -> Option<Move> {
        let (grid, all, region) = (self.grid, self.all, &mut *self.region);
        let before = self.first * grid.columns;
        let at = grid.at(place);
        let own = region[at - before];
        let beside = grid.neighbours(place).map(|beside| region[grid.at(beside) - before]);
        let is_other = |id: u32| (id != own) & (id != NONE);
        // Most tiles have one other region beside them: it is found and asked without branches that go either way.
        let other = beside.iter().rfold(NONE, |found, &id| if is_other(id) { id } else { found });
        if other == NONE {
            return None;
        }
        let cell = grid.cell(place);
        let mut best = (own, all[own as usize].squares_of(&cell) - BETTER_VARIANCES * cell.variance);
        best = better(best, &cell, other, all);
        let is_another = |id: u32| is_other(id) & (id != other);
        if beside.iter().fold(false, |any, &id| any | is_another(id)) {
            best = beside.into_iter().filter(|&id| is_another(id)).fold(best, |best, id| better(best, &cell, id, all));
        }
        let to = best.0;
        if to == own {
            return None;
        }
        region[at - before] = to;
        Some(Move { place, from: own, to })
    }
}

/// The region that leaves less of a cell's squares, and how much: the best so far, or one whose plane is near.
#[inline(always)]
fn better(best: (u32, f64), cell: &Cell, id: u32, all: &[Region]) -> (u32, f64) {
    let region = &all[id as usize];
    let ([u, v], squares) = (cell.middle, region.squares_of(cell));
    let is_near = (region.at(u, v) - cell.origin()[2]).powi(2) <= FAR_DEVIATIONS * FAR_DEVIATIONS * cell.variance;
    if is_near & (squares < best.1) { (id, squares) } else { best }
}

/// For each tile from `at` on 1 if it has a region and one beside it another, else 0; may say so at the ends of a row.
#[inline(always)]
fn find_beside(region: &[u32], columns: usize, at: usize) -> [u8; LANES] {
    let part = |at: usize| region.get(at..).and_then(|from| from.first_chunk::<LANES>());
    let own = part(at).expect("rows of whole parts");
    let (above, below) = (part(at.wrapping_sub(columns)).unwrap_or(own), part(at + columns).unwrap_or(own));
    let (left, right) = (part(at.wrapping_sub(1)).unwrap_or(own), part(at + 1).unwrap_or(own));
    let mut beside = [0; LANES];
    for i in 0..LANES {
        let is_other = |id: u32| (id != own[i]) & (id != NONE);
        let any = is_other(above[i]) | is_other(below[i]) | is_other(left[i]) | is_other(right[i]);
        beside[i] = u8::from((own[i] != NONE) & any);
    }
    beside
}
