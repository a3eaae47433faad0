//! The floor from above, as an occupancy grid that planners take.
//!
//! In: a map and its ground. Out: square cells on the floor. Free is where floor is seen, occupied where an obstacle or a
//! drop is, and unknown all else: what lies behind things, and the floor that is too near for the camera to see.
//!
//! Floor that is seen over a low thing is free as well: a planner finds the way around. A grid is what one frame shows;
//! mappers put many together.

use super::cells::{CELL, Cells};
use super::finder::Ground;
use super::floor::Floor;
use super::marks::{DROP, FLOOR, OBSTACLE};
use super::obstacles::{Obstacle, Obstacles};
use super::standing::{Spot, Standing};
use crate::error::{Error, Result};
use crate::map::{AnyView, with_view};
use crate::sensor::Sensor;
use crate::util::memory::reserve_to;

/// What is known of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Occupancy {
    /// Nothing.
    #[default]
    Unknown,
    /// Floor is seen, and nothing stands on it.
    Free,
    /// Something stands on the floor, or the floor falls.
    Occupied,
}

/// Cells on the floor, in the axes of REP 103: x ahead of the camera and y to its left, from the point of the floor below it.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct OccupancyGrid {
    /// Side of a cell, metres.
    pub resolution_m: f64,
    /// Cells along x.
    pub width: usize,
    /// Cells along y.
    pub height: usize,
    /// x and y of the corner of the first cell, metres: the least of both.
    pub origin_m: [f64; 2],
    /// Cells along x, from the least y to the largest, as in ROS' `nav_msgs/OccupancyGrid`.
    pub cells: Vec<Occupancy>,
}

impl OccupancyGrid {
    /// What is known at a place, metres ahead and to the left; unknown outside of the grid.
    pub fn at(&self, [x_m, y_m]: [f64; 2]) -> Occupancy {
        let index = |at_m: f64, origin_m: f64| ((at_m - origin_m) / self.resolution_m).floor();
        let (column, row) = (index(x_m, self.origin_m[0]), index(y_m, self.origin_m[1]));
        let is_inside = |at: f64, cells: usize| at >= 0.0 && at < cells as f64;
        if !is_inside(column, self.width) || !is_inside(row, self.height) {
            return Occupancy::Unknown;
        }
        self.cells[row as usize * self.width + column as usize]
    }
}

/// Metres of a cell where nothing is stated: what ROS' mappers (slam_toolbox, gmapping, Cartographer) and Nav2's cost maps
/// take, and about what depth cameras err by at 4 m.
pub const RESOLUTION_M: f64 = 0.05;
/// Finest and coarsest cells, metres: below a centimetre no depth camera tells cells apart, above a metre no robot fits between.
const RESOLUTIONS_M: [f64; 2] = [0.01, 1.0];
/// Metres from the camera's foot along an axis to the last cell: beyond, the smooth error of depth cameras is larger than a
/// robot.
const FARTHEST_M: f64 = 10.0;

/// Makes grids of frame after frame, and reuses its memory.
///
/// ```
/// use depthplanes::ground::{GridMapper, GroundFinder, Occupancy};
/// use depthplanes::{Detector, scene::Spec};
/// let frame = "corridor:sensor=kinect2,size=320x240".parse::<Spec>()?.frame()?;
/// let mut detector = Detector::default().sensor(frame.sensor);
/// let (mut finder, mut mapper) = (GroundFinder::default(), GridMapper::default());
/// let ground = finder.find(frame.view(), detector.detect(frame.view())?, &frame.sensor)?;
/// let grid = mapper.grid(frame.view(), &frame.sensor, ground)?;
/// // The corridor is 2 m wide: free 3 m ahead, and its walls stand 1 m to the left and to the right.
/// assert_eq!(grid.at([3.0, 0.0]), Occupancy::Free);
/// let left = |y_m: f64| grid.at([3.0, y_m]) == Occupancy::Occupied;
/// assert!((90..110).any(|centimetres| left(f64::from(centimetres) / 100.0)));
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct GridMapper {
    resolution_m: f64,
    cells: Cells,
    obstacles: Obstacles,
    found: Vec<Obstacle>,
    /// All cells up to [`FARTHEST_M`].
    plan: Plan,
    grid: OccupancyGrid,
}

