//! Stage "judge": regions that are no surface of their own are removed.
//!
//! In: regions and the edges of their adjacency graph. Out: fewer regions. Cells across the crease of two planes make
//! a region that is flat to within the noise, though each of its pixels lies on one plane or the other.

use super::grid::Grid;
use super::layout::{AffineMap, SIDE};
use super::merge::Edge;
use super::region::{CellBox, Planes, Region};
use crate::util::memory::reserve_to;
use crate::util::parallel::{Numbered, map_reduce};
use crate::util::simd::vectorised;
use crate::util::switches::is_on;

/// A region goes if more than this share of its pixels lies on larger planes beside it.
const REDUNDANT_SHARE: f64 = 0.7;
/// How many times as large those are.
const LARGER_TIMES: f64 = 2.0;
/// A strip across a crease lies no further from either plane than this, root mean square, in standard
/// deviations.
const STRIP_DEVIATIONS: f64 = 7.0;
/// Most larger planes that are held against a region.
pub(super) const MOST_LARGER: usize = 8;

/// Finds explained regions; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Redundancy {
    /// For each region the larger planes beside it that may explain it.
    larger: Vec<[u32; MOST_LARGER]>,
    counts: Vec<usize>,
    pub(super) is_redundant: Vec<bool>,
}

impl Redundancy {
    /// Finds the regions of which most pixels lie on larger planes beside them.
    pub(super) fn find(
        &mut self,
        affine: &AffineMap,
        grid: &Grid,
        planes: &Planes<'_>,
        edges: &[Edge],
        boxes: &[CellBox],
        threads: usize,
    ) {
        let Redundancy { larger, counts, is_redundant } = self;
        reserve_to(larger, grid.len());
        reserve_to(counts, grid.len());
        reserve_to(is_redundant, grid.len());
        larger.resize(planes.regions.len(), [0; MOST_LARGER]);
        counts.resize(planes.regions.len(), 0);
        for edge in edges {
            let [a, b] = edge.ids;
            for (small, large) in [(a, b), (b, a)] {
                let [own, other] = [small, large].map(|id| planes.region(id));
                let count = &mut counts[small as usize];
                if *count < MOST_LARGER && is_larger(own, other) && is_near(own, other) {
                    larger[small as usize][*count] = large;
                    *count += 1;
                }
            }
        }
        is_redundant.resize(planes.regions.len(), false);
        let find = |part: Numbered<'_, bool>| {
            for (id, is_redundant) in (part.first..).zip(part.all) {
                let others = &larger[id][..counts[id]];
                let share = || share_on(affine, grid, planes, id as u32, others, &boxes[id]);
                *is_redundant = is_on("redundant") && !others.is_empty() && vectorised(share) > REDUNDANT_SHARE;
            }
        };
        map_reduce(threads, Numbered { first: 0, all: is_redundant }, find, |(), ()| ());
    }

    /// The larger planes beside a region that may explain some of it.
    pub(super) fn larger(&self, id: u32) -> &[u32] {
        &self.larger[id as usize][..self.counts[id as usize]]
    }

    /// The share of a region's pixels that lies on larger planes beside it, and the most that a plane of its own has;
    /// none if there is no such plane.
    pub(super) fn share(
        &self,
        affine: &AffineMap,
        grid: &Grid,
        planes: &Planes<'_>,
        boxes: &[CellBox],
        id: u32,
    ) -> Option<[f64; 2]> {
        let others = self.larger(id);
        (!others.is_empty()).then(|| [share_on(affine, grid, planes, id, others, &boxes[id as usize]), REDUNDANT_SHARE])
    }
}

/// Whether another plane is much larger.
fn is_larger(own: &Region, other: &Region) -> bool {
    other.sums.n > LARGER_TIMES * own.sums.n
}

/// Whether a region may be a strip on the border of a larger plane.
fn is_near(own: &Region, larger: &Region) -> bool {
    let theirs = larger.sums_of(own);
    theirs.squares_about(larger.abc) <= STRIP_DEVIATIONS * STRIP_DEVIATIONS * own.variance
}

