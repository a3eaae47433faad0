//! The rig that makes metres of disparities.

/// A rectified stereo rig, for `z = focal_px * baseline_m / (disparity + doffs_px)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stereo {
    /// Focal length, pixels.
    pub focal_px: f64,
    /// Distance of the two cameras, metres.
    pub baseline_m: f64,
    /// Difference of the two principal points, pixels; 0 for most rigs.
    pub doffs_px: f64,
}
