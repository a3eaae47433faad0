//! Stage "judge": facets of curved surfaces are told from planes.
//!
//! In: regions of cells and the edges of their adjacency graph. Out: which regions are curved. Growth cuts a ball or
//! a column into facets, each flat to within the noise. Five kinds of evidence tell facets from planes
//! ([`Evidence`]). The means of a region's own cells bow: a quadratic explains more of them than chance would. Across
//! the edge of two facets, or through a small facet and what is around it, one quadratic runs on smoothly, while the
//! crease of two planes leaves it far off: the best parabola through a roof misses its ridge by 3/16 of the height.
//! And beyond its border, or where it meets neighbours of its size, the surface turns gently.

use super::curvature::{Border, Bows, Frame, add_run};
use super::grid::{NONE, Place};
use super::grow::Regions;
use super::merge::Edge;
use super::pyramid::Pyramid;
use super::region::{CellBox, Region};
use super::thresholds::{
    Allowance, BOWED_ANGLE, GENTLE, GENTLE_LARGER, GENTLE_SHARE, GENTLE_SIZE, JOINT_GAIN, JOINT_MISS, LOOSE_GAIN,
    LOOSE_MISS, TURN,
};
use crate::methods::rays::Rays;
use crate::noise::NoiseModel;
use crate::statistics::quadratic::QuadraticSums;
use crate::util::memory::reserve_to;
use crate::util::parallel::{Numbered, map_reduce};
use crate::util::runs::each_run;
use crate::util::switches::is_on;
use crate::util::union_find::{find, unite};
use crate::util::vec3::dot;

/// Fewest cells that a quadratic, six numbers, is fitted to.
const QUADRATIC_CELLS: f64 = 12.0;
/// Fewest cells of each side of a joint.
const SIDE_CELLS: f64 = 4.0;
/// Standard deviations between two planes where they touch, from which on they are two surfaces.
const STEP_DEVIATIONS: f64 = 6.0;
/// Pixels below which a region's surroundings are looked at as well: its neighbours may be too small for regions.
const LOOK_AROUND_PIXELS: f64 = 1000.0;
/// Pixels from which on a region is no facet of a mesh or a ball beside others of them, unless it bows itself.
const NO_FACET_PIXELS: f64 = 4000.0;
/// Share of the squares about a plane that a quadratic may leave around a small region: half of what it leaves of a roof.
/// Of `|x|` on -1..1 the best plane leaves 1/6 and the best quadratic 1/96, which is 1/16 of it. Of six columns of means
/// over tiles it leaves less, 1/40: the smallest roofs may pass for curved.
const ROOF_SHARE: f64 = 0.03;
/// Deviations of a pixel from a small region's plane up to which a tile around it is looked at: a quadratic through a roof
/// that rises d to each side is 0.07 d off, root mean square.
const NEAR_DEVIATIONS: f64 = 20.0;
/// How far around, in tiles.
const RING_TILES: usize = 1;

/// Memory of this stage.
#[derive(Debug, Default)]
pub(super) struct CurvatureTest {
    pub(super) bows: Bows,
    pub(super) boxes: Vec<CellBox>,
    /// For each region what shows that it is a facet of a curved surface, if anything.
    pub(super) evidence: Vec<Option<Evidence>>,
    /// For each edge what is known of the surface across it.
    joints: Vec<Option<SmoothEdge>>,
    folds: Vec<Fold>,
}

/// Two regions through which one quadratic runs.
#[derive(Clone, Copy, Debug)]
struct SmoothEdge {
    small: u32,
    large: u32,
    /// Pixels of the larger one that were seen.
    seen: f64,
}

/// What shows that a region is a facet of a curved surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Evidence {
    /// Its own cells bow.
    Bow,
    /// One quadratic runs through it and that neighbour.
    Continuity(u32),
    /// It is small, and one quadratic runs through it and what is around it.
    Surroundings,
    /// Off its border the surface goes on and turns gently.
    Turns,
    /// It and neighbours of its size turn gently where they meet, and it bows, or it is small and the surface goes on.
    Folds,
}

