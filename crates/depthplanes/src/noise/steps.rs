//! The steps that a map's values come in.
//!
//! In: a map. Out: the distance of neighbouring values that occur, map units. Scaled maps leave out many values, and
//! coarse sensors leave out more the further they look.

use crate::map::{DepthView, Pixel};

/// Finds steps; reuses its memory.
#[derive(Debug, Default)]
pub(crate) struct Steps {
    seen: Vec<bool>,
}

impl Steps {
    /// The lower quartile of the distances of neighbouring values that occur; 0 for floating-point maps.
    pub(crate) fn of<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> f64 {
        if !T::IS_INTEGER {
            return 0.0;
        }
        self.seen.clear();
        self.seen.resize(1 << 16, false);
        let validity = map.validity();
        for &value in map.rows().flatten().filter(|value| validity.holds(**value)) {
            self.seen[value.into() as usize] = true;
        }
        let occur = || (1..self.seen.len()).filter(|&value| self.seen[value]);
        let steps = || occur().zip(occur().skip(1)).map(|(a, b)| b - a);
        let count = steps().count();
        let most = |step: usize| 4 * steps().filter(|&other| other <= step).count() >= count;
        (1..self.seen.len()).find(|&step| most(step)).unwrap_or(1) as f64
    }
}
