//! Values that are spread over the channels of a picture: bytes of 16-bit and 24-bit integers and of floats.
//!
//! In: an [`Image`] with all its channels. Out: the same image with one channel. What the values count is the encoding's
//! business ([`crate::encoding`]).

use crate::error::{Error, Result};
use crate::formats::{self, Image};
use crate::frame::Pixels;

/// How the bytes of one value lie in the channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Packing {
    /// 16 bits in the two channels that vary, the high byte in the first of them or in the second.
    TwoBytes { high_first: bool },
    /// 24 bits in red, green and blue, the high byte in red or in blue.
    ThreeBytes { high_first: bool },
    /// A 32-bit float in red, green, blue and opacity.
    Float { big_endian: bool },
}

/// Makes one value of the channels: 16-bit integers, or floats, which hold 24 bits.
///
/// # Errors
/// [`Error::Parameter`] if the image has other channels, or samples that are no bytes.
pub(crate) fn unpack(encoding: &'static str, image: &mut Image, packing: Packing) -> Result<()> {
    let (channels, accepted) = match packing {
        Packing::TwoBytes { .. } => (2..=4, "a picture of two to four channels of 8 bits"),
        Packing::ThreeBytes { .. } => (3..=4, "a picture of red, green and blue of 8 bits"),
        Packing::Float { .. } => (4..=4, "a picture of red, green, blue and opacity of 8 bits"),
    };
    let refused = |image: &Image| {
        let Image { channels, sample, .. } = image;
        Error::parameter("--encoding", encoding, format!("{accepted}; this one has {channels} of {sample}"))
    };
    if !channels.contains(&image.channels) {
        return Err(refused(image));
    }
    let bytes = formats::bytes_of_channels(&image.pixels).ok_or_else(|| refused(image))?;
    let pixels = bytes.chunks_exact(image.channels);
    image.pixels = match packing {
        Packing::TwoBytes { high_first } => {
            let [first, second] = two_channels(encoding, &bytes, image.channels)?;
            let [high, low] = if high_first { [first, second] } else { [second, first] };
            Pixels::U16(pixels.map(|pixel| u16::from_be_bytes([pixel[high], pixel[low]])).collect())
        }
        Packing::ThreeBytes { high_first } => {
            let value = |pixel: &[u8]| {
                let [r, g, b] = [pixel[0], pixel[1], pixel[2]];
                if high_first { u32::from_be_bytes([0, r, g, b]) } else { u32::from_le_bytes([r, g, b, 0]) }
            };
            Pixels::F32(pixels.map(|pixel| value(pixel) as f32).collect())
        }
        Packing::Float { big_endian } => {
            let value = |pixel: &[u8]| {
                let bytes = [pixel[0], pixel[1], pixel[2], pixel[3]];
                if big_endian { f32::from_be_bytes(bytes) } else { f32::from_le_bytes(bytes) }
            };
            Pixels::F32(pixels.map(value).collect())
        }
    };
    image.channels = 1;
    Ok(())
}

/// The two channels that hold bytes: those that vary, or beside the only one that does the one that is not 0 (nor full
/// opacity); the first two if nothing tells.
fn two_channels(encoding: &'static str, bytes: &[u8], channels: usize) -> Result<[usize; 2]> {
    let varies = |channel: usize| bytes.chunks_exact(channels).any(|pixel| pixel[channel] != bytes[channel]);
    let varied: Vec<usize> = (0..channels).filter(|channel| varies(*channel)).collect();
    let equal = |one: usize, other: usize| bytes.chunks_exact(channels).all(|pixel| pixel[one] == pixel[other]);
    match varied[..] {
        [first, second] => Ok([first, second]),
        [only] => {
            let opaque = |channel: usize| channel == 3 && bytes[channel] == u8::MAX;
            let other = (0..channels).find(|channel| *channel != only && bytes[*channel] != 0 && !opaque(*channel));
            let other = other.unwrap_or(if only == 0 { 1 } else { 0 });
            Ok([only.min(other), only.max(other)])
        }
        [] => Ok([0, 1]),
        // Grey as three equal colours, and opacity.
        [0, 1, 2, 3] if equal(0, 1) && equal(0, 2) => Ok([0, 3]),
        _ => {
            let accepted = format!("a picture in two channels of which the values differ; here {} do", varied.len());
            Err(Error::parameter("--encoding", encoding, accepted))
        }
    }
}
