//! NumPy arrays (`.npy`, format versions 1 to 3).
//!
//! In: an array of integers or floats of any byte order, two axes (rows, columns) beside axes of
//! length 1, in C or Fortran order; or an organised cloud, floats of shape (rows, columns, 3), of
//! which z is taken. Out: `u8`, `u16` or `f32` values by the rules of `samples`.
//! The header is read here because all that is needed of it is three fields.

use std::borrow::Cow;

use super::bytes::Cursor;
use super::format::{Format, Image, Limits};
use super::samples::{Sample, pixels};
use crate::error::{Error, Result};

pub(super) const FORMAT: Format = Format {
    name: "npy",
    about: "NumPy array of two axes, integers or floats",
    extensions: &["npy"],
    sniff: |bytes| bytes.starts_with(MAGIC),
    decode: |bytes, options| decode("npy", bytes, &options.limits),
};

const MAGIC: &[u8] = b"\x93NUMPY";

/// What the header says.
#[derive(Debug)]
pub(super) struct Header {
    sample: Sample,
    big_endian: bool,
    fortran: bool,
    pub(super) rows: u64,
    pub(super) columns: u64,
    /// 1, or 3 for x, y, z.
    channels: u64,
    data_at: usize,
}

fn unreadable(format: &'static str, wrong: impl Into<String>) -> Error {
    let accepted = "an array of two axes (rows, columns), uint8 to uint64, int8 to int64 or float16 to float64; or \
         an organised cloud, floats of shape (rows, columns, 3)";
    Error::Unreadable { format, wrong: wrong.into(), accepted }
}

/// Reads the header; `bytes` may end after it.
pub(super) fn header(format: &'static str, bytes: &[u8]) -> Result<Header> {
    let cut = || unreadable(format, "the header is cut off");
    if !bytes.starts_with(MAGIC) {
        return Err(unreadable(format, "the array does not start with \\x93NUMPY"));
    }
    let mut cursor = Cursor::new(bytes, 8);
    let length = match bytes.get(6).ok_or_else(cut)? {
        1 => usize::from(cursor.u16().ok_or_else(cut)?),
        2 | 3 => cursor.u32().ok_or_else(cut)? as usize,
        version => return Err(unreadable(format, format!("format version {version}"))),
    };
    let preamble = if bytes[6] == 1 { 10 } else { 12 };
    let text = cursor.take(length).and_then(|text| std::str::from_utf8(text).ok()).ok_or_else(cut)?;
    let field = |name: &str| -> Result<&str> {
        let quoted = format!("'{name}':");
        let at = text.find(&quoted).ok_or_else(|| unreadable(format, format!("the header lacks '{name}'")))?;
        Ok(text[at + quoted.len()..].trim_start())
    };
    let descr = field("descr")?;
    let (sample, big_endian) = dtype(descr).ok_or_else(|| {
        unreadable(format, format!("dtype {}", descr.split(", '").next().unwrap_or("").escape_default()))
    })?;
    let fortran = field("fortran_order")?.starts_with("True");
    let [rows, columns, channels] =
        shape(field("shape")?).map_err(|shape| unreadable(format, format!("shape {shape}")))?;
    if channels != 1 && !matches!(sample, Sample::F32 | Sample::F64) {
        return Err(unreadable(format, format!("three channels of {}: a colour picture, not depth", sample.name())));
    }
    Ok(Header { sample, big_endian, fortran, rows, columns, channels, data_at: preamble + length })
}

/// `'<u2'` and its like.
fn dtype(descr: &str) -> Option<(Sample, bool)> {
    let code = descr.strip_prefix('\'')?.split('\'').next()?;
    let big_endian = code.starts_with('>');
    let sample = match code.trim_start_matches(['<', '>', '=', '|']) {
        "u1" => Sample::U8,
        "i1" => Sample::I8,
        "u2" => Sample::U16,
        "i2" => Sample::I16,
        "u4" => Sample::U32,
        "i4" => Sample::I32,
        "u8" => Sample::U64,
        "i8" => Sample::I64,
        "f2" => Sample::F16,
        "f4" => Sample::F32,
        "f8" => Sample::F64,
        _ => return None,
    };
    Some((sample, big_endian))
}

/// Rows, columns and channels (1 or 3) of a shape tuple, axes of length 1 dropped from the front,
/// then from the back, until two are left; otherwise the shape as text.
fn shape(text: &str) -> std::result::Result<[u64; 3], String> {
    let tuple = text.split_inclusive(')').next().unwrap_or("");
    let refuse = || tuple.chars().take(80).collect::<String>().escape_default().to_string();
    let inner = tuple.strip_prefix('(').and_then(|t| t.strip_suffix(')')).ok_or_else(refuse)?;
    let axes: Option<Vec<u64>> =
        inner.split(',').map(str::trim).filter(|axis| !axis.is_empty()).map(|axis| axis.parse().ok()).collect();
    let axes = axes.ok_or_else(refuse)?;
    let mut axes = &axes[..];
    while axes.len() > 2 {
        axes = match axes {
            [1, rest @ ..] | [rest @ .., 1] => rest,
            [rows, columns, 3] => return Ok([*rows, *columns, 3]),
            _ => return Err(refuse()),
        };
    }
    match *axes {
        [rows, columns] => Ok([rows, columns, 1]),
        _ => Err(refuse()),
    }
}

/// Reads the array; `format` is `npy`, or `npz` for a member of an archive.
pub(super) fn decode(format: &'static str, bytes: &[u8], limits: &Limits) -> Result<Image> {
    let header = header(format, bytes)?;
    let sample = header.sample;
    let channels = header.channels as usize;
    let area = limits.area(format, header.columns, header.rows, channels * sample.bytes())?;
    let (width, height) = (header.columns as usize, header.rows as usize);
    let needed = area * channels * sample.bytes();
    let data = &bytes[header.data_at..];
    let data = data.get(..needed).ok_or_else(|| {
        unreadable(
            format,
            format!("{width} x {height} {} need {needed} bytes, {} are there", sample.name(), data.len()),
        )
    })?;
    let mut warnings = Vec::new();
    if channels == 3 {
        warnings.push("an organised cloud: its third channel is taken as z".to_string());
    }
    let rows = last_channel_by_rows(data, &header);
    let pixels = pixels(&rows, sample, header.big_endian, &mut warnings);
    Ok(Image { width, height, pixels, sample: sample.name(), warnings })
}

/// The bytes of the only, or the third, channel, row by row.
fn last_channel_by_rows<'a>(data: &'a [u8], header: &Header) -> Cow<'a, [u8]> {
    let (width, height) = (header.columns as usize, header.rows as usize);
    let (channels, size) = (header.channels as usize, header.sample.bytes());
    if channels == 1 && !header.fortran {
        return Cow::Borrowed(data);
    }
    let mut rows = Vec::with_capacity(width * height * size);
    for v in 0..height {
        for u in 0..width {
            let c = channels - 1;
            let at = if header.fortran { (c * width + u) * height + v } else { (v * width + u) * channels + c };
            rows.extend_from_slice(&data[at * size..][..size]);
        }
    }
    Cow::Owned(rows)
}
