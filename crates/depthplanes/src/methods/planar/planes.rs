//! What pixels are held against: planes, and how far from them a sensor's noise lets them lie.

use super::grow::Region;
use crate::noise::NoiseModel;

/// The regions of a map and the noise to expect.
#[derive(Clone, Copy)]
pub(super) struct Planes<'a> {
    pub(super) regions: &'a [Region],
    pub(super) noise: &'a NoiseModel,
    /// How far from a plane its pixels may lie, standard deviations.
    pub(super) confidence: f64,
    /// Whether curved regions have labels, and planes have none.
    pub(super) curved: bool,
}

impl Planes<'_> {
    #[inline(always)]
    pub(super) fn region(&self, id: u32) -> &Region {
        &self.regions[id as usize]
    }

    /// A region's label in the region image, 0 for those that are not wanted.
    #[inline(always)]
    pub(super) fn label(&self, id: u32) -> u16 {
        if self.region(id).is_curved == self.curved { id as u16 + 1 } else { 0 }
    }

    /// Square of the largest distance from a plane at q.
    #[inline(always)]
    pub(super) fn reach(&self, q: f64) -> f64 {
        self.confidence * self.confidence * self.noise.variance(q)
    }
}