/// What is known of the sensor.
#[derive(Clone, Copy)]
pub(super) struct Sensing<'a> {
    pub(super) noise: &'a NoiseModel,
    pub(super) rays: &'a Rays,
}

/// What is known of the regions and the map they lie in.
struct Context<'a> {
    pyramid: &'a Pyramid,
    all: &'a [Region],
    noise: &'a NoiseModel,
    is_redundant: &'a [bool],
    boxes: &'a [CellBox],
    bows: &'a Bows,
}

impl CurvatureTest {
    /// Marks the regions that are facets of a curved surface. Strips across a crease (`is_redundant`) are no facets, and say
    /// nothing of others: through a strip and a narrow plane beside it there often is a quadratic. On as many threads.
    pub(super) fn mark(
        &mut self,
        pyramid: &Pyramid,
        regions: &mut Regions,
        edges: &[Edge],
        is_redundant: &[bool],
        Sensing { noise, rays }: Sensing<'_>,
        threads: usize,
    ) {
        let cells = pyramid.grids[0].len();
        reserve_to(&mut self.evidence, cells);
        reserve_to(&mut self.joints, 4 * cells);
        reserve_to(&mut self.folds, cells);
        let CurvatureTest { bows, boxes, evidence, joints, folds } = self;
        let is_bowed = |(id, is_redundant): (u32, &bool)| {
            is_on("bow") && !is_redundant && bows.is_bowed(id, &regions.all[id as usize], rays, TURN)
        };
        evidence.extend((0..).zip(is_redundant).map(|region| is_bowed(region).then_some(Evidence::Bow)));
        let context = Context { pyramid, all: &regions.all, noise, is_redundant, boxes, bows };
        if is_on("joint") {
            context.find_joints(edges, joints, evidence, threads);
        }
        context.measure_folds(edges, rays, folds);
        let look_around = |part: Numbered<'_, Option<Evidence>>| {
            for (id, sign) in (part.first..).zip(part.all).filter(|(id, sign)| sign.is_none() && !is_redundant[*id]) {
                let (region, number) = (&context.all[id], id as u32);
                let is_small = region.sums.n < NO_FACET_PIXELS;
                let border = Border { grid: &pyramid.grids[0], all: context.all, rays, id: number };
                if is_on("surroundings") && region.sums.n < LOOK_AROUND_PIXELS && context.surroundings(number).bends() {
                    *sign = Some(Evidence::Surroundings);
                } else if is_on("turns") && is_small && border.turns(&boxes[id]) {
                    *sign = Some(Evidence::Turns);
                } else if is_on("folds")
                    && folds[id].is_gentle()
                    && ((is_small && folds[id].goes_on) || bows.is_bowed(number, region, rays, 0.0))
                {
                    *sign = Some(Evidence::Folds);
                }
            }
        };
        map_reduce(threads, Numbered { first: 0, all: &mut evidence[..] }, look_around, |(), ()| ());
        regions.all.iter_mut().zip(evidence).for_each(|(region, sign)| region.is_curved |= sign.is_some());
    }
}

/// How much of a region's border with others turns gently.
#[derive(Clone, Copy, Debug, Default)]
struct Fold {
    /// Places where it turns gently.
    gentle: f64,
    /// Whether it does so towards several neighbours, or towards one that is much larger: a roof has two halves.
    goes_on: bool,
    all: f64,
}

impl Fold {
    fn is_gentle(&self) -> bool {
        self.gentle > 0.0 && self.gentle >= GENTLE_SHARE * self.all
    }
}

/// Whether two planes differ by no more than [`GENTLE`] degrees, and by more than the pieces of one that bows.
fn turn_gently(a: &Region, b: &Region, rays: &Rays) -> bool {
    let [m, n] = [a, b].map(|region| region.inverse(rays));
    let (both, squares) = (dot(m, n), dot(m, m) * dot(n, n));
    let least = |angle: f64| angle.to_radians().cos().powi(2) * squares;
    both > 0.0 && (least(GENTLE)..least(BOWED_ANGLE)).contains(&(both * both))
}

