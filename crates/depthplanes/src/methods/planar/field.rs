//! Stage "field": the map in the space where planes are affine.
//!
//! In: a map and its space. Out: q for every pixel in rows of [`Field::stride`], with room for whole
//! blocks of tiles around it, so that no later stage has to mind the map's edge.

use super::tiles::{LANES, LEVELS, SIDE};
use crate::group::vectorised;
use crate::map::{DepthView, Pixel, Validity};
use crate::noise::Space;

/// Columns that are summed at a time.
const COLUMNS: usize = LANES * SIDE;
/// Rows of the coarsest cells.
const ROWS: usize = SIDE << (LEVELS - 1);
/// Values that are looked at, about, to find the steps they come in.
const SAMPLE: usize = 1 << 15;

/// Values that are passed over at a time where none of them occurs.
const GROUP: usize = 32;
/// Longest step that is told from longer ones, map units.
const FAR: usize = 1023;

/// A map in q; NaN where nothing was measured and beyond the map's edge.
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
    /// Steps that the map's values come in, map units; 0 for values that are not rounded.
    pub(super) step: f64,
    seen: Vec<bool>,
}

impl Field {
    /// Turns every value into q.
    pub(super) fn fill<T: Pixel>(&mut self, map: &DepthView<'_, T>, space: Space) {
        self.prepare(map.width(), map.height());
        let Field { width, stride, q, .. } = self;
        self.valid_pixels = map
            .rows()
            .zip(q.chunks_exact_mut(*stride))
            .map(|(row, q)| {
                let q = &mut q[..*width];
                vectorised(
                    #[inline(always)]
                    || fill_row(row, q, map.validity(), space),
                )
            })
            .sum();
        self.step = if T::IS_INTEGER { self.value_step(map) } else { 0.0 };
    }

    fn prepare(&mut self, width: usize, height: usize) {
        if (self.width, self.height) != (width, height) {
            (self.width, self.height) = (width, height);
            (self.stride, self.rows) = (width.next_multiple_of(COLUMNS), height.next_multiple_of(ROWS));
            self.q.clear();
            self.q.resize(self.stride * self.rows, f32::NAN);
        }
    }

    /// The lower quartile of the distances of neighbouring values that occur: scaled maps leave out many.
    fn value_step<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> f64 {
        let seen = &mut self.seen;
        seen.clear();
        seen.resize(1 << (8 * size_of::<T>()).min(16), false);
        let validity = map.validity();
        for row in map.rows().step_by(map.area().div_ceil(SAMPLE)) {
            row.iter().filter(|value| validity.holds(**value)).for_each(|&value| seen[value.into() as usize] = true);
        }
        let mut steps = [0u32; FAR + 1];
        let mut last = None;
        for (first, values) in (0..).step_by(GROUP).zip(seen.chunks(GROUP)) {
            if values.contains(&true) {
                for (value, _) in (first..).zip(values).filter(|(_, seen)| **seen) {
                    if let Some(last) = last.replace(value) {
                        steps[FAR.min(value - last)] += 1;
                    }
                }
            }
        }
        let count: u32 = steps.iter().sum();
        let mut smaller = 0;
        let quartile = (1..=FAR).find(|&step| {
            smaller += steps[step];
            4 * smaller >= count
        });
        quartile.unwrap_or(1) as f64
    }
}

/// Turns a row into q; how many of its pixels are valid.
#[inline(always)]
fn fill_row<T: Pixel>(row: &[T], q: &mut [f32], validity: Validity<T>, space: Space) -> usize {
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
        let holds = validity.holds(value) & of_value.is_finite();
        *q = if holds { of_value } else { f32::NAN };
        valid += u32::from(holds);
    }
    valid as usize
}
