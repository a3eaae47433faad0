//! Portable grey and pixel maps, ASCII (P2, P3) and binary (P5, P6).
//!
//! In: a PGM or PPM file, maxval 1 to 65535, two bytes big-endian above 255. Out: `u8` values up to
//! maxval 255, `u16` above, as stored (not stretched to the full range).

use super::bytes::header_words;
use super::channels::reduce;
use super::format::{DecodeOptions, Format, Image};
use super::samples::{Sample, pixels};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "pnm",
    about: "PGM (or PPM with equal channels), ASCII or binary, up to 16 bits",
    extensions: &["pgm", "ppm", "pnm"],
    sniff: |bytes| {
        bytes.len() > 2
            && bytes[0] == b'P'
            && matches!(bytes[1], b'2' | b'3' | b'5' | b'6')
            && (bytes[2].is_ascii_whitespace() || bytes[2] == b'#')
    },
    ends,
    decode,
};

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "P2, P3, P5 or P6, width, height and a largest value of 1 to 65535, then all the pixels";
    Error::Unreadable { format: "pnm", wrong: wrong.into(), accepted }
}

/// The header, and all the samples; of text so many bytes for each that the numbers may stand in columns.
fn ends(bytes: &[u8], options: &DecodeOptions) -> Option<u64> {
    let (words, data) = header_words::<3>(bytes.get(2..)?)?;
    let number = |word: &str| word.parse::<u64>().ok();
    let (width, height, largest) = (number(words[0])?, number(words[1])?, number(words[2])?);
    let channels = if matches!(bytes[1], b'3' | b'6') { 3 } else { 1 };
    let each = match bytes[1] {
        b'2' | b'3' => 32,
        _ if largest > 255 => 2,
        _ => 1,
    };
    let samples = width.checked_mul(height)?.checked_mul(channels)?;
    let end = samples.checked_mul(each)?.checked_add((bytes.len() - data.len()) as u64)?;
    Some(end).filter(|&end| each < 32 || end <= options.limits.max_bytes as u64)
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let kind = bytes.get(1).copied().unwrap_or(0);
    let body = bytes.get(2..).unwrap_or(&[]);
    let (words, data) = header_words::<3>(body).ok_or_else(|| unreadable("the header is cut off"))?;
    let number = |word: &str| word.parse::<u64>().map_err(|_| unreadable(format!("`{word}` in the header")));
    let (width, height, largest) = (number(words[0])?, number(words[1])?, number(words[2])?);
    if !(1..=65_535).contains(&largest) {
        return Err(unreadable(format!("the largest value is {largest}")));
    }
    let sample = if largest > 255 { Sample::U16 } else { Sample::U8 };
    let channels = if matches!(kind, b'3' | b'6') { 3 } else { 1 };
    let samples = options.limits.area("pnm", width, height, channels * sample.bytes())? * channels;
    let mut warnings = Vec::new();
    let values = if matches!(kind, b'2' | b'3') {
        ascii(data, samples, sample)?
    } else {
        let needed = samples * sample.bytes();
        let data = data.get(..needed).ok_or_else(|| {
            unreadable(format!("{width} x {height} pixels need {needed} bytes, {} are there", data.len()))
        })?;
        pixels(data, sample, true, &mut warnings)
    };
    let values = match values {
        Pixels::U8(values) => Pixels::U8(within(values, largest as u8)?),
        Pixels::U16(values) => Pixels::U16(within(values, largest as u16)?),
        Pixels::F32(_) => unreachable!("PNM samples are integers"),
    };
    let image = Image::new(width as usize, height as usize, values, sample.name(), warnings);
    let mut image = Image { channels, ..image };
    reduce("pnm", &mut image, false, options)?;
    Ok(image)
}

/// Refuses samples above the largest value that the header states.
fn within<T: PartialOrd + Copy + std::fmt::Display>(values: Vec<T>, largest: T) -> Result<Vec<T>> {
    match values.iter().find(|&&value| value > largest) {
        Some(value) => Err(unreadable(format!("a pixel is {value}, the header states at most {largest}"))),
        None => Ok(values),
    }
}

fn ascii(data: &[u8], samples: usize, sample: Sample) -> Result<Pixels> {
    if data.len() < samples.saturating_mul(2) - 1 {
        return Err(unreadable(format!("{samples} numbers cannot stand in {} bytes", data.len())));
    }
    let text = std::str::from_utf8(data).map_err(|_| unreadable("the numbers are not text"))?;
    let words = text.lines().flat_map(|line| line.split('#').next().unwrap_or("").split_ascii_whitespace());
    let mut values = Vec::with_capacity(samples);
    for word in words.take(samples) {
        values.push(word.parse::<u16>().map_err(|_| unreadable(format!("`{word}` among the numbers")))?);
    }
    if values.len() < samples {
        return Err(unreadable(format!("{samples} numbers are needed, {} are there", values.len())));
    }
    if sample == Sample::U16 {
        return Ok(Pixels::U16(values));
    }
    let narrow = |value: u16| u8::try_from(value).map_err(|_| unreadable(format!("{value} in an 8-bit map")));
    Ok(Pixels::U8(values.into_iter().map(narrow).collect::<Result<_>>()?))
}
