//! Messages of ROS 2 that came to a program by themselves, rather than in a recording, as frames and cameras.

use crate::error::Result;
pub use crate::messages::CameraInfo;
use crate::messages::{Content, frame};
use depthplanes_io::{Frame, ReadOptions};

/// `sensor_msgs/msg/Image`, but for its header.
#[derive(Clone, Copy, Debug)]
pub struct Image<'a> {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bytes from one row to the next.
    pub step: u32,
    /// How pixels are written: `16UC1` and `mono16` (millimetres), `32FC1` (metres), `8UC1`, `mono8`.
    pub encoding: &'a str,
    /// Whether the first byte of a sample is the highest.
    pub is_big_endian: bool,
    /// The rows.
    pub data: &'a [u8],
}

impl Image<'_> {
    /// The frame of it. What `options` state of the numbers counts before what the encoding says; `name` is for messages only.
    ///
    /// # Errors
    /// [`crate::Error::Source`] for another encoding and for rows that are not all there, and those of
    /// [`depthplanes_io::decode`].
    ///
    /// ```
    /// use depthplanes_video::ros::Image;
    /// let rows = [0x04, 0xb0, 0x04, 0xb1, 0, 0, 0, 0, 0x04, 0xb2, 0x04, 0xb3, 0, 0, 0, 0];
    /// let image = Image { width: 2, height: 2, step: 8, encoding: "16UC1", is_big_endian: true, data: &rows };
    /// let frame = image.frame("/camera/depth/image_rect_raw", &Default::default())?;
    /// assert_eq!(frame.pixels, depthplanes_io::Pixels::U16(vec![1200, 1201, 1202, 1203])); // millimetres
    /// # Ok::<(), depthplanes_video::Error>(())
    /// ```
    pub fn frame(&self, name: &str, options: &ReadOptions) -> Result<Frame> {
        let Image { width, height, step, is_big_endian, data, .. } = *self;
        let content =
            Content::Raw { width, height, step, encoding: self.encoding.into(), is_big_endian, data: data.into() };
        frame(&content, name, options)
    }
}
