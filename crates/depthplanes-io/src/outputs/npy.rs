//! Images as NumPy files (`.npy`), format version 1.0.

use crate::frame::Pixels;

/// A map's values as a NumPy file, `uint8`, `uint16` or `float32`, shape `(height, width)`.
pub fn map_npy(width: usize, height: usize, pixels: &Pixels) -> Vec<u8> {
    match pixels {
        Pixels::U8(values) => file("|u1", width, height, values.iter().copied()),
        Pixels::U16(values) => npy_of(width, height, values),
        Pixels::F32(values) => file("<f4", width, height, values.iter().flat_map(|value| value.to_le_bytes())),
    }
}

pub(super) fn npy_of(width: usize, height: usize, labels: &[u16]) -> Vec<u8> {
    file("<u2", width, height, labels.iter().flat_map(|label| label.to_le_bytes()))
}

fn file(sample: &str, width: usize, height: usize, data: impl Iterator<Item = u8>) -> Vec<u8> {
    let mut header = format!("{{'descr': '{sample}', 'fortran_order': False, 'shape': ({height}, {width}), }}");
    // The data start at a multiple of 64; 10 bytes stand before the header, which ends in a line feed.
    let padding = 64 - (10 + header.len() + 1) % 64;
    header.extend(std::iter::repeat_n(' ', padding % 64));
    header.push('\n');

    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.into_bytes());
    bytes.extend(data);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{DecodeOptions, decode};

    #[test]
    fn what_is_written_is_read() {
        let values = [1.5, 0.0, -3.25, 1e30, 7.0, 0.1];
        let maps = [
            Pixels::U8(vec![1, 0, 255, 4, 5, 6]),
            Pixels::U16(vec![1, 0, 65535, 4, 5, 6]),
            Pixels::F32(values.to_vec()),
        ];
        for pixels in maps {
            let (image, format) = decode(&map_npy(3, 2, &pixels), &DecodeOptions::default()).unwrap();
            assert_eq!((image.width, image.height, image.pixels, format.name), (3, 2, pixels, "npy"));
        }
    }
}
