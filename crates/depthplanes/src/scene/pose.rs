//! Where the camera stands: pose, picture size and intrinsics.
//!
//! World coordinates: x right, y forward, z up, metres, the floor usually at z = 0. With the pose's
//! three angles at 0 the camera looks along +y, upright. Camera coordinates are those of
//! [`crate::camera`]: x right, y down, z forward.

use super::exact::{Vec3, add, dot, scale, sin_cos_deg, sub};
use crate::camera::Intrinsics;
use crate::error::{Error, Result};
use crate::limits::{MAX_PIXELS, MAX_SIDE};

/// Position and direction of a camera in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Centre of the camera, world metres; the third number is its height.
    pub position_m: [f64; 3],
    /// Turn to the left about the vertical, degrees.
    pub yaw_deg: f64,
    /// Tilt downwards, degrees.
    pub pitch_deg: f64,
    /// Turn about the optical axis, degrees; positive lowers the camera's right side.
    pub roll_deg: f64,
}

impl Pose {
    /// A camera above the world's origin, level across the picture.
    pub fn at_height(height_m: f64, pitch_deg: f64) -> Self {
        Pose { position_m: [0.0, 0.0, height_m], yaw_deg: 0.0, pitch_deg, roll_deg: 0.0 }
    }
}

/// A placed pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Focal lengths and principal point, pixels.
    pub intrinsics: Intrinsics,
    /// Columns of the picture.
    pub width: usize,
    /// Rows of the picture.
    pub height: usize,
    /// Where it stands.
    pub pose: Pose,
}

/// Focal length of a Kinect v1's 640 x 480 depth camera, pixels (OpenKinect's fit: f b = 43.4 px m,
/// 578 px at a baseline of 7.5 cm; ROS kinect_calibration: about 580).
pub(super) const KINECT_FOCAL_PX: f64 = 580.0;

impl Camera {
    /// A camera with the field of view of a Kinect v1 (58 x 45 degrees at 4:3; other shapes keep
    /// the whole of it inside), principal point in the middle.
    ///
    /// # Errors
    /// As [`Camera::check`].
    pub fn kinect(width: usize, height: usize, pose: Pose) -> Result<Self> {
        let focal = KINECT_FOCAL_PX * (width as f64 / 640.0).min(height as f64 / 480.0);
        let middle = |side: usize| (side as f64 - 1.0) / 2.0;
        let intrinsics = Intrinsics { fx: focal, fy: focal, cx: middle(width), cy: middle(height) };
        let camera = Camera { intrinsics, width, height, pose };
        camera.check()?;
        Ok(camera)
    }

    /// Checks size, intrinsics and pose.
    ///
    /// # Errors
    /// [`Error::Size`] for a picture that no map can hold, [`Error::Camera`] for intrinsics or a
    /// pose that is not finite.
    pub fn check(&self) -> Result<()> {
        let (width, height) = (self.width, self.height);
        let fits = |side| (1..=MAX_SIDE).contains(&side);
        if !fits(width) || !fits(height) || width * height > MAX_PIXELS {
            return Err(Error::Size { width, height });
        }
        let Intrinsics { fx, fy, cx, cy } = self.intrinsics;
        Intrinsics::new(fx, fy, cx, cy)?;
        let [x, y, z] = self.pose.position_m;
        let Pose { yaw_deg, pitch_deg, roll_deg, .. } = self.pose;
        let named = [("x", x), ("y", y), ("height", z), ("yaw", yaw_deg), ("pitch", pitch_deg), ("roll", roll_deg)];
        match named.iter().find(|(_, given)| !given.is_finite()) {
            Some(&(name, given)) => Err(Error::Camera { name, given, accepted: "a finite number" }),
            None => Ok(()),
        }
    }

    /// The change from world to camera coordinates.
    pub(super) fn extrinsics(&self) -> Extrinsics {
        let Pose { position_m, yaw_deg, pitch_deg, roll_deg } = self.pose;
        let (sin_yaw, cos_yaw) = sin_cos_deg(yaw_deg);
        let (sin_pitch, cos_pitch) = sin_cos_deg(pitch_deg);
        let (sin_roll, cos_roll) = sin_cos_deg(roll_deg);
        let level = [-sin_yaw, cos_yaw, 0.0];
        let right = [cos_yaw, sin_yaw, 0.0];
        let up = [0.0, 0.0, 1.0];
        let forward = sub(scale(level, cos_pitch), scale(up, sin_pitch));
        let down = scale(add(scale(level, sin_pitch), scale(up, cos_pitch)), -1.0);
        Extrinsics {
            origin: position_m,
            axes: [
                add(scale(right, cos_roll), scale(down, sin_roll)),
                sub(scale(down, cos_roll), scale(right, sin_roll)),
                forward,
            ],
        }
    }
}

/// A rigid change of coordinates: the new origin and axes, in the old coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extrinsics {
    origin: Vec3,
    axes: [Vec3; 3],
}

impl Extrinsics {
    pub(super) fn point(&self, world: Vec3) -> Vec3 {
        self.direction(sub(world, self.origin))
    }

    pub(super) fn direction(&self, world: Vec3) -> Vec3 {
        self.axes.map(|axis| dot(axis, world))
    }

    /// The same axes, seen from a point `x_m` further along the first of them: the projector or
    /// the second camera of a rectified rig.
    pub(super) fn shifted_right(&self, x_m: f64) -> Self {
        Extrinsics { origin: add(self.origin, scale(self.axes[0], x_m)), axes: self.axes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_turn_the_way_they_say() {
        let seen = |pose: Pose, world| Camera::kinect(64, 48, pose).unwrap().extrinsics().point(world);
        let level = Pose::at_height(1.0, 0.0);
        assert_eq!(seen(level, [0.5, 2.0, 1.25]), [0.5, -0.25, 2.0]);
        let ahead = [0.0, 2.0, 1.0];
        assert!(seen(Pose { yaw_deg: 10.0, ..level }, ahead)[0] > 0.3, "turning left moves things to the right");
        assert!(seen(Pose { pitch_deg: 10.0, ..level }, ahead)[1] < -0.3, "looking down moves things up");
        let beside = [1.0, 2.0, 1.0];
        assert!(seen(Pose { roll_deg: 10.0, ..level }, beside)[1] < -0.1, "a lowered right side sees them higher");
    }

    #[test]
    fn a_camera_that_is_none_is_an_error() {
        assert!(matches!(Camera::kinect(0, 5, Pose::at_height(1.0, 0.0)), Err(Error::Size { .. })));
        let lost = Pose::at_height(f64::NAN, 0.0);
        assert!(matches!(Camera::kinect(4, 5, lost), Err(Error::Camera { name: "height", .. })));
    }
}
