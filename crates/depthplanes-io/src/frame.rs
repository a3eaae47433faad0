//! One map read from a file, owned, with what is known of its numbers.

use depthplanes::{AnyView, DepthView, Sensor};

/// The pixels of a frame, row by row, top row first.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// 8-bit values.
    U8(Vec<u8>),
    /// 16-bit values.
    U16(Vec<u16>),
    /// Floating-point values.
    F32(Vec<f32>),
}

/// A depth or disparity map read from a file. Integer maps keep the numbers that are in the file
/// unless the encoding says that its bits are packed.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The values.
    pub pixels: Pixels,
    /// A value that means "missing" beside 0, NaN and the infinities.
    pub missing: Option<f64>,
    /// Smallest and largest valid value, if the user or the encoding states them.
    pub valid_range: Option<(f64, f64)>,
    /// What the numbers mean, and the camera if known.
    pub sensor: Sensor,
    /// Name of the input format ([`crate::formats::FORMATS`]).
    pub format: &'static str,
    /// Name of the encoding ([`crate::encoding::ENCODINGS`]).
    pub encoding: &'static str,
    /// What a person should know of this file: suspicious numbers, channels dropped.
    pub warnings: Vec<String>,
}

impl Frame {
    /// The library's view of the frame.
    ///
    /// # Errors
    /// [`depthplanes::Error`] for a size or a valid range that the library does not accept.
    pub fn view(&self) -> depthplanes::Result<AnyView<'_>> {
        match &self.pixels {
            Pixels::U8(pixels) => self.typed(pixels),
            Pixels::U16(pixels) => self.typed(pixels),
            Pixels::F32(pixels) => self.typed(pixels),
        }
    }

    fn typed<'a, T: depthplanes::Pixel>(&self, pixels: &'a [T]) -> depthplanes::Result<AnyView<'a>> {
        let mut view = DepthView::new(pixels, self.width, self.height)?;
        if let Some(missing) = self.missing {
            view = view.missing_value(T::from_f64(missing));
        }
        if let Some((low, high)) = self.valid_range {
            view = view.valid_range(T::from_f64(low), T::from_f64(high))?;
        }
        Ok(view.into())
    }
}
