//! The parameters of `planar` and `mdl` that state a map's noise: its white part, which averages out over pixels, and
//! for `planar` its smooth part as well, which does not average out within a surface.

use super::parameter::{Param, ParamKind};
use crate::limits::MAX_NOISE;
use crate::noise::{SensorNoise, Space};

pub(crate) const NOISE: Param = Param {
    name: "noise",
    alias: None,
    default: 0.0,
    min: 0.0,
    max: MAX_NOISE,
    kind: ParamKind::Real,
    unit: "m or map units",
    meaning: "Noise of a single pixel: standard deviation of depth at range 0, metres, or of disparity, map units. If `noise-growth` is 0 too, it is the preset's, or else estimated from the map.",
    source: None,
};

pub(crate) const NOISE_GROWTH: Param = Param {
    name: "noise-growth",
    alias: None,
    default: 0.0,
    min: 0.0,
    max: MAX_NOISE,
    kind: ParamKind::Real,
    unit: "1/m",
    meaning: "Growth of `noise` with the square of the range, 0.0014 for a Kinect v1; not used for disparity.",
    source: None,
};

pub(crate) const SMOOTH_NOISE: Param = Param {
    name: "smooth-noise",
    alias: None,
    default: 0.0,
    min: 0.0,
    max: MAX_NOISE,
    kind: ParamKind::Real,
    unit: "m or map units",
    meaning: "Smooth noise, which pixels share over tens of pixels: standard deviation of depth at range 0, metres, or of disparity, map units. If `smooth-noise-growth` is 0 too, it is the preset's, or else estimated from the map.",
    source: None,
};

pub(crate) const SMOOTH_NOISE_GROWTH: Param = Param {
    name: "smooth-noise-growth",
    alias: None,
    default: 0.0,
    min: 0.0,
    max: MAX_NOISE,
    kind: ParamKind::Real,
    unit: "1/m",
    meaning: "Growth of `smooth-noise` with the square of the range; not used for disparity.",
    source: None,
};

pub(crate) const NOISE_SCALE: Param = Param {
    name: "noise-scale",
    alias: None,
    default: 1.0,
    min: 0.01,
    max: 100.0,
    kind: ParamKind::Real,
    unit: "times",
    meaning: "Factor on all noise, stated or estimated; a larger one joins more pixels and regions.",
    source: None,
};

/// The noise that [`NOISE`] and [`NOISE_GROWTH`] state, or that the parameters of the smooth part state; none if they are 0.
pub(crate) fn stated(space: Space, noise: f64, growth: f64) -> Option<SensorNoise> {
    let is_stated = noise > 0.0 || (space != Space::Value && growth > 0.0);
    is_stated.then(|| of_kind(space, noise, growth))
}

/// Noise of the kind that a map has.
pub(crate) fn of_kind(space: Space, base: f64, growth: f64) -> SensorNoise {
    match space {
        Space::InverseDepth { .. } => SensorNoise::Depth { base, growth },
        Space::Value => SensorNoise::Value { sigma: base },
    }
}
