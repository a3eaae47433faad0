//! Stage "merge": regions that one plane explains as well as two become one.
//!
//! In: regions as they grew, and the tiles' region numbers. Out: fewer regions, and the edges between neighbouring
//! ones with the place where they touch.

use super::grid::{Grid, NONE};
use super::grow::Regions;
use super::region::Region;
use super::thresholds::{BOWED_ANGLE, BOWED_EXCESS, BOWED_MERGE, BOWED_STEP, MERGE, STEP_NOISE};
use crate::error::{Error, Result};
use crate::limits::MAX_PLANES;
use crate::methods::rays::{Rays, dot};
use crate::statistics::least_squares::Moments;
use crate::util::memory::reserve_to;
use crate::util::parallel::{for_row_blocks, map_reduce};
use crate::util::simd::vectorised;
use crate::util::switches::is_on;
use crate::util::union_find::find;
use std::ops::Range;

/// Two regions with tiles side by side, or with one tile of no region between.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// The smaller number and the larger.
    pub(super) ids: [u32; 2],
    /// Places where they touch.
    pub(super) contacts: f64,
    /// Sum over them of (u, v).
    at: [f64; 2],
    /// What merging costs ([`merge_cost`]), infinite if they are not one; NaN if it is not known.
    cost: f64,
}

impl Edge {
    /// Mean (u, v) of the places where they touch.
    pub(super) fn middle(&self) -> [f64; 2] {
        self.at.map(|sum| sum / self.contacts)
    }

    fn add(&mut self, other: &Edge) {
        self.contacts += other.contacts;
        self.at = [0, 1].map(|i| self.at[i] + other.at[i]);
    }
}

/// Where an edge stands in the table of recent ones.
fn slot([a, b]: [u32; 2]) -> usize {
    (a.wrapping_mul(0x9e37_79b1) ^ b.wrapping_mul(0x85eb_ca77)) as usize >> 7 & (RECENT - 1)
}

/// Slots of the table of edges that were just met; a power of two.
const RECENT: usize = 1024;
/// Pairs that are weighed sooner than a second thread wakes up.
const FEW_PAIRS: usize = 512;
/// Rows of tiles that are looked through at a time.
const ROWS: usize = 64;

/// Merges regions; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Merger {
    pub(super) edges: Vec<Edge>,
    /// Those of which a region has just become another.
    renamed: Vec<Edge>,
    parts: Vec<RowEdges>,
    /// For each region the one that it becomes.
    into: Vec<u32>,
    has_changed: Vec<bool>,
    order: Vec<u32>,
}

/// The edges in some rows of tiles.
#[derive(Debug, Default)]
struct RowEdges {
    edges: Vec<Edge>,
    /// For edges by hash, where the edge stands that was last met there.
    recent: Vec<u32>,
}

impl Merger {
    /// Joins neighbouring regions that one plane explains as well as two, the most alike first. Those that
    /// became part of another are still listed. On as many threads.
    pub(super) fn merge(&mut self, grid: &Grid, regions: &mut Regions, rays: &Rays, threads: usize) {
        reserve_to(&mut self.edges, 4 * grid.len());
        reserve_to(&mut self.renamed, 4 * grid.len());
        for memory in [&mut self.into, &mut self.order] {
            reserve_to(memory, 4 * grid.len());
        }
        reserve_to(&mut self.has_changed, grid.len());
        self.into.extend(0..regions.all.len() as u32);
        self.list_pairs(grid, threads);
        self.merge_listed(&mut regions.all, rays, threads);
    }

    /// Joins regions of the listed edges.
    pub(super) fn merge_listed(&mut self, all: &mut [Region], rays: &Rays, threads: usize) {
        weigh(&mut self.edges, all, rays, threads);
        while self.merge_best(all, rays, threads) {}
        self.edges.sort_unstable_by_key(key);
    }

    /// Leaves out regions of fewer than `least` pixels, and those that became part of another.
    ///
    /// # Errors
    /// [`Error::TooManyPlanes`] if more are left than a region image can tell apart.
    pub(super) fn drop_small(
        &mut self,
        grid: &mut Grid,
        regions: &mut Regions,
        least: f64,
        threads: usize,
    ) -> Result<()> {
        self.drop(grid, regions, threads, |region| region.sums.n < least);
        match regions.all.len() {
            found if found >= MAX_PLANES =>
            // one label more is taken, [`super::planes::BENT`]
            {
                Err(Error::TooManyPlanes { found })
            }
            _ => Ok(()),
        }
    }

    /// The region that one has become part of by now, or itself.
    pub(super) fn root(&self, id: u32) -> u32 {
        find(&self.into, id)
    }

