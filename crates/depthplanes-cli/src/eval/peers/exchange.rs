//! A frame as files for a peer, and its label image back.
//!
//! In: a frame. Out: `values.npy`, the map's own numbers, and `depth.npy`, metres; 0 = missing in both. Where unit or camera
//! is unknown, depth is in median depths and the camera is [`Intrinsics::assumed`], as for `ransac`.

use crate::failure::{Failure, Outcome};
use depthplanes::{DepthView, Detection, Intrinsics, Pixel, ValueKind, describe_labels, with_view};
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::outputs::{map_npy, write_file};
use depthplanes_io::{Frame, LabelImage, Pixels, read_labels};
use serde::Serialize;
use std::path::Path;

/// Focal lengths and principal point, pixels.
#[derive(Serialize)]
pub(super) struct Camera {
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
}

/// Writes a frame into a folder; its camera, and whether it is in metres.
///
/// # Errors
/// A disk that refuses.
pub(super) fn put(frame: &Frame, folder: &Path) -> Outcome<(Camera, bool)> {
    let (width, height) = (frame.width, frame.height);
    let inverse: Vec<f64> = with_view!(frame.view()?, view => inverse_depths(&view, frame.sensor.value_kind));
    let is_metric = frame.sensor.is_metric();
    let median = if is_metric { 1.0 } else { median(&inverse) };
    let depth = inverse.iter().map(|&inverse| if inverse > 0.0 { (median / inverse) as f32 } else { 0.0 }).collect();
    write_file(&folder.join("values.npy"), &map_npy(width, height, &valid_values(frame)?))?;
    write_file(&folder.join("depth.npy"), &map_npy(width, height, &Pixels::F32(depth)))?;
    let assumed = || Intrinsics::assumed(width, height);
    let Intrinsics { fx, fy, cx, cy } = frame.sensor.intrinsics.unwrap_or_else(assumed);
    Ok((Camera { fx, fy, cx, cy }, is_metric))
}

/// What is affine in inverse depth, for each pixel; 0 where there is nothing in front of the camera.
fn inverse_depths<T: Pixel>(view: &DepthView<'_, T>, value_kind: ValueKind) -> Vec<f64> {
    let inverse = |value: T| match value_kind {
        _ if !view.validity().holds(value) => 0.0,
        ValueKind::Disparity => value.into().max(0.0),
        _ => value_kind.inverse_depth(value.into()).unwrap_or(0.0),
    };
    view.rows().flatten().map(|&value| inverse(value)).collect()
}

fn median(inverse: &[f64]) -> f64 {
    let mut known: Vec<f64> = inverse.iter().copied().filter(|&inverse| inverse > 0.0).collect();
    let middle = known.len() / 2;
    if known.is_empty() { 1.0 } else { *known.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// The map's numbers with 0 for all that are missing.
fn valid_values(frame: &Frame) -> Outcome<Pixels> {
    fn only<T: Pixel>(view: &DepthView<'_, T>) -> Vec<T> {
        let validity = view.validity();
        view.rows().flatten().map(|&value| if validity.holds(value) { value } else { T::ZERO }).collect()
    }
    Ok(match frame.view()? {
        depthplanes::AnyView::U8(view) => Pixels::U8(only(&view)),
        depthplanes::AnyView::U16(view) => Pixels::U16(only(&view)),
        depthplanes::AnyView::F32(view) => Pixels::F32(only(&view)),
    })
}

/// Reads a label image of a frame: its planes are described as ours are. Pixels without a value have none.
///
/// # Errors
/// A file that is no label image, or one of another size.
pub(super) fn take(frame: &Frame, file: &Path) -> Outcome<Detection> {
    let LabelImage { width, height, labels, .. } = read_labels(file, &DecodeOptions::default())?;
    if [width, height] != [frame.width, frame.height] {
        return Err(Failure::machine(format!(
            "its labels are {width} x {height}, the map is {} x {}; both must be of the same size",
            frame.width, frame.height
        )));
    }
    Ok(describe_labels(frame.view()?, &labels, &frame.sensor)?.0)
}
