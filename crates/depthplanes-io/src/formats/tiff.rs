//! TIFF, the first picture of the file: integers or floats, one channel (or equal ones).
//!
//! In: strips or tiles, uncompressed, PackBits, LZW or deflate. Out: `u8`, `u16` or `f32` values by
//! the rules of `samples`.

use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult, Limits as TiffLimits};
use tiff::{ColorType, TiffError};

use super::format::{DecodeOptions, Format, Image};
use super::samples::{half, integers, single_channel};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "tiff",
    about: "TIFF, 8 or 16 bits or float, first picture",
    extensions: &["tif", "tiff"],
    sniff: |bytes| [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| bytes.starts_with(magic)),
    decode,
};

/// LZW's best: a code of 12 bits for a string of 4096 bytes; the other packings reach less.
const BEST_RATIO: usize = 2731;

fn unreadable(wrong: impl ToString) -> Error {
    let accepted = "a whole TIFF picture, one channel, uncompressed, PackBits, LZW or deflate";
    Error::Unreadable { format: "tiff", wrong: wrong.to_string(), accepted }
}

fn from_tiff(error: TiffError) -> Error {
    unreadable(error)
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let most = bytes.len().saturating_mul(BEST_RATIO).min(options.limits.max_bytes);
    let mut limits = TiffLimits::default();
    limits.decoding_buffer_size = most;
    limits.intermediate_buffer_size = most;
    limits.ifd_value_size = bytes.len();
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(from_tiff)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(from_tiff)?;
    let (channels, alpha) = match decoder.colortype().map_err(from_tiff)? {
        ColorType::Gray(_) => (1, false),
        ColorType::GrayA(_) => (2, true),
        ColorType::RGB(_) => (3, false),
        ColorType::RGBA(_) => (4, true),
        other => return Err(unreadable(format!("its colours are {other:?}"))),
    };
    let area = options.limits.area("tiff", width.into(), height.into(), channels)?;
    let decoded = decoder.read_image().map_err(from_tiff)?;
    let mut warnings = Vec::new();
    let (pixels, sample) = pixels(decoded, channels, alpha, &mut warnings)?;
    let there = match &pixels {
        Pixels::U8(values) => values.len(),
        Pixels::U16(values) => values.len(),
        Pixels::F32(values) => values.len(),
    };
    if there != area {
        return Err(unreadable(format!("{width} x {height} pixels are stated, {there} are there")));
    }
    Ok(Image { width: width as usize, height: height as usize, pixels, sample, warnings })
}

fn pixels(
    decoded: DecodingResult,
    channels: usize,
    alpha: bool,
    warnings: &mut Vec<String>,
) -> Result<(Pixels, &'static str)> {
    macro_rules! one {
        ($values:expr) => {
            single_channel("tiff", $values, channels, alpha, warnings)?
        };
    }
    macro_rules! whole {
        ($values:expr) => {{
            let values = one!($values);
            integers(|| values.iter().map(|&value| i128::from(value)), warnings)
        }};
    }
    Ok(match decoded {
        DecodingResult::U8(values) => (Pixels::U8(one!(values)), "uint8"),
        DecodingResult::U16(values) => (Pixels::U16(one!(values)), "uint16"),
        DecodingResult::F32(values) => (Pixels::F32(one!(values)), "float32"),
        DecodingResult::F64(values) => {
            (Pixels::F32(one!(values).into_iter().map(|value| value as f32).collect()), "float64")
        }
        DecodingResult::F16(values) => {
            (Pixels::F32(one!(values).into_iter().map(|value| half(value.to_bits())).collect()), "float16")
        }
        DecodingResult::I8(values) => (whole!(values), "int8"),
        DecodingResult::I16(values) => (whole!(values), "int16"),
        DecodingResult::U32(values) => (whole!(values), "uint32"),
        DecodingResult::I32(values) => (whole!(values), "int32"),
        DecodingResult::U64(values) => (whole!(values), "uint64"),
        DecodingResult::I64(values) => (whole!(values), "int64"),
    })
}
