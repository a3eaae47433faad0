//! Cameras beside maps that they say nothing of.

use depthplanes::{AnyView, DepthView, Pixel, Sensor, ValueKind, with_view};

use super::probe::Probe;
use crate::frame::Frame;

/// Columns and rows of the pixels that are asked for their ray.
const RAYS: usize = 48;

/// Fewer pixels without a ray are not worth a note: our choice.
const SHARE: f64 = 0.001;

/// A camera for a PFM file that is taken for disparity by its format alone: without a rig the camera says nothing.
pub(super) fn of_disparity(frame: &Frame, _: &Probe) -> Option<String> {
    let is_guess = frame.format == "pfm" && frame.provenance.is_guess();
    (is_guess && frame.sensor.value_kind == ValueKind::Disparity && frame.sensor.intrinsics.is_some()).then(|| {
        "a PFM file is taken for disparity; with the camera alone it has no metres: try --baseline for the rig, or, if it \
         is depth, --encoding metre or --encoding millimetre"
            .to_string()
    })
}

/// A lens whose formula folds back within the picture: the pixels beyond have no ray, and no label.
pub(super) fn folds(frame: &Frame, _: &Probe) -> Option<String> {
    let Sensor { intrinsics: Some(_), distortion: Some(lens), .. } = frame.sensor else { return None };
    let angle = lens.folds_beyond_deg()?;
    let view: AnyView<'_> = frame.view().ok()?;
    let share = with_view!(view, view => without_ray(&view, &frame.sensor));
    let shown = if share < 0.01 { format!("{:.1}", 100.0 * share) } else { format!("{:.0}", 100.0 * share) };
    (share > SHARE).then(|| {
        format!(
            "{shown} % of the pixels have no ray and get no label: the distortion model folds beyond {angle:.0} degrees; check the \
             coefficients, their order and the camera's size, or try --rectified if the map is of the undistorted picture"
        )
    })
}

/// The share of the valid pixels that have no ray, of some that are spread evenly.
fn without_ray<T: Pixel>(view: &DepthView<'_, T>, sensor: &Sensor) -> f64 {
    let middle = |index: usize, side: usize, count: usize| (2 * index + 1) * side / (2 * count);
    let (columns, rows) = (view.width().min(RAYS), view.height().min(RAYS));
    let (mut valid, mut lost) = (0usize, 0usize);
    for v in (0..rows).map(|row| middle(row, view.height(), rows)) {
        for u in (0..columns).map(|column| middle(column, view.width(), columns)) {
            if view.validity().holds(view.row(v)[u]) {
                valid += 1;
                lost += usize::from(sensor.ray(u as f64, v as f64).is_none());
            }
        }
    }
    lost as f64 / valid.max(1) as f64
}
