//! The parts of a sensor's error as a map shows them.

use super::sensor_noise::SensorNoise;
use super::space::Space;

/// The parts of a pixel's error. Standard deviations of q are multiples of `constant + square q^2` where the surface
/// faces the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Errors {
    /// Standard deviation of means over tiles of 4 x 4 pixels.
    pub(crate) constant: f64,
    pub(crate) square: f64,
    /// Lateral error of a pixel's direction, pixels: on a slope g the variance of these means is larger by `ray^2 g^2`.
    pub(crate) ray: f64,
    /// Standard deviations of single pixels about a tile's plane, and of means over 16 x 16, as multiples of that.
    pub(crate) white: f64,
    pub(crate) smooth: f64,
    /// The larger of the multiples for means over 16 x 16 and over 32 x 32 in cells without an edge, if many cells are.
    pub(crate) wide: f64,
    /// As `wide`, from the cells without an edge, however few, and with the waves that are longer than these, of
    /// which second differences see a part: extrapolated to 32 times the root of 2 pixels at the growth from 16 to 32.
    pub(crate) whole: f64,
    /// A q in the middle of those that were seen.
    pub(crate) q: f64,
}

impl Errors {
    /// The errors of a map that shows too little.
    pub(crate) const NONE: Errors =
        Errors { constant: 0.0, square: 0.0, ray: 0.0, white: 4.0, smooth: 0.25, wide: 0.25, whole: 0.25, q: 1.0 };

    /// Variance of the mean over a tile.
    #[inline(always)]
    pub(crate) fn variance(&self, q: f64, slope: f64) -> f64 {
        let sigma = self.constant + self.square * q * q;
        sigma * sigma + self.ray * self.ray * slope
    }

    /// `factor` times the error of a tile's mean, as the noise of a sensor.
    pub(crate) fn times(&self, factor: f64, space: Space) -> SensorNoise {
        match space {
            Space::InverseDepth { .. } => {
                SensorNoise::Depth { base: factor * self.square, growth: factor * self.constant }
            }
            Space::Value => SensorNoise::Value { sigma: factor * self.constant },
        }
    }
}
