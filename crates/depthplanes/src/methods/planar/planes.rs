//! What pixels are held against: planes, and how far from them a sensor's noise lets them lie.

use super::field::Field;
use super::grow::Region;
use super::switches::is_on;
use crate::error::Result;
use crate::map::DepthView;
use crate::noise::NoiseModel;

/// Variance of q that a slope `(a, b)` of q makes of a ray that is known to within `ray` pixels.
#[inline(always)]
pub(super) fn of_slope(ray: f32, a: f32, b: f32) -> f32 {
    ray * ray * (a * a + b * b)
}

/// The regions of a map and the noise to expect.
#[derive(Clone, Copy)]
pub(super) struct Planes<'a> {
    pub(super) regions: &'a [Region],
    pub(super) noise: &'a NoiseModel,
    /// How far from a plane its pixels may lie, standard deviations.
    pub(super) inlier_threshold: f64,
    /// Whether curved regions have labels, and planes have none.
    pub(super) curved: bool,
}

/// The label of what belongs to a curved region while planes are sought.
pub(super) const BENT: u16 = u16::MAX;

impl Planes<'_> {
    #[inline(always)]
    pub(super) fn region(&self, id: u32) -> &Region {
        &self.regions[id as usize]
    }

    /// A region's label in the region image while planes are sought: [`BENT`] for all that are curved; while curved ones
    /// are, 0 for planes.
    #[inline(always)]
    pub(super) fn label(&self, id: u32) -> u16 {
        match (self.region(id).is_curved, self.curved) {
            (true, false) => BENT,
            (false, true) => 0,
            _ => id as u16 + 1,
        }
    }

    /// Variance of a pixel about a region's plane at q: the noise, and what the slope makes of the ray; in a region that
    /// bows by more than that, so much more.
    #[inline(always)]
    pub(super) fn variance(&self, region: &Region, q: f64) -> f64 {
        let [a, b, _] = region.abc.map(|number| number as f32);
        // The two parts of a ray are taken at their worst, off to the same side.
        let expected = self.noise.variance(q)
            + self.noise.smooth_sigma(q).powi(2)
            + f64::from(of_slope((self.noise.ray() + self.noise.smooth_ray()) as f32, a, b));
        if is_on("excess") { region.excess().max(1.0) * expected } else { expected }
    }

    /// Square of the largest distance from a region's plane at q.
    #[inline(always)]
    pub(super) fn reach(&self, region: &Region, q: f64) -> f64 {
        self.inlier_threshold * self.inlier_threshold * self.variance(region, q)
    }
}

/// A region image as a map of numbers, [`BENT`] and 0 missing.
pub(super) fn of_image<'a>(image: &'a [u16], field: &Field) -> Result<DepthView<'a, u16>> {
    let Field { width, height, stride, .. } = *field;
    DepthView::with_stride(&image[..stride * height], width, height, stride)?.valid_range(1, BENT - 1)
}
