//! What a message says, whatever its encoding.

use depthplanes::track::CameraPose;
use depthplanes_io::camera_file::{CameraFile, parse};
use std::borrow::Cow;

/// A message with a depth map, a camera, or what tells of gravity.
#[derive(Debug)]
pub(crate) struct Message<'a> {
    /// When it was taken, seconds; none where it does not say.
    pub(crate) stamp_s: Option<f64>,
    /// The name of the frame of coordinates.
    pub(crate) frame_id: String,
    pub(crate) content: Content<'a>,
}

#[derive(Debug)]
pub(crate) enum Content<'a> {
    /// Pixels as they are, in rows of `step` bytes.
    Raw { width: u32, height: u32, step: u32, encoding: String, is_big_endian: bool, data: Cow<'a, [u8]> },
    /// Pixels in a format of their own.
    Packed { format: String, data: Cow<'a, [u8]> },
    /// A camera, in JSON with ROS's names.
    Camera(String),
    /// What an inertial sensor measures.
    Imu(Imu),
    /// How frames of coordinates lie to each other.
    Transforms(Vec<Transform>),
}

/// What an inertial sensor measures, in its own axes; none of what it does not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Imu {
    /// Specific force, m/s2: gravity's upwards where the sensor rests (REP 145).
    pub(crate) acceleration: Option<[f64; 3]>,
    /// Angular velocity, rad/s.
    pub(crate) turn_rate: Option<[f64; 3]>,
}

/// How one frame of coordinates lies in another.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Transform {
    pub(crate) parent: String,
    pub(crate) child: String,
    /// The child's pose: child to parent.
    pub(crate) pose: CameraPose,
}

/// `sensor_msgs/msg/CameraInfo`, and what other messages of cameras have of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CameraInfo {
    /// Columns of the picture that it is for.
    pub width: u32,
    /// Rows of that picture.
    pub height: u32,
    /// `plumb_bob`, `rational_polynomial`, `equidistant` and the like.
    pub distortion_model: String,
    /// Its coefficients.
    pub d: Vec<f64>,
    /// The camera matrix, 3 x 3, row by row.
    pub k: Vec<f64>,
    /// The turn of a stereo camera's rectification, 3 x 3.
    pub r: Vec<f64>,
    /// The projection of the rectified picture, 3 x 4.
    pub p: Vec<f64>,
    /// Pixels in one, along x and y; 0 is 1.
    pub binning: [u32; 2],
    /// The part of the sensor: left column, top row, width and height; all 0 for the whole.
    pub region: [u32; 4],
}

impl CameraInfo {
    /// The camera, as one in a file.
    ///
    /// # Errors
    /// Those of [`parse`]: a message that no calibration filled in, a model that is not known.
    ///
    /// ```
    /// use depthplanes_video::ros::CameraInfo;
    /// let k = vec![580.0, 0.0, 319.5, 0.0, 580.0, 239.5, 0.0, 0.0, 1.0];
    /// let message = CameraInfo { width: 640, height: 480, distortion_model: "plumb_bob".into(), k, ..CameraInfo::default() };
    /// assert_eq!(message.camera()?.intrinsics.cx, 319.5);
    /// # Ok::<(), depthplanes_io::Error>(())
    /// ```
    pub fn camera(&self) -> depthplanes_io::Result<CameraFile> {
        parse(&self.json())
    }

    /// As the reader of camera files takes it.
    pub(super) fn json(&self) -> String {
        let [x_offset, y_offset, width, height] = self.region;
        let camera = serde_json::json!({
            "width": self.width, "height": self.height, "distortion_model": self.distortion_model,
            "D": self.d, "K": self.k, "R": self.r, "P": self.p,
            "binning_x": self.binning[0], "binning_y": self.binning[1],
            "roi": {"x_offset": x_offset, "y_offset": y_offset, "width": width, "height": height},
        });
        camera.to_string()
    }
}

/// Seconds of a stamp; none for one that is all 0, which nobody set.
pub(super) fn seconds(seconds: i64, nanoseconds: u32) -> Option<f64> {
    ((seconds, nanoseconds) != (0, 0)).then(|| seconds as f64 + 1e-9 * f64::from(nanoseconds))
}