/// Whether there is a step between two regions where they touch.
pub(super) fn are_apart(all: &[Region], noise: &NoiseModel, edge: &Edge) -> bool {
    let [u, v] = edge.middle();
    let [a, b] = edge.ids.map(|id| all[id as usize].at(u, v));
    let q = (a + b) / 2.0;
    (a - b).powi(2) > STEP_DEVIATIONS * STEP_DEVIATIONS * (noise.variance(q) + noise.smooth_sigma(q).powi(2))
}

impl Context<'_> {
    /// How much of each region's border turns gently, towards neighbours that are no strips.
    fn measure_folds(&self, edges: &[Edge], rays: &Rays, folds: &mut Vec<Fold>) {
        folds.resize(self.all.len(), Fold::default());
        for edge in edges.iter().filter(|edge| !self.has_redundant(edge)) {
            let [a, b] = edge.ids.map(|id| id as usize);
            let is_gentle = !self.are_apart(edge) && turn_gently(&self.all[a], &self.all[b], rays);
            for (id, other) in [(a, b), (b, a)] {
                let counts = is_gentle && self.all[other].sums.n > GENTLE_SIZE * self.all[id].sums.n;
                let is_larger = self.all[other].sums.n > GENTLE_LARGER * self.all[id].sums.n;
                folds[id].goes_on |= counts && (is_larger || folds[id].gentle > 0.0);
                folds[id].gentle += if counts { edge.contacts } else { 0.0 };
                folds[id].all += edge.contacts;
            }
        }
    }

    /// Marks the regions that one quadratic joins to a neighbour. On as many threads.
    fn find_joints(
        &self,
        edges: &[Edge],
        joints: &mut Vec<Option<SmoothEdge>>,
        evidence: &mut [Option<Evidence>],
        threads: usize,
    ) {
        joints.resize(edges.len(), None);
        let look_along = |part: Numbered<'_, Option<SmoothEdge>>| {
            for (edge, joint) in edges[part.first..].iter().zip(part.all) {
                *joint = self.smooth_joint(edge, evidence);
            }
        };
        map_reduce(threads, Numbered { first: 0, all: &mut joints[..] }, look_along, |(), ()| ());
        for &SmoothEdge { small, large, seen } in joints.iter().flatten() {
            evidence[small as usize].get_or_insert(Evidence::Continuity(large));
            if 2.0 * seen >= self.all[large as usize].sums.n {
                evidence[large as usize].get_or_insert(Evidence::Continuity(small));
            }
        }
    }

    /// The regions of an edge, if one quadratic runs through both; none if it is known of both that they are curved.
    fn smooth_joint(&self, edge: &Edge, evidence: &[Option<Evidence>]) -> Option<SmoothEdge> {
        if self.has_redundant(edge) || self.are_apart(edge) {
            return None;
        }
        let [a, b] = edge.ids;
        let is_larger = self.boxes[a as usize].area() < self.boxes[b as usize].area();
        let [small, large] = if is_larger { [a, b] } else { [b, a] };
        let is_known = [small, large].iter().all(|&id| evidence[id as usize].is_some());
        if is_known || self.bows.gain(small) + self.bows.gain(large) < JOINT_GAIN.variances {
            return None;
        }
        let seen = self.joint(small, large).is_smooth()?;
        Some(SmoothEdge { small, large, seen })
    }

    /// Whether one of two regions is a strip across a crease.
    fn has_redundant(&self, edge: &Edge) -> bool {
        edge.ids.iter().any(|&id| self.is_redundant[id as usize])
    }

    /// Whether there is a step between two regions where they touch.
    fn are_apart(&self, edge: &Edge) -> bool {
        are_apart(self.all, self.noise, edge)
    }

    /// Looks at a small region and the flat tiles around it that no large plane explains.
    fn surroundings(&self, small: u32) -> Continuity {
        let plane = &self.all[small as usize];
        let grid = &self.pyramid.grids[0];
        let CellBox { first, last } = self.boxes[small as usize];
        let frame = Frame::of(plane);
        let mut sums = [QuadraticSums::default(); 2];
        for row in first[1].saturating_sub(RING_TILES)..(last[1] + RING_TILES + 1).min(grid.rows) {
            for column in first[0].saturating_sub(RING_TILES)..(last[0] + RING_TILES + 1).min(grid.columns) {
                let at = row * grid.columns + column;
                let id = grid.region[at];
                let is_own = id == small;
                let is_loose = || id == NONE || self.all[id as usize].sums.n < LOOK_AROUND_PIXELS;
                if is_own || (grid.roughness[at] <= 1.0 && is_loose()) {
                    let cell = grid.cell(Place { row: row as u32, column: column as u32 });
                    let off = cell.residual_about(plane.abc, plane.origin) / cell.n;
                    if is_own || off * off <= NEAR_DEVIATIONS * NEAR_DEVIATIONS * cell.variance {
                        add_run(&mut sums[usize::from(is_own)], grid, row, column..column + 1, plane, None, &frame);
                    }
                }
            }
        }
        Continuity::of(sums)
    }

    /// Looks at a region and at another, within its box and as much again on each side.
    fn joint(&self, small: u32, large: u32) -> Continuity {
        let plane = &self.all[small as usize];
        let level = self.bows.level(small);
        let grid = &self.pyramid.grids[level];
        let around = self.boxes[small as usize].widened(level, grid);
        let frame = Frame::of(plane);
        let mut sums = [QuadraticSums::default(); 2];
        for row in around.first[1]..=around.last[1] {
            let part = row * grid.columns + around.first[0]..row * grid.columns + around.last[0] + 1;
            each_run(&grid.region[part], around.first[0], |id, columns| {
                if id == small || id == large {
                    let own = Some(&self.all[id as usize]);
                    add_run(&mut sums[usize::from(id == small)], grid, row, columns, plane, own, &frame);
                }
            });
        }
        Continuity::of(sums)
    }
}

