//! What pages in a browser draw: frames, cameras and parameters as messages.
//!
//! In: a frame and what was found in it. Out: a head of JSON and arrays of numbers; docs/live.md describes them.

mod camera;
mod frame;
mod message;
mod parameter;
mod picture;

pub use camera::camera_message;
pub use frame::{Shown, frame_message};
pub use message::Message;
pub use parameter::parameter_record;
