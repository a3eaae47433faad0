//! Messages that have a depth map or a camera in them. A new type is a row of [`TYPES`].

mod cdr;
mod content;
mod foxglove;
mod json;
mod picture;
mod ros;
mod wire;

pub use content::CameraInfo;
pub(crate) use content::{Content, Message};
pub(crate) use picture::{depth_form, frame};

/// A type of messages that is read.
pub(crate) struct MessageType {
    /// Its name.
    pub(crate) schema: &'static str,
    /// How its messages are encoded.
    pub(crate) encoding: &'static str,
    /// Whether it has a camera rather than a picture.
    pub(crate) is_camera: bool,
    /// Takes a message apart; what is wrong with it.
    pub(crate) read: fn(&[u8]) -> Result<Message<'_>, String>,
}

const fn picture(
    schema: &'static str,
    encoding: &'static str,
    read: fn(&[u8]) -> Result<Message<'_>, String>,
) -> MessageType {
    MessageType { schema, encoding, is_camera: false, read }
}

const fn camera(
    schema: &'static str,
    encoding: &'static str,
    read: fn(&[u8]) -> Result<Message<'_>, String>,
) -> MessageType {
    MessageType { schema, encoding, is_camera: true, read }
}

/// All types.
pub(crate) const TYPES: &[MessageType] = &[
    picture("sensor_msgs/msg/Image", "cdr", ros::image),
    picture("sensor_msgs/msg/CompressedImage", "cdr", ros::compressed_image),
    camera("sensor_msgs/msg/CameraInfo", "cdr", ros::camera_info),
    picture("foxglove.RawImage", "protobuf", foxglove::raw_image),
    picture("foxglove.CompressedImage", "protobuf", foxglove::compressed_image),
    camera("foxglove.CameraCalibration", "protobuf", foxglove::camera_calibration),
    picture("foxglove.RawImage", "json", json::raw_image),
    picture("foxglove.CompressedImage", "json", json::compressed_image),
    camera("foxglove.CameraCalibration", "json", json::camera_calibration),
];

/// The type of a channel's messages, if it is read.
pub(crate) fn type_of(schema: &str, encoding: &str) -> Option<&'static MessageType> {
    TYPES.iter().find(|row| row.schema == schema && row.encoding == encoding)
}
