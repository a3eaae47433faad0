//! The payload of a ROS `compressedDepth` topic: a 12-byte header, then PNG or RVL.
//!
//! In: the header (`i32` format, `f32` A, `f32` B, little-endian) and its picture. Out: `u16` values
//! as stored. Of a 16UC1 topic these are millimetres; of a 32FC1 topic they are inverse depth by
//! A and B ([`quantised_inverse_depth`]).
//!
//! The message's format string, which says which of the two it is, is not in the payload. Upstream
//! (compressed_depth_image_transport) sets A and B for 32FC1 alone, as `A = q (q + 1)` and `B = 1 - A / farthest` with
//! `q` of 1 to 150 and a farthest depth of 1 to 100 m; 16UC1 leaves whatever memory held, mostly 0 or a tiny
//! number. So they are taken where both are numbers that make depths of all the values, within wider bounds.

use depthplanes::ValueKind;

use super::bytes::Cursor;
use super::format::{DecodeOptions, Format, Image};
use super::{png, rvl};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "compressed-depth",
    about: "ROS compressedDepth payload: 12-byte header, then PNG or RVL",
    extensions: &["compressedDepth"],
    sniff: |bytes| picture(bytes).is_some(),
    ends: |bytes, options| {
        let (picture, format) = picture(bytes)?;
        Some((format.ends)(picture, options)?.saturating_add(HEADER_BYTES as u64))
    },
    decode,
};

const HEADER_BYTES: usize = 12;

/// The picture behind the header, with its reader.
fn picture(bytes: &[u8]) -> Option<(&[u8], &'static Format)> {
    let format = Cursor::new(bytes, 0).i32()?;
    let picture = bytes.get(HEADER_BYTES..)?;
    // Upstream's enum knows -1 (undefined) and 0 (inverse depth), and writes 0 always.
    if !(-1..=0).contains(&format) {
        return None;
    }
    [&png::FORMAT, &rvl::FORMAT].into_iter().find(|format| (format.sniff)(picture)).map(|format| (picture, format))
}

fn unreadable(wrong: &str) -> Error {
    let accepted = "format (0), two 32-bit floats, then a PNG file or RVL with its size";
    Error::Unreadable { format: "compressed-depth", wrong: wrong.to_string(), accepted }
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let (picture, format) = picture(bytes).ok_or_else(|| unreadable("no PNG or RVL behind the header"))?;
    let mut image = (format.decode)(picture, options)?;
    let [a, b] = parameters(bytes).ok_or_else(|| unreadable("fewer than 12 bytes"))?;
    if explains(a, b, &image.pixels) {
        image.quantisation = Some([a, b]);
    }
    Ok(image)
}

/// A and B of the header.
fn parameters(bytes: &[u8]) -> Option<[f64; 2]> {
    let mut cursor = Cursor::new(bytes, 4);
    let mut float = || cursor.u32().map(|bits| f64::from(f32::from_bits(bits)));
    Some([float()?, float()?])
}

/// Whether A and B make depths of all the values.
fn explains(a: f64, b: f64, pixels: &Pixels) -> bool {
    let Pixels::U16(values) = pixels else { return false };
    let farthest_m = a / (1.0 - b); // Of the value 1; 0 is missing.
    let depths_m = 0.01..=1000.0;
    let nearest_m = |largest: u16| a / (f64::from(largest) - b);
    a.is_finite()
        && b.is_finite()
        && (1.0..=1e6).contains(&a)
        && depths_m.contains(&farthest_m)
        && values.iter().max().is_some_and(|largest| *largest == 0 || depths_m.contains(&nearest_m(*largest)))
}

/// What the numbers of a 32FC1 `compressedDepth` payload mean: upstream restores
/// `z = A / (value - B)`, so `1/z = value / A - B / A`.
///
/// # Errors
/// [`Error::Unreadable`] if the header is short or A and B are not usable: a 16UC1 payload.
pub fn inverse_depth_value_kind(bytes: &[u8]) -> Result<ValueKind> {
    let [a, b] = parameters(bytes).ok_or_else(|| unreadable("fewer than 12 bytes"))?;
    quantised_inverse_depth(a, b)
}

/// What numbers mean that were quantised as `A / z + B`: `1/z = value / A - B / A`.
///
/// # Errors
/// [`Error::Unreadable`] if A is not above 0, or A or B is not finite.
pub fn quantised_inverse_depth(a: f64, b: f64) -> Result<ValueKind> {
    if !(a.is_finite() && a > 0.0 && b.is_finite()) {
        return Err(unreadable(&format!("A = {a}, B = {b} describe no inverse depth")));
    }
    Ok(ValueKind::InverseDepth { slope: 1.0 / a, offset: -b / a })
}
