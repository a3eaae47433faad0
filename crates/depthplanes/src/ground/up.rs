//! Which direction is up, as seen by the camera: stated, or estimated from the planes of a scene.
//!
//! Rooms have a direction that floors, tables and ceilings face and walls are at right angles to. Each plane's normal that
//! a camera held as usual could have above it is tried; what all planes together say decides ("Manhattan" scenes, Coughlan
//! and Yuille 1999, but with one direction instead of three). The largest plane is no better guess than any: often it is a
//! wall.
//!
//! Not for a camera that looks straight down or up, or lies on its side: there a wall and a floor look alike, and up has to
//! be stated.

use super::space::angle_deg;
use crate::camera::Intrinsics;
use crate::detection::{MetricPlane, Plane};
use crate::error::{Error, Result};
use crate::util::vec3::{dot, unit};

/// What is known of the direction that is up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Up {
    /// Nothing: it is estimated from the planes. The camera is upright to within 60 degrees.
    #[default]
    Estimated,
    /// This direction, of length 1, in camera coordinates (x right, y down, z forward): (0, -1, 0) of a level camera.
    Known([f64; 3]),
}

impl Up {
    /// A direction in camera coordinates, of any length; what an accelerometer at rest measures, turned into the camera's
    /// axes, points up.
    ///
    /// # Errors
    /// [`Error::Text`] unless it is three finite numbers, not all 0.
    pub fn known(direction: [f64; 3]) -> Result<Self> {
        let wrong = || {
            let [x, y, z] = direction;
            let accepted =
                "a direction in camera coordinates, three finite numbers that are not all 0: 0,-1,0 of a level camera";
            Error::Text { name: "up", given: format!("{x},{y},{z}"), accepted: accepted.into() }
        };
        Ok(Up::Known(unit(direction).ok_or_else(wrong)?))
    }

    /// `stated` or `estimated`, as in records.
    pub fn name(&self) -> &'static str {
        match self {
            Up::Estimated => "estimated",
            Up::Known(_) => "stated",
        }
    }
}

/// Planes that have a say, largest first; smaller ones say little, and the time grows with the square of their number.
const VOTERS: usize = 64;
/// Share of the valid pixels of a plane that has a say.
const VOTER_SHARE: f64 = 0.002;
/// Degrees off parallel or perpendicular at which a plane no longer speaks for a direction: three standard deviations of
/// normals of recorded planes of a thousand pixels.
const AGREES_DEG: f64 = 10.0;
/// Cosine of the most that a camera leans where up is not stated: 60 degrees.
const UPRIGHT: f64 = 0.5;
/// Degrees between two directions that are not the same one.
const OTHER_DEG: f64 = 20.0;
/// Least agreement that is an answer, as [`Vote::agreement`]. On recorded frames true floors have 0.24 and more, frames
/// without one up to 0.13.
const LEAST: f64 = 0.2;

/// The direction that is up, and how sure that is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vote {
    pub(super) up: [f64; 3],
    /// Share (0 to 1) of the pixels of planes that lie parallel or perpendicular to it, less the farther it is from the
    /// usual up; 1 where it was stated.
    pub(super) agreement: f64,
    /// The same of the next best direction; 0 where there is none.
    pub(super) rival: f64,
}

/// What is up, as stated or by the planes; `None` if they do not say. `valid_pixels` are those of the map.
pub(super) fn find(up: Up, planes: &[Plane], valid_pixels: usize, camera: &Intrinsics) -> Option<Vote> {
    let usual = [0.0, -camera.fy.signum(), 0.0];
    match up {
        Up::Known(up) => Some(Vote { up, agreement: 1.0, rival: 0.0 }),
        Up::Estimated => estimate(planes, VOTER_SHARE * valid_pixels as f64, usual),
    }
}

fn estimate(planes: &[Plane], least_pixels: f64, usual: [f64; 3]) -> Option<Vote> {
    let voters = || {
        let large = planes.iter().filter(move |plane| plane.pixel_count as f64 >= least_pixels);
        large.filter_map(|plane| Some((plane.metric?, plane.pixel_count as f64))).take(VOTERS)
    };
    let all: f64 = voters().map(|(_, pixels)| pixels).sum();
    let agreement = |up: [f64; 3]| {
        let says = |(plane, pixels): (MetricPlane, f64)| pixels * agrees(plane.plane.normal, up);
        dot(up, usual) * voters().map(says).sum::<f64>() / all
    };
    let mut judged = [(0.0, [0.0; 3]); VOTERS];
    let upright = voters().map(|(plane, _)| plane.plane.normal).filter(|&normal| dot(normal, usual) >= UPRIGHT);
    let count = judged.iter_mut().zip(upright).map(|(judged, normal)| *judged = (agreement(normal), normal)).count();
    let judged = &judged[..count];
    let better = |a: &&(f64, [f64; 3]), b: &&(f64, [f64; 3])| a.0.total_cmp(&b.0);
    let &(best, up) = judged.iter().max_by(better)?;
    let rival = judged.iter().filter(|&&(_, other)| angle_deg(other, up) > OTHER_DEG).max_by(better);
    (best >= LEAST).then(|| Vote { up, agreement: best, rival: rival.map_or(0.0, |&(rival, _)| rival) })
}

/// How well a normal suits a direction that is up, 0 to 1: 1 for level and upright planes, falling with the square of the
/// angle.
fn agrees(normal: [f64; 3], up: [f64; 3]) -> f64 {
    let angle = angle_deg(normal, up);
    let off = [angle, (90.0 - angle).abs(), 180.0 - angle].into_iter().fold(f64::INFINITY, f64::min);
    (1.0 - (off / AGREES_DEG).powi(2)).max(0.0)
}
