//! RVL, the lossless depth codec of A. D. Wilson, "Fast Lossless Depth Image Compression", ISS 2017.
//!
//! In: `u32` columns, `u32` rows (little-endian), then the RVL words. Out: `u16` values. The stream
//! alternates runs of zeros and runs of values; a value is the zigzag difference to the last one
//! that was not 0; every number is cut into groups of three bits, lowest first, each with a bit that
//! says whether another follows; eight such nibbles make a little-endian word, first nibble highest.

use super::bytes::Cursor;
use super::format::{DecodeOptions, Format, Image};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "rvl",
    about: "RVL-packed 16-bit depth behind its width and height",
    extensions: &["rvl"],
    sniff: plausible,
    ends: |_, _| None,
    decode: |bytes, options| decode(bytes, options),
};

/// A pixel that is not 0 takes a nibble at least, so four bytes of samples come out of one; beyond
/// this many pixels a shorter payload than a fifth of that is taken for damage, as ROS does it.
/// Below, a blank frame is allowed to be as small as it is.
const ALWAYS_ALLOWED_PIXELS: u64 = 1 << 22;

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "columns and rows as 32-bit numbers, then the RVL words of that many pixels";
    Error::Unreadable { format: "rvl", wrong: wrong.into(), accepted }
}

fn size(bytes: &[u8]) -> Option<(u64, u64)> {
    let mut cursor = Cursor::new(bytes, 0);
    Some((cursor.u32()?.into(), cursor.u32()?.into()))
}

/// RVL has no signature: the size must be a camera's, and the payload long enough for it.
pub(super) fn plausible(bytes: &[u8]) -> bool {
    let is_backed = || size(bytes).is_some_and(|(w, h)| backed(w * h, bytes));
    bytes.len() >= 12 && bytes.len().is_multiple_of(4) && begins(bytes) && is_backed()
}

/// Whether the size is a camera's, however much comes after it.
pub(super) fn begins(bytes: &[u8]) -> bool {
    let side = 1..=16_384;
    size(bytes).is_some_and(|(w, h)| side.contains(&w) && side.contains(&h))
}

fn backed(area: u64, bytes: &[u8]) -> bool {
    area <= ALWAYS_ALLOWED_PIXELS || area <= 5 * bytes.len() as u64
}

/// Reads columns, rows and the words after them.
pub(super) fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let (width, height) = size(bytes).ok_or_else(|| unreadable(format!("{} bytes", bytes.len())))?;
    let area = options.limits.area("rvl", width, height, 2)?;
    if !backed(area as u64, bytes) {
        return Err(unreadable(format!("{width} x {height} pixels in {} bytes", bytes.len())));
    }
    let pixels = Pixels::U16(unpack(&bytes[8..], area)?);
    Ok(Image::new(width as usize, height as usize, pixels, "uint16", Vec::new()))
}

/// The nibbles of a byte slice, in RVL's order.
struct Nibbles<'a> {
    words: std::slice::ChunksExact<'a, u8>,
    word: u32,
    left: u32,
}

impl Nibbles<'_> {
    #[inline]
    fn next(&mut self) -> Option<u32> {
        if self.left == 0 {
            let chunk = self.words.next()?;
            self.word = u32::from_le_bytes([chunk[0], chunk[1], chunk[2], chunk[3]]);
            self.left = 8;
        }
        let nibble = self.word >> 28;
        self.word <<= 4;
        self.left -= 1;
        Some(nibble)
    }

    /// A number of groups of three bits.
    #[inline]
    fn number(&mut self) -> Option<u32> {
        let (mut value, mut shift) = (0u32, 0);
        loop {
            let nibble = self.next()?;
            value |= (nibble & 7) << shift;
            if nibble < 8 {
                return Some(value);
            }
            shift += 3;
            if shift > 30 {
                return None;
            }
        }
    }
}

