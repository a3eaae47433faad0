//! Things on the floor and holes in it: connected cells of obstacles or drops.

use super::cells::{CELL, Cells};
use super::marks::{DROP, OBSTACLE};
use super::standing::{Spot, Standing};
use crate::detection::PixelBox;
use crate::util::memory::reserve_to;
use crate::util::union_find;

/// Something that a wheel does not pass: a thing on the floor, or a hole in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Obstacle {
    /// Whether the floor falls here instead of something standing on it: a hole, or stairs that lead down.
    pub is_drop: bool,
    /// Distance of its nearest point along the floor, from the point below the camera, metres. Of a drop: to its near edge.
    pub distance_m: f64,
    /// Degrees to the right of the direction of view, of that point.
    pub bearing_deg: f64,
    /// Extent across the direction of view, metres.
    pub width_m: f64,
    /// Height of its highest point above the floor, metres; of a drop that of its lowest, below 0.
    pub height_m: f64,
    /// Smallest box around it.
    pub bounding_box: PixelBox,
}

/// Cells of the smallest obstacle: a thing 10 cm wide and 5 cm high at 2 m has 3 to 8 in a picture of 640 x 480.
const LEAST_CELLS: usize = 2;
/// Depths that one surface may have in neighbouring cells: their ratio. More is a thing and what is behind it.
const CONNECTED: f32 = 1.08;

/// Finds the obstacles; reuses its memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Obstacles {
    /// A forest of connected cells; a root is its tree's first cell.
    parents: Vec<u32>,
    /// Of roots: cells of the tree.
    sizes: Vec<u32>,
    /// Of roots of trees that are large enough: number in `extents`.
    numbers: Vec<u32>,
    extents: Vec<Extent>,
    /// Of each cell of an obstacle its distance along the floor, metres, in obstacles that are large enough; 0 elsewhere.
    pub(super) distances_m: Vec<f32>,
}

impl Obstacles {
    /// The obstacles, the nearest first.
    pub(super) fn find(&mut self, cells: &Cells, standing: &Standing, obstacles: &mut Vec<Obstacle>) {
        self.connect(cells);
        self.measure(cells, standing);
        reserve_to(obstacles, self.parents.len() / LEAST_CELLS + 1);
        obstacles.extend(self.extents.iter().filter_map(Extent::obstacle));
        obstacles.sort_unstable_by(|a, b| {
            let place = |of: &Obstacle| (of.bounding_box.v_min, of.bounding_box.u_min);
            a.distance_m.total_cmp(&b.distance_m).then_with(|| place(a).cmp(&place(b)))
        });
    }

    /// Unites each cell of an obstacle with those of its eight neighbours that come before it.
    fn connect(&mut self, cells: &Cells) {
        self.parents.clear();
        self.parents.extend(0..cells.marks.len() as u32);
        let columns = cells.columns;
        for at in (0..cells.marks.len()).filter(|&at| is_obstacle(cells.marks[at])) {
            let (column, row) = (at % columns, at / columns);
            let (is_left, is_right) = (column > 0, column + 1 < columns);
            let mut unite_with = |is_there: bool, back: usize| {
                // Mostly both are of one tree by their parents already.
                if is_there && self.parents[at] != self.parents[at - back] && is_connected(cells, at, at - back) {
                    union_find::unite(&mut self.parents, at as u32, (at - back) as u32);
                }
            };
            unite_with(is_left, 1);
            unite_with(row > 0 && is_left, columns + 1);
            unite_with(row > 0, columns);
            unite_with(row > 0 && is_right, columns - 1);
        }
    }

