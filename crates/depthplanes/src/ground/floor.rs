//! Which planes are the floor, and how the camera stands above it.
//!
//! In: the planes of a detection and the direction that is up. Out: the lowest level surface that is not small, in all its
//! pieces, with the camera's height, tilt and roll and their standard deviations from the plane's covariance.

use super::space::{angle_deg, height_m, height_sd_m};
use super::up::Vote;
use crate::camera::{HessianNormalForm, Intrinsics};
use crate::detection::{MetricPlane, Plane};
use crate::limits::MAX_PLANES;
use crate::util::memory::reserve_to;
use crate::util::vec3::{dot, unit};

/// The floor, and the camera above it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Floor {
    /// Label of its largest piece, whose plane it is.
    pub label: u16,
    /// Labels of all its pieces, the largest first.
    pub labels: Vec<u16>,
    /// Where it is, camera coordinates; the normal points up.
    pub plane: HessianNormalForm,
    /// Covariance of (nx, ny, nz, distance) of the plane, as [`MetricPlane::covariance`].
    pub covariance: [[f64; 4]; 4],
    /// Direction of view along the floor, of length 1, camera coordinates; of a camera that looks straight down that of its
    /// picture's upper edge. With `plane.normal` and `right` these are the axes of somebody who stands below the camera.
    pub ahead: [f64; 3],
    /// To the right of `ahead` along the floor, of length 1.
    pub right: [f64; 3],
    /// Pixels of all pieces.
    pub pixel_count: usize,
    /// Height of the camera above it, metres, and its standard deviation.
    pub height_m: f64,
    /// Standard deviation of `height_m`, metres.
    pub height_sd_m: f64,
    /// How far the camera looks down, degrees: 0 along the floor, 90 straight down, below 0 upwards.
    pub tilt_deg: f64,
    /// Standard deviation of `tilt_deg`, degrees.
    pub tilt_sd_deg: f64,
    /// Turn about the optical axis, degrees; positive where the camera's right side is lower.
    pub roll_deg: f64,
    /// Standard deviation of `roll_deg`, degrees.
    pub roll_sd_deg: f64,
    /// How sure it is that this is the floor, 0 to 1: what speaks for it as a share of that and what speaks against it. No
    /// probability; below 0.5 look at the picture.
    pub confidence: f64,
}

impl Floor {
    /// Where a ray meets the floor: metres to the right and ahead of the point below the camera; `None` of a ray that does
    /// not meet it. Rays are those of [`crate::Sensor::ray`].
    pub fn place(&self, ray: [f64; 3]) -> Option<[f64; 2]> {
        self.plane.point_along(ray).map(|point| [dot(self.right, point), dot(self.ahead, point)])
    }

    /// The point in camera coordinates, metres, that is so far to the right, ahead and above the point of the floor below
    /// the camera.
    pub fn point(&self, [right_m, ahead_m, height_m]: [f64; 3]) -> [f64; 3] {
        let up = height_m - self.plane.distance;
        std::array::from_fn(|i| right_m * self.right[i] + ahead_m * self.ahead[i] + up * self.plane.normal[i])
    }
}

/// Degrees that a level plane may lean against up, which itself is off by some: of an accelerometer 1 or 2, of an estimate
/// from small planes 5.
const LEVEL_DEG: f64 = 10.0;
/// Degrees between two pieces of the floor.
const PIECE_DEG: f64 = 6.0;
/// Metres by which the middle of one piece lies off the plane of another: carpets and thresholds are floor, and the
/// smooth error of depth cameras at 3 m is as large. Pieces whose planes are less certain may be three standard deviations
/// off, up to the second number.
const PIECE_M: [f64; 2] = [0.04, 0.1];
/// Share of the pixels of all level planes that the floor has at least; below that it is a thing mirrored in the floor or
/// a false plane below it. Recorded frames have false ones of 1.3 %, and floors of 12 % and more.
const FLOOR_SHARE: f64 = 0.05;
/// Metres below the floor at which a plane is none of its pieces that err, and speaks against it.
const BELOW_M: f64 = 0.1;
/// What always speaks against a floor, as [`Vote::agreement`]: half of what planes turned at random agree by.
const DOUBT: f64 = 0.1;