/// The share of a region's pixels that lies on other planes, of those that lie on its own.
#[inline(always)]
fn share_on(affine: &AffineMap, grid: &Grid, planes: &Planes<'_>, id: u32, others: &[u32], around: &CellBox) -> f64 {
    let [mut pixels, mut by_others] = [0; 2];
    for row in around.first[1]..=around.last[1] {
        for column in around.first[0]..=around.last[0] {
            let at = row * grid.columns + column;
            if grid.region[at] != id {
                continue;
            }
            let most = planes.inlier_threshold_squared(planes.region(id), grid.q(at)) as f32;
            let place = [column, row].map(|place| place * SIDE);
            let lie_on = |id: u32| affine.lie_on(place, planes.region(id).about(place), most);
            let own = lie_on(id);
            pixels += own.count_ones();
            by_others += (own & others.iter().fold(0, |any, &other| any | lie_on(other))).count_ones();
        }
    }
    f64::from(by_others) / f64::from(pixels.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::region::find_boxes;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, THRESHOLD, noise, planes};

    /// What is found of three regions: to the left of some tiles, those, and to their right.
    fn found(made: &Made, strip: [usize; 2]) -> (Stages, Redundancy) {
        let mut stages = Stages::tiles(made, noise(0.0));
        stages.divide(|column, _| match column {
            _ if column < strip[0] => 0,
            _ if column < strip[1] => 1,
            _ => 2,
        });
        stages.list_edges();
        let run = &mut stages.run;
        find_boxes(&run.pyramid.grids[0], &run.regions.all, &mut run.curvature.boxes);
        let mut redundancy = Redundancy::default();
        let planes = planes(&run.regions.all, &stages.noise);
        redundancy.find(&run.affine, &run.pyramid.grids[0], &planes, &run.merger.edges, &run.curvature.boxes, 1);
        (stages, redundancy)
    }

    /// The share of a region's pixels on its plane that lie on other ones.
    fn share(made: &Made, stages: &Stages, own: usize, others: &[usize]) -> f64 {
        let all = stages.all();
        let is_on = |id: usize, [u, v, q]: [f64; 3]| {
            (q - all[id].at(u, v)).abs() <= THRESHOLD * (SIGMA * SIGMA * all[own].excess().max(1.0)).sqrt()
        };
        let pixels: Vec<[f64; 3]> =
            made.pixels_of(stages.grid(), own as u32).into_iter().filter(|&pixel| is_on(own, pixel)).collect();
        let by_others = pixels.iter().filter(|&&pixel| others.iter().any(|&id| is_on(id, pixel))).count();
        by_others as f64 / pixels.len() as f64
    }

    #[test]
    fn a_strip_across_the_crease_of_two_large_planes_is_redundant_and_these_are_not() {
        for seed in 0..10 {
            let made = Made::noisy([128, 96], seed, |u, v| 40.0 + 0.02 * v - 0.03 * (u - 64.0).abs());
            let (stages, redundancy) = found(&made, [14, 18]);
            assert_eq!(redundancy.is_redundant, [false, true, false], "seed {seed}");
            let mut larger = redundancy.larger(1).to_vec();
            larger.sort_unstable();
            assert_eq!((larger, redundancy.larger(0).len(), redundancy.larger(2).len()), (vec![0, 2], 0, 0));
            let run = &stages.run;
            let planes = planes(stages.all(), &stages.noise);
            let [found, most] = redundancy.share(&run.affine, stages.grid(), &planes, &run.curvature.boxes, 1).unwrap();
            let expected = share(&made, &stages, 1, &[0, 2]);
            assert!((found - expected).abs() < 0.01 && found > most, "{found}, not {expected}");
            assert_eq!(redundancy.share(&run.affine, stages.grid(), &planes, &run.curvature.boxes, 0), None);
        }
    }

    #[test]
    fn a_small_face_of_a_box_before_a_wall_is_a_surface_of_its_own() {
        // It stands out by six deviations, so that some of its pixels lie on the wall's plane, or is turned the other way.
        let kinds: [fn(f64) -> f64; 4] =
            [|_| 4.0 * SIGMA, |_| 6.0 * SIGMA, |_| 30.0 * SIGMA, |u| 5.0 * SIGMA + 0.3 * (u - 64.0)];
        for (seed, face) in (0..).zip(kinds) {
            let made = Made::noisy([128, 96], seed, |u, v| {
                let is_face =
                    (56.0..72.0).contains(&u) && (seed == 0 || !(u as usize * 5 + v as usize * 11).is_multiple_of(48));
                40.0 + 0.02 * v + if is_face { face(u) } else { 0.0 }
            });
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, _| u32::from((14..18).contains(&column)));
            stages.list_edges();
            stages.judge();
            assert_eq!(stages.run.redundancy.is_redundant, [false, false], "face {seed}");
            // Of the pixels on its own plane; those that lie on the wall's alone say nothing.
            let Stages { run, noise, .. } = &stages;
            let planes = planes(&run.regions.all, noise);
            let found = run.redundancy.share(&run.affine, stages.grid(), &planes, &run.curvature.boxes, 1);
            if let Some([found, _]) = found {
                let expected = share(&made, &stages, 1, &[0]);
                assert!((found - expected).abs() < 0.01, "{found}, not {expected}, face {seed}");
            }
            assert_eq!(found.is_some(), seed < 2, "what is far before a wall is no strip of it");
        }
    }

    #[test]
    fn a_region_is_held_against_planes_of_more_than_twice_its_pixels_alone() {
        let made = Made::noisy([128, 96], 1, |u, v| 40.0 + 0.02 * v - 0.03 * (u - 64.0).abs());
        for (width, expected) in [(10, true), (13, false)] {
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, _| if column < width { 0 } else { 1 });
            let [small, large] = [stages.all()[0], stages.all()[1]];
            assert_eq!((is_larger(&small, &large), is_larger(&large, &small)), (expected, false));
        }
    }
}
