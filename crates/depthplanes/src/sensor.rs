//! What is known of how a map came about: what its numbers mean, the camera, the noise.

use crate::camera::{Intrinsics, Measure};
use crate::error::{Error, Result};
use crate::noise::sensor_noise::SensorNoise;

/// Everything known about how a map came about. Detection needs none of it; metric planes need
/// measure and camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// What the numbers mean.
    pub measure: Measure,
    /// The camera, if known.
    pub intrinsics: Option<Intrinsics>,
    /// How far off a pixel is by itself, if known; methods that need it estimate it from the map otherwise.
    pub noise: Option<SensorNoise>,
    /// The part of the error that neighbouring pixels share over tens of pixels, beside `noise`, if known; methods that
    /// need it (`planar`) estimate it from the map otherwise.
    pub smooth_noise: Option<SensorNoise>,
}

impl Sensor {
    /// Whether planes can be given in metres.
    ///
    /// # Errors
    /// [`Error::NotMetric`] for what `wants` them, unless the measure is metric and the camera known.
    pub(crate) fn check_metric(&self, wants: &'static str) -> Result<()> {
        let is_disparity = self.measure == Measure::Disparity;
        let is_metric = !is_disparity && self.intrinsics.is_some();
        if is_metric { Ok(()) } else { Err(Error::NotMetric { wants, is_disparity }) }
    }
}

impl Default for Sensor {
    /// Depth in millimetres, camera unknown.
    fn default() -> Self {
        Sensor { measure: Measure::Depth { metres: 0.001 }, intrinsics: None, noise: None, smooth_noise: None }
    }
}