/// How well one quadratic explains a small region and its neighbours around it. First of each pair the
/// neighbours, then the region.
struct Continuity {
    sums: [QuadraticSums; 2],
    /// Squares of cell means about the quadratic, in variances, beyond what noise leaves.
    missed: [f64; 2],
}

impl Continuity {
    fn of(sums: [QuadraticSums; 2]) -> Self {
        let quadratic = sums[0].merge(&sums[1]).solve::<6>();
        let missed = [0, 1].map(|which: usize| sums[which].left_by(&quadratic) - sums[which].cells);
        Continuity { sums, missed }
    }

    /// Whether a quadratic through them means something.
    fn is_determined(&self) -> bool {
        self.sums[1].cells >= SIDE_CELLS && self.sums.iter().map(|sums| sums.cells).sum::<f64>() >= QUADRATIC_CELLS
    }

    /// Whether enough is seen of both sides as well.
    fn has_enough(&self) -> bool {
        self.is_determined() && self.sums[0].cells >= SIDE_CELLS
    }

    /// Whether it misses neither by more.
    fn is_close(&self, most: Allowance) -> bool {
        (0..2).all(|which| {
            let QuadraticSums { pixels, smooth, .. } = self.sums[which];
            self.missed[which] <= most.of(1.0, pixels, smooth)
        })
    }

    /// Whether the quadratic explains both regions, and better than their planes; if so, how many pixels of
    /// the neighbour were seen.
    fn is_smooth(&self) -> Option<f64> {
        let by_planes: f64 = self.sums.iter().map(|sums| sums.by_planes - sums.cells).sum();
        let is_better = self.is_better(by_planes, JOINT_GAIN);
        (self.has_enough() && is_better && self.is_close(JOINT_MISS)).then_some(self.sums[0].pixels)
    }

    /// Whether the quadratic explains so much more than what leaves such squares.
    fn is_better(&self, squares: f64, gain: Allowance) -> bool {
        let smooth: f64 = self.sums.iter().map(|sums| sums.smooth).sum();
        self.missed.iter().sum::<f64>() + gain.of(1.0, 1.0, smooth) <= squares
    }

    /// Whether a small region and what is around it bend smoothly.
    fn bends(&self) -> bool {
        let both = self.sums[0].merge(&self.sums[1]);
        let missed: f64 = self.missed.iter().sum();
        let by_plane = both.left_by(&both.solve::<3>()) - both.cells;
        let is_bent = self.is_close(JOINT_MISS) || (self.is_close(LOOSE_MISS) && missed <= ROOF_SHARE * by_plane);
        self.has_enough() && self.is_better(by_plane, LOOSE_GAIN) && is_bent
    }
}