/// Unpacks RVL words into `area` values.
///
/// # Errors
/// [`Error::Unreadable`] if the words end early, a run is longer than the map, or a number is
/// longer than 33 bits.
pub fn unpack(words: &[u8], area: usize) -> Result<Vec<u16>> {
    let mut nibbles = Nibbles { words: words.chunks_exact(4), word: 0, left: 0 };
    let mut values = Vec::with_capacity(area);
    let cut = |values: &Vec<u16>| unreadable(format!("the words end after {} of {area} pixels", values.len()));
    let mut last = 0u16;
    while values.len() < area {
        let run = |count: u32, values: &Vec<u16>| {
            let left = area - values.len();
            let count = count as usize;
            if count <= left { Ok(count) } else { Err(unreadable(format!("a run of {count}, {left} pixels are left"))) }
        };
        let before = values.len();
        let zeros = nibbles.number().ok_or_else(|| cut(&values))?;
        let zeros = run(zeros, &values)?;
        values.resize(before + zeros, 0);
        if values.len() == area {
            break; // A blank end needs no run of values behind it.
        }
        let count = nibbles.number().ok_or_else(|| cut(&values))?;
        let count = run(count, &values)?;
        for _ in 0..count {
            let zigzag = nibbles.number().ok_or_else(|| cut(&values))?;
            let difference = (zigzag >> 1) as i32 ^ -((zigzag & 1) as i32);
            last = last.wrapping_add(difference as u16);
            values.push(last);
        }
        if values.len() == before {
            return Err(unreadable(format!("two empty runs after {before} pixels")));
        }
    }
    Ok(values)
}

/// Packs a map: the inverse of [`unpack`], without columns and rows.
pub fn pack(values: &[u16]) -> Vec<u8> {
    let mut packed = Packer::default();
    let (mut at, mut last) = (0, 0i32);
    while at < values.len() {
        let zeros = values[at..].iter().take_while(|&&value| value == 0).count();
        at += zeros;
        let run = values[at..].iter().take_while(|&&value| value != 0).count();
        packed.number(zeros as u32);
        packed.number(run as u32);
        for &value in &values[at..at + run] {
            let difference = i32::from(value) - last;
            packed.number((difference << 1 ^ difference >> 31) as u32);
            last = i32::from(value);
        }
        at += run;
    }
    packed.finish()
}

#[derive(Default)]
struct Packer {
    bytes: Vec<u8>,
    word: u32,
    filled: u32,
}

impl Packer {
    fn number(&mut self, mut value: u32) {
        loop {
            let more = value > 7;
            self.word = self.word << 4 | value & 7 | u32::from(more) << 3;
            self.filled += 1;
            if self.filled == 8 {
                self.bytes.extend_from_slice(&self.word.to_le_bytes());
                (self.word, self.filled) = (0, 0);
            }
            value >>= 3;
            if !more {
                return;
            }
        }
    }

    fn finish(mut self) -> Vec<u8> {
        if self.filled > 0 {
            let word = self.word << (4 * (8 - self.filled));
            self.bytes.extend_from_slice(&word.to_le_bytes());
        }
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_bit_layout_by_hand() {
        // 1 zero, 1 value of 4: zigzag 8 = 0b1_000 -> nibbles 8|0, 1; words read highest nibble first.
        assert_eq!(pack(&[0, 4]), 0x1181_0000u32.to_le_bytes());
        assert_eq!(unpack(&0x1181_0000u32.to_le_bytes(), 2).unwrap(), [0, 4]);
    }

    #[test]
    fn unpack_inverts_pack() {
        let values: Vec<u16> = (0..5000u32).map(|i| if i % 7 < 3 { 0 } else { (i * 7919 % 65_536) as u16 }).collect();
        assert_eq!(unpack(&pack(&values), values.len()).unwrap(), values);
        assert_eq!(unpack(&pack(&[0; 100]), 100).unwrap(), [0; 100]);
        assert_eq!(unpack(&pack(&[65_535; 9]), 9).unwrap(), [65_535; 9]);
    }
}
