//! When two neighbours are linked.

use crate::error::{Error, Result};
use crate::map::{Pixel, Validity};

/// When two neighbours are linked: both valid, values at most `theta` apart.
#[derive(Clone, Copy, Debug)]
pub struct Connectivity<T> {
    /// Which values count. For integers `low` is at least 1, so that the range rules out 0.
    pub(crate) validity: Validity<T>,
    /// Largest difference. Integer maps: theta rounded down, which links the same pixels; `f32`
    /// maps: the nearest `f32`.
    pub(crate) theta: T,
    /// The valid range's length for integers, where one comparison of `value - low` serves for both
    /// ends; its high end for `f32`.
    #[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "only the kernels of x86-64 ask for it"))]
    pub(crate) high_or_span: T,
    /// Whether the rule of validity is the default: 0, NaN and the infinities are missing, and nothing else.
    #[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "only the kernels of x86-64 ask for it"))]
    pub(crate) is_default: bool,
}

impl<T: Pixel> Connectivity<T> {
    /// The rule for a map and a theta in map units.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless theta is a number of at least 0.
    pub fn new(mut validity: Validity<T>, theta: f64) -> Result<Self> {
        let is_default = validity == Validity::default();
        if T::IS_INTEGER && validity.low == T::ZERO {
            validity.low = T::from_f64(1.0);
        }
        if theta >= 0.0 {
            Ok(Connectivity {
                validity,
                theta: T::floor_from(theta),
                high_or_span: T::high_or_span(validity.low, validity.high),
                is_default,
            })
        } else {
            Err(Error::Parameter { name: "theta", given: theta, accepted: "a number from 0 up, in map units".into() })
        }
    }

    /// Whether two values are at most theta apart.
    #[inline(always)]
    pub(crate) fn close(&self, a: T, b: T) -> bool {
        a.distance(b) <= self.theta
    }
}
