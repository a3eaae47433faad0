//! The rays of a camera's pixels, which a page turns depth into points with.

use super::message::Message;
use super::picture::step;
use depthplanes::Sensor;
use serde_json::json;

/// The message of the camera of maps of a size, with the array `rays`, once for all of its frames; `None` unless its rays are
/// known.
pub fn camera_message(width: usize, height: usize, sensor: &Sensor) -> Option<Message> {
    let camera = sensor.intrinsics?;
    let step = step(width, height);
    let ray = |u: usize, v: usize| {
        let ray = sensor.ray(u as f64, v as f64).unwrap_or([f64::NAN; 3]);
        [ray[0] as f32, ray[1] as f32]
    };
    let rows = (0..height).step_by(step);
    let rays: Vec<[f32; 2]> = rows.flat_map(|v| (0..width).step_by(step).map(move |u| ray(u, v))).collect();
    let mut message = Message::new(json!({
        "type": "camera",
        "width": width.div_ceil(step),
        "height": height.div_ceil(step),
        "spacing": step as f64 / camera.fx.abs(),
    }));
    message.add_f32("rays", rays.as_flattened());
    Some(message)
}
