//! What a format is: the row that names it, the map that it reads, and what it may need beside the bytes.
//!
//! Formats take these types from here, and the table of formats takes the formats.

use depthplanes::Intrinsics;

use crate::error::{Error, Result};
use crate::frame::Pixels;

/// What an untrusted file may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Most pixels of a map; 2^27 (134 million) by default.
    pub max_pixels: usize,
    /// Most bytes of a file, and of its decoded samples; 2^30 (1 GiB) by default.
    pub max_bytes: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { max_pixels: 1 << 27, max_bytes: 1 << 30 }
    }
}

impl Limits {
    /// Number of pixels of a map of the stated size.
    ///
    /// # Errors
    /// [`Error::Limit`] above [`Limits::max_pixels`], or if `sample_bytes` each exceed
    /// [`Limits::max_bytes`]; [`Error::Unreadable`] for a side of 0 or above 65535.
    pub fn area(&self, format: &'static str, width: u64, height: u64, sample_bytes: usize) -> Result<usize> {
        let side = 1..=depthplanes::limits::MAX_SIDE as u64;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(Error::Unreadable {
                format,
                wrong: format!("the header states {width} x {height} pixels"),
                accepted: "sides of 1 to 65535 pixels",
            });
        }
        let area = width * height;
        if area > self.max_pixels as u64 {
            return Err(Error::Limit { what: "number of pixels", given: area, limit: self.max_pixels as u64 });
        }
        let bytes = area.saturating_mul(sample_bytes as u64);
        if bytes > self.max_bytes as u64 {
            return Err(Error::Limit { what: "number of decoded bytes", given: bytes, limit: self.max_bytes as u64 });
        }
        Ok(area as usize)
    }
}

/// What a reader may need to know beside the bytes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DecodeOptions {
    /// What the file may ask for.
    pub limits: Limits,
    /// The map to read from a file that holds several: the name of an array (NPZ), the index along the first axis from 0
    /// (NPY), the page from 1 (TIFF).
    pub member: Option<String>,
    /// Columns and rows of a headerless file; stating them selects the format `raw`.
    pub raw_size: Option<(usize, usize)>,
    /// Sample type of a headerless file, such as `uint16` or `float32` ([`super::raw_types`]); without it the length of the
    /// file decides.
    pub raw_type: Option<String>,
    /// Whether pixels of several channels are handed on as they are ([`Image::channels`]), for encodings that read them.
    /// Otherwise channels that differ are refused.
    pub channels: bool,
    /// Whether a colour bitmap (BMP) becomes its luminance instead of being refused: label images with a colour for each
    /// plane.
    pub luminance: bool,
}

/// A map as it stands in the file, before anything is said of its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The values, row by row, top row first.
    pub pixels: Pixels,
    /// Values a pixel, one beside the other, colours as red, green, blue and opacity last. It is 1 unless
    /// [`DecodeOptions::channels`] asks for all of them.
    pub channels: usize,
    /// Sample type in the file, in numpy's words: `uint16`, `float32` ...
    pub sample: &'static str,
    /// The value for "missing" that the file states.
    pub missing: Option<f64>,
    /// A and B of quantised inverse depth, `z = A / (value - B)`, if the file states them (ROS `compressedDepth`).
    pub quantisation: Option<[f64; 2]>,
    /// The camera, if the numbers say it (points of an organised cloud).
    pub intrinsics: Option<Intrinsics>,
    /// What a person should know: channels dropped, numbers converted.
    pub warnings: Vec<String>,
}

impl Image {
    /// A map of one value a pixel of which the file says no more.
    pub(super) fn new(
        width: usize,
        height: usize,
        pixels: Pixels,
        sample: &'static str,
        warnings: Vec<String>,
    ) -> Self {
        Image {
            width,
            height,
            pixels,
            channels: 1,
            sample,
            missing: None,
            quantisation: None,
            intrinsics: None,
            warnings,
        }
    }
}

/// One input format.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// Its name, as in [`crate::Frame::format`].
    pub name: &'static str,
    /// One line for the table of formats.
    pub about: &'static str,
    /// Usual file name extensions, for file dialogs and directory scans only.
    pub extensions: &'static [&'static str],
    /// Whether the bytes claim to be this format.
    pub sniff: fn(&[u8]) -> bool,
    /// How many bytes a file that begins so has at the most, as far as these tell; the number may grow with further bytes. It
    /// is for inputs that have no end of their own. `None` if that cannot be known.
    pub ends: fn(&[u8], &DecodeOptions) -> Option<u64>,
    /// Reads the map.
    pub decode: fn(&[u8], &DecodeOptions) -> Result<Image>,
}
