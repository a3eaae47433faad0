//! The camera that pages know, so that its rays are sent once for all of its frames.

use axum::body::Bytes;
use depthplanes::Sensor;
use depthplanes_io::page::camera_message;
use serde_json::json;

/// A camera as the page gets it.
#[derive(Debug)]
pub(crate) struct Rays {
    pub(crate) number: u64,
    pub(crate) message: Bytes,
    width: usize,
    height: usize,
    sensor: Sensor,
}

impl Rays {
    /// The camera of a map, unless its rays are not known.
    pub(crate) fn new(number: u64, width: usize, height: usize, sensor: &Sensor) -> Option<Self> {
        let message = camera_message(width, height, sensor)?.with(json!({"camera": number}));
        Some(Rays { number, message: message.into_bytes().into(), width, height, sensor: *sensor })
    }

    /// Whether a map of that size and sensor has the same rays.
    pub(crate) fn are_of(&self, width: usize, height: usize, sensor: &Sensor) -> bool {
        let same = (self.width, self.height) == (width, height);
        same && self.sensor.intrinsics == sensor.intrinsics && self.sensor.distortion == sensor.distortion
    }
}
