//! The steps that a map's values come in.
//!
//! In: a map. Out: the distance of neighbouring values that occur, map units. Scaled maps leave out many values, and
//! coarse sensors leave out more the further they look.

use crate::map::{DepthView, Pixel};
use crate::util::simd::vectorised;

/// Values that are looked at, about.
const SAMPLE: usize = 1 << 15;
/// Values that are looked at together.
const GROUP: usize = 32;
/// Longest step that is told from longer ones, map units.
const FAR: usize = 1023;
/// Fewest distances that tell a step. Flat surfaces on which every pixel has one value make fewer distances, and
/// these are jumps in depth.
const LEAST: u32 = 8;

/// Finds steps; reuses its memory.
#[derive(Debug, Default)]
pub(crate) struct Steps {
    seen: Vec<bool>,
}

impl Steps {
    /// The lower quartile of the distances of neighbouring values that occur in rows spread over the map; 0 for
    /// floating-point maps, 1 where too few values occur to tell.
    pub(crate) fn of<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> f64 {
        if !T::IS_INTEGER {
            return 0.0;
        }
        vectorised(
            #[inline(always)]
            || self.look(map),
        );
        let steps = self.steps();
        let count: u32 = steps.iter().sum();
        if count < LEAST {
            return 1.0;
        }
        let mut smaller = 0;
        let quartile = (1..=FAR).find(|&step| {
            smaller += steps[step];
            4 * smaller >= count
        });
        quartile.unwrap_or(1) as f64
    }

    /// Marks the values that occur.
    #[inline(always)]
    fn look<T: Pixel>(&mut self, map: &DepthView<'_, T>) {
        let seen = &mut self.seen;
        seen.clear();
        seen.resize(1 << (8 * size_of::<T>()), false);
        let validity = map.validity();
        // Without a branch: 0 stands for the values that do not count.
        let place = |value: T| if validity.holds(value) { value.to_f32() as u32 } else { 0 };
        for row in map.rows().step_by(map.area().div_ceil(SAMPLE)) {
            let (groups, rest) = row.as_chunks::<GROUP>();
            for group in groups {
                let mut places = [0; GROUP];
                (0..GROUP).for_each(|i| places[i] = place(group[i]));
                places.into_iter().for_each(|place| seen[place as usize] = true);
            }
            rest.iter().for_each(|&value| seen[place(value) as usize] = true);
        }
        seen[0] = false;
    }

    /// For each distance, how often neighbouring values that occur are so far apart.
    fn steps(&self) -> [u32; FAR + 1] {
        let mut steps = [0; FAR + 1];
        let mut last = None;
        for (first, values) in (0..).step_by(GROUP).zip(self.seen.as_chunks::<GROUP>().0) {
            if *values != [false; GROUP] {
                for (value, _) in (first..).zip(values).filter(|(_, seen)| **seen) {
                    if let Some(last) = last.replace(value) {
                        steps[FAR.min(value - last)] += 1;
                    }
                }
            }
        }
        steps
    }
}
