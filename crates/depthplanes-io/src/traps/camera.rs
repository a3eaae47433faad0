//! Cameras that cannot have made the map.

use depthplanes::Measure;

use super::Probe;
use crate::frame::Frame;

/// A principal point outside of the map: the camera of another size, or numbers in another order.
pub(super) fn away(frame: &Frame, _: &Probe) -> Option<String> {
    let camera = frame.sensor.intrinsics?;
    let (width, height) = (frame.width as f64, frame.height as f64);
    let inside = (-0.5..width).contains(&camera.cx) && (-0.5..height).contains(&camera.cy);
    (!inside).then(|| {
        format!(
            "the principal point {}, {} lies outside of {} x {} pixels: is the camera that of another size, or are \
             fx,fy,cx,cy in another order?",
            camera.cx, camera.cy, frame.width, frame.height
        )
    })
}

/// A camera for a PFM file that is taken for disparity by its format alone: without a rig the camera says nothing.
pub(super) fn of_disparity(frame: &Frame, _: &Probe) -> Option<String> {
    let is_guess = frame.format == "pfm" && frame.provenance.encoding != "stated" && frame.provenance.preset.is_none();
    (is_guess && frame.sensor.measure == Measure::Disparity && frame.sensor.intrinsics.is_some()).then(|| {
        "a PFM file is taken for disparity; with the camera alone it has no metres: try --baseline for the rig, or, if it \
         is depth, --encoding metre or --encoding millimetre"
            .to_string()
    })
}
