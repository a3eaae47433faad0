//! What all values of a map are multiples of.
//!
//! In: the values that occur. Out: the largest number, map units, of which all of them are multiples to within single
//! precision; 0 where there is none, as for true floats. The step of rounding is at least that.

use super::level::{LEAST, Level};
use crate::noise::space::Space;

/// Gaps of more units than this say nothing: the unit is not known well enough.
const FAR: f64 = 200.0;
/// Smallest unit, in units of the last place of a value: floats have smaller common divisors by chance.
const PLACES: f64 = 16.0;

/// The common unit of levels that are sorted by q, map units: `least` or more.
pub(super) fn common(levels: &[Level], space: Space, least: f64) -> f64 {
    least.max(match levels.len() {
        0 => 0.0,
        1..=LEAST => usual(levels, space),
        _ => divisor(levels, least),
    })
}

/// Euclid's algorithm on the gaps between neighbours, of which each is off by a unit in the last place.
fn divisor(levels: &[Level], least: f64) -> f64 {
    let gap = |pair: &[Level]| (pair[0].value - pair[1].value).abs();
    let mut unit = levels.windows(2).map(gap).fold(f64::INFINITY, f64::min);
    if unit == least {
        return unit;
    }
    for pair in levels.windows(2) {
        let off = f64::from(f32::EPSILON) * pair[0].value.max(pair[1].value);
        let [mut large, mut small] = [gap(pair), unit];
        if large > FAR * small {
            continue;
        }
        while small > PLACES / 2.0 * off {
            let rest = large - small * (large / small).round();
            [large, small] = [small, rest.abs()];
        }
        unit = large;
        if unit < PLACES * off {
            return 0.0;
        }
    }
    unit
}

/// For few values, whose gaps may be jumps between surfaces: the largest of the usual units that fits all.
fn usual(levels: &[Level], space: Space) -> f64 {
    let fits = |unit: &f64| {
        levels.iter().all(|level| {
            let off = f64::from(f32::EPSILON) * level.value;
            *unit > PLACES * off && (level.value - unit * (level.value / unit).round()).abs() <= 2.0 * off
        })
    };
    match space {
        Space::InverseDepth { metres } => [1e-3, 2e-4, 1e-4, 1e-5].into_iter().map(|m| m / metres).find(fits),
        Space::Value => (0..=8).map(|bits| 0.5f64.powi(bits)).find(fits),
    }
    .unwrap_or(0.0)
}
