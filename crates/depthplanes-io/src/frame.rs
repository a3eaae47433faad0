//! One map read from a file, owned, with what is known of its numbers.

use depthplanes::scene::{SceneFrame, ScenePixels};
use depthplanes::{AnyView, DepthView, Pixel, Sensor, with_view};
use std::cmp::Ordering;

use crate::stereo::Stereo;

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

impl Pixels {
    /// Number of pixels.
    #[expect(clippy::len_without_is_empty, reason = "a map has pixels")]
    pub fn len(&self) -> usize {
        match self {
            Pixels::U8(values) => values.len(),
            Pixels::U16(values) => values.len(),
            Pixels::F32(values) => values.len(),
        }
    }

    /// A view of them as a map of that size.
    pub(crate) fn view(&self, width: usize, height: usize) -> depthplanes::Result<AnyView<'_>> {
        Ok(match self {
            Pixels::U8(pixels) => DepthView::new(pixels, width, height)?.into(),
            Pixels::U16(pixels) => DepthView::new(pixels, width, height)?.into(),
            Pixels::F32(pixels) => DepthView::new(pixels, width, height)?.into(),
        })
    }
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
    /// Who said so, and what was stated beside the file.
    pub provenance: Provenance,
    /// What a person should know of this file: suspicious numbers, channels dropped.
    pub warnings: Vec<String>,
}

/// Where the meaning of a map's numbers comes from, so that a result can be made again and a wrong one traced.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// Why the encoding is what it is: `stated`, `preset`, or what the map looks like.
    pub encoding: String,
    /// The sensor preset in use.
    pub preset: Option<&'static str>,
    /// The encoding's scale, if one was stated.
    pub scale: Option<f64>,
    /// The stereo rig, if one was stated.
    pub stereo: Option<Stereo>,
    /// Whether the numbers were stated to be disparities, by a flag, a rig or the camera file.
    pub disparity: bool,
    /// Who stated the noise of single pixels; nobody if the sensor has none.
    pub noise: Option<Source>,
    /// Who stated the smooth part of the noise.
    pub smooth_noise: Option<Source>,
    /// Whether the values were distances along the rays and were turned into depth.
    pub ray_distance: bool,
}

impl Provenance {
    /// Whether nobody stated the encoding, neither the user nor a preset: it is what the map looks like.
    pub fn is_guess(&self) -> bool {
        self.encoding != "stated" && self.encoding != "preset"
    }
}

/// Who stated something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The user.
    Stated,
    /// The sensor preset.
    Preset,
}

impl From<SceneFrame> for Frame {
    /// A synthetic frame, which knows its own unit and camera.
    fn from(scene: SceneFrame) -> Self {
        let pixels = match scene.pixels {
            ScenePixels::U8(pixels) => Pixels::U8(pixels),
            ScenePixels::U16(pixels) => Pixels::U16(pixels),
            ScenePixels::F32(pixels) => Pixels::F32(pixels),
        };
        Frame {
            width: scene.width,
            height: scene.height,
            pixels,
            missing: None,
            valid_range: None,
            sensor: scene.sensor,
            format: "scene",
            encoding: "scene",
            provenance: Provenance { encoding: "a synthetic scene knows its own".into(), ..Provenance::default() },
            warnings: Vec::new(),
        }
    }
}

impl Frame {
    /// The library's view of the frame.
    ///
    /// # Errors
    /// [`depthplanes::Error`] for a size or a valid range that the library does not accept.
    pub fn view(&self) -> depthplanes::Result<AnyView<'_>> {
        with_validity(self.pixels.view(self.width, self.height)?, self.missing, self.valid_range)
    }
}

/// A map with the rule for which of its pixels are valid.
pub(crate) fn with_validity<'m>(
    map: AnyView<'m>,
    missing: Option<f64>,
    valid_range: Option<(f64, f64)>,
) -> depthplanes::Result<AnyView<'m>> {
    fn typed<'m, T: Pixel>(
        mut view: DepthView<'m, T>,
        missing: Option<f64>,
        valid_range: Option<(f64, f64)>,
    ) -> depthplanes::Result<AnyView<'m>> {
        if let Some(missing) = missing {
            view = view.missing_value(T::from_f64(missing));
        }
        if let Some((low, high)) = valid_range {
            if low.partial_cmp(&high) != Some(Ordering::Less) {
                return Err(depthplanes::Error::ValidRange { low, high }); // before NaN becomes a whole number
            }
            view = view.valid_range(T::from_f64(low), T::from_f64(high))?;
        }
        Ok(view.into())
    }
    with_view!(map, view => typed(view, missing, valid_range))
}
