//! Stage "grow": cells that lie on one plane become a region.
//!
//! In: the pyramid of a map. Out: for every tile its region, and every region's sums and plane. Growth goes from the
//! coarsest cells to the finest: large flat cells give regions whose planes are well known before the small cells
//! along the borders are asked. A cell joins a region by its squared residuals about the region's plane, which its
//! sums give without touching a pixel; among cells of one size, those that scatter least are the first seeds. A large
//! map is grown over band by band ([`super::layout`]); regions that a band's edge cuts are merged as any others are
//! (stage "merge").

use super::grid::{Cell, Grid, NONE, Place};
use super::layout::{LANES, LEVELS, SIDE, for_each_band};
use super::pyramid::{Pyramid, propagate_down};
use super::region::Region;
use crate::util::bits::bits;
use crate::util::memory::reserve_to;
use crate::util::simd::vectorised;
use std::array::from_fn;
use std::mem::take;
use std::ops::Range;

/// Fewest pixels of a tile that starts a region, as a share of all.
const OF_TILE: f32 = 0.5;
/// Fewest pixels of a larger cell that starts or joins one: half of a cell may lie in a gap that it would reach over.
const OF_CELL: f32 = 0.75;

/// The regions of a map; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Regions {
    pub(super) all: Vec<Region>,
    /// For each band what grows in it.
    growths: Vec<Growth>,
}

/// The regions of a band.
#[derive(Debug, Default)]
struct Growth {
    all: Vec<Region>,
    work: Work,
}

/// Memory of growth.
#[derive(Debug, Default)]
struct Work {
    /// Cells that may start a region: the bits of their scatter, which is not negative, and behind them the cell.
    seeds: Vec<u64>,
    /// Cells whose neighbours are still to be asked.
    queue: Vec<Place>,
    /// For each cell 1 if it has no region and may join one, else 0.
    open: Vec<u8>,
}

impl Regions {
    /// Grows regions over a pyramid, on as many threads.
    pub(super) fn grow(&mut self, pyramid: &mut Pyramid, inlier_threshold: f64, threads: usize) {
        reserve_to(&mut self.all, pyramid.grids[0].len());
        self.growths.resize_with(pyramid.bands.len(), Growth::default);
        let mut regions = pyramid.grids.each_mut().map(|grid| take(&mut grid.region));
        let mut level = 0;
        let wholes = regions.each_mut().map(|region| {
            level += 1;
            (&mut region[..], pyramid.per_row(level - 1))
        });
        for_each_band(&pyramid.bands, &mut self.growths, wholes, threads, |band, growth, regions| {
            vectorised(
                #[inline(always)]
                || growth.grow(pyramid, band, regions, inlier_threshold),
            );
        });
        pyramid.grids.iter_mut().zip(regions).for_each(|(grid, region)| grid.region = region);
        self.unite(pyramid);
    }

    /// Numbers the regions of all bands.
    fn unite(&mut self, pyramid: &mut Pyramid) {
        let per_row = pyramid.per_row(0);
        let mut left = &mut pyramid.grids[0].region[..];
        for (band, growth) in pyramid.bands.iter().zip(&self.growths) {
            let before = self.all.len() as u32;
            self.all.extend(&growth.all);
            let own = left.split_off_mut(..band.len() * per_row).expect("the band's rows");
            if before > 0 {
                own.iter_mut().for_each(|id| *id += if *id == NONE { 0 } else { before });
            }
        }
    }
}

