//! Map enhancing (paper, section 3b): missing pixels take the mean of the valid pixels around them.
//!
//! In: a map and the side of a window, odd, 3..=31. Out: the map with gaps filled: a missing pixel
//! becomes the mean of the valid pixels in the window around it, clipped at the map's edges, unless
//! more than half of the (clipped) window is missing. Means of whole numbers round half up. Only the
//! original map is read, so the order of pixels does not matter. The cost of a pixel does not depend
//! on the window: sums of columns move down row by row, and their prefix sums give any window by one
//! subtraction.

use crate::error::{Error, Result};
use crate::map::{DepthView, Pixel};

/// Smallest and largest side of the window.
pub const WINDOW: std::ops::RangeInclusive<u32> = 3..=31;

/// Fills maps; reuses its memory from map to map.
#[derive(Debug, Default)]
pub struct Enhancer {
    columns: Columns,
    u8: Buffers<u8>,
    u16: Buffers<u16>,
    f32: Buffers<f32>,
}

/// The filled map, and what the pass before it left.
#[derive(Debug, Default)]
#[doc(hidden)]
pub struct Buffers<T> {
    filled: Vec<T>,
    before: Vec<T>,
}

/// Pixel types that the enhancer has memory for.
pub trait Fillable: Pixel {
    /// The enhancer's memory for this type.
    fn buffers(enhancer: &mut Enhancer) -> (&mut Buffers<Self>, &mut Columns);
}

macro_rules! fillable {
    ($t:ident) => {
        impl Fillable for $t {
            fn buffers(enhancer: &mut Enhancer) -> (&mut Buffers<Self>, &mut Columns) {
                (&mut enhancer.$t, &mut enhancer.columns)
            }
        }
    };
}
fillable!(u8);
fillable!(u16);
fillable!(f32);

impl Enhancer {
    /// Fills a map `passes` times, each pass reading what the one before left, and returns it with the
    /// number of pixels that were filled. Valid pixels keep their values, and pixels that stay missing
    /// keep theirs.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `window` is odd and within [`WINDOW`].
    ///
    /// ```
    /// use depthplanes::{DepthView, internals::Enhancer};
    /// let map: [u16; 9] = [10, 11, 12, 10, 0, 12, 10, 11, 13];
    /// let mut enhancer = Enhancer::default();
    /// let (filled, count) = enhancer.enhance(&DepthView::new(&map, 3, 3)?, 3, 1)?;
    /// assert_eq!(filled.row(1), [10, 11, 12]);
    /// assert_eq!(count, 1);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn enhance<'a, T: Fillable>(
        &'a mut self,
        map: &DepthView<'_, T>,
        window: u32,
        passes: u32,
    ) -> Result<(DepthView<'a, T>, usize)> {
        if !WINDOW.contains(&window) || window.is_multiple_of(2) {
            let accepted = format!("an odd whole number of pixels from {} to {}", WINDOW.start(), WINDOW.end());
            return Err(Error::Parameter { name: "window", given: window.into(), accepted });
        }
        let reach = (window / 2) as usize;
        let (Buffers { filled, before }, columns) = T::buffers(self);
        filled.clear();
        map.rows().for_each(|row| filled.extend_from_slice(row));
        let mut count = fill(map, reach, columns, filled);
        for _ in 1..passes {
            before.clone_from(filled);
            count += fill(&map.over(before), reach, columns, filled);
        }
        Ok((map.over(filled), count))
    }
}

/// Sums over the window's rows, one for each column, and their prefix sums.
#[derive(Debug, Default)]
#[doc(hidden)]
pub struct Columns {
    count: Vec<u32>,
    sum: Vec<f64>,
    count_before: Vec<u32>,
    sum_before: Vec<f64>,
}

impl Columns {
    fn prepare(&mut self, width: usize) {
        for counts in [&mut self.count, &mut self.count_before] {
            counts.clear();
            counts.resize(width + 1, 0);
        }
        for sums in [&mut self.sum, &mut self.sum_before] {
            sums.clear();
            sums.resize(width + 1, 0.0);
        }
    }

