//! The rays of a camera's pixels, which the page turns depth into points with.

use crate::message::Arrays;
use crate::picture::step;
use axum::body::Bytes;
use depthplanes::Sensor;
use serde_json::json;

/// A camera as the page gets it, once for all of its frames.
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
        let camera = sensor.intrinsics?;
        let step = step(width, height);
        let ray = |u: usize, v: usize| {
            let ray = sensor.ray(u as f64, v as f64).unwrap_or([f64::NAN; 3]);
            [ray[0] as f32, ray[1] as f32]
        };
        let rows = (0..height).step_by(step);
        let rays: Vec<[f32; 2]> = rows.flat_map(|v| (0..width).step_by(step).map(move |u| ray(u, v))).collect();
        let mut arrays = Arrays::default();
        arrays.add_f32("rays", rays.as_flattened());
        let head = json!({
            "type": "camera",
            "camera": number,
            "width": width.div_ceil(step),
            "height": height.div_ceil(step),
            "spacing": step as f64 / camera.fx.abs(),
        });
        Some(Rays { number, message: arrays.message(head), width, height, sensor: *sensor })
    }

    /// Whether a map of that size and sensor has the same rays.
    pub(crate) fn are_of(&self, width: usize, height: usize, sensor: &Sensor) -> bool {
        let same = (self.width, self.height) == (width, height);
        same && self.sensor.intrinsics == sensor.intrinsics && self.sensor.distortion == sensor.distortion
    }
}
