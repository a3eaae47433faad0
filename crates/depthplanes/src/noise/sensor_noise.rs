//! What a sensor's maker or a calibration says of its error.

use super::table::NoiseTable;
use crate::camera::within;
use crate::error::Result;
use crate::limits::MAX_NOISE;

/// What a sensor's maker or a calibration says of its error: the standard deviation of one pixel. Rounding to the
/// map's steps comes on top.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::large_enum_variant, reason = "a handful exist at a time, and being `Copy` keeps a `Sensor` plain")]
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
    /// Of depth, by a table over the range.
    Table(NoiseTable),
}

impl SensorNoise {
    /// That its numbers are accepted, however it was made. Tables are checked when they are made.
    ///
    /// # Errors
    /// [`Error::Camera`](crate::Error::Camera), which calls it `name`, for a number below 0 or above [`MAX_NOISE`].
    pub(crate) fn check(&self, name: &'static str) -> Result<()> {
        let numbers = match *self {
            SensorNoise::Depth { base, growth } => [base, growth],
            SensorNoise::Value { sigma } => [sigma, 0.0],
            SensorNoise::Table(_) => return Ok(()),
        };
        let accepted = "standard deviations from 0 to 1e12";
        numbers.into_iter().try_for_each(|given| within(name, given, (0.0..=MAX_NOISE).contains(&given), accepted))
    }

    /// Standard deviation of depth at range `depth_m`, metres; `None` for [`SensorNoise::Value`], which takes a
    /// value kind to become depth ([`super::NoiseModel::depth_sigma_m`]).
    pub fn depth_sigma_m(&self, depth_m: f64) -> Option<f64> {
        match self {
            SensorNoise::Depth { base, growth } => Some(base + growth * depth_m * depth_m),
            SensorNoise::Table(table) => Some(table.sigma_m(depth_m)),
            SensorNoise::Value { .. } => None,
        }
    }

    /// Whether all its numbers can be given.
    pub(crate) fn is_finite(&self) -> bool {
        match self {
            SensorNoise::Depth { base, growth } => base.is_finite() && growth.is_finite(),
            SensorNoise::Value { sigma } => sigma.is_finite(),
            SensorNoise::Table(table) => table.rows().iter().flatten().all(|number| number.is_finite()),
        }
    }

    /// Whether there is none.
    pub(crate) fn is_zero(&self) -> bool {
        matches!(self, SensorNoise::Depth { base: 0.0, growth: 0.0 } | SensorNoise::Value { sigma: 0.0 })
    }

    /// This noise with standard deviations `factor` times as large.
    pub(crate) fn times(self, factor: f64) -> Self {
        match self {
            SensorNoise::Depth { base, growth } => SensorNoise::Depth { base: factor * base, growth: factor * growth },
            SensorNoise::Value { sigma } => SensorNoise::Value { sigma: factor * sigma },
            SensorNoise::Table(table) => SensorNoise::Table(table.times(factor)),
        }
    }
}