    /// Measures each tree that is large enough.
    fn measure(&mut self, cells: &Cells, standing: &Standing) {
        let count = cells.marks.len();
        let is_one = |at: &usize| is_obstacle(cells.marks[*at]);
        self.sizes.clear();
        self.sizes.resize(count, 0);
        for at in (0..count).filter(is_one) {
            // The root comes before, and so do all on the way to it: their parents are roots by now.
            self.parents[at] = self.parents[self.parents[at] as usize];
            self.sizes[self.parents[at] as usize] += 1;
        }
        self.distances_m.clear();
        self.distances_m.resize(count, 0.0);
        self.numbers.resize(count, 0);
        reserve_to(&mut self.extents, count / LEAST_CELLS + 1);
        for at in (0..count).filter(is_one) {
            let root = self.parents[at] as usize;
            if (self.sizes[root] as usize) < LEAST_CELLS {
                continue;
            }
            if root == at {
                self.numbers[root] = self.extents.len() as u32;
                self.extents.push(Extent::new(cells.marks[at] == DROP));
            }
            let extent = &mut self.extents[self.numbers[root] as usize];
            self.distances_m[at] = extent.add(cells, at, standing).unwrap_or(0.0);
        }
    }
}

/// How far the cells of an obstacle reach.
#[derive(Clone, Copy, Debug)]
struct Extent {
    is_drop: bool,
    nearest: Option<Spot>,
    nearest_m: f64,
    across_m: [f64; 2],
    height_m: f64,
    /// Columns and rows of cells: least of both, largest of both.
    bounds: [usize; 4],
}

impl Extent {
    fn new(is_drop: bool) -> Self {
        let across_m = [f64::INFINITY, f64::NEG_INFINITY];
        let bounds = [usize::MAX, usize::MAX, 0, 0];
        Extent { is_drop, nearest: None, nearest_m: f64::INFINITY, across_m, height_m: 0.0, bounds }
    }

    /// Adds a cell; its distance along the floor, or `None` if the lens has no ray for it.
    fn add(&mut self, cells: &Cells, at: usize, standing: &Standing) -> Option<f32> {
        let ray = cells.rays[at]?;
        let depth = f64::from(cells.depths[at]);
        let spot = standing.spot(ray.map(|r| r * depth));
        // What is seen of a hole lies behind its edge: the ray passes the floor's level there.
        let place = if self.is_drop { standing.on_floor(ray).unwrap_or(spot) } else { spot };
        let distance = place.distance_m();
        if distance < self.nearest_m {
            (self.nearest_m, self.nearest) = (distance, Some(place));
        }
        self.across_m = [self.across_m[0].min(place.right_m), self.across_m[1].max(place.right_m)];
        self.height_m = if self.is_drop { self.height_m.min(spot.height_m) } else { self.height_m.max(spot.height_m) };
        let (column, row) = (at % cells.columns, at / cells.columns);
        let [left, top, right, bottom] = self.bounds;
        self.bounds = [left.min(column), top.min(row), right.max(column), bottom.max(row)];
        Some(distance as f32)
    }

    /// `None` if the lens has rays for none of its cells.
    fn obstacle(&self) -> Option<Obstacle> {
        let nearest = self.nearest?;
        let first = |cell: usize| (cell * CELL) as u32;
        let last = |cell: usize| (cell * CELL + CELL - 1) as u32;
        let [left, top, right, bottom] = self.bounds;
        Some(Obstacle {
            is_drop: self.is_drop,
            distance_m: nearest.distance_m(),
            bearing_deg: nearest.bearing_deg(),
            width_m: self.across_m[1] - self.across_m[0],
            height_m: self.height_m,
            bounding_box: PixelBox { u_min: first(left), v_min: first(top), u_max: last(right), v_max: last(bottom) },
        })
    }
}

fn is_obstacle(mark: u8) -> bool {
    mark == OBSTACLE || mark == DROP
}

/// Whether two neighbouring cells are of one obstacle.
fn is_connected(cells: &Cells, a: usize, b: usize) -> bool {
    let (near, far) = (cells.depths[a].min(cells.depths[b]), cells.depths[a].max(cells.depths[b]));
    cells.marks[a] == cells.marks[b] && far <= CONNECTED * near
}
