//! The ground of C: the floor, what stands on it, and what each plane and pixel is to somebody who stands there.

use crate::border::{guarded, keep_last, lent, required};
use crate::error::{Result, dp_status};
use depthplanes::ground::{ClassifiedPlane, Floor, GroundFinder, Obstacle, PlaneClass, Sector, Step, Up};
use depthplanes::{AnyView, Detection, Sensor};
use std::mem::MaybeUninit;
use std::ptr::null;

/// The floor, and how the camera stands above it. Standard deviations follow from the noise of the sensor.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_floor {
    /// Label of its largest piece, whose plane it is.
    pub label: u16,
    /// Pixels of all pieces.
    pub pixel_count: usize,
    /// Its unit normal, up, camera coordinates.
    pub normal: [f64; 3],
    /// Direction of view along the floor, of length 1, camera coordinates.
    pub ahead: [f64; 3],
    /// To the right of `ahead` along the floor, of length 1.
    pub right: [f64; 3],
    /// Height of the camera above it, metres.
    pub height_m: f64,
    /// Standard deviation of `height_m`.
    pub height_sd_m: f64,
    /// How far the camera looks down, degrees: 0 along the floor, 90 straight down, below 0 upwards.
    pub tilt_deg: f64,
    /// Standard deviation of `tilt_deg`.
    pub tilt_sd_deg: f64,
    /// Turn about the optical axis, degrees; above 0 where the camera's right side is lower.
    pub roll_deg: f64,
    /// Standard deviation of `roll_deg`.
    pub roll_sd_deg: f64,
    /// How sure it is that this is the floor, 0 to 1; below 0.5 look at the picture.
    pub confidence: f64,
}

/// What a plane is to somebody who stands on the floor.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum dp_plane_class {
    /// None of the others.
    DP_OTHER = 0,
    /// The floor, or a piece of it.
    DP_FLOOR = 1,
    /// Level, faces down, at 1.8 m or higher.
    DP_CEILING = 2,
    /// Upright and at least a quarter of a square metre.
    DP_WALL = 3,
    /// Level, faces up, too high for a step: the top of a table, a seat, a shelf.
    DP_TABLE = 4,
    /// Faces up and slopes by at most 30 degrees.
    DP_RAMP = 5,
    /// Level, faces up, and no more than 25 cm above or below the floor or another step.
    DP_STEP = 6,
}

/// A plane, by where it is above the floor.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_classified_plane {
    /// Its label.
    pub label: u16,
    /// What it is.
    pub plane_class: dp_plane_class,
    /// Height of its middle above the floor, metres; NaN if its place is not known.
    pub height_m: f64,
    /// Angle between its normal and the floor's, degrees: 0 of level planes that face up, 90 of upright ones, 180 of ceilings.
    pub slope_deg: f64,
}

/// Something that a wheel does not pass: a thing on the floor, or a hole in it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_obstacle {
    /// Whether the floor falls here instead of something standing on it.
    pub is_drop: bool,
    /// Distance of its nearest point along the floor, from the point below the camera, metres. Of a drop: to its near edge.
    pub distance_m: f64,
    /// Degrees to the right of the direction of view, of that point.
    pub bearing_deg: f64,
    /// Extent across the direction of view, metres.
    pub width_m: f64,
    /// Height of its highest point above the floor, metres; of a drop that of its lowest, below 0.
    pub height_m: f64,
    /// Leftmost column of its pixels.
    pub u_min: u32,
    /// Topmost row.
    pub v_min: u32,
    /// Rightmost column, inclusive.
    pub u_max: u32,
    /// Bottom row, inclusive.
    pub v_max: u32,
}

/// A range of bearings, and how far the floor is free in it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_sector {
    /// Its left end, degrees to the right of the direction of view.
    pub from_deg: f64,
    /// Its right end.
    pub to_deg: f64,
    /// Metres along the floor from the point below the camera to the nearest obstacle or drop, or to the farthest floor that is
    /// seen; 0 where no floor is.
    pub free_m: f64,
    /// Whether an obstacle or a drop ends it. Otherwise nothing is known of what comes after `free_m`.
    pub is_blocked: bool,
}

