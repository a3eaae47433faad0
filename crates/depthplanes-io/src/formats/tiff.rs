//! TIFF, one page of the file: integers or floats, one channel (or equal ones).
//!
//! In: strips or tiles, uncompressed, PackBits, LZW or deflate; without a page stated, the first of the largest pages that
//! are no thumbnails, and no colour pictures where there are others. Out: `u8`, `u16` or `f32` values by the rules of
//! `samples`. Unsigned integers of which 0 is white are inverted as the standard says; floats are taken as they are, since
//! they have no largest value to be subtracted from.

use std::borrow::Cow;
use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult, Limits as TiffLimits};
use tiff::tags::{ByteOrder, Tag};
use tiff::{ColorType, TiffError};

use super::channels::reduce;
use super::format::{DecodeOptions, Format, Image};
use super::orientation::orient;
use super::samples::{doubles, half, integers};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "tiff",
    about: "TIFF, integers or float, first page of full size or a chosen one",
    extensions: &["tif", "tiff"],
    sniff: |bytes| [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| bytes.starts_with(magic)),
    ends: |bytes, _| pages_end(bytes),
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

/// Pages beyond these are not looked at.
const MOST_PAGES: usize = 1000;

type Reader<'a> = Decoder<Cursor<&'a [u8]>>;

/// Behind everything that the pages point at, as far as the bytes lead.
fn pages_end(bytes: &[u8]) -> Option<u64> {
    let (is_little, is_big) = (bytes.starts_with(b"II"), matches!(bytes.get(..4)?, b"II+\0" | b"MM\0+"));
    let number = |at: u64, length: u64| -> Option<u64> {
        let bytes = bytes.get(usize::try_from(at).ok()?..usize::try_from(at.checked_add(length)?).ok()?)?;
        let shift = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
        Some(if is_little { bytes.iter().rev().fold(0, shift) } else { bytes.iter().fold(0, shift) })
    };
    let (count_bytes, word, entry) = if is_big { (8, 8, 20) } else { (2, 4, 12) };
    let mut page = number(if is_big { 8 } else { 4 }, word)?;
    let mut end = 16;
    for _ in 0..MOST_PAGES {
        if page == 0 {
            break;
        }
        let Some(entries) = number(page, count_bytes) else { return Some(end.max(page.saturating_add(count_bytes))) };
        let next = page + count_bytes + entry * entries.min(1 << 16);
        let Some(following) = number(next, word) else { return Some(end.max(next + word)) };
        end = end.max(next + word);
        // Places and lengths of strips and tiles, by their tags; each a list of numbers, in the entry if it fits there.
        let list = |tags: [u64; 2]| -> Option<Vec<u64>> {
            let mut entries = (0..entries.min(1 << 16)).map(|index| page + count_bytes + entry * index);
            let at = entries.find(|&at| number(at, 2).is_some_and(|tag| tags.contains(&tag)))?;
            let size = match number(at + 2, 2)? {
                3 => 2,
                4 => 4,
                _ => 8,
            };
            let count = number(at + 4, word)?.min(1 << 24);
            let value = at + 4 + word;
            let first = if count * size <= word { value } else { number(value, word)? };
            let last = first.saturating_add(count * size);
            if number(last.saturating_sub(1), 1).is_none() {
                return Some(vec![last]); // still to come
            }
            (0..count).map(|index| number(first + index * size, size)).collect()
        };
        let (places, lengths) = (list([273, 324]).unwrap_or_default(), list([279, 325]).unwrap_or_default());
        let behind = places.iter().zip(lengths.iter().chain(std::iter::repeat(&0)));
        end = behind.fold(end, |end, (place, length)| end.max(place.saturating_add(*length)));
        end = lengths.iter().filter(|_| lengths.len() != places.len()).fold(end, |end, at| end.max(*at));
        page = following;
    }
    Some(end)
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let (page, note) = choose(&pages(bytes, options)?, options)?;
    let mut decoder = reader(bytes, options)?;
    decoder.seek_to_image(page).map_err(from_tiff)?;
    let white_is_zero = photometric(&mut decoder)? == Some(0);
    // The crate inverts while it reads, floats as well; so it is told that black is 0.
    let plain = if white_is_zero { black_is_zero(bytes, &mut decoder) } else { Cow::Borrowed(bytes) };
    let mut decoder = reader(&plain, options)?;
    decoder.seek_to_image(page).map_err(from_tiff)?;
    let mut image = read_page(&mut decoder, options)?;
    image.warnings.splice(0..0, note);
    if white_is_zero {
        invert(&mut image);
    }
    let orientation = decoder.find_tag_unsigned::<u16>(Tag::Orientation).map_err(from_tiff)?;
    orient("tiff", &mut image, orientation.unwrap_or(1))?;
    let alpha = opacity_is_last(&mut decoder, image.channels);
    reduce("tiff", &mut image, alpha, options)?;
    Ok(image)
}

