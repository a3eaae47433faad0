//! The planes of a label image that somebody else made.
//!
//! In: a map and a label for each of its pixels. Out: a detection as a method would give it: records of the planes, fitted
//! to their pixels, under labels by decreasing size.

use crate::components::selection::LabelledRun;
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::lens::Lens;
use crate::map::{AnyView, DepthView, Pixel, with_view};
use crate::noise::stated_noise;
use crate::sensor::Sensor;
use crate::statistics::{PlaneStatistics, Seen};

/// Describes the planes of a label image, row by row, 0 = none. They get new labels, 1, 2, .. by decreasing number of
/// pixels; pixels of the map that are missing lose theirs. Beside the detection: for each of its planes the label that it
/// had.
///
/// # Errors
/// [`Error::Labels`] unless there is a label for each pixel, [`Error::Camera`] for a sensor whose numbers mean nothing.
///
/// ```
/// use depthplanes::{DepthView, Sensor, describe_labels};
/// let depth_mm: [u16; 8] = [1000, 1001, 1002, 2000, 1000, 1001, 1002, 0];
/// let labels = [3, 3, 3, 7, 3, 3, 3, 7];
/// let (found, names) = describe_labels(DepthView::new(&depth_mm, 4, 2)?, &labels, &Sensor::default())?;
/// assert_eq!(found.labels, [1, 1, 1, 2, 1, 1, 1, 0]);
/// assert_eq!(names, [3, 7]); // `found.planes[0]` had label 3
/// assert!((found.planes[0].fit.unwrap().gradient[0] - 1.0).abs() < 1e-9);
/// # Ok::<(), depthplanes::Error>(())
/// ```
pub fn describe_labels<'m>(
    map: impl Into<AnyView<'m>>,
    labels: &[u16],
    sensor: &Sensor,
) -> Result<(Detection, Vec<u16>)> {
    describe_view(map.into(), labels, sensor)
}

fn describe_view(map: AnyView<'_>, labels: &[u16], sensor: &Sensor) -> Result<(Detection, Vec<u16>)> {
    let pixels = map.width() * map.height();
    if labels.len() != pixels {
        return Err(Error::Labels { given: labels.len(), pixels });
    }
    sensor.check()?;
    if Lens::is_needed(sensor) {
        return through_lens(&map, labels, sensor);
    }
    Ok(with_view!(map, map => described(&map, labels.to_vec(), sensor)))
}

/// Pixels as they are in the map, metres by its pinhole picture.
fn through_lens(map: &AnyView<'_>, labels: &[u16], sensor: &Sensor) -> Result<(Detection, Vec<u16>)> {
    let plain = Sensor { intrinsics: None, distortion: None, ..*sensor };
    let (mut found, names) = with_view!(map, map => described(map, labels.to_vec(), &plain));
    let mut lens = Lens::default();
    let straight = lens.labels_of_picture(map, sensor, &found.labels)?;
    let describe =
        |picture: AnyView<'_>, sensor: Sensor, _: Option<&mut crate::coplanar::Joiner>, out: &mut Detection| {
            let (described, names) = with_view!(picture, picture => described(&picture, straight, &sensor));
            for (plane, &name) in described.planes.iter().zip(&names) {
                found.planes[usize::from(name) - 1].metric = plane.metric;
            }
            *out = described;
            Ok(())
        };
    lens.through(map, sensor, None, describe, &mut Detection::default())?;
    Ok((found, names))
}

fn described<T: Pixel>(map: &DepthView<'_, T>, mut labels: Vec<u16>, sensor: &Sensor) -> (Detection, Vec<u16>) {
    let validity = map.validity();
    let pixels = labels.iter_mut().zip(map.rows().flatten());
    pixels.filter(|(_, value)| !validity.holds(**value)).for_each(|(label, _)| *label = 0);
    let names = by_size(&mut labels);
    let (width, height, valid_pixels) = (map.width(), map.height(), map.valid_pixels());
    let runs = runs(&labels, width);
    let noise = stated_noise::<T>(sensor);
    let (mut statistics, mut planes) = (PlaneStatistics::default(), Vec::new());
    statistics.tally(map, &runs, 0, sensor, 1);
    let seen = Seen { sensor, noise: noise.as_ref(), valid_pixels };
    statistics.describe(map, &runs, &seen, 1, &mut planes);
    (Detection { width, height, labels, planes, valid_pixels, ..Detection::default() }, names)
}

/// Renames labels: 1, 2, .. by decreasing number of pixels. For each of these the name before.
fn by_size(labels: &mut [u16]) -> Vec<u16> {
    let mut sizes = vec![0usize; usize::from(u16::MAX) + 1];
    labels.iter().for_each(|&label| sizes[usize::from(label)] += 1);
    let mut order: Vec<u16> = (1..=u16::MAX).filter(|&label| sizes[usize::from(label)] > 0).collect();
    order.sort_by_key(|&label| std::cmp::Reverse(sizes[usize::from(label)]));
    let mut names = vec![0u16; sizes.len()];
    order.iter().zip(1..).for_each(|(&label, name)| names[usize::from(label)] = name);
    labels.iter_mut().for_each(|label| *label = names[usize::from(*label)]);
    order
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
        assert_eq!(by_size(&mut labels), [4, 9, 7]);
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
        let (found, names) = describe_labels(view, &[5; 200], &Sensor::default()).unwrap();
        assert_eq!(names, [5]);
        let fit = found.planes[0].fit.unwrap();
        assert_eq!((found.planes.len(), found.planes[0].pixel_count, found.labels[3]), (1, 199, 0));
        assert!((fit.gradient[0] - 3.0).abs() < 1e-9 && (fit.gradient[1] + 2.0).abs() < 1e-9, "{fit:?}");
        assert_eq!(
            describe_labels(view, &[5; 199], &Sensor::default()).unwrap_err(),
            Error::Labels { given: 199, pixels: 200 }
        );
    }
}
