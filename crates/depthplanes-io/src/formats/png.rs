//! PNG, 8 and 16 bits: grey, grey with opacity, and colour or palette whose channels are equal.
//!
//! In: a PNG file. Out: `u8` or `u16` values as stored; 1, 2 and 4-bit grey is widened to 8 bits.
//! 16-bit samples are decoded into the frame's own buffer and their bytes swapped in place.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, DecodingError, Reader, Transformations};

use super::channels::reduce;
use super::format::{DecodeOptions, Format, Image};
use super::orientation::{of_exif, orient};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "png",
    about: "PNG, 8 or 16 bits, grey (or equal channels)",
    extensions: &["png"],
    sniff: |bytes| bytes.starts_with(&SIGNATURE),
    ends: |bytes, _| chunks_end(bytes),
    decode,
};

const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
const ACCEPTED: &str = "a whole PNG file with one depth map";
/// Deflate packs no more than 1032 bytes into one, so a longer promise cannot be kept.
const BEST_RATIO: usize = 1032;

fn unreadable(error: DecodingError) -> Error {
    Error::Unreadable { format: "png", wrong: error.to_string(), accepted: ACCEPTED }
}

/// Behind the last chunk, or as far as the chunks lead; no further than one that no PNG file has.
fn chunks_end(bytes: &[u8]) -> Option<u64> {
    /// Descriptions, profiles and the like are shorter in any file that other readers take (libpng's limit).
    const LONGEST: u64 = 8_000_000;
    let number = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let [width, height] = [16, 20].map(|at| number(at).map_or(0, u64::from));
    // 4 channels of 16 bits, a byte a row, and twice that for what is packed badly.
    let most_data = (16 * width + 2).saturating_mul(height).saturating_add(LONGEST);
    let (mut at, mut data) = (SIGNATURE.len(), 0u64);
    while let Some(length) = number(at).map(u64::from) {
        let Some(kind) = bytes.get(at + 4..at + 8) else { break };
        let is_data = kind == b"IDAT";
        data += if is_data { length } else { 0 };
        let is_one =
            kind.iter().all(u8::is_ascii_alphabetic) && if is_data { data <= most_data } else { length <= LONGEST };
        if !is_one {
            return Some(at as u64 + 8);
        }
        let end = at as u64 + 12 + length;
        if kind == b"IEND" || end > bytes.len() as u64 {
            // The head of the next chunk is read with this one.
            return Some(if kind == b"IEND" { end } else { end + 8 });
        }
        at = end as usize;
    }
    Some(at as u64 + 8)
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: options.limits.max_bytes });
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let mut reader = decoder.read_info().map_err(unreadable)?;
    let (width, height) = (reader.info().width, reader.info().height);
    let stored_bits = reader.info().bit_depth as u8;
    let palette = reader.info().color_type == ColorType::Indexed;
    let (color, depth) = reader.output_color_type();
    let sample_bytes = if depth == BitDepth::Sixteen { 2 } else { 1 };
    let channels = color.samples();
    let area = options.limits.area("png", width.into(), height.into(), channels * sample_bytes)?;
    let samples = area * channels;
    let least_raw = area * usize::from(stored_bits) / 8;
    if least_raw > bytes.len().saturating_mul(BEST_RATIO) {
        let wrong = format!("{width} x {height} pixels cannot come out of {} bytes", bytes.len());
        return Err(Error::Unreadable { format: "png", wrong, accepted: ACCEPTED });
    }
    let mut warnings = Vec::new();
    if stored_bits < 8 && !palette {
        warnings.push(format!("{stored_bits}-bit grey is widened to 8 bits"));
    }
    let alpha = matches!(color, ColorType::GrayscaleAlpha | ColorType::Rgba);
    let pixels = if sample_bytes == 2 {
        Pixels::U16(read_u16(&mut reader, samples)?)
    } else {
        let mut buffer = vec![0u8; samples];
        reader.next_frame(&mut buffer).map_err(unreadable)?;
        Pixels::U8(buffer)
    };
    let sample = if sample_bytes == 2 { "uint16" } else { "uint8" };
    let image = Image::new(width as usize, height as usize, pixels, sample, warnings);
    let mut image = Image { channels, ..image };
    let orientation = reader.info().exif_metadata.as_deref().map_or(1, of_exif);
    orient("png", &mut image, orientation)?;
    reduce("png", &mut image, alpha, options)?;
    Ok(image)
}

/// PNG stores 16-bit samples big-endian.
fn read_u16(reader: &mut Reader<Cursor<&[u8]>>, samples: usize) -> Result<Vec<u16>> {
    let mut buffer = vec![0u16; samples];
    reader.next_frame(bytemuck::cast_slice_mut(&mut buffer)).map_err(unreadable)?;
    for value in &mut buffer {
        *value = u16::from_be(*value);
    }
    Ok(buffer)
}
