//! The payload of a ROS `compressedDepth` topic: a 12-byte header, then PNG or RVL.
//!
//! In: the header (`i32` format, `f32` A, `f32` B, little-endian) and its picture. Out: `u16` values
//! as stored. Of a 16UC1 topic these are millimetres; of a 32FC1 topic they are inverse depth by
//! A and B ([`inverse_depth_measure`]). The payload cannot say which of the two it is, only the
//! message's format string can: 16UC1 leaves A and B unset.

use depthplanes::Measure;

use super::bytes::Cursor;
use super::format::{DecodeOptions, Format, Image};
use super::{png, rvl};
use crate::error::{Error, Result};

pub(super) const FORMAT: Format = Format {
    name: "compressed-depth",
    about: "ROS compressedDepth payload: 12-byte header, then PNG or RVL",
    extensions: &["compressedDepth"],
    sniff: |bytes| picture(bytes).is_some(),
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
    (format.decode)(picture, options)
}

/// What the numbers of a 32FC1 `compressedDepth` payload mean: upstream restores
/// `z = A / (value - B)`, so `1/z = value / A - B / A`.
///
/// # Errors
/// [`Error::Unreadable`] if the header is short or A and B are not usable: a 16UC1 payload.
pub fn inverse_depth_measure(bytes: &[u8]) -> Result<Measure> {
    let mut cursor = Cursor::new(bytes, 4);
    let mut float = || cursor.u32().map(|bits| f64::from(f32::from_bits(bits)));
    let (a, b) = float().zip(float()).ok_or_else(|| unreadable("fewer than 12 bytes"))?;
    if !(a.is_finite() && a > 0.0 && b.is_finite()) {
        return Err(unreadable(&format!("A = {a}, B = {b} describe no inverse depth")));
    }
    Ok(Measure::InverseDepth { slope: 1.0 / a, offset: -b / a })
}
