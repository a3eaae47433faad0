//! NumPy arrays (`.npy`, format versions 1 to 3).
//!
//! In: an array of integers or floats of any byte order, two axes (rows, columns) beside axes of
//! length 1, in C or Fortran order; an organised cloud, floats of shape (rows, columns, 3), of
//! which z is taken; integers or floats of two to four channels (rows, columns, channels); or a stack (maps, rows,
//! columns), of which the option `member` says which one. Out: `u8`, `u16` or `f32` values by the rules of `samples`.
//! The header is read here because all that is needed of it is three fields.

use std::borrow::Cow;

use super::bytes::Cursor;
use super::channels::reduce;
use super::cloud::find_camera;
use super::format::{DecodeOptions, Format, Image};
use super::samples::{Sample, pixels};
use crate::error::{Error, Result};

pub(super) const FORMAT: Format = Format {
    name: "npy",
    about: "NumPy array of two axes, integers or floats",
    extensions: &["npy"],
    sniff: |bytes| bytes.starts_with(MAGIC),
    ends: |bytes, _| {
        let header = header("npy", bytes).ok()?;
        let samples = [header.maps, header.rows, header.columns, header.channels]
            .into_iter()
            .try_fold(header.sample.bytes() as u64, u64::checked_mul)?;
        samples.checked_add(header.data_at as u64)
    },
    decode: |bytes, options| decode("npy", bytes, options),
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
    /// 1, or 2 to 4: of floats, 3 are x, y, z.
    channels: u64,
    /// Maps along the first axis.
    maps: u64,
    data_at: usize,
}

fn unreadable(format: &'static str, wrong: impl Into<String>) -> Error {
    let accepted = "an array of two axes (rows, columns), uint8 to uint64, int8 to int64 or float16 to float64; or \
         an organised cloud, floats of shape (rows, columns, 3); or one of a stack (maps, rows, columns), chosen by \
         --member";
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
    let (sample, big_endian) = dtype(descr).ok_or_else(|| unreadable(format, unknown_dtype(descr)))?;
    let fortran = field("fortran_order")?.starts_with("True");
    let [maps, rows, columns, channels] =
        shape(field("shape")?).map_err(|shape| unreadable(format, format!("shape {shape}")))?;
    Ok(Header { sample, big_endian, fortran, maps, rows, columns, channels, data_at: preamble + length })
}

/// What an array holds whose numbers are not read.
fn unknown_dtype(descr: &str) -> String {
    let first = descr.split(", '").next().unwrap_or("").trim_end_matches(['\n', ' ', ',']);
    let shown: String = first.chars().take(80).collect();
    let what = match descr.trim_start_matches(['\'', '<', '>', '|', '=']).chars().next() {
        _ if descr.starts_with('[') => "a structured array: save its field of depth, array['z']",
        Some('O') => {
            "Python objects, which are pickled: save the array itself, numpy.asarray(map, dtype=numpy.float32)"
        }
        Some('b') if !descr.contains("i1") => "true and false: a mask, not depth",
        Some('c') => "complex numbers",
        Some('U' | 'S') => "text",
        _ => "no numbers that are read",
    };
    format!("dtype {}: {what}", shown.escape_debug())
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

/// Maps, rows, columns and channels (1 to 4) of a shape tuple, axes of length 1 dropped from the front,
/// then from the back, until two are left; otherwise the shape as text.
fn shape(text: &str) -> std::result::Result<[u64; 4], String> {
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
            [rows, columns, channels @ 2..=4] => return Ok([1, *rows, *columns, *channels]),
            [maps, rows, columns] => return Ok([*maps, *rows, *columns, 1]),
            _ => return Err(refuse()),
        };
    }
    match *axes {
        [rows, columns] => Ok([1, rows, columns, 1]),
        _ => Err(refuse()),
    }
}

/// Reads the array; `format` is `npy`, or `npz` for a member of an archive.
pub(super) fn decode(format: &'static str, bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let header = header(format, bytes)?;
    let sample = header.sample;
    let channels = header.channels as usize;
    let area = options.limits.area(format, header.columns, header.rows, channels * sample.bytes())?;
    let (width, height) = (header.columns as usize, header.rows as usize);
    let chosen = choose(format, &header, options)?;
    let data = bytes.get(header.data_at..).unwrap_or(&[]);
    let needed = header.maps.saturating_mul((area * channels * sample.bytes()) as u64);
    if needed > data.len() as u64 {
        let stack = if header.maps > 1 { format!("{} maps of ", header.maps) } else { String::new() };
        let name = sample.name();
        let wrong = format!("{stack}{width} x {height} {name} need {needed} bytes, {} are there", data.len());
        return Err(unreadable(format, wrong));
    }
    let mut warnings = Vec::new();
    if header.maps > 1 {
        warnings.push(format!("map {chosen} of {} along the first axis, counted from 0", header.maps));
    }
    let is_cloud = channels == 3 && matches!(sample, Sample::F32 | Sample::F64);
    let (first, kept) = if is_cloud { (2, 1) } else { (0, channels) };
    let of = |first, kept, warnings: &mut Vec<String>| {
        pixels(&by_rows(data, &header, chosen, first, kept), sample, header.big_endian, warnings)
    };
    let pixels = of(first, kept, &mut warnings);
    let mut image = Image { channels: kept, ..Image::new(width, height, pixels, sample.name(), warnings) };
    if is_cloud && !options.channels {
        image.warnings.push("an organised cloud: its third channel is taken as z".to_string());
        let [x, y, z] = [0, 1, 2].map(|axis| of(axis, 1, &mut Vec::new()));
        find_camera(&mut image, [&x, &y, &z]);
    }
    reduce(format, &mut image, channels == 4, options)?;
    Ok(image)
}

/// Which map of a stack, from 0.
fn choose(format: &'static str, header: &Header, options: &DecodeOptions) -> Result<usize> {
    let last = header.maps.saturating_sub(1);
    let accepted = || format!("one of the {} maps along the first axis: 0 to {last}", header.maps);
    match &options.member {
        _ if header.maps == 0 => Err(unreadable(format, "the first axis is empty")),
        _ if header.maps == 1 => Ok(0),
        // The member of an archive is a name.
        Some(member) if format == "npy" => match member.parse::<u64>() {
            Ok(index) if index <= last => Ok(index as usize),
            _ => Err(Error::parameter("--member", member, accepted())),
        },
        _ if format == "npz" => {
            let wrong = format!("the array is a stack of {} maps; save the one to read", header.maps);
            Err(unreadable(format, wrong))
        }
        _ => Err(Error::parameter("--member", "not given", accepted())),
    }
}

/// The bytes of one map, row by row, of its channels from `first`, `kept` in number.
fn by_rows<'a>(data: &'a [u8], header: &Header, chosen: usize, first: usize, kept: usize) -> Cow<'a, [u8]> {
    let (width, height, maps) = (header.columns as usize, header.rows as usize, header.maps as usize);
    let (channels, size) = (header.channels as usize, header.sample.bytes());
    let map = width * height * channels * size;
    if kept == channels && !header.fortran {
        return Cow::Borrowed(&data[chosen * map..][..map]);
    }
    let mut rows = Vec::with_capacity(width * height * kept * size);
    for v in 0..height {
        for u in 0..width {
            for c in first..first + kept {
                let at = if header.fortran {
                    ((c * width + u) * height + v) * maps + chosen
                } else {
                    ((chosen * height + v) * width + u) * channels + c
                };
                rows.extend_from_slice(&data[at * size..][..size]);
            }
        }
    }
    Cow::Owned(rows)
}