fn reader<'a>(bytes: &'a [u8], options: &DecodeOptions) -> Result<Reader<'a>> {
    let most = bytes.len().saturating_mul(BEST_RATIO).min(options.limits.max_bytes);
    let mut limits = TiffLimits::default();
    limits.decoding_buffer_size = most;
    limits.intermediate_buffer_size = most;
    limits.ifd_value_size = bytes.len();
    Ok(Decoder::new(Cursor::new(bytes)).map_err(from_tiff)?.with_limits(limits))
}

/// A page of the file.
struct Page {
    width: u32,
    height: u32,
    /// A smaller version of another page, or a mask, by its own word.
    reduced: bool,
    /// A colour picture: more channels than a value and its opacity.
    colour: bool,
}

fn pages(bytes: &[u8], options: &DecodeOptions) -> Result<Vec<Page>> {
    let mut decoder = reader(bytes, options)?;
    let mut pages = Vec::new();
    loop {
        let (width, height) = decoder.dimensions().map_err(from_tiff)?;
        let kind = decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten().unwrap_or(0);
        let old_kind = decoder.find_tag_unsigned::<u32>(Tag::SubfileType).ok().flatten().unwrap_or(0);
        let channels = decoder.find_tag_unsigned::<u16>(Tag::SamplesPerPixel).ok().flatten().unwrap_or(1);
        pages.push(Page { width, height, reduced: kind & 5 != 0 || old_kind == 2, colour: channels > 2 });
        if !decoder.more_images() || pages.len() == MOST_PAGES {
            return Ok(pages);
        }
        if decoder.next_image().is_err() {
            return Ok(pages); // What follows cannot be told from damage; the pages before it are there.
        }
    }
}

/// The index of the page to read, and what to say if there are several.
fn choose(pages: &[Page], options: &DecodeOptions) -> Result<(usize, Option<String>)> {
    let sizes: Vec<String> = pages.iter().take(6).map(|page| format!("{}x{}", page.width, page.height)).collect();
    let more = if pages.len() > 6 { " ..." } else { "" };
    let sizes = format!("{}{more}", sizes.join(", "));
    if let Some(member) = &options.member {
        return match member.parse::<usize>() {
            Ok(page) if (1..=pages.len()).contains(&page) => Ok((page - 1, None)),
            _ => Err(Error::parameter("--member", member, format!("a page of 1 to {} ({sizes})", pages.len()))),
        };
    }
    let area = |page: &Page| u64::from(page.width) * u64::from(page.height);
    // A value spread over channels is asked for by its encoding; else a colour picture stands beside the depth.
    let fits = |page: &Page| [!page.reduced, options.channels || !page.colour];
    let most = pages.iter().map(fits).max().unwrap_or_default();
    let largest = pages.iter().filter(|page| fits(page) == most).map(area).max().unwrap_or(0);
    let chosen = pages.iter().position(|page| fits(page) == most && area(page) == largest).unwrap_or(0);
    let note = (pages.len() > 1)
        .then(|| format!("page {} of {} is taken ({sizes}); --member states another", chosen + 1, pages.len()));
    Ok((chosen, note))
}

fn photometric(decoder: &mut Reader<'_>) -> Result<Option<u16>> {
    decoder.find_tag_unsigned::<u16>(Tag::PhotometricInterpretation).map_err(from_tiff)
}

/// The file with the page's photometric interpretation changed from 0 to 1.
fn black_is_zero<'a>(bytes: &'a [u8], decoder: &mut Reader<'_>) -> Cow<'a, [u8]> {
    let little = matches!(decoder.byte_order(), ByteOrder::LittleEndian);
    let big_tiff = matches!(bytes.get(..4), Some(b"II+\0" | b"MM\0+"));
    let number = |at: usize, length: usize| -> Option<u64> {
        let bytes = bytes.get(at..at.checked_add(length)?)?;
        let shift = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
        Some(if little { bytes.iter().rev().fold(0, shift) } else { bytes.iter().fold(0, shift) })
    };
    let mut place = || {
        let at = usize::try_from(decoder.ifd_pointer()?.0).ok()?;
        let (count_bytes, entry, value) = if big_tiff { (8, 20, 12) } else { (2, 12, 8) };
        let entries = number(at, count_bytes)?.min(1 << 16) as usize;
        let places = (0..entries).map(|index| at + count_bytes + entry * index);
        let tag = u64::from(Tag::PhotometricInterpretation.to_u16());
        places.into_iter().find(|at| number(*at, 2) == Some(tag)).map(|at| at + value + usize::from(!little))
    };
    match place() {
        Some(at) if at < bytes.len() => {
            let mut changed = bytes.to_vec();
            changed[at] = 1;
            Cow::Owned(changed)
        }
        _ => Cow::Borrowed(bytes),
    }
}

