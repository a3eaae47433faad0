//! Stage "grow": cells that lie on one plane become a region.
//!
//! In: the pyramid of a map. Out: for every tile its region, and every region's sums and plane. Growth
//! goes from the coarsest cells to the finest: large flat cells give regions whose planes are
//! well known before the small cells along the borders are asked. A cell joins by its squared residuals
//! about the region's plane, which its sums give without touching a pixel; among cells of one size, seeds are
//! taken in order of their own scatter.

use super::grid::{Cell, Grid, NONE, Place};
use super::tiles::{LEVELS, Pyramid, SIDE};
use crate::fit::Moments;
use crate::group::reserve_to;

/// Below so many pixels a region's plane is too uncertain to be held against a neighbour: the cell is
/// tested against the plane of both.
const SMALL: f64 = 144.0;
/// A plane is fitted anew when its region has grown by this factor.
const REFIT: f64 = 1.125;
/// Fewest pixels of a tile that starts a region, as a share of all.
const OF_TILE: f32 = 0.5;
/// Fewest pixels of a larger cell that starts or joins one: half of a cell may lie in a gap that it would reach over.
const OF_CELL: f32 = 0.75;

/// Cells on one plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Sums about `origin`.
    pub(super) sums: Moments,
    /// (u, v, q) that sums and plane stand about.
    pub(super) origin: [f64; 3],
    /// The least-squares plane about `origin`.
    pub(super) abc: [f64; 3],
    /// Mean (u, v) of its pixels.
    pub(super) middle: [f64; 2],
    /// Squared residuals about it.
    pub(super) squares: f64,
    /// Sum of the pixels' variances.
    pub(super) variance: f64,
    /// Whether it is a facet of a curved surface.
    pub(super) is_curved: bool,
    /// Pixels at which its plane was fitted.
    fitted_at: f64,
}

impl Region {
    pub(super) fn of(cell: &Cell) -> Self {
        let mut region = Region {
            sums: cell.moments(cell.origin()),
            origin: cell.origin(),
            abc: [0.0; 3],
            middle: [0.0; 2],
            squares: 0.0,
            variance: cell.variance * cell.n,
            is_curved: false,
            fitted_at: 0.0,
        };
        region.refit();
        region
    }

    /// The plane's q at a pixel.
    #[inline(always)]
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let [u0, v0, q0] = self.origin;
        self.abc[0] * (u - u0) + self.abc[1] * (v - v0) + self.abc[2] + q0
    }

    /// Fits its plane to its sums.
    pub(super) fn refit(&mut self) {
        if let Some(fit) = self.sums.fit() {
            self.abc = fit.abc;
            self.squares = fit.rms * fit.rms * fit.n;
        }
        let [u, v, _] = self.origin;
        self.middle = [u + self.sums.u / self.sums.n, v + self.sums.v / self.sums.n];
        self.fitted_at = self.sums.n;
    }

    /// Takes a cell's pixels in; the plane stays as it is.
    pub(super) fn take(&mut self, cell: &Cell) {
        self.sums.merge(&cell.moments(self.origin));
        self.variance += cell.variance * cell.n;
    }

    /// Gives a cell's pixels away; the plane stays as it is.
    pub(super) fn give(&mut self, cell: &Cell) {
        self.sums.remove(&cell.moments(self.origin));
        self.variance -= cell.variance * cell.n;
    }

    /// Takes a cell in if its pixels lie on the plane.
    #[inline(always)]
    fn takes(&mut self, cell: &Cell, only_flat: bool, confidence: f64) -> bool {
        let most = if only_flat { cell.most_drifted() } else { cell.most_squares(confidence) };
        let is_small = self.sums.n < SMALL;
        if !is_small && cell.squares_about(self.abc, self.origin) > most {
            return false;
        }
        let mut both = self.sums;
        both.merge(&cell.moments(self.origin));
        if is_small && both.fit().is_none_or(|fit| cell.squares_about(fit.abc, self.origin) > most) {
            return false;
        }
        self.sums = both;
        self.variance += cell.variance * cell.n;
        if is_small || self.sums.n >= REFIT * self.fitted_at {
            self.refit();
        }
        true
    }
}