    /// Lists the edges of the region adjacency graph, on as many threads.
    fn list_pairs(&mut self, grid: &Grid, threads: usize) {
        let Merger { edges, parts, .. } = self;
        for_row_blocks(threads, grid.rows, ROWS, parts, |part, rows| {
            vectorised(
                #[inline(always)]
                || part.list(grid, rows),
            );
        });
        parts.iter().for_each(|part| edges.extend(&part.edges));
        unite(edges);
    }

    /// Merges the edges that cost least, each region once; whether there were any.
    fn merge_best(&mut self, all: &mut [Region], rays: &Rays, threads: usize) -> bool {
        let Merger { edges, renamed, into, has_changed, order, .. } = self;
        order.clear();
        order.extend((0..edges.len() as u32).filter(|&at| edges[at as usize].cost.is_finite()));
        if order.is_empty() {
            return false;
        }
        order.sort_unstable_by(|&x, &y| {
            let [x, y] = [x, y].map(|at| &edges[at as usize]);
            x.cost.total_cmp(&y.cost).then(key(x).cmp(&key(y)))
        });
        has_changed.clear();
        has_changed.resize(all.len(), false);
        for &at in order.iter() {
            let [a, b] = edges[at as usize].ids.map(|id| id as usize);
            if !has_changed[a] && !has_changed[b] {
                let other = all[b];
                all[a].absorb(&other);
                into[b] = a as u32;
                has_changed[a] = true;
                has_changed[b] = true;
            }
        }
        renamed.clear();
        renamed.extend(edges.extract_if(.., |edge| edge.ids.iter().any(|&id| has_changed[id as usize])));
        for edge in renamed.iter_mut() {
            let [a, b] = edge.ids.map(|id| into[id as usize]);
            edge.ids = [a.min(b), a.max(b)];
        }
        renamed.retain(|edge| edge.ids[0] != edge.ids[1]);
        unite(renamed);
        weigh(renamed, all, rays, threads);
        edges.append(renamed);
        true
    }

    /// Leaves out the regions that `goes` names or that were merged, and counts the others anew. On as many threads.
    pub(super) fn drop(
        &mut self,
        grid: &mut Grid,
        regions: &mut Regions,
        threads: usize,
        mut goes: impl FnMut(&Region) -> bool,
    ) {
        let Merger { edges, into, order: number, .. } = self;
        number.clear();
        let mut kept = 0;
        number.extend(regions.all.iter().enumerate().map(|(id, region)| {
            let is_kept = !goes(region) && into[id] == id as u32;
            kept += u32::from(is_kept);
            if is_kept { kept - 1 } else { NONE }
        }));
        edges.iter_mut().for_each(|edge| edge.ids = edge.ids.map(|id| number[id as usize]));
        edges.retain(|edge| !edge.ids.contains(&NONE));
        // A region is merged into one before it, whose new number is known by then.
        for id in 0..into.len() {
            into[id] = if into[id] as usize == id { number[id] } else { into[into[id] as usize] };
        }
        let renumber =
            |ids: &mut [u32]| ids.iter_mut().for_each(|id| *id = into.get(*id as usize).map_or(NONE, |&id| id));
        map_reduce(threads, &mut grid.region[..], renumber, |(), ()| ());
        let mut numbers = number.iter();
        regions.all.retain(|_| numbers.next() != Some(&NONE));
        into.clear();
        into.extend(0..regions.all.len() as u32);
    }
}

impl RowEdges {
    /// Lists the edges that a tile of some rows makes with the next to its right or below.
    #[inline(always)]
    fn list(&mut self, grid: &Grid, of: Range<usize>) {
        let RowEdges { edges, recent } = self;
        let Grid { columns, rows, region, .. } = grid;
        reserve_to(edges, 2 * of.len() * columns);
        recent.clear();
        recent.resize(RECENT, NONE);
        let side = grid.side as f64;
        let mut touch = |a: u32, b: u32, column: usize, row: usize| {
            let ids = [a.min(b), a.max(b)];
            let at = [column, row].map(|place| (place as f64 + 0.5) * side);
            let met = Edge { ids, contacts: 1.0, at, cost: f64::NAN };
            let recent = &mut recent[slot(ids)];
            match edges.get_mut(*recent as usize) {
                Some(edge) if edge.ids == ids => edge.add(&met),
                _ => {
                    *recent = edges.len() as u32;
                    edges.push(met);
                }
            }
        };
        let mut look = |row: usize, column: usize, step: usize, room: usize| {
            let at = row * columns + column;
            // Beyond a tile of no region the next one counts.
            let is_gap = region[at + step] == NONE && room > 1;
            let beside = region[if is_gap { at + 2 * step } else { at + step }];
            if beside != NONE && beside != region[at] {
                touch(region[at], beside, column, row);
            }
        };
        for row in of {
            let own = row * columns;
            let below = own + if row + 1 < *rows { *columns } else { 0 };
            let (here, below) = (&region[own..own + columns], &region[below..below + columns]);
            for first in (0..*columns).step_by(LANES) {
                let [at_right, at_bottom] = find_ends(here, below, first);
                each_one(at_right, |i| {
                    let column = first + i;
                    look(row, column, 1, columns - 1 - column);
                });
                each_one(at_bottom, |i| look(row, first + i, *columns, rows - 1 - row));
            }
        }
    }
}

