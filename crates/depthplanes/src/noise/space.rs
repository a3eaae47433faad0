//! The space where planes are affine.

use crate::camera::ValueKind;

/// Largest q that counts as measured: sums of its squares fit single precision. As depth it is a femtometre.
pub(crate) const LARGEST_Q: f32 = 1e15;

/// The space where planes of a map are affine, `q = a u + b v + c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Space {
    /// q is inverse depth, 1/m, of maps with that many metres per map unit.
    InverseDepth {
        /// Metres per map unit.
        metres: f64,
    },
    /// q is the map's value: disparity, or inverse depth up to a scale and an offset.
    Value,
}

impl Space {
    /// The space for a map whose numbers mean that.
    pub fn of(value_kind: ValueKind) -> Self {
        match value_kind {
            ValueKind::Depth { metres } => Space::InverseDepth { metres },
            ValueKind::InverseDepth { .. } | ValueKind::Disparity => Space::Value,
        }
    }

    /// q of a map value.
    #[inline(always)]
    pub fn q(self, value: f64) -> f64 {
        match self {
            Space::InverseDepth { metres } => 1.0 / (metres * value),
            Space::Value => value,
        }
    }

    /// How much q changes for one map unit, at q: |dq / dvalue|.
    #[inline]
    pub fn unit(self, q: f64) -> f64 {
        match self {
            Space::InverseDepth { metres } => metres * q * q,
            Space::Value => 1.0,
        }
    }
}
