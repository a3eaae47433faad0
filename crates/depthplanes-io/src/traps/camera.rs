//! Cameras beside maps that they say nothing of.

use depthplanes::ValueKind;

use super::probe::Probe;
use crate::frame::Frame;

/// A camera for a PFM file that is taken for disparity by its format alone: without a rig the camera says nothing.
pub(super) fn of_disparity(frame: &Frame, _: &Probe) -> Option<String> {
    let is_guess = frame.format == "pfm" && frame.provenance.is_guess();
    (is_guess && frame.sensor.value_kind == ValueKind::Disparity && frame.sensor.intrinsics.is_some()).then(|| {
        "a PFM file is taken for disparity; with the camera alone it has no metres: try --baseline for the rig, or, if it \
         is depth, --encoding metre or --encoding millimetre"
            .to_string()
    })
}
