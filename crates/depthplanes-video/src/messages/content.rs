//! What a message says, whatever its encoding.

use std::borrow::Cow;

/// A message with a depth map or a camera.
#[derive(Debug)]
pub(crate) struct Message<'a> {
    /// When it was taken, seconds; none where it does not say.
    pub(crate) stamp_s: Option<f64>,
    /// The name of the camera's frame of coordinates.
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
}

/// Numbers of a camera that ROS and Foxglove alike have.
#[derive(Default)]
pub(super) struct CameraNumbers {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) distortion_model: String,
    pub(super) d: Vec<f64>,
    pub(super) k: Vec<f64>,
    pub(super) r: Vec<f64>,
    pub(super) p: Vec<f64>,
    /// In x and y; ROS alone has it, as the region.
    pub(super) binning: [u32; 2],
    /// Left column, top row, width and height.
    pub(super) region: [u32; 4],
}

impl CameraNumbers {
    /// As the reader of camera files takes it.
    pub(super) fn json(&self) -> Content<'static> {
        let [x_offset, y_offset, width, height] = self.region;
        let camera = serde_json::json!({
            "width": self.width, "height": self.height, "distortion_model": self.distortion_model,
            "D": self.d, "K": self.k, "R": self.r, "P": self.p,
            "binning_x": self.binning[0], "binning_y": self.binning[1],
            "roi": {"x_offset": x_offset, "y_offset": y_offset, "width": width, "height": height},
        });
        Content::Camera(camera.to_string())
    }
}

/// Seconds of a stamp; none for one that is all 0, which nobody set.
pub(super) fn seconds(seconds: i64, nanoseconds: u32) -> Option<f64> {
    ((seconds, nanoseconds) != (0, 0)).then(|| seconds as f64 + 1e-9 * f64::from(nanoseconds))
}
