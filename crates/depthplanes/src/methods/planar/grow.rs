//! Stages "grow" and "merge": tiles that lie on one plane become a region.
//!
//! In: tiles with their sums and the variance expected. Out: for every tile its region, and every
//! region's sums and plane. A tile joins by its mean squared residual about the region's plane, which
//! its sums give without touching a pixel; seeds are taken in order of their own scatter.

use super::tiles::{Layer, NONE, Tile};
use crate::error::{Error, Result};
use crate::fit::Moments;
use crate::group::reserve_to;
use crate::select::MAX_PLANES;
use std::collections::VecDeque;

/// Below so many tiles a region's plane is too uncertain to be held against a neighbour: the tile is
/// tested against the plane of both.
const SMALL: usize = 9;

/// Tiles on one plane.
#[derive(Clone, Debug)]
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
    /// Its tiles.
    pub(super) tiles: usize,
    /// Whether it is a facet of a curved surface.
    pub(super) is_curved: bool,
    /// Whether it has not changed in this pass of merging.
    is_fresh: bool,
}

impl Region {
    /// The plane's q at a pixel.
    #[inline(always)]
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let [u0, v0, q0] = self.origin;
        self.abc[0] * (u - u0) + self.abc[1] * (v - v0) + self.abc[2] + q0
    }

    fn refit(&mut self) {
        if let Some(fit) = self.sums.fit() {
            self.abc = fit.abc;
            self.squares = fit.rms * fit.rms * fit.n;
        }
        let [u, v, _] = self.origin;
        self.middle = [u + self.sums.u / self.sums.n, v + self.sums.v / self.sums.n];
    }

    fn absorb(&mut self, other: &Region) {
        self.sums.merge(&self.sums_of(other));
        self.variance += other.variance;
        self.tiles += other.tiles;
        self.is_fresh = false;
        self.refit();
    }

    /// Sums of another region about this one's origin.
    fn sums_of(&self, other: &Region) -> Moments {
        let [u, v, q] = self.origin;
        other.sums.moved([other.origin[0] - u, other.origin[1] - v, other.origin[2] - q])
    }
}

/// The regions of a map; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Regions {
    pub(super) all: Vec<Region>,
    /// Regions with tiles side by side, smaller number first.
    pub(super) pairs: Vec<(u32, u32)>,
    /// Tiles that may start a region, the flattest first.
    seeds: Vec<u32>,
    queue: VecDeque<u32>,
    /// Pairs that may be merged, and what that costs.
    costs: Vec<(f64, u32, u32)>,
    /// For each region the one that it becomes.
    into: Vec<u32>,
}

impl Regions {
    /// Forgets the last map, and makes room for the worst of one with so many tiles.
    pub(super) fn prepare(&mut self, tiles: usize) {
        reserve_to(&mut self.all, 2 * tiles);
        reserve_to(&mut self.pairs, 16 * tiles);
        reserve_to(&mut self.seeds, tiles);
        reserve_to(&mut self.costs, 16 * tiles);
        reserve_to(&mut self.into, 2 * tiles);
        self.queue.clear();
        self.queue.reserve(tiles);
    }

    /// Grows regions from the tiles that are planar themselves and have at least so many pixels.
    pub(super) fn grow(&mut self, layer: &mut Layer, least: f64, confidence: f64) {
        let tiles = &layer.tiles;
        self.seeds.clear();
        self.seeds.extend((0..tiles.len() as u32).filter(|&at| {
            let tile = &tiles[at as usize];
            tile.sums.n >= least && tile.scatter() <= limit(tile.sums.n, confidence)
        }));
        let scatter = |at: u32| tiles[at as usize].scatter();
        self.seeds.sort_unstable_by(|&a, &b| scatter(a).total_cmp(&scatter(b)).then(a.cmp(&b)));
        for i in 0..self.seeds.len() {
            let seed = self.seeds[i] as usize;
            if layer.region[seed] == NONE {
                let region = self.grow_from(layer, seed, confidence);
                self.all.push(region);
            }
        }
    }

    fn grow_from(&mut self, layer: &mut Layer, seed: usize, confidence: f64) -> Region {
        let id = self.all.len() as u32;
        let tile = &layer.tiles[seed];
        let mut region = Region {
            sums: tile.sums,
            origin: [tile.u, tile.v, tile.q],
            abc: [0.0; 3],
            middle: [0.0; 2],
            squares: 0.0,
            variance: tile.variance * tile.sums.n,
            tiles: 1,
            is_curved: false,
            is_fresh: true,
        };
        region.refit();
        layer.region[seed] = id;
        self.queue.clear();
        self.queue.push_back(seed as u32);
        while let Some(at) = self.queue.pop_front() {
            for next in layer.neighbours(at as usize) {
                if layer.region[next] == NONE && region.takes(&layer.tiles[next], confidence) {
                    layer.region[next] = id;
                    self.queue.push_back(next as u32);
                }
            }
        }
        region
    }