/// Tiles of a row that are looked at together; a row has a multiple of them.
const LANES: usize = 16;

/// For each tile from `first` on 1 if it has a region and the one to its right another or none, else 0; the same below.
#[inline(always)]
fn find_ends(here: &[u32], below: &[u32], first: usize) -> [[u8; LANES]; 2] {
    let part = |row: &[u32], at: usize| *row[at..].first_chunk::<LANES>().expect("rows of whole parts");
    let (own, below) = (part(here, first), part(below, first));
    let right = here.get(first + 1..).and_then(|row| row.first_chunk::<LANES>()).copied();
    let right = right.unwrap_or_else(|| std::array::from_fn(|i| own[(i + 1).min(LANES - 1)]));
    [right, below].map(|beside| std::array::from_fn(|i| u8::from((own[i] != NONE) & (own[i] != beside[i]))))
}

/// Calls `visit` with the place of each that is 1.
#[inline(always)]
fn each_one(ones: [u8; LANES], mut visit: impl FnMut(usize)) {
    let mut rest = u128::from_le_bytes(ones);
    while rest != 0 {
        visit(rest.trailing_zeros() as usize / 8);
        rest &= rest - 1;
    }
}

/// What edges are sorted by.
fn key(&Edge { ids: [a, b], .. }: &Edge) -> u64 {
    u64::from(a) << 32 | u64::from(b)
}

/// Finds what merging along each edge costs, on as many threads.
fn weigh(edges: &mut [Edge], all: &[Region], rays: &Rays, threads: usize) {
    let weigh = |edges: &mut [Edge]| {
        for edge in edges {
            let [a, b] = edge.ids.map(|id| &all[id as usize]);
            let cost = merge_cost(a, b);
            let bowed = BOWED_MERGE * a.excess().max(b.excess()).clamp(1.0, BOWED_EXCESS);
            let is_one = cost <= 1.0 || (cost <= bowed && is_on("bowed-merge") && goes_on(a, b, edge.middle(), rays));
            edge.cost = if is_one { cost } else { f64::INFINITY };
        }
    };
    let weigh = |edges: &mut [Edge]| {
        vectorised(
            #[inline(always)]
            || weigh(edges),
        )
    };
    let threads = if edges.len() < FEW_PAIRS { 1 } else { threads };
    map_reduce(threads, edges, weigh, |(), ()| ());
}

/// Makes one edge of those that are the same.
fn unite(edges: &mut Vec<Edge>) {
    edges.sort_unstable_by_key(key);
    edges.dedup_by(|next, edge| {
        let same = next.ids == edge.ids;
        if same {
            edge.add(next);
        }
        same
    });
}

/// Whether two planes meet without a step and turn by little.
fn goes_on(a: &Region, b: &Region, [u, v]: [f64; 2], rays: &Rays) -> bool {
    let limit = |region: &Region| STEP_NOISE.of(1.0, region.variance, region.smooth) / region.sums.n;
    let step = a.at(u, v) - b.at(u, v);
    if step * step > BOWED_STEP * BOWED_STEP * limit(a).max(limit(b)) {
        return false;
    }
    let [m, n] = [a, b].map(|region| rays.inverse([region.abc[0], region.abc[1]], |u, v| region.at(u, v)));
    let (both, squares) = (dot(m, n), dot(m, m) * dot(n, n));
    let cosine = BOWED_ANGLE.to_radians().cos();
    both > 0.0 && both * both >= cosine * cosine * squares
}

/// What a joint plane adds to the squares of the region that it suits less, as a multiple of what may be ([`MERGE`]).
#[inline(always)]
pub(super) fn merge_cost(a: &Region, b: &Region) -> f64 {
    let theirs = a.sums_of(b);
    let mut both = a.sums;
    both.merge(&theirs);
    let Some(joint) = both.fit() else { return f64::INFINITY };
    let added = |sums: &Moments, region: &Region| {
        // Its sums of variances are over its pixels.
        (sums.squares_about(joint.abc) - region.squares) / MERGE.of(1.0, region.variance, region.smooth)
    };
    added(&a.sums, a).max(added(&theirs, b))
}