/// Gives the facets of one surface one number in a region image. `parents`: memory to work in.
pub(super) fn join_facets(
    all: &[Region],
    edges: &[Edge],
    noise: &NoiseModel,
    parents: &mut Vec<u16>,
    image: &mut [u16],
    most_regions: usize,
) {
    reserve_to(parents, most_regions);
    parents.extend((0..all.len()).map(|id| id as u16));
    for edge in edges {
        if edge.ids.iter().all(|&id| all[id as usize].is_curved) && !are_apart(all, noise, edge) {
            let [a, b] = edge.ids.map(|id| id as u16);
            unite(parents, a, b);
        }
    }
    image.iter_mut().filter(|id| **id > 0).for_each(|id| *id = find(parents, *id - 1) + 1);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, noise};

    const SIZE: [usize; 2] = [192, 144];

    /// What noise is expected: of a smooth part little.
    fn expected() -> NoiseModel {
        noise(0.2 * SIGMA)
    }

    /// A wall and a ball of that radius in pixels before it, seen by the camera that is assumed.
    fn ball(seed: u64, radius: f64) -> Made {
        // The wall at depth 1/20, the ball's middle at 1/40; a pixel is 1/192 of the depth.
        let (depth, focal) = (1.0 / 40.0, 192.0);
        let r = radius * depth / focal;
        Made::noisy(SIZE, seed, |u, v| {
            let ray = [(u - 96.0) / focal, (v - 72.0) / focal, 1.0];
            let [rays, along] = [dot(ray, ray), ray[2] * depth];
            let root = along * along - rays * (depth * depth - r * r);
            if root > 0.0 { rays / (along - root.sqrt()) } else { 20.0 }
        })
    }

    /// Pixels of curved regions and of all regions, of tiles that lie wholly within a circle or wholly outside.
    fn curved_pixels(stages: &Stages, radius: f64, inside: bool) -> [f64; 2] {
        let (grid, mut pixels) = (stages.grid(), [0.0; 2]);
        for at in 0..grid.len() {
            let [u, v] = grid.middle(grid.place(at));
            let distance = (u - 96.0).hypot(v - 72.0);
            let is_here = if inside { distance < radius - 4.0 } else { distance > radius + 8.0 };
            if is_here && let Some(region) = stages.all().get(grid.region[at] as usize) {
                let own = f64::from(grid.pixels(at));
                pixels = [pixels[0] + if region.is_curved { own } else { 0.0 }, pixels[1] + own];
            }
        }
        pixels
    }

    #[test]
    fn the_facets_of_a_ball_are_curved_and_the_wall_behind_it_is_not() {
        for (seed, radius) in [(1, 50.0), (2, 40.0), (3, 30.0), (4, 55.0)] {
            let stages = Stages::judged(&ball(seed, radius), expected());
            let [curved, all] = curved_pixels(&stages, radius, true);
            assert!(all > 500.0 && curved > 0.9 * all, "{curved} of {all} pixels of a ball of {radius}");
            let [curved, all] = curved_pixels(&stages, radius, false);
            assert!(all > 10_000.0 && curved == 0.0, "{curved} of {all} pixels of the wall");
            let evidence = &stages.run.curvature.evidence;
            assert_eq!(evidence.len(), stages.all().len());
            assert!(stages.all().iter().zip(evidence).all(|(region, sign)| region.is_curved == sign.is_some()));
        }
    }

    #[test]
    fn a_column_is_curved_by_its_own_bow() {
        // One region, whatever growth makes of it.
        let made = Made::noisy(SIZE, 3, |u, _| 40.0 - 0.004 * (u - 96.0).powi(2).min(60.0f64.powi(2)));
        let mut stages = Stages::tiles(&made, expected());
        stages.divide(|column, _| if (10..38).contains(&column) { 0 } else { NONE });
        stages.run.merger.edges.clear();
        stages.judge();
        assert_eq!(stages.run.curvature.evidence, [Some(Evidence::Bow)]);
    }

    #[test]
    fn a_flat_wall_with_white_noise_is_not_curved() {
        for seed in 0..20 {
            let [a, b] = [0.02 * (seed as f64 - 10.0), 0.1 - 0.01 * seed as f64];
            let made = Made::noisy(SIZE, seed, |u, v| 40.0 + a * u + b * v).with_holes(seed, 0.05);
            let stages = Stages::judged(&made, expected());
            assert!(stages.all().iter().all(|region| !region.is_curved), "seed {seed}");
        }
    }

    #[test]
    fn a_roof_of_two_planes_is_not_curved_however_steep() {
        for (seed, slope) in [(1, 0.1), (2, 0.15), (3, 0.2), (4, 0.3), (5, 0.5)] {
            let made = Made::noisy(SIZE, seed, |u, v| 40.0 + 0.02 * v - slope * (u - 94.0).abs());
            let stages = Stages::judged(&made, expected());
            let signs = &stages.run.curvature.evidence;
            let large = stages.all().iter().filter(|region| region.sums.n > 5000.0);
            assert_eq!(large.clone().count(), 2, "slope {slope}");
            assert!(large.clone().all(|region| !region.is_curved), "slope {slope}: {signs:?}");
        }
    }

    #[test]
    fn one_quadratic_runs_on_through_two_halves_of_a_bowl_and_through_no_roof() {
        let halves = |seed: u64, q: fn(f64) -> f64| {
            let mut stages = Stages::tiles(&Made::noisy(SIZE, seed, |u, v| 40.0 + 0.02 * v + q(u - 95.5)), expected());
            stages.divide(|column, _| u32::from(column >= 24));
            stages.list_edges();
            stages.judge();
            let run = &stages.run;
            let context = Context {
                pyramid: &run.pyramid,
                all: &run.regions.all,
                noise: &stages.noise,
                is_redundant: &run.redundancy.is_redundant,
                boxes: &run.curvature.boxes,
                bows: &run.curvature.bows,
            };
            let both = context.joint(0, 1);
            let by_planes = both.sums.iter().map(|sums| sums.by_planes - sums.cells).sum();
            let [is_close, is_better] = [both.is_close(JOINT_MISS), both.is_better(by_planes, JOINT_GAIN)];
            assert_eq!(both.is_smooth().is_some(), is_close && is_better);
            [is_close, is_better]
        };
        for seed in 0..5 {
            assert_eq!(halves(seed, |u| -0.002 * u * u), [true, true], "a bowl, seed {seed}");
            assert_eq!(halves(seed, |u| -0.2 * u.abs()), [false, false], "a roof, seed {seed}");
            assert_eq!(halves(seed, |_| 0.0), [true, false], "a wall, seed {seed}");
        }
    }

    #[test]
    fn a_small_region_and_what_is_around_it_bend_on_a_bowl_and_not_on_a_roof() {
        let bends = |seed: u64, q: fn(f64) -> f64| {
            let made = Made::noisy(SIZE, seed, |u, v| 40.0 + 0.01 * v + SIGMA * q(u - 95.5));
            let mut stages = Stages::tiles(&made, noise(0.0));
            // Eight tiles by four, around the ridge.
            stages.divide(|column, row| if (20..28).contains(&column) && (10..14).contains(&row) { 0 } else { NONE });
            stages.run.merger.edges.clear();
            stages.judge();
            let run = &stages.run;
            let context = Context {
                pyramid: &run.pyramid,
                all: &run.regions.all,
                noise: &stages.noise,
                is_redundant: &run.redundancy.is_redundant,
                boxes: &run.curvature.boxes,
                bows: &run.curvature.bows,
            };
            context.surroundings(0).bends()
        };
        for seed in 0..5 {
            assert!(bends(seed, |u| -0.05 * u * u), "a bowl, seed {seed}");
            assert!(!bends(seed, |u| -0.4 * u.abs()), "a low roof, seed {seed}");
            assert!(!bends(seed, |u| -3.0 * u.abs()), "a steep roof, seed {seed}");
            assert!(!bends(seed, |_| 0.0), "a wall, seed {seed}");
        }
    }

    #[test]
    fn two_surfaces_are_apart_from_six_deviations_on_where_they_touch() {
        for (deviations, expected) in [(0.0, false), (5.5, false), (7.0, true), (-7.0, true)] {
            // They touch in the middle of the tiles before the border, column 62; elsewhere the step is another.
            let q =
                |u: f64, v: f64| 40.0 + if u < 64.0 { 0.0 } else { deviations * SIGMA + 0.1 * (u - 62.0) } + 0.01 * v;
            let made = Made::exact([128, 32], |u, v| q(u as f64, v as f64));
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, _| u32::from(column >= 16));
            stages.list_edges();
            let [edge] = &stages.run.merger.edges[..] else { panic!("one edge between two regions") };
            assert_eq!(are_apart(stages.all(), &stages.noise, edge), expected, "{deviations} deviations");
        }
    }

    #[test]
    fn planes_turn_gently_between_8_and_23_and_a_half_degrees() {
        let camera = Stages::tiles(&Made::exact(SIZE, |_, _| 40.0), noise(0.0)).rays;
        for (degrees, expected) in [(0.0, false), (7.0, false), (9.0, true), (22.5, true), (25.0, false), (90.0, false)]
        {
            // Two planes through the same point of the middle, symmetrically turned about the rows.
            let [one, other] = [-0.5, 0.5].map(|way: f64| {
                let slope = 40.0 / 192.0 * (way * degrees).to_radians().tan();
                let made = Made::exact(SIZE, |u, _| 40.0 + slope * (u as f64 - 96.0));
                let mut stages = Stages::tiles(&made, noise(0.0));
                stages.divide(|_, _| 0);
                stages.all()[0]
            });
            assert_eq!(turn_gently(&one, &other, &camera), expected, "{degrees} degrees");
        }
    }

    /// The number of each of some facets, four tiles wide each, of which some are curved, with steps of so many deviations
    /// between them.
    fn numbers(curved: &[bool], steps: &[f64], gap_after: Option<usize>) -> Vec<u16> {
        let level = |u: f64| steps.iter().take(u as usize / 16).sum::<f64>() * SIGMA;
        let made = Made::exact([16 * curved.len(), 32], |u, v| 40.0 + 0.01 * v as f64 + level(u as f64));
        let mut stages = Stages::tiles(&made, noise(0.0));
        // A gap of two tiles is none's.
        stages.divide(|column, _| {
            let is_gap = gap_after.is_some_and(|facet| [4 * facet + 3, 4 * facet + 2].contains(&column));
            if is_gap { NONE } else { column as u32 / 4 }
        });
        stages.list_edges();
        stages.run.regions.all.iter_mut().zip(curved).for_each(|(region, &is_curved)| region.is_curved = is_curved);
        let mut image: Vec<u16> = (0..=curved.len() as u16).collect();
        let mut parents = Vec::new();
        join_facets(stages.all(), &stages.run.merger.edges, &stages.noise, &mut parents, &mut image, 100);
        assert_eq!(image[0], 0, "no region stays none");
        image[1..].to_vec()
    }

    #[test]
    fn facets_side_by_side_get_one_number_unless_there_is_a_step_between_them() {
        assert_eq!(numbers(&[true; 4], &[0.0; 3], None), [1, 1, 1, 1]);
        assert_eq!(numbers(&[true; 4], &[3.0, -3.0, 3.0], None), [1, 1, 1, 1]);
        assert_eq!(numbers(&[true; 4], &[0.0, 10.0, 0.0], None), [1, 1, 3, 3]);
        assert_eq!(numbers(&[true; 4], &[-10.0, 0.0, 10.0], None), [1, 2, 2, 4]);
    }

    #[test]
    fn facets_that_a_plane_or_nothing_parts_are_two_surfaces() {
        assert_eq!(numbers(&[true, true, false, true], &[0.0; 3], None), [1, 1, 3, 4]);
        assert_eq!(numbers(&[true; 4], &[0.0; 3], Some(1)), [1, 1, 3, 3]);
    }
}