/// Finds the floor; `None` if no plane can be it. `known_height_m`: the camera's height, if somebody knows it, which
/// decides between several levels. `labels` is memory for the floor's.
pub(super) fn find(
    planes: &[Plane],
    vote: &Vote,
    known_height_m: Option<f64>,
    camera: &Intrinsics,
    labels: &mut Vec<u16>,
) -> Option<Floor> {
    let least_cosine = LEVEL_DEG.to_radians().cos();
    let level = || metric(planes).filter(move |(_, plane)| dot(plane.plane.normal, vote.up) >= least_cosine);
    let all: usize = level().map(|(plane, _)| plane.pixel_count).sum();
    let mut best: Option<(f64, usize)> = None;
    for (plane, base) in level() {
        let pieces = || level().filter(|(_, other)| is_piece(other, &base));
        let pixels: usize = pieces().map(|(plane, _)| plane.pixel_count).sum();
        // The largest piece speaks for all of them, or else the plane of a sliver would.
        let is_largest = pieces().all(|(other, _)| other.pixel_count <= plane.pixel_count);
        if !is_largest || (pixels as f64) < FLOOR_SHARE * all as f64 {
            continue;
        }
        let rank = match known_height_m {
            Some(known) => (base.plane.distance - known).abs(),
            None => dot(vote.up, base.centroid_m),
        };
        if best.is_none_or(|(least, _)| rank < least) {
            best = Some((rank, usize::from(plane.label)));
        }
    }
    let base = planes[best?.1 - 1].metric?;
    let mut labels = std::mem::take(labels);
    reserve_to(&mut labels, MAX_PLANES);
    labels.extend(level().filter(|(_, other)| is_piece(other, &base)).map(|(plane, _)| plane.label));
    let pixel_count = labels.iter().map(|&label| planes[usize::from(label) - 1].pixel_count).sum();
    let mut floor = stand(&base, labels, camera);
    floor.pixel_count = pixel_count;
    floor.confidence = vote.agreement / (vote.agreement + vote.rival + DOUBT) * uncontested(planes, &floor);
    Some(floor)
}

/// The planes that are known in metres.
fn metric(planes: &[Plane]) -> impl Iterator<Item = (&Plane, MetricPlane)> {
    planes.iter().filter_map(|plane| Some((plane, plane.metric?)))
}

/// Whether two level planes are pieces of one floor; the same the other way round.
fn is_piece(a: &MetricPlane, b: &MetricPlane) -> bool {
    let holds = |floor: &MetricPlane, other: &MetricPlane| {
        let sd_m = height_sd_m(&floor.covariance, other);
        height_m(&floor.plane, other.centroid_m).abs() <= (3.0 * sd_m).clamp(PIECE_M[0], PIECE_M[1])
    };
    holds(a, b) && holds(b, a) && angle_deg(a.plane.normal, b.plane.normal) <= PIECE_DEG
}

/// The floor's pixels as a share of these and those of planes below it: what a table's top, taken for the floor, has much of.
fn uncontested(planes: &[Plane], floor: &Floor) -> f64 {
    let lower = metric(planes).filter(|(_, plane)| height_m(&floor.plane, plane.centroid_m) < -BELOW_M);
    let below: usize = lower.map(|(plane, _)| plane.pixel_count).sum();
    floor.pixel_count as f64 / (floor.pixel_count + below) as f64
}

/// Height, tilt and roll of the camera, with standard deviations to first order in the covariance of the plane.
///
/// With the normal n = (x, y, z) in a frame of x right and y down, `tilt = asin(-z)` and `roll = atan2(-x, -y)`.
fn stand(base: &MetricPlane, labels: Vec<u16>, camera: &Intrinsics) -> Floor {
    // Axes of a camera whose y points up (fy below 0), or whose x points left, turned to right and down.
    let [right, down] = [camera.fx.signum(), camera.fy.signum()];
    let [x, y, z] = base.plane.normal;
    let (x, y) = (right * x, down * y);
    let across = (x * x + y * y).max(f64::MIN_POSITIVE);
    let covariance = base.covariance;
    let [to_right, ahead] = axes(base.plane.normal, camera);
    let sd_deg = |gradient: [f64; 3]| {
        let row = |i: usize| (0..3).map(|j| gradient[i] * covariance[i][j] * gradient[j]).sum::<f64>();
        (0..3).map(row).sum::<f64>().max(0.0).sqrt().to_degrees()
    };
    Floor {
        label: labels[0],
        labels,
        plane: base.plane,
        covariance,
        ahead,
        right: to_right,
        pixel_count: 0,
        height_m: base.plane.distance,
        height_sd_m: covariance[3][3].max(0.0).sqrt(),
        tilt_deg: (-z).clamp(-1.0, 1.0).asin().to_degrees(),
        tilt_sd_deg: sd_deg([0.0, 0.0, across.sqrt().recip()]),
        roll_deg: (-x).atan2(-y).to_degrees(),
        roll_sd_deg: sd_deg([right * y / across, -down * x / across, 0.0]),
        confidence: 0.0,
    }
}

/// To the right and ahead along the floor.
fn axes(up: [f64; 3], camera: &Intrinsics) -> [[f64; 3]; 2] {
    // Within 3 degrees of straight down the axis of view says nothing.
    let is_down = up[2].abs() > 0.9986;
    let view = if is_down { [0.0, -camera.fy.signum(), 0.0] } else { [0.0, 0.0, 1.0] };
    let lift = dot(view, up);
    let ahead = unit(std::array::from_fn(|i| view[i] - lift * up[i])).unwrap_or(view);
    let [x, y, z] = ahead;
    // Pictures whose y axis points up have coordinates of the other hand.
    let hand = camera.fx.signum() * camera.fy.signum();
    let side = [y * up[2] - z * up[1], z * up[0] - x * up[2], x * up[1] - y * up[0]];
    [side.map(|x| hand * x), ahead]
}
