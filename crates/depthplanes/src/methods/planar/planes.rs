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

/// The label of what belongs to a curved region, until all pixels are assigned.
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

    /// Square of the largest distance from a plane at q.
    #[inline(always)]
    pub(super) fn reach(&self, q: f64) -> f64 {
        self.confidence * self.confidence * self.noise.variance(q)
    }
}
