//! What is known of how a map came about: what its numbers mean, the camera, the noise.

use crate::camera::{HessianNormalForm, Intrinsics, ValueKind};
use crate::error::{Error, Result};
use crate::lens::distortion::Distortion;
use crate::noise::sensor_noise::SensorNoise;

/// Everything known about how a map came about. Detection needs none of it; metric planes need
/// a metric value kind and the camera.
///
/// ```
/// use depthplanes::{Intrinsics, Sensor, ValueKind};
/// let sensor = Sensor::default().value_kind(ValueKind::depth(0.001)?).intrinsics(Intrinsics::new(525.0, 525.0, 319.5, 239.5)?);
/// assert!(sensor.noise.is_none()); // it is estimated from each map
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Sensor {
    /// What the numbers mean: depth in some unit, inverse depth or disparity.
    pub value_kind: ValueKind,
    /// The camera, if known.
    pub intrinsics: Option<Intrinsics>,
    /// The distortion of the camera's lens; none for maps of a pinhole camera and rectified ones. Without intrinsics it means
    /// nothing.
    #[cfg_attr(feature = "serde", serde(default))]
    pub distortion: Option<Distortion>,
    /// The noise of single pixels, if known; methods that need it estimate it from the map otherwise.
    pub noise: Option<SensorNoise>,
    /// The part of the error that neighbouring pixels share over tens of pixels, beside `noise`, if known; methods that
    /// need it (`planar`) estimate it from the map otherwise.
    pub smooth_noise: Option<SensorNoise>,
}

impl Sensor {
    /// This sensor with numbers of that kind.
    #[must_use]
    pub fn value_kind(self, value_kind: ValueKind) -> Self {
        Sensor { value_kind, ..self }
    }

    /// This sensor with that camera, or with none.
    #[must_use]
    pub fn intrinsics(self, intrinsics: impl Into<Option<Intrinsics>>) -> Self {
        Sensor { intrinsics: intrinsics.into(), ..self }
    }

    /// This sensor with a lens that distorts, or with none that does. A detector then finds planes in the picture that a
    /// pinhole camera would have made, and gives labels of the map's own pixels ([`crate::Detector`]).
    #[must_use]
    pub fn distortion(self, distortion: impl Into<Option<Distortion>>) -> Self {
        Sensor { distortion: distortion.into(), ..self }
    }

    /// The ray through pixel (u, v), scaled so that its z is 1, with the distortion of the lens undone; `None` without
    /// intrinsics, and where the lens puts nothing ([`Distortion::undistort`]).
    pub fn ray(&self, u: f64, v: f64) -> Option<[f64; 3]> {
        let ray = self.intrinsics?.ray(u, v);
        let Some(distortion) = self.distortion.filter(|distortion| !distortion.is_none()) else { return Some(ray) };
        let [x, y] = distortion.undistort([ray[0], ray[1]])?;
        Some([x, y, 1.0])
    }

    /// This sensor with that noise of single pixels, or with one to be estimated.
    #[must_use]
    pub fn noise(self, noise: impl Into<Option<SensorNoise>>) -> Self {
        Sensor { noise: noise.into(), ..self }
    }

    /// This sensor with that smooth part of the noise, or with one to be estimated.
    #[must_use]
    pub fn smooth_noise(self, smooth_noise: impl Into<Option<SensorNoise>>) -> Self {
        Sensor { smooth_noise: smooth_noise.into(), ..self }
    }

    /// That its numbers mean something, however it was made.
    ///
    /// # Errors
    /// [`Error::Camera`] for a unit, a slope, an offset, a camera, a lens or a noise outside of [`crate::limits`].
    pub(crate) fn check(&self) -> Result<()> {
        self.value_kind.check()?;
        self.noise.map_or(Ok(()), |noise| noise.check("noise"))?;
        self.smooth_noise.map_or(Ok(()), |noise| noise.check("smooth noise"))?;
        self.distortion.map_or(Ok(()), |distortion| distortion.check())?;
        self.intrinsics.map_or(Ok(()), |camera| Intrinsics::new(camera.fx, camera.fy, camera.cx, camera.cy).map(drop))
    }

    /// Whether planes can be given in metres: the value kind is metric and the camera known.
    pub fn is_metric(&self) -> bool {
        self.value_kind != ValueKind::Disparity && self.intrinsics.is_some()
    }

    /// That planes can be given in metres.
    ///
    /// # Errors
    /// [`Error::NotMetric`], which names what `wants` them, unless the value kind is metric and the camera known.
    pub(crate) fn check_metric(&self, wants: &'static str) -> Result<()> {
        let is_disparity = self.value_kind == ValueKind::Disparity;
        if self.is_metric() { Ok(()) } else { Err(Error::NotMetric { wants, is_disparity }) }
    }
}

impl Default for Sensor {
    /// Depth in millimetres, camera unknown.
    fn default() -> Self {
        Sensor {
            value_kind: ValueKind::Depth { metres: 0.001 },
            intrinsics: None,
            distortion: None,
            noise: None,
            smooth_noise: None,
        }
    }
}

impl HessianNormalForm {
    /// As [`HessianNormalForm::point_at`], on the true ray behind a lens.
    pub(crate) fn point_seen_by(&self, [u, v]: [f64; 2], sensor: &Sensor) -> Option<[f64; 3]> {
        self.point_along(sensor.ray(u, v)?)
    }
}
