//! The parameters of `planar`, and what they say of the noise.

use super::region::{Planes, Region};
use crate::methods::extraction::MIN_PIXELS;
use crate::methods::noise::{NOISE, NOISE_GROWTH, NOISE_SCALE, SMOOTH_NOISE, SMOOTH_NOISE_GROWTH, stated};
use crate::methods::parameter::{Param, ParamKind, defaults, setters};
use crate::noise::errors::Errors;
use crate::noise::scales::RAY;
use crate::noise::{NoiseModel, Rounding, SensorNoise, Space};
use crate::sensor::Sensor;

pub(super) const PARAMS: &[Param] = &[
    MIN_PIXELS,
    Param {
        name: "min-area",
        alias: None,
        default: 0.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "m2",
        meaning: "A plane has at least this area; needs unit and camera; 0 for off.",
        source: None,
    },
    NOISE,
    NOISE_GROWTH,
    SMOOTH_NOISE,
    SMOOTH_NOISE_GROWTH,
    NOISE_SCALE,
    Param {
        name: "lateral-noise",
        alias: None,
        default: 0.0,
        min: 0.0,
        max: 100.0,
        kind: ParamKind::Real,
        unit: "pixels",
        meaning: "Lateral error of a pixel's direction, one standard deviation; on slanted surfaces it acts as noise. 0: estimated from the map, at least 0.05.",
        source: None,
    },
    Param {
        name: "inlier-threshold",
        alias: None,
        default: 4.0,
        min: 0.5,
        max: 100.0,
        kind: ParamKind::Real,
        unit: "standard deviations",
        meaning: "How far from a plane its pixels may lie.",
        source: None,
    },
];

/// Parameters of the method `planar`: the defaults, changed by setters.
///
/// ```
/// use depthplanes::{Detector, Planar};
/// let detector = Detector::new(Planar::default().min_pixels(500).inlier_threshold(3.0))?;
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[non_exhaustive]
pub struct Planar {
    /// A plane has strictly more pixels than this.
    #[cfg_attr(feature = "serde", serde(alias = "min"))]
    pub min_pixels: u32,
    /// A plane has at least this area ([`crate::detection::MetricPlane::area_m2`]), square metres; 0 for off.
    pub min_area: f64,
    /// Standard deviation of a pixel by itself: of depth at range 0, metres; of disparity, map units. If this and
    /// `noise_growth` are 0, it is the sensor's ([`crate::Sensor::noise`]), or else estimated from each map.
    pub noise: f64,
    /// What the standard deviation of depth grows by with the square of the range, 1/m; not used for disparity.
    pub noise_growth: f64,
    /// Standard deviation of the part of the error that neighbouring pixels share over tens of pixels, in the units of
    /// `noise`: it does not average out within a surface. If this and `smooth_noise_growth` are 0, it is the sensor's
    /// ([`crate::Sensor::smooth_noise`]), or else estimated from each map. What wide cells and large regions of a map show beyond it
    /// counts as well.
    pub smooth_noise: f64,
    /// What that of depth grows by with the square of the range, 1/m; not used for disparity.
    pub smooth_noise_growth: f64,
    /// What both parts are multiplied by, stated or estimated, 0.01..=100; a `lateral_noise` that is estimated, too. Larger joins
    /// more.
    pub noise_scale: f64,
    /// How well the ray of a pixel is known, pixels, one standard deviation, 0..=100: what a surface's slope makes of it
    /// comes on top of the noise. If it is 0, it is estimated from each map, as 0.05 and more, whether or not the noise
    /// is stated.
    pub lateral_noise: f64,
    /// How far from a plane its pixels may lie, standard deviations, 0.5..=100.
    pub inlier_threshold: f64,
}

impl Planar {
    pub(super) fn from_values(values: &[f64]) -> Self {
        assert_eq!(values.len(), PARAMS.len(), "one value for each row of PARAMS");
        Planar {
            min_pixels: values[0] as u32,
            min_area: values[1],
            noise: values[2],
            noise_growth: values[3],
            smooth_noise: values[4],
            smooth_noise_growth: values[5],
            noise_scale: values[6],
            lateral_noise: values[7],
            inlier_threshold: values[8],
        }
    }

    pub(super) fn values(&self) -> [f64; 9] {
        let noise = [self.noise, self.noise_growth, self.smooth_noise, self.smooth_noise_growth];
        let [white, white_growth, smooth, smooth_growth] = noise;
        let Planar { min_pixels, min_area, noise_scale, lateral_noise, inlier_threshold, .. } = *self;
        [
            min_pixels.into(),
            min_area,
            white,
            white_growth,
            smooth,
            smooth_growth,
            noise_scale,
            lateral_noise,
            inlier_threshold,
        ]
    }

    /// The noise to expect: each part as the parameters state it, or else as the sensor's, or else as a map shows it whose
    /// values are rounded so.
    pub(super) fn expected(&self, sensor: &Sensor, shown: &Errors, rounding: Rounding) -> NoiseModel {
        let (space, scale) = (Space::of(sensor.value_kind), self.noise_scale);
        // What is stated for another kind of map counts as not stated.
        let model = |noise: SensorNoise| {
            Some(NoiseModel::new(sensor.value_kind, noise.times(scale), 0.0)?.with_rounding(rounding))
        };
        let estimated = |factor: f64| shown.times(factor, space);
        let white =
            stated(space, self.noise, self.noise_growth).or(sensor.noise).and_then(model).unwrap_or_else(|| {
                model(estimated(shown.white)).expect("an estimate is of the map's own kind").of_scatter()
            });
        let stated_smooth = self.stated_smooth(sensor);
        let white = if stated_smooth.is_none() { white.of_smooth_shown() } else { white };
        let smooth = stated_smooth.unwrap_or_else(|| estimated(shown.smooth)).times(scale);
        match self.lateral_noise {
            0.0 => {
                let [ray, smooth_ray] = [shown.white, shown.smooth].map(|factor| scale * factor * shown.ray);
                white.with_ray(ray.max(RAY[0])).with_smooth(smooth, smooth_ray)
            }
            // Of its error the same share is smooth as of the noise that the map shows.
            ray => white.with_ray(ray).with_smooth(smooth, ray * shown.smooth / shown.white),
        }
    }

    /// The smooth part as the parameters state it, or else as the sensor's, if it is of the map's kind.
    pub(super) fn stated_smooth(&self, sensor: &Sensor) -> Option<SensorNoise> {
        let stated = stated(Space::of(sensor.value_kind), self.smooth_noise, self.smooth_noise_growth);
        stated.or(sensor.smooth_noise).filter(|&noise| NoiseModel::new(sensor.value_kind, noise, 0.0).is_some())
    }

    /// Fewest pixels of a region of tiles: a plane has many of its pixels in tiles that it shares with others.
    pub(super) fn least(&self) -> f64 {
        f64::from(self.min_pixels) * 0.5
    }

    /// What pixels are held against.
    pub(super) fn planes<'a>(&self, regions: &'a [Region], noise: &'a NoiseModel, curved: bool) -> Planes<'a> {
        Planes { regions, noise, inlier_threshold: self.inlier_threshold, curved }
    }
}

impl Default for Planar {
    fn default() -> Self {
        Self::from_values(&defaults(PARAMS))
    }
}

setters!(
    Planar: min_pixels: u32, min_area: f64, noise: f64, noise_growth: f64, smooth_noise: f64, smooth_noise_growth: f64,
    noise_scale: f64, lateral_noise: f64, inlier_threshold: f64,
);