impl Default for GridMapper {
    fn default() -> Self {
        GridMapper {
            resolution_m: RESOLUTION_M,
            cells: Cells::default(),
            obstacles: Obstacles::default(),
            found: Vec::new(),
            plan: Plan::default(),
            grid: OccupancyGrid::default(),
        }
    }
}

impl GridMapper {
    /// With cells of that side.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless it is 0.01 to 1 m.
    pub fn resolution_m(self, resolution_m: f64) -> Result<Self> {
        let [finest, coarsest] = RESOLUTIONS_M;
        if !(finest..=coarsest).contains(&resolution_m) {
            let accepted = format!("metres of a cell's side, {finest} to {coarsest}");
            return Err(Error::Parameter { name: "resolution", given: resolution_m, accepted });
        }
        Ok(GridMapper { resolution_m, ..self })
    }

    /// The grid of a map by the ground that was found in it, as large as what is known and the camera's foot need. Without a
    /// floor that is one unknown cell.
    ///
    /// # Errors
    /// [`Error::Labels`] if the ground is not one of a map of that size.
    pub fn grid<'m>(
        &mut self,
        map: impl Into<AnyView<'m>>,
        sensor: &Sensor,
        ground: &Ground,
    ) -> Result<&OccupancyGrid> {
        self.grid_of_view(map.into(), sensor, ground)
    }

    fn grid_of_view(&mut self, map: AnyView<'_>, sensor: &Sensor, ground: &Ground) -> Result<&OccupancyGrid> {
        self.plan.clear(self.resolution_m);
        if let Some(floor) = &ground.floor {
            let pixels = map.width() * map.height();
            if ground.marks.len() != pixels {
                return Err(Error::Labels { given: ground.marks.len(), pixels });
            }
            let standing = Standing::new(floor);
            self.cells.fill(map, sensor, &ground.marks);
            self.obstacles.find(&self.cells, &standing, &mut self.found);
            let seen = Seen { map, sensor, floor, standing, marks: &ground.marks };
            self.plan.free(&seen);
            self.plan.occupy(&seen, &self.cells, &self.obstacles.distances_m);
        }
        self.plan.crop(&mut self.grid);
        Ok(&self.grid)
    }
}

/// A frame whose marks are known.
struct Seen<'a> {
    map: AnyView<'a>,
    sensor: &'a Sensor,
    floor: &'a Floor,
    standing: Standing,
    marks: &'a [u8],
}

impl Seen<'_> {
    /// Where the ray of a pixel meets the floor, x and y in metres.
    fn on_floor(&self, [u, v]: [usize; 2]) -> Option<[f64; 2]> {
        let [right, ahead] = self.floor.place(self.sensor.ray(u as f64, v as f64)?)?;
        Some([ahead, -right])
    }

    /// Where the surface of a pixel is.
    fn spot(&self, [u, v]: [usize; 2]) -> Option<Spot> {
        let value = with_view!(self.map, view => f64::from(view.row(v)[u]));
        let depth = self.sensor.value_kind.depth_m(value)?;
        let ray = self.sensor.ray(u as f64, v as f64)?;
        Some(self.standing.spot(ray.map(|r| r * depth)))
    }
}

/// Cells on all sides of the camera's foot, which is the corner in their middle.
#[derive(Clone, Debug, Default)]
struct Plan {
    resolution_m: f64,
    /// Cells from the foot to a side.
    reach: usize,
    cells: Vec<Occupancy>,
}

impl Plan {
    fn clear(&mut self, resolution_m: f64) {
        self.resolution_m = resolution_m;
        self.reach = (FARTHEST_M / resolution_m).ceil() as usize;
        self.cells.clear();
        self.cells.resize(4 * self.reach * self.reach, Occupancy::Unknown);
    }

