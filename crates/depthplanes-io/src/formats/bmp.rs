//! Uncompressed Windows bitmaps: 1, 4 and 8 bits through a palette, 24 and 32 bits.
//!
//! In: a BMP file, bottom-up or top-down. Out: `u8` values: the palette's grey, not its index.

use super::bytes::Cursor;
use super::channels::reduce;
use super::format::{DecodeOptions, Format, Image};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "bmp",
    about: "Windows bitmap, uncompressed, grey palette (or equal channels)",
    extensions: &["bmp"],
    sniff: |bytes| {
        bytes.starts_with(b"BM") && bytes.len() >= 18 && matches!(bytes[14], 12 | 40 | 52 | 56 | 64 | 108 | 124)
    },
    ends: |bytes, _| {
        let header = header(bytes).ok()?;
        let stride = header.width.checked_mul(header.bits as u64)?.div_ceil(32) * 4;
        stride.checked_mul(header.height)?.checked_add(header.pixels_at as u64)
    },
    decode,
};

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "uncompressed bitmaps of 1, 4, 8, 24 or 32 bits; save the map as 16-bit PNG if it is another kind";
    Error::Unreadable { format: "bmp", wrong: wrong.into(), accepted }
}

struct Header {
    pixels_at: usize,
    palette_at: usize,
    palette_entry: usize,
    palette_entries: usize,
    width: u64,
    height: u64,
    top_down: bool,
    bits: usize,
}

fn header(bytes: &[u8]) -> Result<Header> {
    let short = || unreadable(format!("the header is cut off after {} bytes", bytes.len()));
    let mut cursor = Cursor::new(bytes, 10);
    let pixels_at = cursor.u32().ok_or_else(short)? as usize;
    let header_bytes = cursor.u32().ok_or_else(short)? as usize;
    let core = header_bytes == 12;
    let (width, height) = if core {
        (i64::from(cursor.u16().ok_or_else(short)?), i64::from(cursor.u16().ok_or_else(short)?))
    } else {
        (i64::from(cursor.i32().ok_or_else(short)?), i64::from(cursor.i32().ok_or_else(short)?))
    };
    let _planes = cursor.u16().ok_or_else(short)?;
    let bits = usize::from(cursor.u16().ok_or_else(short)?);
    let compression = if core { 0 } else { cursor.u32().ok_or_else(short)? };
    let mut palette_entries = 0;
    if !core {
        cursor.take(12).ok_or_else(short)?;
        palette_entries = cursor.u32().ok_or_else(short)? as usize;
    }
    if !(compression == 0 || compression == 3 && bits == 32) {
        return Err(unreadable(format!("compression {compression}")));
    }
    if !matches!(bits, 1 | 4 | 8 | 24 | 32) {
        return Err(unreadable(format!("{bits} bits a pixel")));
    }
    if palette_entries == 0 || palette_entries > 1 << bits.min(8) {
        palette_entries = 1 << bits.min(8);
    }
    Ok(Header {
        pixels_at,
        palette_at: 14 + header_bytes,
        palette_entry: if core { 3 } else { 4 },
        palette_entries,
        width: u64::try_from(width).map_err(|_| unreadable(format!("a width of {width}")))?,
        height: height.unsigned_abs(),
        top_down: height < 0,
        bits,
    })
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let header = header(bytes)?;
    let channels = if header.bits >= 24 { header.bits / 8 } else { 3 };
    let area = options.limits.area("bmp", header.width, header.height, channels)?;
    let (width, height) = (header.width as usize, header.height as usize);
    let stride = (width * header.bits).div_ceil(32) * 4;
    let rows = bytes.get(header.pixels_at..).filter(|rows| rows.len() >= stride * height).ok_or_else(|| {
        let there = bytes.len().saturating_sub(header.pixels_at);
        unreadable(format!("{width} x {height} pixels need {} bytes, {there} are there", stride * height))
    })?;
    let palette = if header.bits <= 8 { palette(bytes, &header)? } else { Vec::new() };
    let mut samples = Vec::with_capacity(area * channels);
    for v in 0..height {
        let row = &rows[stride * if header.top_down { v } else { height - 1 - v }..][..stride];
        if header.bits >= 24 {
            samples.extend_from_slice(&row[..width * channels]);
        } else {
            push_palette_row(row, width, &header, &palette, &mut samples)?;
        }
    }
    if options.luminance {
        let grey = samples.chunks_exact(channels).map(luminance).collect();
        return Ok(Image::new(width, height, Pixels::U8(grey), "uint8", Vec::new()));
    }
    samples.chunks_exact_mut(channels).for_each(|pixel| pixel.swap(0, 2)); // Blue comes first in the file.
    let image = Image::new(width, height, Pixels::U8(samples), "uint8", Vec::new());
    let mut image = Image { channels, ..image };
    reduce("bmp", &mut image, channels == 4, options)?;
    if header.bits <= 8 {
        image.warnings.clear(); // A grey palette is the ordinary way to store one channel.
    }
    Ok(image)
}

/// Of blue, green and red, as of standard-definition television (ITU-R BT.601).
fn luminance(pixel: &[u8]) -> u8 {
    let weighed = 114 * u32::from(pixel[0]) + 587 * u32::from(pixel[1]) + 299 * u32::from(pixel[2]);
    ((weighed + 500) / 1000) as u8
}

/// Blue, green, red of each palette entry.
fn palette(bytes: &[u8], header: &Header) -> Result<Vec<[u8; 3]>> {
    let needed = header.palette_entries * header.palette_entry;
    let entries = bytes
        .get(header.palette_at..header.palette_at + needed)
        .ok_or_else(|| unreadable(format!("the palette of {} entries is cut off", header.palette_entries)))?;
    Ok(entries.chunks_exact(header.palette_entry).map(|entry| [entry[0], entry[1], entry[2]]).collect())
}

fn push_palette_row(
    row: &[u8],
    width: usize,
    header: &Header,
    palette: &[[u8; 3]],
    samples: &mut Vec<u8>,
) -> Result<()> {
    let per_byte = 8 / header.bits;
    let mask = ((1u16 << header.bits) - 1) as u8;
    for u in 0..width {
        let shift = 8 - header.bits * (u % per_byte + 1);
        let index = usize::from(row[u / per_byte] >> shift & mask);
        let entry = palette
            .get(index)
            .ok_or_else(|| unreadable(format!("a pixel uses palette entry {index}, there are {}", palette.len())))?;
        samples.extend_from_slice(entry);
    }
    Ok(())
}
