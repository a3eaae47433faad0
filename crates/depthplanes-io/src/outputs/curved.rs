//! The label image of curved regions: 0 where there is none, otherwise the region's label, 16 bits.

use super::error::OutputError;
use super::npy::npy_of;
use super::output::{Output, Report, Writer};
use super::picture::grey16_png;
use depthplanes::detection::Curved;

pub(super) const OUTPUT: Output = Output {
    name: "curved-labels",
    about: "label image of curved surfaces, 16 bits: 0 = none, otherwise the region's label; goes with --curved",
    file: "curved.png",
    needs_camera: false,
    needs_curved: true,
    writers: &[
        Writer {
            extension: "png",
            encode: |report| {
                let curved = found(report)?;
                Ok(grey16_png(report.detection.width, report.detection.height, &curved.labels))
            },
        },
        Writer {
            extension: "npy",
            encode: |report| {
                let curved = found(report)?;
                Ok(npy_of(report.detection.width, report.detection.height, &curved.labels))
            },
        },
    ],
};

fn found<'a>(report: &Report<'a>) -> Result<&'a Curved, OutputError> {
    report.detection.curved.as_ref().ok_or(OutputError::NeedsCurved)
}
