//! Headerless samples, as cameras, `ffmpeg -pix_fmt gray16le` and numpy's `tofile` write them.
//!
//! In: the samples row by row, and the size, which nothing in the file can say. The type is stated, or the length of the
//! file says it: 1 byte a pixel is `uint8`, 2 are little-endian `uint16`, 8 are `float64`, and 4 are the first of
//! `float32`, `uint32` (either byte order) and `int32` whose numbers can be a map. Out: values by the rules
//! of `samples`.

use super::format::{DecodeOptions, Format, Image, Limits};
use super::samples::{Sample, half, pixels};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "raw",
    about: "headerless samples, integers or floats, with a stated size",
    extensions: &["raw", "bin", "z16"],
    sniff: |_| false,
    ends: |_, options| {
        let (width, height) = options.raw_size?;
        let most = match &options.raw_type {
            Some(name) => stated(name).ok()?.1.bytes(),
            None => Sample::F64.bytes(),
        };
        let end = (width as u64).checked_mul(height as u64)?.checked_mul(most as u64)?;
        // The largest type is a bound alone.
        Some(end).filter(|&end| options.raw_type.is_some() || end <= options.limits.max_bytes as u64)
    },
    decode,
};

/// A name, what it is, and whether it is big-endian.
type Type = (&'static str, Sample, bool);

const TYPES: &[Type] = &[
    ("uint8", Sample::U8, false),
    ("int8", Sample::I8, false),
    ("uint16", Sample::U16, false),
    ("uint16-be", Sample::U16, true),
    ("int16", Sample::I16, false),
    ("int16-be", Sample::I16, true),
    ("uint32", Sample::U32, false),
    ("uint32-be", Sample::U32, true),
    ("int32", Sample::I32, false),
    ("int32-be", Sample::I32, true),
    ("uint64", Sample::U64, false),
    ("uint64-be", Sample::U64, true),
    ("int64", Sample::I64, false),
    ("int64-be", Sample::I64, true),
    ("float16", Sample::F16, false),
    ("float16-be", Sample::F16, true),
    ("float32", Sample::F32, false),
    ("float32-be", Sample::F32, true),
    ("float64", Sample::F64, false),
    ("float64-be", Sample::F64, true),
];

/// Sizes of depth maps that cameras and networks make.
const COMMON_SIZES: &[(usize, usize)] = &[
    (640, 480),
    (320, 240),
    (1280, 720),
    (848, 480),
    (640, 360),
    (424, 240),
    (480, 270),
    (256, 192),
    (512, 424),
    (640, 576),
    (320, 288),
    (1024, 1024),
    (512, 512),
    (640, 400),
    (1280, 800),
    (1024, 768),
    (480, 640),
    (192, 256),
    (160, 120),
    (224, 172),
    (176, 144),
    (240, 180),
    (1280, 960),
    (1920, 1080),
    (672, 376),
];

/// Names of the sample types of headerless files, in numpy's words; `-be` is big-endian.
pub fn raw_types() -> impl Iterator<Item = &'static str> {
    TYPES.iter().map(|(name, ..)| *name)
}

/// Bytes of a headerless map of the stated size and type; without a type it is `uint16`.
///
/// # Errors
/// [`Error::Parameter`] without a size, or for a type that is none of [`raw_types`]; [`Error::Limit`] for too large a map.
pub fn raw_bytes(options: &DecodeOptions) -> Result<usize> {
    let Some((width, height)) = options.raw_size else {
        return Err(Error::parameter("--raw-size", "not given", "WIDTHxHEIGHT of the headerless samples"));
    };
    let sample = match &options.raw_type {
        Some(name) => stated(name)?.1,
        None => Sample::U16,
    };
    Ok(options.limits.area("raw", width as u64, height as u64, sample.bytes())? * sample.bytes())
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let Some((width, height)) = options.raw_size else {
        return Err(Error::parameter("--raw-size", "not given", "WIDTHxHEIGHT of the headerless samples"));
    };
    let area = options.limits.area("raw", width as u64, height as u64, 1)?;
    let (name, sample, big_endian) = match &options.raw_type {
        Some(name) => stated(name)?,
        None => by_length(bytes, area).ok_or_else(|| misfit(bytes, (width, height), None))?,
    };
    let mut image = samples_of(bytes, (name, sample, big_endian), (width, height), &options.limits)?;
    if options.raw_type.is_none() && sample != Sample::U16 {
        let each = sample.bytes();
        let other = if each == 1 { "" } else { "; another is stated with --raw-type" };
        let note = format!("{each} byte{} a pixel are read as {name}{other}", if each == 1 { "" } else { "s" });
        image.warnings.insert(0, note); // before what is said of the values
    }
    if options.raw_type.is_none() && sample == Sample::U16 {
        image.warnings.extend(halves(bytes));
    }
    let swapped = swapped_size(&image.pixels, width, height);
    image.warnings.extend(swapped);
    Ok(image)
}