impl Growth {
    /// Grows the regions of a band; `regions`: for each level and cell of its rows the region.
    #[inline(always)]
    fn grow(
        &mut self,
        pyramid: &Pyramid,
        band: &Range<usize>,
        mut regions: [&mut [u32]; LEVELS],
        inlier_threshold: f64,
    ) {
        let Growth { all, work } = self;
        reserve_to(all, regions[0].len());
        reserve_to(&mut work.seeds, regions[0].len());
        reserve_to(&mut work.queue, regions[0].len());
        reserve_to(&mut work.open, regions[0].len());
        for level in (0..LEVELS).rev() {
            let (grid, rows) = (&pyramid.grids[level], pyramid.rows_of(band, level));
            let (finer, coarser) = regions.split_at_mut(level + 1);
            if let [coarser, ..] = coarser {
                propagate_down(grid, rows.start, coarser, finer[level]);
            }
            let mut area = Area { grid, inlier_threshold, rows, region: &mut *finer[level], all, work };
            area.open();
            area.grow_on();
            area.seed();
        }
        all.iter_mut().for_each(Region::refit);
    }
}

/// Rows of a grid over which regions grow; there is nothing beyond them.
struct Area<'a> {
    grid: &'a Grid,
    inlier_threshold: f64,
    rows: Range<usize>,
    /// For each cell of the rows its region, or [`NONE`].
    region: &'a mut [u32],
    all: &'a mut Vec<Region>,
    work: &'a mut Work,
}

impl Area<'_> {
    /// Finds the cells that may join a region.
    #[inline(always)]
    fn open(&mut self) {
        let Area { grid, region, work: Work { open, .. }, .. } = self;
        let (least, any_may, before) = (fewest_joining(grid), !is_large(grid), self.rows.start * grid.columns);
        open.resize(region.len(), 0);
        let cells = region.iter().zip(&grid.sums.n[before..]).zip(&grid.roughness[before..]);
        for (open, ((&id, &pixels), &roughness)) in open.iter_mut().zip(cells) {
            *open = u8::from((id == NONE) & (pixels >= least) & (any_may | (roughness <= 1.0)));
        }
    }

    /// Lets the regions that came down from coarser cells grow on.
    #[inline(always)]
    fn grow_on(&mut self) {
        self.work.queue.clear();
        if self.all.is_empty() {
            return;
        }
        for row in self.rows.clone() {
            for first in (0..self.grid.columns).step_by(LANES) {
                let open = self.open_from(Place::new(first, row));
                let mut rest = if open == 0 { 0 } else { open & self.find_beside(Place::new(first, row)) };
                while rest != 0 {
                    let bit = rest & rest.wrapping_neg();
                    rest ^= bit;
                    if self.take_beside(Place::new(first + bit.trailing_zeros() as usize / 8, row)) {
                        rest |= open & bit << 8; // the next cell has one beside it now
                    }
                }
            }
        }
        self.spread();
    }

    /// Starts regions from the flat cells that are left, the flattest first.
    #[inline(always)]
    fn seed(&mut self) {
        let grid = self.grid;
        let least = fewest(grid);
        self.work.seeds.clear();
        for row in self.rows.clone() {
            for first in (0..grid.columns).step_by(LANES) {
                for bit in bits(self.open_from(Place::new(first, row))) {
                    let at = row * grid.columns + first + bit / 8;
                    if grid.roughness[at] <= 1.0 && grid.pixels(at) >= least {
                        self.work.seeds.push(u64::from(grid.scatter(at).to_bits()) << 32 | at as u64);
                    }
                }
            }
        }
        self.work.seeds.sort_unstable();
        for i in 0..self.work.seeds.len() {
            let seed = grid.place(self.work.seeds[i] as u32 as usize);
            let at = self.at(seed);
            if self.region[at] == NONE {
                self.all.push(Region::of(&grid.cell(seed)));
                self.work.queue.clear();
                self.give(seed, self.all.len() as u32 - 1);
                self.spread();
            }
        }
    }

    /// Lets regions take in the neighbours of the cells in the queue.
    #[inline(always)]
    fn spread(&mut self) {
        let mut next = 0;
        while let Some(&place) = self.work.queue.get(next) {
            next += 1;
            let id = self.region[self.at(place)];
            let beside = self.neighbours(place);
            for i in 0..4 {
                if self.work.open[self.at(beside[i])] != 0 {
                    self.take(id, beside[i], &self.grid.cell(beside[i]));
                }
            }
        }
    }

    /// Gives a cell to a region and to the queue, if it lies on its plane.
    #[inline(always)]
    fn take(&mut self, id: u32, place: Place, cell: &Cell) -> bool {
        let takes = self.all[id as usize].takes(cell, is_large(self.grid), self.inlier_threshold);
        if takes {
            self.give(place, id);
        }
        takes
    }

    /// Gives a cell to a region and to the queue.
    #[inline(always)]
    fn give(&mut self, place: Place, id: u32) {
        let at = self.at(place);
        self.region[at] = id;
        self.work.open[at] = 0;
        self.work.queue.push(place);
    }

    /// Where a cell's region stands.
    #[inline(always)]
    fn at(&self, place: Place) -> usize {
        self.grid.at(place) - self.rows.start * self.grid.columns
    }

    /// Which of the cells from one on may join a region: a byte of 1 for each.
    #[inline(always)]
    fn open_from(&self, place: Place) -> u64 {
        u64::from_le_bytes(*self.work.open[self.at(place)..].first_chunk().expect("rows of whole parts"))
    }

    /// Which of the cells from one on have a cell with a region beside them; may say so at the ends of a row.
    #[inline(always)]
    fn find_beside(&self, place: Place) -> u64 {
        let (at, columns) = (self.at(place), self.grid.columns);
        let is_taken = |at: usize| u64::from(self.region.get(at).is_some_and(|&id| id != NONE));
        let are_taken = |at: usize| {
            let ids = self.region.get(at..).and_then(|from| from.first_chunk::<LANES>());
            ids.map_or(0, |ids| u64::from_le_bytes(from_fn(|i| u8::from(ids[i] != NONE))))
        };
        let own = are_taken(at);
        let left = own << 8 | is_taken(at.wrapping_sub(1));
        let right = own >> 8 | is_taken(at + LANES) << 56;
        left | right | are_taken(at.wrapping_sub(columns)) | are_taken(at + columns)
    }

    /// Gives a cell to the first region beside it on whose plane it lies.
    #[inline(always)]
    fn take_beside(&mut self, place: Place) -> bool {
        let ids = self.neighbours(place).map(|beside| self.region[self.at(beside)]);
        let cell = self.grid.cell(place);
        (0..4).any(|i| ids[i] != NONE && !ids[..i].contains(&ids[i]) && self.take(ids[i], place, &cell))
    }

    /// The four neighbours of a cell; at the edge itself in place of those that are missing.
    #[inline(always)]
    fn neighbours(&self, place: Place) -> [Place; 4] {
        self.grid.neighbours_within(place, &self.rows)
    }
}

