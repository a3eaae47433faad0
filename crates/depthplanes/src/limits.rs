//! How large maps may be, how many planes one may have, and which cameras and units mean something.
//!
//! Within these limits no product of a few quantities overflows, whatever the values of the map are.

use std::ops::RangeInclusive;

/// Longest side of a map, in pixels.
pub const MAX_SIDE: usize = 65_535;
/// Most pixels of a map; group ids and sums are sized for it.
pub const MAX_PIXELS: usize = 1 << 30;
/// Most planes that 16-bit labels can name.
pub const MAX_PLANES: usize = u16::MAX as usize;
/// Metres in a unit of a map of depth: from atoms to the orbits of planets.
pub const METRES_PER_UNIT: RangeInclusive<f64> = 1e-12..=1e12;
/// Slope of inverse depth, 1/m in a unit of the map, either sign: that of a satellite's pair of pictures is 1e-12.
pub const SLOPE_PER_M: RangeInclusive<f64> = 1e-15..=1e15;
/// Largest inverse depth at value 0, 1/m, either sign.
pub const MAX_OFFSET_PER_M: f64 = 1e15;
/// Focal length, pixels, either sign: with the smallest a single pixel sees 179.8 degrees, with the largest the longest
/// map sees 14 seconds of arc.
pub const FOCAL_PX: RangeInclusive<f64> = 1e-3..=1e9;
/// Farthest principal point from the first pixel along either axis, pixels.
pub const MAX_PRINCIPAL_POINT_PX: f64 = 1e9;
/// Largest noise, metres or map units, and 1/m for its growth.
pub const MAX_NOISE: f64 = 1e12;