/// The image of samples in memory, row by row, of the type of that name ([`raw_types`]).
///
/// # Errors
/// [`Error::Parameter`] for another type or other than that many samples, [`Error::Limit`] for too large a map.
pub(crate) fn image_of(bytes: &[u8], name: &str, size: (usize, usize), limits: &Limits) -> Result<Image> {
    samples_of(bytes, stated(name)?, size, limits)
}

fn samples_of(bytes: &[u8], (_, sample, big_endian): Type, size: (usize, usize), limits: &Limits) -> Result<Image> {
    let (width, height) = size;
    let area = limits.area("raw", width as u64, height as u64, sample.bytes())?;
    if bytes.len() != area * sample.bytes() {
        return Err(misfit(bytes, size, Some(sample)));
    }
    let mut warnings = Vec::new();
    let pixels = pixels(bytes, sample, big_endian, &mut warnings);
    Ok(Image::new(width, height, pixels, sample.name(), warnings))
}

/// The type of that name: one of the table, shorter (`f32`, `u16be`), or numpy's code (`<f4`).
fn stated(given: &str) -> Result<Type> {
    let (is_big_endian, code) = match given.split_at_checked(1) {
        Some(("<" | "=" | "|", code)) => (false, code),
        Some((">", code)) => (true, code),
        _ => (false, given),
    };
    let found = TYPES.iter().find(|(name, sample, big_endian)| {
        let short = name.replacen("uint", "u", 1).replacen("int", "i", 1).replacen("float", "f", 1);
        let coded = format!("{}{}", &name[..1], sample.bytes());
        let by_code = coded == code && (*big_endian == is_big_endian || sample.bytes() == 1);
        *name == given || short == given || short.replace('-', "") == given || by_code
    });
    found.copied().ok_or_else(|| {
        let names: Vec<_> = raw_types().collect();
        Error::parameter("--raw-type", given, names.join(", "))
    })
}

/// The type that the number of bytes a pixel says.
fn by_length(bytes: &[u8], area: usize) -> Option<Type> {
    let named = |name: &str| TYPES.iter().find(|(known, ..)| *known == name).copied();
    if !bytes.len().is_multiple_of(area) {
        return None;
    }
    match bytes.len() / area {
        1 => named("uint8"),
        2 => named("uint16"),
        4 => ["float32", "float32-be", "uint32", "uint32-be", "int32"]
            .into_iter()
            .filter_map(named)
            .find(|t| plausible(bytes, t)),
        8 => ["float64", "float64-be"].into_iter().filter_map(named).find(|t| plausible(bytes, t)),
        _ => None,
    }
}

/// Whether the numbers can be a map: floats are 0, not finite, or of usual size, integers stay below 2^24.
fn plausible(bytes: &[u8], (_, sample, big_endian): &Type) -> bool {
    let each = sample.bytes();
    let every = (bytes.len() / each).div_ceil(1 << 16).max(1);
    let (mut some, mut fitting, mut finite) = (0usize, 0usize, 0usize);
    for chunk in bytes.chunks_exact(each).step_by(every) {
        let mut little = [0; 8];
        little[..each].copy_from_slice(chunk);
        if *big_endian {
            little[..each].reverse();
        }
        let low = [little[0], little[1], little[2], little[3]];
        let value = match sample {
            Sample::F32 => f64::from(f32::from_le_bytes(low)),
            Sample::F64 => f64::from_le_bytes(little),
            Sample::I32 => f64::from(i32::from_le_bytes(low)),
            _ => f64::from(u32::from_le_bytes(low)),
        };
        let is_float = matches!(sample, Sample::F32 | Sample::F64);
        let usual = value == 0.0 || !value.is_finite() || (1e-4..1e7).contains(&value.abs());
        some += 1;
        finite += usize::from(value.is_finite());
        fitting += usize::from(if is_float { usual } else { value < f64::from(1 << 24) });
    }
    fitting * 100 >= some * 98 && finite > 0
}

/// Depths as 16-bit floats hold them: unit, smallest, largest.
const OF_HALVES: [(&str, f32, f32); 2] = [("m", 0.1, 32.0), ("mm", 100.0, 32_000.0)];

