//! The label image: 0 where there is no plane, otherwise the plane's label, 16 bits.
//!
//! PNG opens anywhere and is small; NPY is what NumPy and the EVOPS tools take.

use super::picture::grey16_png;
use super::{Output, Writer};
use depthplanes::Detection;

pub(super) const OUTPUT: Output = Output {
    name: "labels",
    about: "label image, 16 bits: 0 = no plane, otherwise the plane's label",
    file: "labels.png",
    needs_camera: false,
    needs_curved: false,
    writers: &[
        Writer { extension: "png", encode: |report| Ok(png(report.detection)) },
        Writer { extension: "npy", encode: |report| Ok(npy(report.detection)) },
    ],
};

/// The label image as a 16-bit grey PNG file.
pub fn png(detection: &Detection) -> Vec<u8> {
    grey16_png(detection.width, detection.height, &detection.labels)
}

/// The label image as a NumPy file, `uint16`, shape `(height, width)`.
pub fn npy(detection: &Detection) -> Vec<u8> {
    npy_of(detection.width, detection.height, &detection.labels)
}

pub(super) fn npy_of(width: usize, height: usize, labels: &[u16]) -> Vec<u8> {
    let shape = format!("({height}, {width})");
    let mut header = format!("{{'descr': '<u2', 'fortran_order': False, 'shape': {shape}, }}");
    // NPY format 1.0: the data start at a multiple of 64; 10 bytes stand before the header, which
    // ends in a line feed.
    let padding = 64 - (10 + header.len() + 1) % 64;
    header.extend(std::iter::repeat_n(' ', padding % 64));
    header.push('\n');

    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.into_bytes());
    bytes.extend(labels.iter().flat_map(|label| label.to_le_bytes()));
    bytes
}
