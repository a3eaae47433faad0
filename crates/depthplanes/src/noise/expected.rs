//! What a method expected of a map's pixels, for the record.

use super::sensor_noise::SensorNoise;

/// The noise that a method expected of a map's pixels, with all factors, so that a result can be made again.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ExpectedNoise {
    /// The part that differs from pixel to pixel: of depth in metres, of all else in map units.
    pub white: SensorNoise,
    /// Whether that part was estimated from the map, because nobody stated it.
    pub white_is_estimated: bool,
    /// The part that neighbouring pixels share, in the same units; `None` of methods that do not tell it apart.
    pub smooth: Option<SensorNoise>,
    /// Whether the smooth part was estimated from the map.
    pub smooth_is_estimated: bool,
    /// Lateral error of a pixel's direction, pixels, one standard deviation; 0 of methods that do not know it.
    pub lateral_noise_px: f64,
}
