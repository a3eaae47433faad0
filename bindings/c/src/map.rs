//! Maps in the caller's memory.
//!
//! In: a pointer, a type, a size and a stride. Out: rows of pixels, checked once, and a view of them where they lie.

use crate::error::{Error, Result};
use depthplanes::limits::{MAX_PIXELS, MAX_SIDE};
use depthplanes::{AnyView, DepthView, Pixel};
use std::ffi::c_void;

/// The type of a map's pixels.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum dp_pixel_type {
    /// `uint8_t`: grey levels without a unit, unless one is stated.
    DP_UINT8 = 0,
    /// `uint16_t`: millimetres, unless a unit is stated.
    DP_UINT16 = 1,
    /// `float`: metres, unless a unit is stated.
    DP_FLOAT32 = 2,
    /// `double`: as `float`, to which it is converted.
    DP_FLOAT64 = 3,
}

use dp_pixel_type::{DP_FLOAT32, DP_FLOAT64, DP_UINT8, DP_UINT16};

/// Each type, its name in numpy's words, its bytes.
const TYPES: [(dp_pixel_type, &str, usize); 4] =
    [(DP_UINT8, "uint8", 1), (DP_UINT16, "uint16", 2), (DP_FLOAT32, "float32", 4), (DP_FLOAT64, "float64", 8)];

/// A depth or disparity map in the caller's memory, row by row, top row first. 0, NaN and infinity mean "not measured".
///
/// Pixels of type `uint8_t`, `uint16_t` and `float` are read where they lie if they are aligned as their type asks for; all
/// else is copied once. They must not be written to during a call.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_map {
    /// The first pixel of the first row.
    pub pixels: *const c_void,
    /// The type of the pixels, a `dp_pixel_type`.
    pub pixel_type: i32,
    /// Columns, 1 to 65535.
    pub width: usize,
    /// Rows, 1 to 65535; 2^30 pixels at most.
    pub height: usize,
    /// Bytes from the start of a row to the start of the next; 0 if there is no gap between them.
    pub stride_bytes: usize,
}

/// A map whose numbers were checked.
pub(crate) struct Pixels<'m> {
    map: &'m dp_map,
    pub(crate) sample: &'static str,
    pixel_type: dp_pixel_type,
    pixel_bytes: usize,
    stride_bytes: usize,
}

impl dp_map {
    /// The map, if its numbers are accepted.
    ///
    /// # Errors
    /// A null pointer, an unknown type, a size or a stride that is not accepted.
    pub(crate) fn checked(&self) -> Result<Pixels<'_>> {
        if self.pixels.is_null() {
            return Err(Error::null("map.pixels"));
        }
        let row = TYPES.iter().find(|row| row.0 as i32 == self.pixel_type);
        let &(pixel_type, sample, pixel_bytes) = row.ok_or_else(|| {
            let names = "DP_UINT8 (0), DP_UINT16 (1), DP_FLOAT32 (2), DP_FLOAT64 (3)";
            Error::invalid(format!("the pixel type is {}; accepted: {names}", self.pixel_type))
        })?;
        let (width, height) = (self.width, self.height);
        let fits = |side| (1..=MAX_SIDE).contains(&side);
        if !fits(width) || !fits(height) || width * height > MAX_PIXELS {
            return Err(depthplanes::Error::Size { width, height }.into());
        }
        let row_bytes = width * pixel_bytes;
        let stride_bytes = if self.stride_bytes == 0 { row_bytes } else { self.stride_bytes };
        let is_within = |bytes: usize| isize::try_from(bytes).is_ok();
        if stride_bytes < row_bytes || !stride_bytes.checked_mul(height).is_some_and(is_within) {
            return Err(Error::invalid(format!(
                "the stride is {stride_bytes} bytes; accepted: 0 for rows without a gap, or from the {row_bytes} bytes of \
                 {width} pixels of {sample} up to what fits in memory"
            )));
        }
        Ok(Pixels { map: self, sample, pixel_type, pixel_bytes, stride_bytes })
    }
}

impl<'m> Pixels<'m> {
    /// Columns and rows.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.map.width, self.map.height)
    }

    /// The pixels where they lie; `None` if they do not lie as those of a map, or are of another type.
    pub(crate) fn in_place(&self) -> Option<depthplanes::Result<AnyView<'m>>> {
        match self.pixel_type {
            DP_UINT8 => self.typed::<u8>(),
            DP_UINT16 => self.typed::<u16>(),
            DP_FLOAT32 => self.typed::<f32>(),
            DP_FLOAT64 => None,
        }
    }

    fn typed<T: Pixel>(&self) -> Option<depthplanes::Result<AnyView<'m>>> {
        let (start, (width, height)) = (self.map.pixels.cast::<T>(), self.size());
        if !start.is_aligned() || !self.stride_bytes.is_multiple_of(self.pixel_bytes) {
            return None;
        }
        let stride = self.stride_bytes / self.pixel_bytes;
        // SAFETY: the caller of C says that there are `height` rows of `width` pixels that begin `stride` pixels apart, and
        // that nobody writes to them during the call; any bits are a number. It was checked that they are aligned.
        let pixels = unsafe { std::slice::from_raw_parts(start, (height - 1) * stride + width) };
        Some(DepthView::with_stride(pixels, width, height, stride).map(Into::into))
    }

    /// A copy of the pixels' bytes, without gaps between rows.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let (width, height) = self.size();
        let row = |v: usize| {
            // SAFETY: as in `typed`; bytes need no alignment.
            unsafe {
                let start = self.map.pixels.cast::<u8>().add(v * self.stride_bytes);
                std::slice::from_raw_parts(start, width * self.pixel_bytes)
            }
        };
        (0..height).flat_map(row).copied().collect()
    }
}
