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
use crate::util::bits::each_one;
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
                || part.refine(inner, moves),
            );
        });
        let mut whole = TileRows { grid, first: 0, region: &mut region, all };
        for (band, moves) in bands.iter().zip(&mut *moves).skip(1) {
            let edge = pyramid.rows_of(band, 0).start;
            whole.refine(edge - 1..edge + 1, moves);
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
    fn refine(&mut self, rows: Range<usize>, moves: &mut Vec<Move>) {
        let columns = self.grid.columns;
        for row in rows {
            for first in (0..columns).step_by(LANES) {
                let beside = find_beside(self.region, columns, (row - self.first) * columns + first);
                each_one(beside, |at| moves.extend(self.refine_tile(Place::new(first + at, row))));
            }
        }
    }

    #[inline(always)]
    fn refine_tile(&mut self, place: Place) -> Option<Move> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::layout::SIDE;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, bands, noise};

    fn refine(stages: &mut Stages, threads: usize) {
        let Stages { run, .. } = stages;
        run.refiner.refine(&mut run.pyramid, &mut run.regions.all, threads);
    }

    /// A shallow crease down the middle: beyond it the planes part by a deviation for each two pixels.
    fn crease() -> Made {
        Made::noisy([128, 96], 3, |u, v| 40.0 + 0.02 * v - 0.5 * SIGMA * (u - 63.5).abs())
    }

    #[test]
    fn tiles_that_were_given_to_the_wrong_side_of_a_crease_go_back() {
        for (bands, threads) in [(bands(&[0, 6]), 1), (bands(&[0, 2, 3, 6]), 2)] {
            let mut stages = Stages::tiles(&crease(), noise(0.0));
            // Growth ran on over the crease here and there, on each side, and on a band's last row and first.
            let is_off = |column: usize, row: usize| match row {
                2 | 3 | 7 | 8 => column == 17,
                11 | 12 | 20 => column == 14,
                _ => false,
            };
            stages.divide(|column, row| u32::from((column >= 16) != is_off(column, row)));
            stages.run.pyramid.bands = bands;
            refine(&mut stages, threads);
            for (row, column) in (0..24).flat_map(|row| (0..32).map(move |column| (row, column))) {
                let id = stages.region_at([SIDE * column, SIDE * row]);
                assert_eq!(id, u32::from(column >= 16), "tile {column}, {row}");
            }
            stages.check_sums();
            // And the planes are those of the sides.
            let mut right = Stages::tiles(&crease(), noise(0.0));
            right.divide(|column, _| u32::from(column >= 16));
            for (found, expected) in stages.all().iter().zip(right.all()) {
                let [u, v] = expected.middle;
                assert!(
                    (found.at(u, v) - expected.at(u, v)).abs() < 1e-6 && (found.abc[0] - expected.abc[0]).abs() < 1e-6
                );
            }
        }
    }

    #[test]
    fn nothing_moves_between_two_pieces_of_one_plane() {
        for seed in 0..20 {
            let made = Made::noisy([128, 96], seed, |u, v| 40.0 + 0.1 * u - 0.02 * v);
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, row| u32::from(column + row % 5 > 17));
            let before = stages.grid().region.clone();
            let sums = stages.all().iter().map(|region| region.sums).collect::<Vec<_>>();
            refine(&mut stages, 1);
            assert_eq!(stages.grid().region, before, "seed {seed}");
            assert_eq!(stages.all().iter().map(|region| region.sums).collect::<Vec<_>>(), sums);
        }
    }

    #[test]
    fn a_tile_goes_to_no_plane_that_is_far_from_its_middle_and_to_none_that_is_not_beside_it() {
        // Two steps of ten deviations: the tiles of the middle stay with the left, which explains them as badly as the
        // right does, and those of the right, given to the left, have the right beside them in the last column alone.
        let step = |u: f64| 10.0 * SIGMA * (f64::from(u >= 32.0) + f64::from(u >= 96.0));
        let made = Made::noisy([128, 64], 4, |u, v| 40.0 + 0.02 * v + step(u));
        let mut stages = Stages::tiles(&made, noise(0.0));
        stages.divide(|column, _| u32::from(column >= 24));
        let before = stages.grid().region.clone();
        refine(&mut stages, 1);
        assert_eq!(stages.grid().region, before);
        // The same tiles of the third, one column given away: it is beside the third and goes back, no further one does.
        stages.divide(|column, row| u32::from(column >= 24 + usize::from(row < 8)));
        refine(&mut stages, 1);
        assert_eq!(stages.grid().region, before);
        stages.check_sums();
    }

    #[test]
    fn a_tile_far_from_both_planes_stays_and_one_near_the_other_goes() {
        for (level, expected) in [(9.0, 0), (13.0, 1)] {
            // Two tiles of the left lie between the planes, nearer to the right's, which is 15 deviations higher.
            let is_between = |u: f64, v: f64| (60.0..64.0).contains(&u) && (28.0..36.0).contains(&v);
            let made = Made::noisy([128, 64], 4, |u, v| {
                40.0 + SIGMA * if is_between(u, v) { level } else { 15.0 * f64::from(u >= 64.0) }
            });
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, _| u32::from(column >= 16));
            refine(&mut stages, 1);
            assert_eq!([28, 32].map(|v| stages.region_at([60, v])), [expected; 2], "{level} deviations");
            assert_eq!([24, 36].map(|v| stages.region_at([60, v])), [0; 2]);
        }
    }

    #[test]
    fn tiles_of_no_region_stay_without_one() {
        let mut stages = Stages::tiles(&crease(), noise(0.0));
        stages.divide(|column, row| if (6..9).contains(&row) && column > 13 { NONE } else { u32::from(column >= 16) });
        let before = stages.grid().region.clone();
        refine(&mut stages, 1);
        assert_eq!(stages.grid().region, before);
    }
}
