//! A value that occurs in a map.

use super::sample::Counted;
use crate::noise::space::Space;

/// Fewest gaps of a stretch that tell its step. Flat surfaces on which every pixel has one value make fewer gaps, and
/// these are jumps in depth.
pub(super) const LEAST: usize = 8;

/// A value that occurs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    pub(super) value: f64,
    pub(super) q: f64,
    /// How often it starts anew in rows or in columns, whichever is less.
    pub(super) repeats: u32,
    /// How often it starts anew in rows and in columns together.
    pub(super) weight: u32,
}

impl Level {
    pub(super) fn of(counted: Counted, space: Space) -> Self {
        let Counted { value, rows, columns } = counted;
        let value = f64::from(value);
        Level { value, q: space.q(value), repeats: rows.min(columns), weight: rows + columns }
    }
}