    /// Adds a row to the window, or takes it away.
    fn add<T: Pixel>(&mut self, row: &[T], map: &DepthView<'_, T>, sign: f64) {
        let validity = map.validity();
        let step = sign as i32 as u32;
        for ((&value, sum), count) in row.iter().zip(&mut self.sum).zip(&mut self.count) {
            let valid = validity.holds(value);
            *sum += if valid { sign * value.into() } else { 0.0 };
            *count = count.wrapping_add(if valid { step } else { 0 });
        }
    }

    fn accumulate(&mut self) {
        let (mut count, mut sum) = (0, 0.0);
        for u in 0..self.count.len() {
            (self.count_before[u], self.sum_before[u]) = (count, sum);
            count += self.count[u];
            sum += self.sum[u];
        }
    }
}

/// Writes the means into `out`, which holds the map's own values; returns how many pixels were filled.
fn fill<T: Pixel>(map: &DepthView<'_, T>, reach: usize, columns: &mut Columns, out: &mut [T]) -> usize {
    let (width, height, validity) = (map.width(), map.height(), map.validity());
    let exact = sums_are_exact(map);
    columns.prepare(width);
    (0..reach.min(height)).for_each(|v| columns.add(map.row(v), map, 1.0));
    let mut filled = 0;
    for v in 0..height {
        if v + reach < height {
            columns.add(map.row(v + reach), map, 1.0);
        }
        if v > reach {
            columns.add(map.row(v - reach - 1), map, -1.0);
        }
        let row = map.row(v);
        if row.iter().all(|&value| validity.holds(value)) {
            continue;
        }
        columns.accumulate();
        let rows = v.saturating_sub(reach)..(v + reach + 1).min(height);
        for u in (0..width).filter(|&u| !validity.holds(row[u])) {
            let (first, end) = (u.saturating_sub(reach), (u + reach + 1).min(width));
            let valid = columns.count_before[end] - columns.count_before[first];
            let area = ((end - first) * rows.len()) as u32;
            if valid == 0 || (area - valid) * 2 > area {
                continue;
            }
            let sum = match exact {
                true => columns.sum_before[end] - columns.sum_before[first],
                false => sum_directly(map, rows.clone(), first..end),
            };
            let mean = T::from_f64(sum / f64::from(valid));
            // Our choice: a mean that itself means "missing" (the sentinel) fills nothing.
            if validity.holds(mean) {
                out[v * width + u] = mean;
                filled += 1;
            }
        }
    }
    filled
}

/// The definition: the sum of the window's valid pixels in raster order, in `f64`.
fn sum_directly<T: Pixel>(
    map: &DepthView<'_, T>,
    rows: std::ops::Range<usize>,
    columns: std::ops::Range<usize>,
) -> f64 {
    let validity = map.validity();
    let values = rows.flat_map(|v| &map.row(v)[columns.clone()]);
    values.filter(|&&value| validity.holds(value)).map(|&value| value.into()).sum()
}

/// Whether `f64` adds and takes away any of this map's values without rounding, so that moving sums
/// equal direct ones bit for bit: all values are multiples of the smallest one's last place, and the
/// largest sum of a row's width of windows stays below 2^53 of those. True for integers and for any
/// real depth map in `f32`; a map that spans more than some 10^5 falls back to direct sums.
fn sums_are_exact<T: Pixel>(map: &DepthView<'_, T>) -> bool {
    if T::IS_INTEGER {
        return true; // at most 65,535 * 31 * 65,535 in one row of columns
    }
    let validity = map.validity();
    let (mut smallest, mut largest) = (f64::MAX, 0.0f64);
    for &value in map.rows().flatten().filter(|&&value| validity.holds(value)) {
        let size = value.into().abs();
        smallest = smallest.min(size);
        largest = largest.max(size);
    }
    let terms = (map.width() * (*WINDOW.end() as usize)) as f64;
    let last_place = smallest * f64::from(f32::EPSILON) / 2.0;
    largest * terms < last_place * (1u64 << 53) as f64
}
