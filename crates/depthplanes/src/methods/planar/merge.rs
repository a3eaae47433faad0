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
use crate::methods::rays::Rays;
use crate::statistics::least_squares::Moments;
use crate::util::bits::each_one;
use crate::util::memory::reserve_to;
use crate::util::parallel::{for_row_blocks, map_reduce};
use crate::util::simd::vectorised;
use crate::util::switches::is_on;
use crate::util::union_find::find;
use crate::util::vec3::dot;
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
const FEW_EDGES: usize = 512;
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
        self.list_edges(grid, threads);
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
            // one label more is taken, [`super::region::CURVED_LABEL`]
            {
                Err(Error::TooManyPlanes { found, raise: "`min-pixels`".to_string() })
            }
            _ => Ok(()),
        }
    }

    /// The region that one has become part of by now, or itself.
    pub(super) fn root(&self, id: u32) -> u32 {
        find(&self.into, id)
    }

    /// Lists the edges of the region adjacency graph, on as many threads.
    pub(super) fn list_edges(&mut self, grid: &Grid, threads: usize) {
        let Merger { edges, parts, .. } = self;
        let parts = for_row_blocks(threads, grid.rows, ROWS, parts, |part, rows| {
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
    let threads = if edges.len() < FEW_EDGES { 1 } else { threads };
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
    let [m, n] = [a, b].map(|region| region.inverse(rays));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, cells_of, noise, patchy, plane_of, squares_about};
    use crate::util::random::Random;
    use std::collections::BTreeMap;

    /// A map of tiles, with regions of some tiles each and gaps of one tile and more.
    fn tiles(random: &mut Random, columns: usize, rows: usize) -> Grid {
        let mut grid = Grid { columns, rows, ..Grid::new(4) };
        grid.region = vec![NONE; columns * rows];
        for _ in 0..columns * rows / 8 {
            let id = [NONE, random.whole(0, 9) as u32][random.whole(0, 3).min(1)];
            let [column, row] = [random.whole(0, columns - 1), random.whole(0, rows - 1)];
            let size = [random.whole(1, 6), random.whole(1, 6)];
            for row in row..(row + size[1]).min(rows) {
                grid.region[row * columns..][column..(column + size[0]).min(columns)].fill(id);
            }
        }
        grid
    }

    #[test]
    fn edges_and_where_they_touch_are_what_a_look_at_each_tile_and_the_next_finds() {
        let mut random = Random::new(4);
        for round in 0..20 {
            // More rows than are looked through at a time.
            let grid = tiles(&mut random, 64, 1 + 45 * (round % 4));
            let mut expected: BTreeMap<[u32; 2], [f64; 3]> = BTreeMap::new();
            let at =
                |column: usize, row: usize| (column < 64 && row < grid.rows).then(|| grid.region[row * 64 + column]);
            for (row, column) in (0..grid.rows).flat_map(|row| (0..64).map(move |column| (row, column))) {
                let own = at(column, row).unwrap();
                for [right, down] in [[1, 0], [0, 1]] {
                    let next = at(column + right, row + down);
                    let beyond = at(column + 2 * right, row + 2 * down);
                    let beside = if next == Some(NONE) { beyond } else { next };
                    if let Some(beside) = beside.filter(|&id| id != own && id != NONE && own != NONE) {
                        let edge = expected.entry([own.min(beside), own.max(beside)]).or_default();
                        let place = [4.0 * column as f64 + 2.0, 4.0 * row as f64 + 2.0];
                        *edge = [edge[0] + 1.0, edge[1] + place[0], edge[2] + place[1]];
                    }
                }
            }
            for threads in [1, 3] {
                let mut merger = Merger::default();
                merger.list_edges(&grid, threads);
                let found = merger.edges.iter().map(|edge| (edge.ids, [edge.contacts, edge.at[0], edge.at[1]]));
                assert_eq!(found.collect::<Vec<_>>(), expected.clone().into_iter().collect::<Vec<_>>());
                for edge in &merger.edges {
                    let [count, u, v] = expected[&edge.ids];
                    assert_eq!(edge.middle(), [u / count, v / count]);
                }
            }
            assert!(grid.rows == 1 || expected.len() > 20);
        }
    }

    #[test]
    fn merging_costs_what_the_joint_plane_adds_to_the_worse_of_two_whichever_comes_first() {
        let smooth = 0.02;
        for seed in 1..8 {
            let made = patchy(seed);
            let mut stages = Stages::tiles(&made, noise(smooth));
            stages.divide(|column, row| [0, 1, 2, 3][column / 7 % 2 + row / 5 % 2 * 2]);
            let all = stages.all();
            let pixels = [0, 1, 2, 3].map(|id| made.pixels_of(stages.grid(), id));
            for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))).filter(|(a, b)| a != b) {
                let (joint, _) = plane_of(&[pixels[a].clone(), pixels[b].clone()].concat(), [0.0; 2]);
                let added = [a, b].map(|id| {
                    let more = squares_about(&pixels[id], joint, [0.0; 2]) - plane_of(&pixels[id], [0.0; 2]).1;
                    more / (pixels[id].len() as f64 * (0.5 * SIGMA * SIGMA + 6.0 * smooth * smooth))
                });
                let (expected, found) = (added[0].max(added[1]), merge_cost(&all[a], &all[b]));
                assert!((found - expected).abs() <= 1e-3 * expected, "{found}, not {expected}");
                let other_way = merge_cost(&all[b], &all[a]);
                assert!((found - other_way).abs() <= 1e-6 * found, "{found}, and {other_way} the other way round");
            }
        }
    }

    #[test]
    fn pieces_of_one_plane_merge_and_planes_that_differ_by_more_than_the_noise_do_not() {
        // A step of ten deviations, a crease of a pixel's value for each two, and a step that noise hides.
        type Off = fn(f64) -> f64;
        let kinds: [(&str, Off, usize); 4] = [
            ("one plane", |_| 0.0, 1),
            ("a step", |u| if u < 64.0 { 0.0 } else { 10.0 * SIGMA }, 2),
            ("a crease", |u| -0.5 * (u - 63.5).abs(), 2),
            ("a shallow step", |u| if u < 64.0 { 0.0 } else { 0.5 * SIGMA }, 1),
        ];
        for (name, off, expected) in kinds {
            for seed in 0..5 {
                let made = Made::noisy([128, 96], seed, |u, v| 40.0 + 0.05 * u - 0.02 * v + off(u));
                let mut stages = Stages::tiles(&made, noise(0.0));
                // Twelve pieces.
                stages.divide(|column, row| (column / 8 + row / 8 * 4) as u32);
                stages.merge();
                assert_eq!(stages.all().len(), expected, "{name}, seed {seed}");
                stages.check_sums();
                let of = |column: usize| stages.region_at([4 * column, 40]);
                assert_eq!([of(0) == of(15), of(16) == of(31), of(0) == of(31)], [true, true, expected == 1]);
            }
        }
    }

    #[test]
    fn what_bows_by_a_small_angle_is_one_and_what_turns_at_a_crease_of_12_degrees_is_two() {
        // A column is 1/128 of the depth; both creases cost more than the noise, and less than a bow may.
        for (degrees, expected) in [(6.0, 1), (12.0, 2)] {
            for seed in 0..5 {
                let slope = 40.0 / 128.0 * (0.5 * f64::to_radians(degrees)).tan();
                let made = Made::noisy([24, 128], seed, |u, _| 40.0 - slope * (u - 11.5).abs());
                let mut stages = Stages::tiles(&made, noise(0.0));
                stages.divide(|column, _| u32::from(column >= 3));
                let cost = merge_cost(&stages.all()[0], &stages.all()[1]);
                assert!(cost > 1.0 && cost < BOWED_MERGE, "{cost} at {degrees} degrees");
                stages.merge();
                assert_eq!(stages.all().len(), expected, "{degrees} degrees, seed {seed}");
            }
        }
    }

    #[test]
    fn pieces_of_one_plane_that_are_far_apart_stay_two() {
        let made = Made::noisy([128, 64], 3, |u, v| 40.0 + 0.05 * u - 0.02 * v);
        let mut stages = Stages::tiles(&made, noise(0.0));
        stages.divide(|column, _| [0, NONE, 1][column.saturating_sub(13).min(2)]);
        stages.merge();
        assert_eq!(stages.all().len(), 1, "a tile between is no gap");
        stages.divide(|column, _| [0, NONE, NONE, 1][column.saturating_sub(13).min(3)]);
        stages.merge();
        assert_eq!(stages.all().len(), 2, "two tiles between are one");
    }

    #[test]
    fn regions_that_are_left_have_numbers_without_gaps_and_their_own_tiles() {
        let (made, mut random) = (patchy(5), Random::new(6));
        for round in 0..30 {
            let mut stages = Stages::tiles(&made, noise(0.01));
            stages.divide(|column, row| (column / 3 + row / 3 * 13) as u32);
            let Stages { run, rays, .. } = &mut stages;
            run.merger.merge(&run.pyramid.grids[0], &mut run.regions, rays, 1);
            let before: Vec<u32> = run.pyramid.grids[0].region.clone();
            let roots: Vec<u32> = (0..run.regions.all.len() as u32).map(|id| run.merger.root(id)).collect();
            let sums: Vec<_> = run.regions.all.iter().map(|region| region.sums).collect();
            let dropped: Vec<bool> = sums.iter().map(|_| random.uniform() < 0.4).collect();
            let edges: Vec<[u32; 2]> = run.merger.edges.iter().map(|edge| edge.ids).collect();
            let mut order = dropped.iter();
            run.merger.drop(&mut run.pyramid.grids[0], &mut run.regions, 1 + round % 3, |_| *order.next().unwrap());
            let number = |id: u32| {
                let is_left = |id: u32| roots[id as usize] == id && !dropped[id as usize];
                let root = roots[id as usize];
                if is_left(root) { (0..root).filter(|&before| is_left(before)).count() as u32 } else { NONE }
            };
            let expected: Vec<u32> = before.iter().map(|&id| if id == NONE { NONE } else { number(id) }).collect();
            assert_eq!(run.pyramid.grids[0].region, expected);
            let left: Vec<_> =
                (0..roots.len() as u32).filter(|&id| roots[id as usize] == id && number(id) != NONE).collect();
            assert_eq!(run.regions.all.len(), left.len());
            (0..left.len()).for_each(|new| assert_eq!(run.regions.all[new].sums, sums[left[new] as usize]));
            let renamed = edges.iter().map(|ids| ids.map(number)).filter(|ids| !ids.contains(&NONE));
            assert_eq!(run.merger.edges.iter().map(|edge| edge.ids).collect::<Vec<_>>(), renamed.collect::<Vec<_>>());
            assert!(
                (0..left.len() as u32)
                    .all(|id| run.merger.root(id) == id && cells_of(&run.pyramid.grids[0], id).count() > 0)
            );
            stages.check_sums();
        }
    }

    #[test]
    fn small_regions_are_dropped_and_more_than_an_image_can_tell_apart_are_an_error() {
        let made = Made::noisy([128, 64], 3, |u, v| 40.0 + 0.05 * u - 0.02 * v);
        let mut stages = Stages::tiles(&made, noise(0.0));
        stages.divide(|_, _| 0);
        let run = &mut stages.run;
        let region = run.regions.all[0];
        let some = |n: f64| {
            let mut some = region;
            some.sums.n = n;
            some
        };
        let mut grid = Grid { columns: 4, rows: 1, ..Grid::new(4) };
        grid.region = vec![0, 1, 2, 3];
        let mut merger = Merger { into: vec![0, 1, 2, 3], ..Merger::default() };
        run.regions.all = [100.0, 99.0, 101.0, 3.0].map(some).to_vec();
        merger.drop_small(&mut grid, &mut run.regions, 100.0, 1).unwrap();
        assert_eq!(run.regions.all.iter().map(|region| region.sums.n).collect::<Vec<_>>(), [100.0, 101.0]);
        assert_eq!(grid.region, [0, NONE, 1, NONE]);
        for (count, fits) in [(MAX_PLANES - 1, true), (MAX_PLANES, false)] {
            run.regions.all = vec![some(100.0); count];
            let mut merger = Merger { into: (0..count as u32).collect(), ..Merger::default() };
            let result = merger.drop_small(&mut grid, &mut run.regions, 100.0, 1);
            assert_eq!(result.is_ok(), fits, "{result:?}");
        }
    }
}