/// A step up from the floor, or down from it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_step {
    /// Label of its tread.
    pub label: u16,
    /// 1 for the first step up from the floor, then 2, ...; -1 for the first one down.
    pub order: i32,
    /// Height of the tread above the floor, metres; below 0 of steps down.
    pub height_m: f64,
    /// Height from the level before, metres; below 0 of steps down.
    pub rise_m: f64,
    /// Distance from the near edge of the step before to its own, metres; NaN of the first.
    pub run_m: f64,
    /// Distance of the near edge from the point below the camera, metres, along the direction of the stair.
    pub distance_m: f64,
}

impl From<&Floor> for dp_floor {
    fn from(floor: &Floor) -> Self {
        dp_floor {
            label: floor.label,
            pixel_count: floor.pixel_count,
            normal: floor.plane.normal,
            ahead: floor.ahead,
            right: floor.right,
            height_m: floor.height_m,
            height_sd_m: floor.height_sd_m,
            tilt_deg: floor.tilt_deg,
            tilt_sd_deg: floor.tilt_sd_deg,
            roll_deg: floor.roll_deg,
            roll_sd_deg: floor.roll_sd_deg,
            confidence: floor.confidence,
        }
    }
}

impl From<&ClassifiedPlane> for dp_classified_plane {
    fn from(of: &ClassifiedPlane) -> Self {
        let plane_class = match of.class {
            PlaneClass::Floor => dp_plane_class::DP_FLOOR,
            PlaneClass::Ceiling => dp_plane_class::DP_CEILING,
            PlaneClass::Wall => dp_plane_class::DP_WALL,
            PlaneClass::Table => dp_plane_class::DP_TABLE,
            PlaneClass::Ramp => dp_plane_class::DP_RAMP,
            PlaneClass::Step => dp_plane_class::DP_STEP,
            _ => dp_plane_class::DP_OTHER,
        };
        let [height_m, slope_deg] = [of.height_m, of.slope_deg].map(|number| number.unwrap_or(f64::NAN));
        dp_classified_plane { label: of.label, plane_class, height_m, slope_deg }
    }
}

impl From<&Obstacle> for dp_obstacle {
    fn from(of: &Obstacle) -> Self {
        let bounds = of.bounding_box;
        dp_obstacle {
            is_drop: of.is_drop,
            distance_m: of.distance_m,
            bearing_deg: of.bearing_deg,
            width_m: of.width_m,
            height_m: of.height_m,
            u_min: bounds.u_min,
            v_min: bounds.v_min,
            u_max: bounds.u_max,
            v_max: bounds.v_max,
        }
    }
}

impl From<&Sector> for dp_sector {
    fn from(of: &Sector) -> Self {
        dp_sector { from_deg: of.from_deg, to_deg: of.to_deg, free_m: of.free_m, is_blocked: of.is_blocked }
    }
}

impl From<&Step> for dp_step {
    fn from(of: &Step) -> Self {
        dp_step {
            label: of.label,
            order: of.order,
            height_m: of.height_m,
            rise_m: of.rise_m,
            run_m: of.run_m.unwrap_or(f64::NAN),
            distance_m: of.distance_m,
        }
    }
}

/// The ground of a map, and the memory that frames share. What its functions return belongs to it, and is valid until
/// `dp_detector_ground` writes to it again or it is freed. Threads may read one at the same time.
#[derive(Default)]
pub struct dp_ground {
    finder: GroundFinder,
    floor: Option<dp_floor>,
    /// What each pixel is; memory of frames with a floor.
    marks: Vec<u8>,
    planes: Vec<dp_classified_plane>,
    obstacles: Vec<dp_obstacle>,
    sectors: Vec<dp_sector>,
    steps: Vec<dp_step>,
}

/// Replaces the values by others, in the same memory.
fn refill<'a, From, To: std::convert::From<&'a From>>(values: &mut Vec<To>, by: &'a [From]) {
    values.clear();
    values.extend(by.iter().map(To::from));
}

impl dp_ground {
    /// Forgets what was found.
    pub(crate) fn clear(&mut self) {
        self.floor = None;
        self.marks.clear();
        self.planes.clear();
        self.obstacles.clear();
        self.sectors.clear();
        self.steps.clear();
    }

