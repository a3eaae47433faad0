//! Bytes to frames and detections to bytes: the only crate with codecs.

mod frame;
pub mod outputs;

pub use frame::{Frame, Pixels};
