//! What a sensor's error is at a given range.
//!
//! In: what is known of the sensor ([`SensorNoise`]) and the steps that its values come in. Out: the standard deviation of one pixel in the space where planes
//! are affine ([`Space`]): inverse depth for depth maps, the value itself for all others. Structured
//! light and stereo err by a constant there, time of flight by a constant in depth; both parts add.

use crate::camera::Measure;

/// The space where planes of a map are affine, `q = a u + b v + c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Space {
    /// q is inverse depth, 1/m, of maps with that many metres per map unit.
    InverseDepth {
        /// Metres per map unit.
        metres: f64,
    },
    /// q is the map's value: disparity, or inverse depth up to a scale and an offset.
    Value,
}

impl Space {
    /// The space for a map whose numbers mean that.
    pub fn of(measure: Measure) -> Self {
        match measure {
            Measure::Depth { metres } => Space::InverseDepth { metres },
            Measure::InverseDepth { .. } | Measure::Disparity => Space::Value,
        }
    }

    /// q of a map value.
    #[inline(always)]
    pub fn q(self, value: f64) -> f64 {
        match self {
            Space::InverseDepth { metres } => 1.0 / (metres * value),
            Space::Value => value,
        }
    }
}

/// What a sensor's maker or a calibration says of its error: the standard deviation of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorNoise {
    /// Of depth z: `base + growth z^2`, metres.
    Depth {
        /// At range 0, metres.
        base: f64,
        /// 1/m. Structured light and stereo: `(sigma of disparity) / (f T)` (the derivative of eq. 6).
        growth: f64,
    },
    /// Of the map's value, map units: constant in disparity.
    Value {
        /// Map units.
        sigma: f64,
    },
}

/// Standard deviation of one pixel's q: `constant + square q^2`, never below what rounding alone makes.
///
/// An error of depth of `s(z) = base + growth z^2` metres is `s / z^2 = growth + base q^2` in inverse
/// depth: `constant` is the growth with the range, `square` the error at range 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseModel {
    /// Part that does not depend on q, units of q.
    pub constant: f64,
    /// Part that grows with q squared, 1 / units of q; 0 in [`Space::Value`].
    pub square: f64,
    /// Rounding of whole map units, same form.
    rounding: [f64; 2],
}

/// What rounding to steps may do, in steps, to all pixels of a small patch at once: on a slow ramp they lie on one
/// level, up to half a step off, and no average over them helps. (Over many steps it would be 1 / sqrt(12).)
const ROUNDING: f64 = 0.5;

impl NoiseModel {
    /// The model of a sensor whose error is known; `None` if it is stated for another kind of map.
    pub fn of_sensor(space: Space, noise: SensorNoise, step: f64) -> Option<Self> {
        match (space, noise) {
            (Space::InverseDepth { .. }, SensorNoise::Depth { base, growth }) => {
                Some(Self::new(space, growth, base, step))
            }
            (Space::Value, SensorNoise::Value { sigma }) => Some(Self::new(space, sigma, 0.0, step)),
            _ => None,
        }
    }

    /// A model of a map whose values come in steps of so many map units; 0 for values that are not rounded.
    pub fn new(space: Space, constant: f64, square: f64, step: f64) -> Self {
        let rounding = match space {
            Space::InverseDepth { metres } => [0.0, ROUNDING * step * metres],
            Space::Value => [ROUNDING * step, 0.0],
        };
        NoiseModel { constant, square, rounding }
    }

    /// Variance of one pixel's q.
    #[inline(always)]
    pub fn variance(&self, q: f64) -> f64 {
        let sensor = self.constant + self.square * q * q;
        let rounding = self.rounding[0] + self.rounding[1] * q * q;
        let single = 2e-7 * q; // single precision, in which q is kept
        sensor * sensor + rounding * rounding + single * single
    }
}
