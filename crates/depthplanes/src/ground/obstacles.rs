//! Things on the floor and holes in it: connected cells of obstacles or drops.

use super::cells::{CELL, Cells};
use super::marks::{DROP, OBSTACLE};
use super::standing::{Spot, Standing};
use crate::detection::PixelBox;
use crate::sensor::Sensor;
use crate::util::memory::reserve_to;

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
    stack: Vec<u32>,
    /// Of each cell of an obstacle its distance along the floor, metres, in obstacles that are large enough; 0 elsewhere.
    pub(super) distances_m: Vec<f32>,
    members: Vec<u32>,
    seen: Vec<bool>,
}

impl Obstacles {
    /// The obstacles, the nearest first.
    pub(super) fn find(&mut self, cells: &Cells, standing: &Standing, sensor: &Sensor, obstacles: &mut Vec<Obstacle>) {
        let count = cells.marks.len();
        self.seen.clear();
        self.seen.resize(count, false);
        self.distances_m.clear();
        self.distances_m.resize(count, 0.0);
        reserve_to(&mut self.stack, count);
        reserve_to(&mut self.members, count);
        obstacles.clear();
        reserve_to(obstacles, count / LEAST_CELLS + 1);
        for start in 0..count {
            let mark = cells.marks[start];
            if self.seen[start] || (mark != OBSTACLE && mark != DROP) {
                continue;
            }
            self.collect(cells, start);
            if self.members.len() >= LEAST_CELLS {
                obstacles.extend(self.describe(cells, standing, sensor, mark == DROP));
            }
        }
        obstacles.sort_unstable_by(|a, b| {
            let place = |of: &Obstacle| (of.bounding_box.v_min, of.bounding_box.u_min);
            a.distance_m.total_cmp(&b.distance_m).then_with(|| place(a).cmp(&place(b)))
        });
    }

    /// The cells connected with one, into `members`.
    fn collect(&mut self, cells: &Cells, start: usize) {
        self.members.clear();
        self.stack.push(start as u32);
        self.seen[start] = true;
        while let Some(at) = self.stack.pop() {
            self.members.push(at);
            let at = at as usize;
            let (column, row) = (at % cells.columns, at / cells.columns);
            for v in row.saturating_sub(1)..=(row + 1).min(cells.rows - 1) {
                for u in column.saturating_sub(1)..=(column + 1).min(cells.columns - 1) {
                    let next = v * cells.columns + u;
                    if !self.seen[next] && is_connected(cells, at, next) {
                        self.seen[next] = true;
                        self.stack.push(next as u32);
                    }
                }
            }
        }
    }

    /// The obstacle that `members` are; `None` if the lens has rays for none of them.
    fn describe(&mut self, cells: &Cells, standing: &Standing, sensor: &Sensor, is_drop: bool) -> Option<Obstacle> {
        let (mut nearest_m, mut nearest): (f64, Option<Spot>) = (f64::INFINITY, None);
        let (mut across, mut height) = ([f64::INFINITY, f64::NEG_INFINITY], 0.0f64);
        let mut bounds = [usize::MAX, usize::MAX, 0, 0];
        for &at in &self.members {
            let at = at as usize;
            let [u, v] = cells.middle(at);
            let Some(ray) = sensor.ray(u, v) else { continue };
            let depth = f64::from(cells.depths[at]);
            let spot = standing.spot(ray.map(|r| r * depth));
            // What is seen of a hole lies behind its edge: the ray passes the floor's level there.
            let place = if is_drop { standing.on_floor(ray).unwrap_or(spot) } else { spot };
            let distance = place.distance_m();
            self.distances_m[at] = distance as f32;
            if distance < nearest_m {
                (nearest_m, nearest) = (distance, Some(place));
            }
            across = [across[0].min(place.right_m), across[1].max(place.right_m)];
            height = if is_drop { height.min(spot.height_m) } else { height.max(spot.height_m) };
            let (column, row) = (at % cells.columns, at / cells.columns);
            bounds = [bounds[0].min(column), bounds[1].min(row), bounds[2].max(column), bounds[3].max(row)];
        }
        let nearest = nearest?;
        let first = |cell: usize| (cell * CELL) as u32;
        let last = |cell: usize| (cell * CELL + CELL - 1) as u32;
        let [u_min, v_min, u_max, v_max] = bounds;
        Some(Obstacle {
            is_drop,
            distance_m: nearest.distance_m(),
            bearing_deg: nearest.bearing_deg(),
            width_m: across[1] - across[0],
            height_m: height,
            bounding_box: PixelBox { u_min: first(u_min), v_min: first(v_min), u_max: last(u_max), v_max: last(v_max) },
        })
    }
}

/// Whether two neighbouring cells are of one obstacle.
fn is_connected(cells: &Cells, a: usize, b: usize) -> bool {
    let (near, far) = (cells.depths[a].min(cells.depths[b]), cells.depths[a].max(cells.depths[b]));
    cells.marks[a] == cells.marks[b] && far <= CONNECTED * near
}
