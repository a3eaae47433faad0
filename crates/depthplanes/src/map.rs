//! The input: a borrowed depth or disparity map and the rule for which of its pixels are valid.
//!
//! In: a slice of `u8`, `u16` or `f32` with width, height and stride. Out: a [`DepthView`], checked
//! once, that every stage reads. It never copies a pixel and never moves one: missing pixels stay
//! in place.

use crate::error::{Error, Result};
use crate::limits::{MAX_PIXELS, MAX_SIDE};

mod sealed {
    /// What the stages need of a pixel type; no part of the interface.
    pub trait Sealed: Sized {
        /// |a - b|.
        fn distance(self, other: Self) -> Self;
        /// The largest value of this type that is not above theta; for `f32`, the nearest.
        fn floor_from(theta: f64) -> Self;
        /// What kernels compare with for the range's high end: `high - low` for integers, else `high`.
        fn high_or_span(low: Self, high: Self) -> Self;
    }

    macro_rules! sealed {
        ($t:ident, $distance:expr, $floor_from:expr, $high_or_span:expr) => {
            impl Sealed for $t {
                #[inline(always)]
                fn distance(self, other: Self) -> Self {
                    $distance(self, other)
                }
                fn floor_from(theta: f64) -> Self {
                    $floor_from(theta)
                }
                fn high_or_span(low: Self, high: Self) -> Self {
                    $high_or_span(low, high)
                }
            }
        };
    }
    // `as` from a float clamps to the type's range and drops the fraction.
    sealed!(u8, u8::abs_diff, |theta: f64| theta as u8, |low, high: u8| high - low);
    sealed!(u16, u16::abs_diff, |theta: f64| theta as u16, |low, high: u16| high - low);
    sealed!(f32, |a: f32, b: f32| (a - b).abs(), |theta: f64| theta as f32, |_, high| high);
}

/// A pixel type: `u8`, `u16` or `f32`.
#[diagnostic::on_unimplemented(message = "`{Self}` is no pixel type", note = "pixels are `u8`, `u16` or `f32`")]
pub trait Pixel:
    sealed::Sealed + Copy + PartialOrd + PartialEq + Send + Sync + std::fmt::Debug + Into<f64> + 'static
{
    /// Always missing, in every map.
    const ZERO: Self;
    /// Lowest value that can be valid.
    const LOWEST: Self;
    /// Highest value that can be valid; for `f32` it excludes the infinities.
    const HIGHEST: Self;
    /// Whether values are whole numbers.
    const IS_INTEGER: bool;

    /// Nearest value of this type, clamped to its range.
    fn from_f64(value: f64) -> Self;

    /// The value in single precision, exactly.
    fn to_f32(self) -> f32;

    /// Wraps a view of this type.
    fn any(view: DepthView<'_, Self>) -> AnyView<'_>;
}

macro_rules! integer_pixel {
    ($t:ty, $variant:ident) => {
        impl Pixel for $t {
            const ZERO: Self = 0;
            const LOWEST: Self = 0;
            const HIGHEST: Self = <$t>::MAX;
            const IS_INTEGER: bool = true;
            fn from_f64(value: f64) -> Self {
                value.round() as $t
            }
            #[inline(always)]
            fn to_f32(self) -> f32 {
                self.into()
            }
            fn any(view: DepthView<'_, Self>) -> AnyView<'_> {
                AnyView::$variant(view)
            }
        }
    };
}
integer_pixel!(u8, U8);
integer_pixel!(u16, U16);

impl Pixel for f32 {
    const ZERO: Self = 0.0;
    const LOWEST: Self = f32::MIN;
    const HIGHEST: Self = f32::MAX;
    const IS_INTEGER: bool = false;
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }
    fn any(view: DepthView<'_, Self>) -> AnyView<'_> {
        AnyView::F32(view)
    }
}

/// Which values are measurements. A value is valid if it is not 0, not the sentinel, and within
/// `low..=high`; NaN and the infinities are never valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity<T> {
    /// Smallest valid value.
    pub low: T,
    /// Largest valid value.
    pub high: T,
    /// A second value that means "missing" beside 0; 0 if there is none.
    pub sentinel: T,
}

impl<T: Pixel> Validity<T> {
    /// Whether `value` is a measurement.
    #[inline(always)]
    pub fn holds(&self, value: T) -> bool {
        (value != T::ZERO) & (value != self.sentinel) & (value >= self.low) & (value <= self.high)
    }
}

impl<T: Pixel> Default for Validity<T> {
    fn default() -> Self {
        Validity { low: T::LOWEST, high: T::HIGHEST, sentinel: T::ZERO }
    }
}

/// A borrowed map, row by row, top row first.
///
/// ```
/// use depthplanes::DepthView;
/// let depth_mm: [u16; 6] = [1000, 1001, 0, 1002, 2047, 1003];
/// let view = DepthView::new(&depth_mm, 3, 2)?.missing_value(2047);
/// assert_eq!(view.valid_pixels(), 4);
/// assert!(DepthView::new(&depth_mm, 4, 2).is_err());
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DepthView<'a, T> {
    pixels: &'a [T],
    width: usize,
    height: usize,
    stride: usize,
    validity: Validity<T>,
}

