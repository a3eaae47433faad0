//! A frame as files for a peer, and its label image back.
//!
//! In: a frame. Out: `values.npy`, the map's own numbers, and `depth.npy`, metres; 0 = missing in both. Where unit or camera
//! is unknown, depth is in median depths and the camera is [`Intrinsics::assumed`], as for `ransac`.

use crate::failure::{Failure, Outcome};
use depthplanes::describe::{Describer, Seen};
use depthplanes::select::LabelledRun;
use depthplanes::{DepthView, Detection, Intrinsics, Measure, Pixel, with_view};
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
    let inverse: Vec<f64> = with_view!(frame.view()?, view => inverse_depths(&view, frame.sensor.measure));
    let is_metric = frame.sensor.intrinsics.is_some() && frame.sensor.measure != Measure::Disparity;
    let median = if is_metric { 1.0 } else { median(&inverse) };
    let depth = inverse.iter().map(|&inverse| if inverse > 0.0 { (median / inverse) as f32 } else { 0.0 }).collect();
    write_file(&folder.join("values.npy"), &map_npy(width, height, &valid_values(frame)?))?;
    write_file(&folder.join("depth.npy"), &map_npy(width, height, &Pixels::F32(depth)))?;
    let assumed = || Intrinsics::assumed(width, height);
    let Intrinsics { fx, fy, cx, cy } = frame.sensor.intrinsics.unwrap_or_else(assumed);
    Ok((Camera { fx, fy, cx, cy }, is_metric))
}

/// What is affine in inverse depth, for each pixel; 0 where there is nothing in front of the camera.
fn inverse_depths<T: Pixel>(view: &DepthView<'_, T>, measure: Measure) -> Vec<f64> {
    let inverse = |value: T| match measure {
        _ if !view.validity().holds(value) => 0.0,
        Measure::Disparity => value.into().max(0.0),
        _ => measure.inverse_depth(value.into()).unwrap_or(0.0),
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
    Ok(with_view!(frame.view()?, view => described(frame, &view, labels)))
}

fn described<T: Pixel>(frame: &Frame, view: &DepthView<'_, T>, mut labels: Vec<u16>) -> Detection {
    let validity = view.validity();
    labels
        .iter_mut()
        .zip(view.rows().flatten())
        .filter(|(_, value)| !validity.holds(**value))
        .for_each(|(label, _)| *label = 0);
    by_size(&mut labels);
    let (width, height, valid_pixels) = (view.width(), view.height(), view.valid_pixels());
    let runs = runs(&labels, width);
    let (mut describer, mut planes) = (Describer::default(), Vec::new());
    describer.tally(view, &runs, 0, &frame.sensor, 1);
    let seen = Seen { sensor: &frame.sensor, noise: None, valid_pixels };
    describer.describe(view, &runs, &seen, 1, &mut planes);
    Detection { width, height, labels, planes, valid_pixels, ..Detection::default() }
}

/// Renames labels: 1, 2, .. by decreasing number of pixels, as ours are.
fn by_size(labels: &mut [u16]) {
    let mut sizes = vec![0usize; usize::from(u16::MAX) + 1];
    labels.iter().for_each(|&label| sizes[usize::from(label)] += 1);
    let mut order: Vec<usize> = (1..sizes.len()).filter(|&label| sizes[label] > 0).collect();
    order.sort_by_key(|&label| std::cmp::Reverse(sizes[label]));
    let mut names = vec![0u16; sizes.len()];
    order.iter().zip(1..).for_each(|(&label, name)| names[label] = name);
    labels.iter_mut().for_each(|label| *label = names[usize::from(*label)]);
}

/// Stretches of rows with the same label.
fn runs(labels: &[u16], width: usize) -> Vec<LabelledRun> {
    let mut runs = Vec::new();
    for (v, row) in (0..).zip(labels.chunks(width)) {
        let mut u_first = 0;
        for stretch in row.chunk_by(|a, b| a == b) {
            let end = u_first + stretch.len() as u32;
            if stretch[0] > 0 {
                runs.push(LabelledRun { v, u_first, u_last: end - 1, label: stretch[0] });
            }
            u_first = end;
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_named_by_size_and_their_rows_are_cut_where_the_label_changes() {
        let mut labels = vec![9, 9, 4, 4, 4, 0, 7, 4];
        by_size(&mut labels);
        assert_eq!(labels, [2, 2, 1, 1, 1, 0, 3, 1]);
        let found: Vec<[u32; 4]> =
            runs(&labels, 4).iter().map(|run| [run.v, run.u_first, run.u_last, run.label.into()]).collect();
        assert_eq!(found, [[0, 0, 1, 2], [0, 2, 3, 1], [1, 0, 0, 1], [1, 2, 2, 3], [1, 3, 3, 1]]);
    }

    #[test]
    fn a_described_plane_is_the_one_in_the_map() {
        let width = 20;
        let value = |at: usize| 1000.0 + 3.0 * (at % width) as f32 - 2.0 * (at / width) as f32;
        let mut values: Vec<f32> = (0..width * 10).map(value).collect();
        values[3] = f32::NAN;
        let view = DepthView::new(&values, width, 10).unwrap();
        let pixels = Pixels::F32(values.clone());
        let frame = Frame {
            width,
            height: 10,
            pixels,
            missing: None,
            valid_range: None,
            sensor: depthplanes::Sensor::default(),
            format: "npy",
            encoding: "millimetre",
            warnings: Vec::new(),
        };
        let found = described(&frame, &view, vec![5; 200]);
        let fit = found.planes[0].fit.unwrap();
        assert_eq!((found.planes.len(), found.planes[0].pixel_count, found.labels[3]), (1, 199, 0));
        assert!((fit.gradient[0] - 3.0).abs() < 1e-9 && (fit.gradient[1] + 2.0).abs() < 1e-9, "{fit:?}");
    }
}
