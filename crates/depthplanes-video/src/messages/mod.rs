//! Messages that have a depth map, a camera, or what tells of gravity in them. A new type is a row of [`TYPES`].

mod cdr;
mod content;
mod foxglove;
mod json;
mod picture;
mod ros;
mod wire;

pub use content::CameraInfo;
pub(crate) use content::{Content, Imu, Message, Transform};
pub(crate) use picture::{depth_form, frame};

/// What messages of a type have in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A map, or a picture.
    Picture,
    /// A camera.
    Camera,
    /// Readings of an inertial sensor.
    Imu,
    /// How frames of coordinates lie to each other.
    Transforms,
}

/// A type of messages that is read.
pub(crate) struct MessageType {
    /// Its name.
    pub(crate) schema: &'static str,
    /// How its messages are encoded.
    pub(crate) encoding: &'static str,
    pub(crate) kind: Kind,
    /// Takes a message apart; what is wrong with it.
    pub(crate) read: fn(&[u8]) -> Result<Message<'_>, String>,
}

const fn row(
    schema: &'static str,
    encoding: &'static str,
    kind: Kind,
    read: fn(&[u8]) -> Result<Message<'_>, String>,
) -> MessageType {
    MessageType { schema, encoding, kind, read }
}

/// All types.
pub(crate) const TYPES: &[MessageType] = &[
    row("sensor_msgs/msg/Image", "cdr", Kind::Picture, ros::image),
    row("sensor_msgs/msg/CompressedImage", "cdr", Kind::Picture, ros::compressed_image),
    row("sensor_msgs/msg/CameraInfo", "cdr", Kind::Camera, ros::camera_info),
    row("sensor_msgs/msg/Imu", "cdr", Kind::Imu, ros::imu),
    row("tf2_msgs/msg/TFMessage", "cdr", Kind::Transforms, ros::transforms),
    row("foxglove.RawImage", "protobuf", Kind::Picture, foxglove::raw_image),
    row("foxglove.CompressedImage", "protobuf", Kind::Picture, foxglove::compressed_image),
    row("foxglove.CameraCalibration", "protobuf", Kind::Camera, foxglove::camera_calibration),
    row("foxglove.RawImage", "json", Kind::Picture, json::raw_image),
    row("foxglove.CompressedImage", "json", Kind::Picture, json::compressed_image),
    row("foxglove.CameraCalibration", "json", Kind::Camera, json::camera_calibration),
];

/// The type of a channel's messages, if it is read.
pub(crate) fn type_of(schema: &str, encoding: &str) -> Option<&'static MessageType> {
    TYPES.iter().find(|row| row.schema == schema && row.encoding == encoding)
}