/// All channels of the page, side by side.
fn read_page(decoder: &mut Reader<'_>, options: &DecodeOptions) -> Result<Image> {
    let (width, height) = decoder.dimensions().map_err(from_tiff)?;
    let color = decoder.colortype().map_err(from_tiff)?;
    let channels = match color {
        ColorType::Gray(_) | ColorType::GrayA(_) | ColorType::RGB(_) | ColorType::RGBA(_) => color.num_samples(),
        ColorType::Multiband { num_samples: samples @ 1..=4, .. } => samples,
        ColorType::Multiband { num_samples, .. } => return Err(unreadable(format!("it has {num_samples} channels"))),
        other => return Err(unreadable(format!("its colours are {other:?}"))),
    };
    let channels = usize::from(channels);
    let area = options.limits.area("tiff", width.into(), height.into(), channels)?;
    let planar = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(from_tiff)? == Some(2);
    let mut decoded = DecodingResult::U8(Vec::new());
    decoder.read_image_to_buffer(&mut decoded).map_err(from_tiff)?;
    let mut warnings = Vec::new();
    let (mut pixels, sample) = pixels(decoded, &mut warnings);
    let there = match &pixels {
        Pixels::U8(values) => values.len(),
        Pixels::U16(values) => values.len(),
        Pixels::F32(values) => values.len(),
    };
    if there != area * channels {
        let needed = area * channels;
        let wrong = format!("{width} x {height} pixels of {channels} channels need {needed} values, {there} are there");
        return Err(unreadable(wrong));
    }
    if planar && channels > 1 {
        pixels = match pixels {
            Pixels::U8(values) => Pixels::U8(interleaved(&values, channels)),
            Pixels::U16(values) => Pixels::U16(interleaved(&values, channels)),
            Pixels::F32(values) => Pixels::F32(interleaved(&values, channels)),
        };
    }
    let image = Image::new(width as usize, height as usize, pixels, sample, warnings);
    let mut image = Image { channels, ..image };
    if let Some(missing) = no_data(decoder) {
        image.warnings.push(format!("{missing} is taken as missing, as the file says (GDAL_NODATA)"));
        image.missing = Some(missing);
    }
    Ok(image)
}

/// GDAL's value for missing, unless it is missing anyway: 0, not finite or negative.
fn no_data(decoder: &mut Reader<'_>) -> Option<f64> {
    let text = decoder.find_tag(Tag::GdalNodata).ok()??.into_string().ok()?;
    let value: f64 = text.trim_matches(['\0', ' ']).parse().ok()?;
    (value.is_finite() && value > 0.0).then_some(value)
}

/// Whether the last of the channels is opacity.
fn opacity_is_last(decoder: &mut Reader<'_>, channels: usize) -> bool {
    let extra = decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples).ok().flatten().unwrap_or_default();
    let color = decoder.colortype().ok();
    matches!(color, Some(ColorType::GrayA(_) | ColorType::RGBA(_)))
        || matches!(channels, 2 | 4) && matches!(extra.last(), Some(1 | 2))
}

/// White is 0: the largest value of the type minus the value, which the standard means for unsigned integers.
fn invert(image: &mut Image) {
    match &mut image.pixels {
        Pixels::U8(values) if image.sample == "uint8" => values.iter_mut().for_each(|value| *value = !*value),
        Pixels::U16(values) if image.sample == "uint16" => values.iter_mut().for_each(|value| *value = !*value),
        _ => return,
    }
    image.warnings.push("0 is white in this file: the values are inverted, as the standard says".to_string());
}

fn interleaved<T: Copy>(planes: &[T], channels: usize) -> Vec<T> {
    let area = planes.len() / channels;
    (0..area * channels).map(|at| planes[at % channels * area + at / channels]).collect()
}

fn pixels(decoded: DecodingResult, warnings: &mut Vec<String>) -> (Pixels, &'static str) {
    macro_rules! whole {
        ($values:expr) => {
            integers(|| $values.iter().map(|&value| i128::from(value)), warnings)
        };
    }
    match decoded {
        DecodingResult::U8(values) => (Pixels::U8(values), "uint8"),
        DecodingResult::U16(values) => (Pixels::U16(values), "uint16"),
        DecodingResult::F32(values) => (Pixels::F32(values), "float32"),
        DecodingResult::F64(values) => (doubles(values.into_iter(), warnings), "float64"),
        DecodingResult::F16(values) => {
            (Pixels::F32(values.into_iter().map(|value| half(value.to_bits())).collect()), "float16")
        }
        DecodingResult::I8(values) => (whole!(values), "int8"),
        DecodingResult::I16(values) => (whole!(values), "int16"),
        DecodingResult::U32(values) => (whole!(values), "uint32"),
        DecodingResult::I32(values) => (whole!(values), "int32"),
        DecodingResult::U64(values) => (whole!(values), "uint64"),
        DecodingResult::I64(values) => (whole!(values), "int64"),
    }
}