impl<'a, T: Pixel> DepthView<'a, T> {
    /// A map whose rows follow each other without a gap: `pixels.len() == width * height`.
    ///
    /// # Errors
    /// [`Error::Size`] for a side of 0 or above [`MAX_SIDE`], or more than [`MAX_PIXELS`] in all;
    /// [`Error::Length`] if the slice does not hold exactly that many pixels.
    pub fn new(pixels: &'a [T], width: usize, height: usize) -> Result<Self> {
        let view = Self::with_stride(pixels, width, height, width)?;
        let exact = width * height;
        if pixels.len() != exact {
            return Err(Error::Length { given: pixels.len(), least: exact, most: exact });
        }
        Ok(view)
    }

    /// A map whose rows start `stride` pixels (not bytes) apart. The last row may end early: the
    /// slice holds `(height - 1) * stride + width` to `height * stride` pixels.
    ///
    /// # Errors
    /// As [`DepthView::new`], and [`Error::Stride`] if rows would overlap.
    pub fn with_stride(pixels: &'a [T], width: usize, height: usize, stride: usize) -> Result<Self> {
        let fits = |side| (1..=MAX_SIDE).contains(&side);
        if !fits(width) || !fits(height) || width * height > MAX_PIXELS {
            return Err(Error::Size { width, height });
        }
        let most = stride.checked_mul(height).filter(|_| stride >= width).ok_or(Error::Stride { stride, width })?;
        let least = most - stride + width;
        if !(least..=most).contains(&pixels.len()) {
            return Err(Error::Length { given: pixels.len(), least, most });
        }
        Ok(DepthView { pixels, width, height, stride, validity: Validity::default() })
    }

    /// States a value that means "missing", beside 0, NaN and the infinities (2047 for raw Kinect v1).
    #[must_use]
    pub fn missing_value(mut self, sentinel: T) -> Self {
        self.validity.sentinel = sentinel;
        self
    }

    /// Only values within `low..=high` (map units) are valid. An infinite end means no limit on that
    /// side; the infinities themselves stay missing.
    ///
    /// # Errors
    /// [`Error::ValidRange`] unless `low < high`.
    pub fn valid_range(mut self, low: T, high: T) -> Result<Self> {
        if low < high {
            self.validity.low = if low < T::LOWEST { T::LOWEST } else { low };
            self.validity.high = if high > T::HIGHEST { T::HIGHEST } else { high };
            Ok(self)
        } else {
            Err(Error::ValidRange { low: low.into(), high: high.into() })
        }
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Pixels in the map, valid or not.
    pub fn area(&self) -> usize {
        self.width * self.height
    }

    /// The rule for which pixels are valid.
    pub fn validity(&self) -> Validity<T> {
        self.validity
    }

    /// Row `v`, `width` pixels. Panics if `v >= height`.
    #[inline(always)]
    pub fn row(&self, v: usize) -> &'a [T] {
        assert!(v < self.height);
        &self.pixels[v * self.stride..][..self.width]
    }

    /// All rows, top first.
    pub fn rows(&self) -> impl Iterator<Item = &'a [T]> + use<'a, T> {
        let view = *self;
        (0..view.height).map(move |v| view.row(v))
    }

    /// How many pixels are valid.
    pub fn valid_pixels(&self) -> usize {
        let valid = self.validity;
        self.rows().map(|row| row.iter().filter(|&&value| valid.holds(value)).count()).sum()
    }

    /// A view of other pixels of the same width and height, without gaps between rows, with the same rule of validity.
    pub(crate) fn over<'b>(&self, pixels: &'b [T]) -> DepthView<'b, T> {
        assert_eq!(pixels.len(), self.area());
        DepthView { pixels, width: self.width, height: self.height, stride: self.width, validity: self.validity }
    }
}

/// A view of any of the three pixel types, for callers that learn the type at run time.
#[derive(Clone, Copy, Debug)]
pub enum AnyView<'a> {
    /// 8-bit values.
    U8(DepthView<'a, u8>),
    /// 16-bit values.
    U16(DepthView<'a, u16>),
    /// Floating-point values.
    F32(DepthView<'a, f32>),
}

impl<'a, T: Pixel> From<DepthView<'a, T>> for AnyView<'a> {
    fn from(view: DepthView<'a, T>) -> Self {
        T::any(view)
    }
}

/// Runs the same expression over the view inside an [`AnyView`], whatever its pixel type.
#[macro_export]
macro_rules! with_view {
    ($any:expr, $view:ident => $body:expr) => {
        match $any {
            $crate::AnyView::U8($view) => $body,
            $crate::AnyView::U16($view) => $body,
            $crate::AnyView::F32($view) => $body,
        }
    };
}
pub(crate) use with_view;

impl AnyView<'_> {
    /// Columns.
    pub fn width(&self) -> usize {
        with_view!(self, view => view.width())
    }

    /// Rows.
    pub fn height(&self) -> usize {
        with_view!(self, view => view.height())
    }
}
