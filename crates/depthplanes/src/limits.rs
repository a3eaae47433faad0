//! How large maps may be, and how many planes one may have.

/// Longest side of a map, in pixels.
pub const MAX_SIDE: usize = 65_535;
/// Most pixels of a map; group ids and sums are sized for it.
pub const MAX_PIXELS: usize = 1 << 30;
/// Most planes that 16-bit labels can name.
pub const MAX_PLANES: usize = u16::MAX as usize;
