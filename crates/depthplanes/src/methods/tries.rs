//! Which changes of parameters give a pixel a plane, found by trying.
//!
//! In: a method's values, a map, a pixel, and changes in the order of preference. Out: the first that works. Nothing
//! is suggested that was not run.

use super::extraction::MIN_PIXELS;
use super::method::{Job, MethodInfo};
use crate::detection::Detection;
use crate::explanation::Suggestion;
use crate::map::AnyView;
use crate::sensor::Sensor;

/// A map and the method that finds no plane at one of its pixels.
pub(crate) struct Tries<'a> {
    pub(crate) info: &'static MethodInfo,
    /// Its values, in the order of its parameters.
    pub(crate) values: &'a [f64],
    pub(crate) map: AnyView<'a>,
    pub(crate) sensor: Sensor,
    pub(crate) at: [usize; 2],
    /// How many planes it finds with these values.
    pub(crate) planes: usize,
}

/// Parameters with their values.
pub(crate) type Change = Vec<(&'static str, f64)>;

impl Tries<'_> {
    /// The first change after which the pixel belongs to a plane.
    pub(crate) fn first(&self, changes: impl IntoIterator<Item = Change>) -> Option<Suggestion> {
        changes.into_iter().find_map(|change| self.attempt(change))
    }

    fn attempt(&self, change: Change) -> Option<Suggestion> {
        let mut values = self.values.to_vec();
        for &(name, value) in &change {
            values[self.info.position(name)?] = value;
        }
        let mut method = self.info.of_values(&values).ok()?.0;
        let mut found = Detection::default();
        let mut job = Job { sensor: self.sensor, threads: 1, curved: false, joiner: None, observer: &mut |_| () };
        method.run(self.map, &mut job, &mut found).ok()?;
        let label = found.labels[self.at[1] * found.width + self.at[0]];
        let plane = found.planes.get(usize::from(label.checked_sub(1)?))?;
        Some(Suggestion {
            parameters: change,
            plane_pixels: plane.pixel_count,
            planes_before: self.planes,
            planes_after: found.planes.len(),
        })
    }
}

/// Fewest pixels of a surface for which `min-pixels` is lowered: letting stray pixels in would make a plane of each.
const STRAY: usize = 8;

/// The changes of `min-pixels` that may let in a surface of `pixels` pixels: a value a little below that first, then smaller ones.
pub(crate) fn lower_min_pixels(pixels: usize) -> impl Iterator<Item = Change> {
    let shares = [0.97, 0.8, 0.6, 0.4, 0.2, 0.1, 0.0].into_iter().filter(move |_| pixels >= STRAY);
    shares.map(move |share| vec![(MIN_PIXELS.name, floored(share * pixels as f64))])
}

/// The value rounded down to a whole number of two significant digits.
fn floored(value: f64) -> f64 {
    let unit = 10f64.powi((value.max(1.0).log10().floor() as i32 - 1).max(0));
    (value / unit).floor() * unit
}

/// The value rounded up to two significant digits.
pub(crate) fn rounded_up(value: f64) -> f64 {
    rounded(value, |number| (number - 1e-9).ceil())
}

/// The value rounded down to two significant digits.
pub(crate) fn rounded_down(value: f64) -> f64 {
    rounded(value, |number| (number + 1e-9).floor())
}

fn rounded(value: f64, to_whole: impl Fn(f64) -> f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return value;
    }
    let digits = 1 - value.log10().floor() as i32;
    // Through text, so that 0.3 is 0.3 and not 0.30000000000000004.
    let number = to_whole(value * 10f64.powi(digits)) / 10f64.powi(digits);
    format!("{number:.*}", digits.max(0) as usize).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::{floored, rounded_up};

    #[test]
    fn suggested_numbers_are_short() {
        assert_eq!([0.0, 7.9, 64.9, 99.0, 1234.0].map(floored), [0.0, 7.0, 64.0, 99.0, 1200.0]);
        assert_eq!([0.0, 0.00141, 0.3, 7.21, 1234.0].map(rounded_up), [0.0, 0.0015, 0.3, 7.3, 1300.0]);
    }
}