/// Whether cells are larger than tiles: only flat ones join then.
#[inline(always)]
fn is_large(grid: &Grid) -> bool {
    grid.side > SIDE
}

/// Fewest pixels of a cell that joins a region.
#[inline(always)]
fn fewest_joining(grid: &Grid) -> f32 {
    if is_large(grid) { fewest(grid) } else { 3.0 }
}

/// Fewest pixels of a cell that starts a region.
#[inline(always)]
pub(super) fn fewest(grid: &Grid) -> f32 {
    let share = if is_large(grid) { OF_CELL } else { OF_TILE };
    share * (grid.side * grid.side) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::layout::SIDE;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, THRESHOLD, noise};
    use crate::util::random::Random;

    /// The numbers of the regions of the tiles between some columns.
    fn ids_between(stages: &Stages, columns: Range<usize>, rows: usize) -> Vec<u32> {
        let tiles = columns.step_by(SIDE).flat_map(|u| (0..rows).step_by(SIDE).map(move |v| [u, v]));
        let mut ids: Vec<u32> = tiles.map(|at| stages.region_at(at)).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }

    #[test]
    fn regions_of_two_planes_that_meet_at_a_crease_end_at_it_and_have_the_plane_of_their_side() {
        // Both turn by half a pixel's value a column: at right angles, in space.
        for (seed, crease) in [(1, 63.5), (2, 63.5), (3, 62.0), (4, 65.3), (5, 71.5)] {
            let q = |u: f64, v: f64| 40.0 - 0.5 * (u - crease).abs() + 0.02 * v;
            let stages = Stages::grown(&Made::noisy([128, 96], seed, q), noise(0.0));
            let edge = crease as usize / SIDE * SIDE;
            let [left, right] = [0..edge, edge + SIDE..128].map(|columns| ids_between(&stages, columns, 96));
            assert!(left.iter().all(|id| !right.contains(id)), "{left:?} and {right:?} at {crease}");
            assert!(!left.contains(&NONE) && !right.contains(&NONE), "a tile has no region");
            for (ids, places) in [(&left, [[2.0, 2.0], [50.0, 90.0]]), (&right, [[80.0, 2.0], [125.0, 90.0]])] {
                for ([u, v], &id) in places.into_iter().flat_map(|place| ids.iter().map(move |id| (place, id))) {
                    let region = &stages.all()[id as usize];
                    // A small one's plane is known to less, far from it.
                    if region.sums.n > 1000.0 {
                        assert!((region.at(u, v) - q(u, v)).abs() < SIGMA, "region {id} at {u}, {v}");
                    }
                }
            }
            stages.check_sums();
            let merged = Stages::merged(&Made::noisy([128, 96], seed, q), noise(0.0));
            let large = merged.all().iter().filter(|region| region.sums.n > 1000.0).count();
            assert_eq!(large, 2);
        }
    }

    #[test]
    fn every_tile_of_one_plane_with_noise_has_one_of_few_regions_and_these_are_one() {
        for seed in 0..20 {
            let [a, b] = [0.02 * (seed as f64 - 10.0), 0.15 - 0.01 * seed as f64];
            let made = Made::noisy([128, 96], seed, |u, v| 40.0 + a * u + b * v).with_holes(seed, 0.1);
            let stages = Stages::grown(&made, noise(0.0));
            assert!((1..=4).contains(&stages.all().len()), "{} regions, seed {seed}", stages.all().len());
            let pixels: f64 = stages.all().iter().map(|region| region.sums.n).sum();
            assert_eq!(pixels, f64::from(stages.grid().sums.n.iter().sum::<f32>()), "seed {seed}");
            stages.check_sums();
            assert_eq!(Stages::merged(&made, noise(0.0)).all().len(), 1, "seed {seed}");
        }
    }

    #[test]
    fn clutter_is_no_region() {
        let mut random = Random::new(2);
        let made = Made::exact([128, 96], |_, _| random.between(20.0, 60.0));
        let stages = Stages::grown(&made, noise(0.0));
        assert_eq!(stages.all().len(), 0);
        assert!(stages.run.pyramid.grids.iter().all(|grid| grid.region.iter().all(|&id| id == NONE)));
    }

    #[test]
    fn a_flat_patch_amid_clutter_is_a_region_of_its_tiles_alone() {
        let mut random = Random::new(3);
        let made = Made::exact([128, 96], |u, v| {
            let is_flat = (40..72).contains(&u) && (32..56).contains(&v);
            if is_flat { 40.0 + 0.1 * u as f64 + SIGMA * random.gaussian() } else { random.between(20.0, 60.0) }
        });
        let stages = Stages::grown(&made, noise(0.0));
        assert_eq!(stages.all().len(), 1);
        for (row, column) in (0..24).flat_map(|row| (0..32).map(move |column| (row, column))) {
            let is_flat = (10..18).contains(&column) && (8..14).contains(&row);
            assert_eq!(stages.region_at([4 * column, 4 * row]) != NONE, is_flat, "tile {column}, {row}");
        }
    }

    #[test]
    fn tiles_with_few_pixels_start_no_region_but_join_one() {
        // The lower half has 6 pixels a tile, the upper one all of them; a gap parts them, or not.
        for (gap, expected) in [(0, true), (8, false)] {
            let made = Made::exact([128, 64], |u, v| {
                let is_there = v < 32 || (v >= 32 + gap && (u + 2 * v) % 4 < 2 && (u + v) % 4 != 1);
                if is_there { 40.0 + 0.1 * u as f64 + 0.05 * v as f64 } else { f64::NAN }
            });
            let stages = Stages::grown(&made, noise(0.0));
            assert!((3.0..8.0).contains(&stages.grid().pixels(12 * 32 + 3)), "{}", stages.grid().pixels(12 * 32 + 3));
            let below = ids_between(&stages, 0..128, 64).contains(&NONE);
            assert_eq!((stages.all().len(), !below), (1, expected));
            assert_eq!(stages.region_at([60, 60]) == 0, expected);
        }
    }

    #[test]
    fn regions_of_a_map_in_bands_end_at_the_bands_and_are_numbered_one_after_the_other() {
        // A tile in nine has no pixel, others in each band.
        let is_hole = |u: usize, v: usize| (u / 4 + v / 4 * 5 + v / 16).is_multiple_of(9);
        let made = Made::exact([128, 96], |u, v| {
            if is_hole(u, v) { f64::NAN } else { 40.0 - 0.5 * (u as f64 - 63.5).abs() + 0.02 * v as f64 }
        });
        let mut stages = Stages::tiles(&made, noise(0.0));
        stages.run.pyramid.bands = vec![0..2, 2..5, 5..6];
        stages.run.regions.grow(&mut stages.run.pyramid, THRESHOLD, 2);
        assert_eq!(stages.all().len(), 6);
        for (band, rows) in [(0, 0..32), (1, 32..80), (2, 80..96)] {
            let mut ids: Vec<u32> = rows
                .step_by(SIDE)
                .flat_map(|v| (0..128).step_by(SIDE).map(move |u| [u, v]))
                .filter(|&[u, v]| {
                    let has_none = stages.region_at([u, v]) == NONE;
                    assert_eq!(has_none, is_hole(u, v), "at {u}, {v}");
                    !has_none
                })
                .map(|at| stages.region_at(at))
                .collect();
            ids.sort_unstable();
            ids.dedup();
            assert_eq!(ids, [2 * band, 2 * band + 1]);
        }
        stages.check_sums();
    }

    #[test]
    fn regions_of_slanted_patches_are_connected_and_have_the_sums_of_their_tiles() {
        let mut random = Random::new(7);
        let slopes: Vec<[f64; 3]> = (0..12)
            .map(|_| [random.between(20.0, 60.0), random.between(-0.3, 0.3), random.between(-0.3, 0.3)])
            .collect();
        let made = Made::noisy([160, 96], 7, |u, v| {
            let [q, a, b] = slopes[((u as usize + v as usize / 3) / 40 + v as usize / 40 * 4) % 12];
            q + a * (u - 80.0) + b * (v - 48.0)
        });
        let stages = Stages::grown(&made, noise(0.005));
        assert!(stages.all().len() >= 10, "{}", stages.all().len());
        stages.check_sums();
        let grid = stages.grid();
        // Flood each region from its first tile.
        for id in 0..stages.all().len() as u32 {
            let own: Vec<usize> = (0..grid.len()).filter(|&at| grid.region[at] == id).collect();
            let mut seen = vec![own[0]];
            let mut next = 0;
            while next < seen.len() {
                for beside in grid.neighbours(grid.place(seen[next])).map(|place| grid.at(place)) {
                    if grid.region[beside] == id && !seen.contains(&beside) {
                        seen.push(beside);
                    }
                }
                next += 1;
            }
            assert_eq!(seen.len(), own.len(), "region {id} is in pieces");
        }
    }
}
