//! ROS 2 messages that the node takes and sends, field by field as their `.msg` files have them (Humble and later).
//!
//! The golden files of `tests/golden` hold them to the Python package rosbags: `tests/oracles/test_ros2.py`.

use serde::{Deserialize, Serialize};

/// `builtin_interfaces/msg/Time`, and `Duration`, which has the same fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds beside them.
    pub nanosec: u32,
}

/// `std_msgs/msg/Header`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// When the message is of.
    pub stamp: Time,
    /// The frame of coordinates.
    pub frame_id: String,
}

/// `sensor_msgs/msg/Image`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// When it was taken, and the camera's frame of coordinates.
    pub header: Header,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// How pixels are written.
    pub encoding: String,
    /// Not 0 if the first byte of a sample is the highest.
    pub is_bigendian: u8,
    /// Bytes from one row to the next.
    pub step: u32,
    /// The rows.
    #[serde(with = "serde_bytes")]
    pub data: Vec<u8>,
}

/// `sensor_msgs/msg/RegionOfInterest`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RegionOfInterest {
    /// Left column.
    pub x_offset: u32,
    /// Top row.
    pub y_offset: u32,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// Whether the region is of the rectified picture.
    pub do_rectify: bool,
}

/// `sensor_msgs/msg/CameraInfo`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CameraInfo {
    /// When the picture was taken, and the camera's frame of coordinates.
    pub header: Header,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// The model of the lens.
    pub distortion_model: String,
    /// Its coefficients.
    pub d: Vec<f64>,
    /// The camera matrix, row by row.
    pub k: [f64; 9],
    /// The turn of a stereo camera's rectification, row by row.
    pub r: [f64; 9],
    /// The projection of the rectified picture, row by row.
    pub p: [f64; 12],
    /// Pixels in one, along x.
    pub binning_x: u32,
    /// Pixels in one, along y.
    pub binning_y: u32,
    /// The part of the sensor.
    pub roi: RegionOfInterest,
}

/// `std_msgs/msg/String`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Text {
    /// The text.
    pub data: String,
}

/// `geometry_msgs/msg/Point`, and `Vector3`, which has the same fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Metres along x.
    pub x: f64,
    /// Metres along y.
    pub y: f64,
    /// Metres along z.
    pub z: f64,
}

impl From<[f64; 3]> for Point {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Point { x, y, z }
    }
}

/// `geometry_msgs/msg/Quaternion`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quaternion {
    /// Of i.
    pub x: f64,
    /// Of j.
    pub y: f64,
    /// Of k.
    pub z: f64,
    /// The real part.
    pub w: f64,
}

impl Default for Quaternion {
    fn default() -> Self {
        [0.0, 0.0, 0.0, 1.0].into()
    }
}

impl From<[f64; 4]> for Quaternion {
    fn from([x, y, z, w]: [f64; 4]) -> Self {
        Quaternion { x, y, z, w }
    }
}

/// `geometry_msgs/msg/Pose`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Where it is.
    pub position: Point,
    /// How it is turned.
    pub orientation: Quaternion,
}

/// `std_msgs/msg/ColorRGBA`, each part from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Colour {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
    /// 1 if nothing shines through.
    pub a: f32,
}

/// `sensor_msgs/msg/CompressedImage`, which markers have as texture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CompressedImage {
    /// Time and frame of coordinates.
    pub header: Header,
    /// The format.
    pub format: String,
    /// Its bytes.
    #[serde(with = "serde_bytes")]
    pub data: Vec<u8>,
}

/// `visualization_msgs/msg/UVCoordinate`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UvCoordinate {
    /// Across the texture, from 0 to 1.
    pub u: f32,
    /// Up the texture, from 0 to 1.
    pub v: f32,
}

/// `visualization_msgs/msg/MeshFile`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshFile {
    /// Its name.
    pub filename: String,
    /// Its bytes.
    #[serde(with = "serde_bytes")]
    pub data: Vec<u8>,
}

/// `visualization_msgs/msg/Marker`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// When it is of, and the frame of its coordinates.
    pub header: Header,
    /// A marker is known by this and by `id`.
    pub ns: String,
    /// The number of the marker.
    pub id: i32,
    /// What it is ([`Marker::LINE_LIST`] and others).
    pub r#type: i32,
    /// What is to be done with it ([`Marker::ADD`] and others).
    pub action: i32,
    /// Where it is.
    pub pose: Pose,
    /// How large it is: of lines x is their width.
    pub scale: Point,
    /// Its colour.
    pub color: Colour,
    /// How long it is shown; 0 is for ever.
    pub lifetime: Time,
    /// Whether it moves with the frame of coordinates after its time.
    pub frame_locked: bool,
    /// The points of lines.
    pub points: Vec<Point>,
    /// A colour for each point.
    pub colors: Vec<Colour>,
    /// The name of a texture.
    pub texture_resource: String,
    /// A texture.
    pub texture: CompressedImage,
    /// Where its points are on the texture.
    pub uv_coordinates: Vec<UvCoordinate>,
    /// Text.
    pub text: String,
    /// The name of a mesh.
    pub mesh_resource: String,
    /// A mesh.
    pub mesh_file: MeshFile,
    /// Whether the mesh has colours of its own.
    pub mesh_use_embedded_materials: bool,
}

impl Marker {
    /// Type: each two points are a line.
    pub const LINE_LIST: i32 = 5;
    /// Type: text that always faces the viewer.
    pub const TEXT_VIEW_FACING: i32 = 9;
    /// Action: show it.
    pub const ADD: i32 = 0;
    /// Action: take all markers away.
    pub const DELETE_ALL: i32 = 3;
}

/// `visualization_msgs/msg/MarkerArray`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MarkerArray {
    /// The markers, in turn.
    pub markers: Vec<Marker>,
}

/// `geometry_msgs/msg/Transform`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Transform {
    /// Where the origin of the child is in the parent.
    pub translation: Point,
    /// How the child is turned in the parent.
    pub rotation: Quaternion,
}

/// `geometry_msgs/msg/TransformStamped`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TransformStamped {
    /// When it is of, and the parent frame.
    pub header: Header,
    /// The child frame.
    pub child_frame_id: String,
    /// From the child's coordinates to the parent's.
    pub transform: Transform,
}

/// `tf2_msgs/msg/TFMessage`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TfMessage {
    /// The transforms.
    pub transforms: Vec<TransformStamped>,
}
