//! Distances along the rays of the pixels become depths along the optical axis.
//!
//! Simulators, laser scanners and some time-of-flight drivers deliver how far a point is from the camera, r. Its depth is
//! `z = r / sqrt(x^2 + y^2 + 1)` for the ray (x, y, 1) of the pixel.

use depthplanes::{Sensor, ValueKind};

use crate::error::{Error, Result};
use crate::frame::{Frame, Pixels};

/// Turns a frame of distances into one of depth, in the same unit, as floats.
///
/// # Errors
/// [`Error::Parameter`] unless the frame's values are lengths and its camera is known.
pub(crate) fn to_depth(frame: &mut Frame) -> Result<()> {
    let refused = |given, accepted| Err(Error::parameter("--ray-distance", given, accepted));
    let ValueKind::Depth { .. } = frame.sensor.value_kind else {
        return refused("for disparity", "a map of distances; --encoding states its unit");
    };
    if frame.sensor.intrinsics.is_none() {
        return refused(
            "without a camera",
            "a camera as well: --intrinsics fx,fy,cx,cy, --camera FILE or a --preset that has one",
        );
    }
    let sensor = frame.sensor;
    let valid = |value: f64| {
        value != 0.0
            && frame.missing != Some(value)
            && frame.valid_range.is_none_or(|(low, high)| (low..=high).contains(&value))
    };
    let mut depths: Vec<f32> = match &frame.pixels {
        Pixels::U8(values) => values.iter().map(|&value| f32::from(value)).collect(),
        Pixels::U16(values) => values.iter().map(|&value| f32::from(value)).collect(),
        Pixels::F32(values) => values.clone(),
    };
    for (at, value) in depths.iter_mut().enumerate() {
        let distance = f64::from(*value);
        let pixel = [at % frame.width, at / frame.width];
        *value = match ray_length(&sensor, pixel) {
            Some(length) if valid(distance) => (distance / length) as f32,
            _ => f32::NAN,
        };
    }
    frame.pixels = Pixels::F32(depths);
    (frame.missing, frame.valid_range) = (None, Some((0.0, f64::from(f32::MAX))));
    Ok(())
}

/// Turns a frame of depth that [`to_depth`] made back into what it was.
pub(crate) fn to_distance(frame: &mut Frame) {
    let (sensor, width) = (frame.sensor, frame.width);
    if let Pixels::F32(depths) = &mut frame.pixels {
        for (at, value) in depths.iter_mut().enumerate() {
            *value *= ray_length(&sensor, [at % width, at / width]).unwrap_or(f64::NAN) as f32;
        }
    }
}

/// Length of a pixel's ray up to depth 1; `None` where the lens has none.
fn ray_length(sensor: &Sensor, [u, v]: [usize; 2]) -> Option<f64> {
    Some(sensor.ray(u as f64, v as f64)?.iter().map(|x| x * x).sum::<f64>().sqrt())
}
