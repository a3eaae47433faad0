//! A ROS 2 node that finds planes, floor and obstacles in a topic of depth images. docs/ros2.md says what to type.
//!
//! In: `sensor_msgs/Image` and `sensor_msgs/CameraInfo`. Out: label images, planes as JSON and as markers, what is in the way,
//! and the floor's frame of coordinates. The middleware is RustDDS, so that nothing of ROS is needed to build or to run it.
#![forbid(unsafe_code)]

mod camera;
mod floor;
mod markers;
pub mod messages;
mod node;
mod options;
mod outputs;
mod patience;
mod pictures;
mod say;
mod search;
mod topics;

pub use node::Node;
pub use options::Options;
pub use say::{Error, note};