    /// Joins neighbouring regions that one plane explains as well as two, the most alike first.
    pub(super) fn merge(&mut self, layers: &mut [Layer]) {
        loop {
            self.list_pairs(layers);
            let Regions { all, pairs, costs, into, .. } = self;
            costs.clear();
            costs.extend(pairs.iter().map(|&(a, b)| (bend(&all[a as usize], &all[b as usize]), a, b)));
            costs.retain(|&(cost, ..)| cost <= BEND);
            if costs.is_empty() {
                return;
            }
            costs.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
            into.clear();
            into.extend(0..all.len() as u32);
            for &(_, a, b) in costs.iter() {
                // Whoever has changed in this pass waits for the next.
                if into[a as usize] == a
                    && into[b as usize] == b
                    && all[a as usize].is_fresh
                    && all[b as usize].is_fresh
                {
                    let other = all[b as usize].clone();
                    all[a as usize].absorb(&other);
                    into[b as usize] = a;
                }
            }
            all.iter_mut().for_each(|region| region.is_fresh = true);
            regions_of(layers).for_each(|region| *region = into[*region as usize]);
        }
    }

    /// Leaves out regions that lost their tiles or have fewer pixels, and counts the others anew.
    ///
    /// # Errors
    /// [`Error::TooManyPlanes`] if more are left than a region image can tell apart.
    pub(super) fn drop_small(&mut self, layers: &mut [Layer], least: f64) -> Result<()> {
        let Regions { all, into, .. } = self;
        into.clear();
        into.resize(all.len(), NONE);
        regions_of(layers).for_each(|region| into[*region as usize] = 0);
        let mut kept = 0;
        for (region, into) in all.iter().zip(into.iter_mut()) {
            if *into == 0 {
                let stays = region.sums.n >= least;
                *into = if stays { kept } else { NONE };
                kept += u32::from(stays);
            }
        }
        let mut number = into.iter();
        all.retain(|_| number.next() != Some(&NONE));
        regions_of(layers).for_each(|region| *region = into[*region as usize]);
        if kept as usize > MAX_PLANES { Err(Error::TooManyPlanes { found: kept as usize }) } else { Ok(()) }
    }

    /// Lists pairs of regions with tiles in one place, side by side, or with one tile of no region between.
    pub(super) fn list_pairs(&mut self, layers: &[Layer]) {
        self.pairs.clear();
        let (columns, rows) = (layers[0].columns, layers[0].rows);
        for (at, _, a) in layers.iter().flat_map(Layer::placed) {
            let right = columns - 1 - at % columns;
            let below = rows - 1 - at / columns;
            for (step, room) in [(0, 1), (1, right), (columns, below)] {
                for reach in 1..=room.min(2) {
                    let place = at + reach * step;
                    let there = || layers.iter().map(|layer| layer.region[place]).filter(|&b| b != NONE);
                    self.pairs.extend(there().filter(|&b| a != b).map(|b| (a.min(b), a.max(b))));
                    if there().next().is_some() {
                        break;
                    }
                }
            }
        }
        self.pairs.sort_unstable();
        self.pairs.dedup();
    }
}

fn regions_of(layers: &mut [Layer]) -> impl Iterator<Item = &mut u32> {
    layers.iter_mut().flat_map(|layer| &mut layer.region).filter(|region| **region != NONE)
}

impl Region {
    /// Takes a tile in if its pixels lie on the plane.
    fn takes(&mut self, tile: &Tile, confidence: f64) -> bool {
        let n = tile.sums.n;
        if n < 3.0 {
            return false;
        }
        let [u, v, q] = self.origin;
        let moved = tile.sums.moved([tile.u - u, tile.v - v, tile.q - q]);
        let most = limit(n, confidence) * tile.variance * n;
        let fits = if self.tiles < SMALL {
            let mut both = self.sums;
            both.merge(&moved);
            both.fit().is_some_and(|fit| tile.squares_about(fit.abc, self.origin) <= most)
        } else {
            tile.squares_about(self.abc, self.origin) <= most
        };
        if fits {
            self.sums.merge(&moved);
            self.variance += tile.variance * n;
            self.tiles += 1;
            self.refit();
        }
        fits
    }
}

/// Largest mean squared residual of n pixels of one plane, in variances: the mean of chi-squared / n is
/// 1, its standard deviation sqrt(2 / n). The noise level itself is known to about a fifth.
fn limit(n: f64, confidence: f64) -> f64 {
    1.4 * (1.0 + confidence * (2.0 / n).sqrt())
}

/// Two regions are one plane if their joint plane adds no more than this to the mean squared residual of
/// either, in variances.
const BEND: f64 = 0.5;

/// What a joint plane adds to the mean squared residual of the region that it suits less, in variances.
fn bend(a: &Region, b: &Region) -> f64 {
    let theirs = a.sums_of(b);
    let mut both = a.sums;
    both.merge(&theirs);
    let Some(joint) = both.fit() else { return f64::INFINITY };
    let added = |sums: &Moments, own: f64, variance: f64| (sums.squares_about(joint.abc) - own) / variance;
    added(&a.sums, a.squares, a.variance).max(added(&theirs, b.squares, b.variance))
}
