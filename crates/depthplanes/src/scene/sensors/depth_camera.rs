//! From exact depth to the map of a sensor that errs: one mechanism, with a [`DepthCamera`] for each sensor.
//!
//! In: the exact picture, the sensor's row and random draws. Out: 16-bit pixels, 0 = missing. Edges move or mix;
//! shadows, range and grazing angles make holes; the error is added where planes are affine; then the value is
//! rounded and written.

use super::edges::Edges;
use super::error::ErrorModel;
use super::exposure::{Exposure, millimetres};
use crate::util::random::Random;

/// What a second eye to the right of the camera does not see is missing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shadow {
    /// Distance of the projector or the second camera, metres.
    pub(super) baseline_m: f64,
    /// Whether points left or right of the other eye's own picture are missing too.
    pub(super) bounded: bool,
}

/// How depth is written.
#[derive(Clone, Copy, Debug)]
pub(super) enum Output {
    /// Whole millimetres.
    Millimetres,
    /// Disparity: map units per pixel, and the baseline in metres.
    Disparity { units: f64, baseline_m: f64 },
}

/// One sensor as numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct DepthCamera {
    /// Depths that are measured, metres.
    pub(super) range_m: [f64; 2],
    pub(super) shadow: Option<Shadow>,
    pub(super) edges: Edges,
    /// Cosine of the angle between ray and normal below which pixels drop out, with a probability
    /// that reaches 1 at 90 degrees.
    pub(super) grazing_cosine: f32,
    pub(super) error: ErrorModel,
    pub(super) output: Output,
}

impl DepthCamera {
    /// `width * height` values; the smooth part of the error is drawn from `lasting`, if that is given.
    pub(super) fn pixels(&self, exposure: &Exposure<'_>, random: &mut Random, lasting: Option<Random>) -> Vec<u16> {
        let (width, height) = (exposure.camera.width, exposure.camera.height);
        let hidden = self.shadow.map(|shadow| exposure.hidden_from_right(shadow.baseline_m, shadow.bounded));
        let edges = self.edges.drawn(exposure, random);
        let mut error = match lasting {
            Some(mut lasting) => self.error.drawn(exposure.camera, &mut lasting),
            None => self.error.drawn(exposure.camera, random),
        };
        let range_m = self.range_m[0]..=self.range_m[1];
        let mut pixels = Vec::with_capacity(width * height);
        for v in 0..height {
            error.start_row(v);
            for u in 0..width {
                // Drawn for every pixel, so that a hole does not change the noise elsewhere.
                let (noise, chance) = (random.gaussian(), random.uniform());
                let (z, source) = edges.depth_m(exposure, v * width + u, random);
                let shaded = hidden.as_ref().is_some_and(|hidden| hidden[source]);
                let dropped = chance < f64::from(1.0 - exposure.seen.cosines[source] / self.grazing_cosine);
                let measured = range_m.contains(&z) && !shaded && !dropped;
                pixels.push(if measured { self.output.value(error.depth_m(u, z, noise), exposure) } else { 0 });
            }
        }
        pixels
    }
}

impl Output {
    /// The map's value for a depth in metres; 0 for what 16 bits cannot hold.
    fn value(self, depth_m: f64, exposure: &Exposure<'_>) -> u16 {
        match self {
            Output::Millimetres => millimetres(depth_m),
            Output::Disparity { units, baseline_m } => {
                let value = (units * exposure.camera.intrinsics.fx.abs() * baseline_m / depth_m + 0.5).floor();
                if (1.0..=65_535.0).contains(&value) { value as u16 } else { 0 }
            }
        }
    }
}
