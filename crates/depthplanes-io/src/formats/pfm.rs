//! Portable float maps, as Middlebury and ETH3D publish disparity.
//!
//! In: `Pf` (grey) or `PF` (colour, only with equal channels), either byte order, rows bottom-up.
//! Out: `f32` values, top row first. The header's scale gives the byte order by its sign; its size
//! is ignored, as every loader of these data sets does, with a warning unless it is 1.

use super::bytes::header_words;
use super::channels::reduce;
use super::format::{DecodeOptions, Format, Image};
use super::samples::{Sample, pixels};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "pfm",
    about: "portable float map, both byte orders",
    extensions: &["pfm"],
    sniff: |bytes| bytes.len() > 2 && matches!(&bytes[..2], b"Pf" | b"PF") && bytes[2].is_ascii_whitespace(),
    ends,
    decode,
};

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "Pf or PF, width, height, a scale other than 0, then all the 32-bit floats";
    Error::Unreadable { format: "pfm", wrong: wrong.into(), accepted }
}

fn ends(bytes: &[u8], _: &DecodeOptions) -> Option<u64> {
    let channels = if bytes.get(1) == Some(&b'F') { 3 } else { 1 };
    let (words, data) = header_words::<3>(bytes.get(2..)?)?;
    let number = |word: &str| word.parse::<u64>().ok();
    let floats = number(words[0])?.checked_mul(number(words[1])?)?.checked_mul(channels)?;
    floats.checked_mul(4)?.checked_add((bytes.len() - data.len()) as u64)
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let channels = if bytes.get(1) == Some(&b'F') { 3 } else { 1 };
    let body = bytes.get(2..).unwrap_or(&[]);
    let (words, data) = header_words::<3>(body).ok_or_else(|| unreadable("the header is cut off"))?;
    let number = |word: &str| word.parse::<u64>().map_err(|_| unreadable(format!("`{word}` in the header")));
    let (width, height) = (number(words[0])?, number(words[1])?);
    let scale: f64 = words[2].parse().map_err(|_| unreadable(format!("the scale is `{}`", words[2])))?;
    if scale == 0.0 || !scale.is_finite() {
        return Err(unreadable(format!("the scale is {scale}")));
    }
    let samples = options.limits.area("pfm", width, height, 4 * channels)? * channels;
    let data = data.get(..samples * 4).ok_or_else(|| {
        unreadable(format!("{width} x {height} pixels need {} bytes, {} are there", samples * 4, data.len()))
    })?;
    let mut warnings = Vec::new();
    if scale.abs() != 1.0 {
        warnings.push(format!("the header's scale {scale} gives the byte order only; values are as stored"));
    }
    let Pixels::F32(mut values) = pixels(data, Sample::F32, scale > 0.0, &mut warnings) else {
        unreachable!("floats stay floats");
    };
    let (width, height) = (width as usize, height as usize);
    let row = width * channels;
    for v in 0..height / 2 {
        let (top, bottom) = values.split_at_mut((height - 1 - v) * row);
        top[v * row..][..row].swap_with_slice(&mut bottom[..row]);
    }
    let image = Image::new(width, height, Pixels::F32(values), "float32", warnings);
    let mut image = Image { channels, ..image };
    reduce("pfm", &mut image, false, options)?;
    Ok(image)
}
