//! Headerless 16-bit samples, little-endian, as cameras and `ffmpeg -pix_fmt gray16le` write them.
//!
//! In: exactly `2 * width * height` bytes and the size, which nothing in the file can say. Out:
//! `u16` values. Big-endian samples are read with the option to swap bytes.

use super::format::{DecodeOptions, Format, Image};
use super::samples::{Sample, pixels};
use crate::error::{Error, Result};

pub(super) const FORMAT: Format = Format {
    name: "raw",
    about: "headerless 16-bit little-endian samples, with a stated size",
    extensions: &["raw", "bin", "z16"],
    sniff: |_| false,
    decode,
};

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let Some((width, height)) = options.raw_size else {
        return Err(Error::parameter("--raw-size", "not given", "WIDTHxHEIGHT of the headerless samples"));
    };
    let area = options.limits.area("raw", width as u64, height as u64, 2)?;
    if bytes.len() != 2 * area {
        let accepted =
            format!("a size of {} pixels in all: the input has {} bytes, two a pixel", bytes.len() / 2, bytes.len());
        return Err(Error::parameter("--raw-size", format_args!("{width}x{height}"), accepted));
    }
    let pixels = pixels(bytes, Sample::U16, false, &mut Vec::new());
    Ok(Image { width, height, pixels, sample: "uint16", warnings: Vec::new() })
}
