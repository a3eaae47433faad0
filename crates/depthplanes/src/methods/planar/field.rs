//! Stage "field": the map in the space where planes are affine.
//!
//! In: a map and its space. Out: q for every pixel in rows of [`Field::stride`], with room for whole
//! blocks of tiles around it, so that no later stage has to mind the map's edge.

use super::pyramid::LEVELS;
use super::tiles::{LANES, SIDE};
use crate::map::{DepthView, Pixel, Validity};
use crate::noise::{LARGEST_Q, Space};

/// Columns of the coarsest cells that are summed at a time.
pub(super) const COLUMNS: usize = LANES * ROWS;
/// Rows of the coarsest cells.
pub(super) const ROWS: usize = SIDE << (LEVELS - 1);

/// A map in q; NaN where nothing was measured, where q is more than [`LARGEST_Q`], and beyond the map's edge.
#[derive(Debug, Default)]
pub(super) struct Field {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Columns, a multiple of [`COLUMNS`].
    pub(super) stride: usize,
    /// Rows, a multiple of [`ROWS`].
    pub(super) rows: usize,
    pub(super) q: Vec<f32>,
    pub(super) valid_pixels: usize,
}

impl Field {
    /// Makes room for a map.
    pub(super) fn prepare<T: Pixel>(&mut self, map: &DepthView<'_, T>) {
        let (width, height) = (map.width(), map.height());
        if (self.width, self.height) != (width, height) {
            (self.width, self.height) = (width, height);
            (self.stride, self.rows) = (width.next_multiple_of(COLUMNS), height.next_multiple_of(ROWS));
            self.q.clear();
            self.q.resize(self.stride * self.rows, f32::NAN);
        }
    }
}

/// Turns a row of a map into q; how many of its pixels are valid.
#[inline(always)]
pub(super) fn fill_row<T: Pixel>(row: &[T], q: &mut [f32], validity: Validity<T>, space: Space) -> usize {
    match space {
        Space::InverseDepth { metres } => {
            let per_unit = (1.0 / metres) as f32;
            fill_with(row, q, validity, |value| per_unit / value)
        }
        Space::Value => fill_with(row, q, validity, |value| value),
    }
}

#[inline(always)]
fn fill_with<T: Pixel>(row: &[T], q: &mut [f32], validity: Validity<T>, of: impl Fn(f32) -> f32) -> usize {
    let mut valid = 0u32;
    for (q, &value) in q.iter_mut().zip(row) {
        let of_value = of(value.to_f32());
        let holds = validity.holds(value) & (of_value.abs() <= LARGEST_Q);
        *q = if holds { of_value } else { f32::NAN };
        valid += u32::from(holds);
    }
    valid as usize
}