    /// Finds the ground of a map by what was found in it.
    ///
    /// # Errors
    /// Those of [`GroundFinder::find`].
    pub(crate) fn find(&mut self, map: AnyView<'_>, found: &Detection, sensor: &Sensor) -> depthplanes::Result<()> {
        let ground = self.finder.find(map, found, sensor)?;
        self.floor = ground.floor.as_ref().map(dp_floor::from);
        self.marks.extend_from_slice(&ground.marks);
        refill(&mut self.planes, &ground.planes);
        refill(&mut self.obstacles, &ground.obstacles);
        refill(&mut self.sectors, &ground.sectors);
        refill(&mut self.steps, &ground.steps);
        Ok(())
    }
}

/// States something of a ground. The text of an error is that of `dp_error(NULL)`.
fn state(ground: Option<&mut dp_ground>, act: impl FnOnce(&mut dp_ground) -> Result<()>) -> dp_status {
    let done = guarded(|| act(required("ground", ground)?));
    done.inspect_err(keep_last).map_or_else(|error| error.status, |()| dp_status::DP_OK)
}

/// A ground of no map, to be written to by `dp_detector_ground`. Keep it for all frames of a camera: its memory is used again.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_new() -> Box<dp_ground> {
    Box::default()
}

/// Frees a ground; null is none.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_free(ground: Option<Box<dp_ground>>) {
    drop(ground);
}

/// States the direction that is up, in camera coordinates (x right, y down, z forward), of any length: what an accelerometer at
/// rest measures, turned into the camera's axes. It may change from frame to frame. Without it up is estimated from the planes, for
/// a camera that is upright to within 60 degrees. The text of an error is that of `dp_error(NULL)`.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_set_up(ground: Option<&mut dp_ground>, x: f64, y: f64, z: f64) -> dp_status {
    state(ground, |ground| {
        ground.finder.set_up(Up::known([x, y, z])?);
        Ok(())
    })
}

/// States the camera's height above the floor that it stands on, metres: of several levels the one nearest to it is the floor.
/// Without it the lowest is. The text of an error is that of `dp_error(NULL)`.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_set_camera_height(ground: Option<&mut dp_ground>, height_m: f64) -> dp_status {
    state(ground, |ground| {
        ground.finder = ground.finder.clone().camera_height_m(height_m)?;
        Ok(())
    })
}

/// The floor; null if there is none in view, none that can be told from a wall, or nothing was looked for.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_floor(ground: Option<&dp_ground>) -> *const dp_floor {
    ground.and_then(|ground| ground.floor.as_ref()).map_or(null(), std::ptr::from_ref)
}

/// What each pixel is, row by row without gaps: 0 not known, 1 floor, 2 obstacle, 4 drop, 8 overhead (above 2 m). Null without
/// a floor.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_marks(ground: Option<&dp_ground>) -> *const u8 {
    lent(ground.map(|ground| &ground.marks), None)
}

/// What each plane of the detection is, in its order. Their number is written to `count`, unless that is null. Null without a floor.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_planes(
    ground: Option<&dp_ground>,
    count: Option<&mut MaybeUninit<usize>>,
) -> *const dp_classified_plane {
    lent(ground.map(|ground| &ground.planes), count)
}

/// What stands on the floor and where it falls, the nearest first. Their number is written to `count`, unless that is null. Null if
/// there is nothing.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_obstacles(
    ground: Option<&dp_ground>,
    count: Option<&mut MaybeUninit<usize>>,
) -> *const dp_obstacle {
    lent(ground.map(|ground| &ground.obstacles), count)
}

/// How far the floor is free, from left to right across the picture. Their number is written to `count`, unless that is null.
/// Null without a floor.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_sectors(
    ground: Option<&dp_ground>,
    count: Option<&mut MaybeUninit<usize>>,
) -> *const dp_sector {
    lent(ground.map(|ground| &ground.sectors), count)
}

/// Steps up from the floor, then steps down. Their number is written to `count`, unless that is null. Null if there are none.
#[unsafe(no_mangle)]
pub extern "C" fn dp_ground_steps(
    ground: Option<&dp_ground>,
    count: Option<&mut MaybeUninit<usize>>,
) -> *const dp_step {
    lent(ground.map(|ground| &ground.steps), count)
}
