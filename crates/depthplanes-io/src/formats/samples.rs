//! From samples of any type and byte order to the three pixel types; the rules that all formats share.
//!
//! - 8-bit, 16-bit unsigned and 32-bit float samples stay as they are.
//! - Other integers become 16-bit if all fit, otherwise 32-bit floats (exact to 2^24), with a
//!   warning. Negative integers mean "missing" in every data set known to us: they become 0, with
//!   a warning.
//! - 16-bit and 64-bit floats become 32-bit floats. Numbers beyond these become infinite, which is missing, with a warning.

use crate::frame::Pixels;

/// Sample types of the formats that have several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sample {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F16,
    F32,
    F64,
}

impl Sample {
    pub(super) fn bytes(self) -> usize {
        match self {
            Sample::U8 | Sample::I8 => 1,
            Sample::U16 | Sample::I16 | Sample::F16 => 2,
            Sample::U32 | Sample::I32 | Sample::F32 => 4,
            Sample::U64 | Sample::I64 | Sample::F64 => 8,
        }
    }

    /// numpy's name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Sample::U8 => "uint8",
            Sample::I8 => "int8",
            Sample::U16 => "uint16",
            Sample::I16 => "int16",
            Sample::U32 => "uint32",
            Sample::I32 => "int32",
            Sample::U64 => "uint64",
            Sample::I64 => "int64",
            Sample::F16 => "float16",
            Sample::F32 => "float32",
            Sample::F64 => "float64",
        }
    }
}

macro_rules! numbers {
    ($bytes:expr, $t:ty, $big_endian:expr) => {
        $bytes.chunks_exact(size_of::<$t>()).map(|chunk| {
            let chunk = chunk.try_into().expect("chunks of the type's size");
            if $big_endian { <$t>::from_be_bytes(chunk) } else { <$t>::from_le_bytes(chunk) }
        })
    };
}

/// Decodes `bytes`, which hold whole samples, by the rules above; warnings are appended.
pub(super) fn pixels(bytes: &[u8], sample: Sample, big_endian: bool, warnings: &mut Vec<String>) -> Pixels {
    match sample {
        Sample::U8 => Pixels::U8(bytes.to_vec()),
        Sample::U16 => Pixels::U16(numbers!(bytes, u16, big_endian).collect()),
        Sample::F16 => Pixels::F32(numbers!(bytes, u16, big_endian).map(half).collect()),
        Sample::F32 => Pixels::F32(numbers!(bytes, f32, big_endian).collect()),
        Sample::F64 => doubles(numbers!(bytes, f64, big_endian), warnings),
        Sample::I8 => integers(|| bytes.iter().map(|&byte| i128::from(byte as i8)), warnings),
        Sample::I16 => integers(|| numbers!(bytes, i16, big_endian).map(i128::from), warnings),
        Sample::U32 => integers(|| numbers!(bytes, u32, big_endian).map(i128::from), warnings),
        Sample::I32 => integers(|| numbers!(bytes, i32, big_endian).map(i128::from), warnings),
        Sample::U64 => integers(|| numbers!(bytes, u64, big_endian).map(i128::from), warnings),
        Sample::I64 => integers(|| numbers!(bytes, i64, big_endian).map(i128::from), warnings),
    }
}

/// 32-bit floats of 64-bit ones.
pub(super) fn doubles(values: impl Iterator<Item = f64>, warnings: &mut Vec<String>) -> Pixels {
    let mut beyond = 0usize;
    let narrow = |value: f64| {
        beyond += usize::from(value.is_finite() && (value as f32).is_infinite());
        value as f32
    };
    let values = values.map(narrow).collect();
    if beyond > 0 {
        warnings.push(format!("{beyond} values beyond 3.4e38 do not fit 32-bit floats: they are taken as missing"));
    }
    Pixels::F32(values)
}

/// A 16-bit IEEE float, from its bits.
pub(super) fn half(bits: u16) -> f32 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (bits >> 10 & 31, f32::from(bits & 0x3ff) / 1024.0);
    sign * match exponent {
        0 => fraction * 2f32.powi(-14),
        31 if fraction == 0.0 => f32::INFINITY,
        31 => f32::NAN,
        _ => (1.0 + fraction) * 2f32.powi(i32::from(exponent) - 15),
    }
}

/// 16-bit pixels if every value fits, floats otherwise; negative values become 0.
pub(super) fn integers<I: Iterator<Item = i128>>(values: impl Fn() -> I, warnings: &mut Vec<String>) -> Pixels {
    let (mut largest, mut negative) = (0, 0usize);
    for value in values() {
        largest = largest.max(value);
        negative += usize::from(value < 0);
    }
    if negative > 0 {
        warnings.push(format!("{negative} negative values are taken as missing"));
    }
    if largest <= i128::from(u16::MAX) {
        return Pixels::U16(values().map(|value| value.max(0) as u16).collect());
    }
    warnings.push(format!("values up to {largest} do not fit 16 bits: read as floats; state the unit with --encoding"));
    Pixels::F32(values().map(|value| value.max(0) as f32).collect())
}
