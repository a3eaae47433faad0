//! A camera that moves through a scene: a loop of small swings and turns about where the scene puts it.

use super::exact::sin_cos_deg;
use super::frame::SceneFrame;
use super::pose::{Camera, Pose};
use super::render::render_frame;
use super::sensors::SensorModel;
use super::spec::Spec;
use super::staged::Staged;
use crate::error::Result;
use crate::track::CameraPose;

/// Frames of a camera that moves through a scene, with the truth of each.
///
/// The same surfaces keep their numbers ([`super::TruthPlane::surface`]), so that a plane can be followed by the truth.
/// At speed 1 the camera is where it began after [`Walk::LOOP`] frames. The white part of the noise and what edges make of depth differ
/// from frame to frame; the smooth part is that of the camera, and stays.
///
/// ```
/// use depthplanes::scene::Walk;
/// let walk = Walk::new("room:size=160x120".parse()?, 1.0);
/// let (first, later) = (walk.frame(0)?, walk.frame(30)?);
/// assert_ne!(first.truth.labels, later.truth.labels);
/// assert_ne!(walk.pose(0)?.translation_m(), walk.pose(30)?.translation_m());
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Walk {
    staged: Staged,
    sensor: SensorModel,
    seed: u64,
    size: [usize; 2],
    speed: f64,
}

/// Metres that the camera swings to each side, forth and up.
const SWINGS_M: [f64; 3] = [0.30, 0.20, 0.05];
/// Degrees that it turns: yaw, pitch, roll.
const TURNS_DEG: [f64; 3] = [12.0, 4.0, 2.0];

impl Walk {
    /// Frames of a loop at speed 1: ten seconds at 30 frames a second, up to 0.3 m and 15 degrees a second.
    pub const LOOP: u64 = 300;

    /// A walk through a scene. The speed is in loops per [`Walk::LOOP`] frames: 1 is a slow hand, 0 stands still.
    pub fn new(spec: Spec, speed: f64) -> Self {
        let staged = (spec.scene.build)(spec.seed);
        Walk { staged, sensor: spec.sensor, seed: spec.seed, size: [spec.width, spec.height], speed }
    }

    /// Makes a frame.
    ///
    /// # Errors
    /// As [`Camera::check`].
    pub fn frame(&self, index: u64) -> Result<SceneFrame> {
        let noise = self.seed.wrapping_mul(1_000_003).wrapping_add(index);
        render_frame(&self.staged.scene, &self.camera(index)?, self.sensor, noise, Some(self.seed))
    }

    /// Where the camera is in a frame.
    ///
    /// # Errors
    /// As [`Camera::check`].
    pub fn pose(&self, index: u64) -> Result<CameraPose> {
        let eye = self.camera(index)?.extrinsics();
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        CameraPose::new(axes.map(|axis| eye.direction(axis)), self.place(index).position_m)
    }

    /// For each pixel of a frame the pixel of an earlier one that shows the same spot of the same surface, by the truth,
    /// if one does. `now` and `before` are the frames of those indices.
    ///
    /// # Errors
    /// As [`Camera::check`].
    pub fn same_spots(&self, now: (u64, &SceneFrame), before: (u64, &SceneFrame)) -> Result<Vec<Option<u32>>> {
        let (camera, earlier) = (self.camera(now.0)?, self.camera(before.0)?);
        let (eye, earlier_eye) = (self.pose(now.0)?, earlier.extrinsics());
        let (truth, then) = (&now.1.truth, &before.1.truth);
        let same_spot = |at: usize| {
            let (u, v) = ((at % truth.width) as f64, (at / truth.width) as f64);
            let seen = camera.intrinsics.ray(u, v).map(|r| r * truth.depth_m[at]);
            let turned = eye.rotation().map(|row| row[0] * seen[0] + row[1] * seen[1] + row[2] * seen[2]);
            let [x, y, z] = earlier_eye.point([0, 1, 2].map(|k| turned[k] + eye.translation_m()[k]));
            let camera = earlier.intrinsics;
            let (u, v) = ((camera.fx * x / z + camera.cx).round(), (camera.fy * y / z + camera.cy).round());
            let is_inside = z > 0.0 && u >= 0.0 && v >= 0.0 && u < then.width as f64 && v < then.height as f64;
            let place = is_inside.then(|| v as usize * then.width + u as usize)?;
            (truth.surfaces[at] != 0 && then.surfaces[place] == truth.surfaces[at]).then_some(place as u32)
        };
        Ok((0..truth.surfaces.len()).map(same_spot).collect())
    }

    fn camera(&self, index: u64) -> Result<Camera> {
        let [width, height] = self.size;
        Camera::kinect(width, height, self.place(index))
    }

    /// Each coordinate swings once or a few times a loop, so that the path closes and does not retrace itself.
    fn place(&self, index: u64) -> Pose {
        let degrees = 360.0 * (self.speed * index as f64 / Self::LOOP as f64).fract();
        let sine = |times: f64| sin_cos_deg(times * degrees).0;
        let Pose { position_m: [x, y, z], yaw_deg, pitch_deg, roll_deg } = self.staged.pose;
        let [right, ahead, up] = SWINGS_M;
        let [yaw, pitch, roll] = TURNS_DEG;
        Pose {
            position_m: [x + right * sine(1.0), y + ahead * sine(2.0), z + up * sine(3.0)],
            yaw_deg: yaw_deg + yaw * sine(2.0),
            pitch_deg: pitch_deg + pitch * sine(3.0),
            roll_deg: roll_deg + roll * sine(1.0),
        }
    }
}