    /// Number of the cell at a place; `None` beyond the last.
    fn index(&self, place_m: [f64; 2]) -> Option<usize> {
        let [column, row] = place_m.map(|at| (at / self.resolution_m).floor() + self.reach as f64);
        let side = 2 * self.reach;
        let is_inside = |at: f64| at >= 0.0 && at < side as f64;
        (is_inside(column) && is_inside(row)).then(|| row as usize * side + column as usize)
    }

    fn set(&mut self, place_m: [f64; 2], to: Occupancy) {
        if let Some(at) = self.index(place_m) {
            self.cells[at] = to;
        }
    }

    /// Frees the cells where floor is seen. Pixels far away are farther apart than cells: between two that touch in a column
    /// of the picture all is free.
    fn free(&mut self, seen: &Seen<'_>) {
        let (width, height) = (seen.map.width(), seen.map.height());
        for u in 0..width {
            let mut before: Option<[f64; 2]> = None;
            for v in (0..height).rev() {
                let is_floor = seen.marks[v * width + u] == FLOOR;
                let place = if is_floor { seen.on_floor([u, v]) } else { None };
                if let Some(to) = place {
                    self.free_between(before.unwrap_or(to), to);
                }
                before = place;
            }
        }
    }

    fn free_between(&mut self, from: [f64; 2], to: [f64; 2]) {
        let apart_m = (to[0] - from[0]).hypot(to[1] - from[1]);
        // Two places in a cell, so that a line across a corner leaves none out.
        let parts = (2.0 * apart_m / self.resolution_m).ceil().clamp(1.0, 4.0 * self.reach as f64);
        for part in 1..=parts as usize {
            let share = part as f64 / parts;
            self.set(std::array::from_fn(|i| from[i] + share * (to[i] - from[i])), Occupancy::Free);
        }
    }

    /// Occupies the cells of obstacles, and those where the floor falls: what is seen of a hole lies behind its edge.
    fn occupy(&mut self, seen: &Seen<'_>, cells: &Cells, distances_m: &[f32]) {
        let width = seen.map.width();
        for at in (0..cells.marks.len()).filter(|&at| distances_m[at] > 0.0) {
            let mark = cells.marks[at];
            let [first, top] = [at % cells.columns * CELL, at / cells.columns * CELL];
            for v in top..top + CELL {
                for u in (first..first + CELL).filter(|u| seen.marks[v * width + u] == mark) {
                    let spot = || seen.spot([u, v]).map(|spot| [spot.ahead_m, -spot.right_m]);
                    let place = match mark {
                        OBSTACLE => spot(),
                        DROP => seen.on_floor([u, v]).or_else(spot),
                        _ => None,
                    };
                    place.into_iter().for_each(|place| self.set(place, Occupancy::Occupied));
                }
            }
        }
    }

    /// The part of it that is known, with the camera's foot.
    fn crop(&self, grid: &mut OccupancyGrid) {
        let (side, reach) = (2 * self.reach, self.reach);
        let (mut low, mut high) = ([reach; 2], [reach + 1; 2]);
        for (row, cells) in self.cells.chunks_exact(side).enumerate() {
            let is_known = |cell: &Occupancy| *cell != Occupancy::Unknown;
            let Some(first) = cells.iter().position(is_known) else { continue };
            let last = cells.iter().rposition(is_known).unwrap_or(first);
            low = [low[0].min(first), low[1].min(row)];
            high = [high[0].max(last + 1), high[1].max(row + 1)];
        }
        grid.resolution_m = self.resolution_m;
        (grid.width, grid.height) = (high[0] - low[0], high[1] - low[1]);
        grid.origin_m = low.map(|at| (at as f64 - reach as f64) * self.resolution_m);
        reserve_to(&mut grid.cells, self.cells.len());
        for row in low[1]..high[1] {
            grid.cells.extend_from_slice(&self.cells[row * side + low[0]..row * side + high[0]]);
        }
    }
}
