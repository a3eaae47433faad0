//! The label image: 0 where there is no plane, otherwise the plane's label, 16 bits.
//!
//! PNG opens anywhere and is small; NPY is what NumPy and the EVOPS tools take.

use super::npy::npy_of;
use super::output::{Output, Writer};
use super::picture::grey16_png;
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