/// The regions of a map; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Regions {
    pub(super) all: Vec<Region>,
    /// Cells that may start a region: the bits of their scatter, which is not negative, and behind them the cell.
    seeds: Vec<u64>,
    /// Cells whose neighbours are still to be asked.
    queue: Vec<Place>,
    /// For each region whether a tile went over to it or from it.
    pub(super) has_changed: Vec<bool>,
}

impl Regions {
    /// Grows regions over a pyramid.
    pub(super) fn grow(&mut self, pyramid: &mut Pyramid, confidence: f64) {
        let cells = pyramid.grids[0].len();
        reserve_to(&mut self.all, cells);
        reserve_to(&mut self.seeds, cells);
        reserve_to(&mut self.queue, cells);
        for level in (0..LEVELS).rev() {
            let grid = &mut pyramid.grids[level];
            self.grow_on(grid, level > 0, confidence);
            self.seed(grid, level > 0, confidence);
            if level > 0 {
                pyramid.hand_down(level);
            }
        }
        self.all.iter_mut().for_each(Region::refit);
    }

    /// Lets the regions that came down from coarser cells grow on.
    fn grow_on(&mut self, grid: &mut Grid, only_flat: bool, confidence: f64) {
        self.queue.clear();
        if self.all.is_empty() {
            return;
        }
        for row in 0..grid.rows {
            let mut next = 0;
            while let Some(column) = grid.next_free(row, next) {
                next = column + 1;
                let place = Place { row: row as u32, column: column as u32 };
                if may_join(grid, grid.at(place), only_flat) {
                    for beside in grid.neighbours(place) {
                        let id = grid.region[grid.at(beside)];
                        if id != NONE && self.take(grid, id, place, only_flat, confidence) {
                            break;
                        }
                    }
                }
            }
        }
        self.spread(grid, only_flat, confidence);
    }

    /// Starts regions from the flat cells that are left, the flattest first.
    fn seed(&mut self, grid: &mut Grid, only_flat: bool, confidence: f64) {
        let least = fewest(grid);
        self.seeds.clear();
        for row in 0..grid.rows {
            let mut next = 0;
            while let Some(column) = grid.next_free(row, next) {
                next = column + 1;
                let at = row * grid.columns + column;
                if grid.roughness[at] <= 1.0 && grid.pixels(at) >= least {
                    self.seeds.push(u64::from(grid.scatter(at).to_bits()) << 32 | at as u64);
                }
            }
        }
        self.seeds.sort_unstable();
        for i in 0..self.seeds.len() {
            let at = self.seeds[i] as u32 as usize;
            if grid.region[at] == NONE {
                let seed = grid.place(at);
                grid.region[at] = self.all.len() as u32;
                self.all.push(Region::of(&grid.cell(seed)));
                self.queue.clear();
                self.queue.push(seed);
                self.spread(grid, only_flat, confidence);
            }
        }
    }

    /// Lets regions take in the neighbours of the cells in the queue.
    fn spread(&mut self, grid: &mut Grid, only_flat: bool, confidence: f64) {
        let mut next = 0;
        while let Some(&place) = self.queue.get(next) {
            next += 1;
            let id = grid.region[grid.at(place)];
            for beside in grid.neighbours(place) {
                let at = grid.at(beside);
                if grid.region[at] == NONE && may_join(grid, at, only_flat) {
                    self.take(grid, id, beside, only_flat, confidence);
                }
            }
        }
    }

    /// Gives a cell to a region and to the queue, if it lies on its plane.
    #[inline(always)]
    fn take(&mut self, grid: &mut Grid, id: u32, place: Place, only_flat: bool, confidence: f64) -> bool {
        let takes = self.all[id as usize].takes(&grid.cell(place), only_flat, confidence);
        if takes {
            let at = grid.at(place);
            grid.region[at] = id;
            self.queue.push(place);
        }
        takes
    }
}

/// Whether a cell has what it takes to join a region.
#[inline(always)]
fn may_join(grid: &Grid, at: usize, only_flat: bool) -> bool {
    if only_flat { grid.pixels(at) >= fewest(grid) && grid.roughness[at] <= 1.0 } else { grid.pixels(at) >= 3.0 }
}

/// Fewest pixels of a cell that starts a region.
#[inline(always)]
pub(super) fn fewest(grid: &Grid) -> f32 {
    let share = if grid.side > SIDE { OF_CELL } else { OF_TILE };
    share * (grid.side * grid.side) as f32
}