/// What to say of 16-bit integers that are rather floats. Those of 0.1 to 32 m are the integers from 11,878 to 20,480, those of
/// 100 to 32,000 mm the ones from 22,080 to 30,672, where no depth camera has all of its millimetres.
fn halves(bytes: &[u8]) -> Option<String> {
    let every = (bytes.len() / 2).div_ceil(1 << 16).max(1);
    for (name, big_endian) in [("float16", false), ("float16-be", true)] {
        let bits = bytes.chunks_exact(2).step_by(every).map(|pair| {
            if big_endian { u16::from_be_bytes([pair[0], pair[1]]) } else { u16::from_le_bytes([pair[0], pair[1]]) }
        });
        // 0, infinities and NaN stand for nothing.
        let mut depths: Vec<f32> = bits.filter(|bits| bits & 0x7fff != 0).map(half).filter(|m| m.is_finite()).collect();
        depths.sort_by(f32::total_cmp);
        for (unit, least, most) in OF_HALVES {
            let usual = depths.iter().filter(|depth| (least..most).contains(*depth)).count();
            if usual < 64 || usual * 100 < depths.len() * 99 {
                continue;
            }
            let [low, high] = [depths[depths.len() / 50], depths[depths.len() * 49 / 50]];
            // Integers that are about equal say nothing.
            if high > 1.2 * low {
                return Some(format!(
                    "as 16-bit floats the values are depths of {low:.1} to {high:.1} {unit}, as integers they are all alike: try \
                     --raw-type {name}"
                ));
            }
        }
    }
    None
}

/// What to say of rows that go on in the ones below only if the two sides of the size are exchanged.
fn swapped_size(pixels: &Pixels, width: usize, height: usize) -> Option<String> {
    let value = |at: usize| match pixels {
        Pixels::U8(values) => f64::from(values[at]),
        Pixels::U16(values) => f64::from(values[at]),
        Pixels::F32(values) => f64::from(values[at]),
    };
    let area = width * height;
    // How far apart values are that are so many samples apart: the mean share, in which edges count for little. Over 35 recorded
    // maps rows that do not go on in the ones below have 0.019 or more, 13 times what the rows of the map have.
    let apart = |step: usize| {
        let places = (0..area - step).step_by(area / 4096 + 1).map(|at| [value(at), value(at + step)]);
        let valid = places.filter(|pair| pair.iter().all(|value| *value > 0.0 && value.is_finite()));
        let shares: Vec<f64> = valid.map(|[a, b]| ((a - b).abs() / (a + b)).min(0.1)).collect();
        (shares.len() >= 64).then(|| shares.iter().sum::<f64>() / shares.len() as f64)
    };
    if width == height || width.min(height) < 8 {
        return None;
    }
    let (stated, swapped) = (apart(width)?, apart(height)?);
    (stated > 0.01 && stated > 4.0 * swapped).then(|| {
        format!(
            "the width {width} seems wrong: rows do not match the rows below them; with a width of {height} they do: try --raw-size \
             {height}x{width}"
        )
    })
}

/// What to say of a size and type that the file has not.
fn misfit(bytes: &[u8], (width, height): (usize, usize), sample: Option<Sample>) -> Error {
    let (length, area) = (bytes.len(), width * height);
    if sample.is_none() && length == 4 * area || length == 8 * area {
        let accepted = "one that is stated: the numbers are no depths as float32 or float64, nor integers below 2^24; try \
             float32, float32-be, uint32, int32 or float64";
        return Error::parameter("--raw-type", "not given", accepted);
    }
    let sizes: Vec<usize> = sample.map_or(vec![8, 4, 2, 1], |sample| vec![sample.bytes()]);
    // A header is short: more than an eighth of the map would be another size.
    let header = sizes.iter().find(|each| length > area * **each && length - area * **each <= area * **each / 8);
    let mut accepted = match sample {
        Some(sample) => {
            format!("a size of {length} bytes in all at {} bytes a pixel ({})", sample.bytes(), sample.name())
        }
        None => format!("a size of {length} bytes in all at 1, 2, 4 or 8 bytes a pixel"),
    };
    if let Some(each) = header {
        let before = length - area * each;
        accepted = format!(
            "samples without a header: the file has {before} bytes more than {width} x {height} pixels of {each} bytes; if \
             they are a header, remove it (tail -c +{} FILE > map.raw)",
            before + 1
        );
    }
    let fitting = common_sizes(length, &sizes);
    if !fitting.is_empty() {
        accepted = format!("{accepted}; of the common sizes {fitting}");
    }
    Error::parameter("--raw-size", format_args!("{width}x{height}"), accepted)
}

/// Common sizes that the length of a file is: `640x480 (2 bytes a pixel) fits`.
fn common_sizes(length: usize, bytes_a_pixel: &[usize]) -> String {
    let mut fitting = Vec::new();
    for each in [2, 4, 8, 1].into_iter().filter(|each| bytes_a_pixel.contains(each)) {
        let sizes = COMMON_SIZES.iter().filter(|(width, height)| width * height * each == length);
        fitting.extend(sizes.map(|(width, height)| format!("{width}x{height} ({each} bytes a pixel)")));
    }
    match fitting.len() {
        0 => String::new(),
        1 => format!("{} fits", fitting[0]),
        _ => format!("{} fit", fitting[..fitting.len().min(4)].join(", ")),
    }
}
