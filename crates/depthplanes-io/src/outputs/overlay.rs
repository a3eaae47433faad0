//! The picture for people: the map in muted greys, planes over it in colour, a thin dark line where
//! labels change; with outlines these instead, in white.
//!
//! With a legend the picture grows to the right; without, it has exactly the map's size. The scene
//! itself is never covered, but for the small numbers that the legend refers to.

use super::colour::{COLOUR_SHARE, colour, id_colour, palette};
use super::error::OutputError;
use super::output::{Output, Report, Writer};
use super::picture::{Picture, blend};
use super::{legend, lines, shade};
use depthplanes::outline::Outlines;
use depthplanes::track::Tracks;
use depthplanes::{AnyView, Detection, Sensor};

pub(super) const OUTPUT: Output = Output {
    name: "overlay",
    about: "picture of the map in grey and each plane in its colour; with --curved, curved surfaces hatched",
    file: "overlay.png",
    needs_camera: false,
    needs_curved: false,
    writers: &[Writer { extension: "png", encode: |report| Ok(picture(report)?.png()) }],
};

/// How much an outline is darker than its plane.
const OUTLINE_SHARE: f32 = 0.5;

/// The picture of what was found in a map as the bytes of a PNG file: the map in grey, each plane in its colour, with white
/// outlines if they are given.
///
/// # Errors
/// [`OutputError::Size`] unless the detection is one of a map of that size.
///
/// ```
/// use depthplanes::{DepthView, Detector, Sensor};
/// use depthplanes_io::outputs::overlay_png;
/// let (depth_mm, sensor) = ([1000u16; 64 * 48], Sensor::default());
/// let map = DepthView::new(&depth_mm, 64, 48)?;
/// let mut detector = Detector::default().sensor(sensor);
/// let png = overlay_png(map, &sensor, detector.detect(map)?, None)?;
/// assert_eq!(&png[1..4], b"PNG");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn overlay_png<'m>(
    map: impl Into<AnyView<'m>>,
    sensor: &Sensor,
    found: &Detection,
    outlines: Option<&Outlines>,
) -> Result<Vec<u8>, OutputError> {
    let map = map.into();
    check_size([map.width(), map.height()], found)?;
    Ok(tinted(map, sensor, found, outlines).png())
}

/// The pixels of that picture without outlines, sRGB, row by row; over another picture than the map in grey if one is given.
///
/// # Errors
/// [`OutputError::Size`] unless map and picture are of the detection's size.
pub fn overlay_pixels<'m>(
    map: impl Into<AnyView<'m>>,
    sensor: &Sensor,
    found: &Detection,
    picture: Option<(usize, Vec<[u8; 3]>)>,
) -> Result<Vec<[u8; 3]>, OutputError> {
    let map = map.into();
    check_size([map.width(), map.height()], found)?;
    let (width, pixels) = picture.unwrap_or_else(|| (found.width, shade::greys(map, sensor.value_kind)));
    check_size([width, pixels.len().checked_div(width).unwrap_or(0)], found)?;
    Ok(over(Picture { width, height: found.height, pixels }, found, None).pixels)
}

fn check_size(map: [usize; 2], found: &Detection) -> Result<(), OutputError> {
    let found = [found.width, found.height];
    if map == found { Ok(()) } else { Err(OutputError::Size { map, found }) }
}

/// The overlay of a frame of a video: each plane in the colour of its id, and the ids of the largest ones on them. `tracks` are
/// those after the frame.
///
/// # Errors
/// [`OutputError::Size`] unless the detection is one of a map of that size.
///
/// # Panics
/// If the tracks have fewer ids than the detection has planes.
pub fn tracked_png<'m>(
    map: impl Into<AnyView<'m>>,
    sensor: &Sensor,
    found: &Detection,
    tracks: &Tracks,
) -> Result<Vec<u8>, OutputError> {
    let map = map.into();
    check_size([map.width(), map.height()], found)?;
    let pixels = shade::greys(map, sensor.value_kind);
    let mut picture = Picture { width: found.width, height: found.height, pixels };
    let palette: Vec<[u8; 3]> = [colour(0)].into_iter().chain(tracks.ids.iter().copied().map(id_colour)).collect();
    tint_planes(&mut picture, tracks.labels_of(found), &palette, true);
    legend::number_planes(&mut picture, found, |label| tracks.ids[usize::from(label) - 1].to_string());
    Ok(picture.png())
}

fn picture(report: &Report<'_>) -> Result<Picture, OutputError> {
    let Report { frame, detection, outlines, .. } = report;
    let mut picture = tinted(frame.view()?, &frame.sensor, detection, *outlines);
    if report.legend {
        legend::number_planes(&mut picture, detection, |label| label.to_string());
        picture = legend::beside(&picture, detection, frame.sensor.value_kind);
    }
    Ok(picture)
}

/// The map in grey and over it what was found.
fn tinted(map: AnyView<'_>, sensor: &Sensor, detection: &Detection, outlines: Option<&Outlines>) -> Picture {
    let pixels = shade::greys(map, sensor.value_kind);
    over(Picture { width: detection.width, height: detection.height, pixels }, detection, outlines)
}

/// A picture and over it what was found.
fn over(mut picture: Picture, detection: &Detection, outlines: Option<&Outlines>) -> Picture {
    tint_planes(&mut picture, &detection.labels, &palette(detection.planes.len()), outlines.is_none());
    if let Some(curved) = &detection.curved {
        hatch_curved(&mut picture, &curved.labels);
    }
    if let Some(outlines) = outlines {
        lines::draw_outlines(&mut picture, outlines);
    }
    picture
}

/// Columns and rows from one line of the hatching to the next.
const HATCH: usize = 6;
/// Share of the hatching's white.
const HATCH_SHARE: f32 = 0.6;

/// Slanting lines over the surfaces that bend, and a line around each.
fn hatch_curved(picture: &mut Picture, labels: &[u16]) {
    let width = picture.width;
    for (at, &label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
        let (u, v) = (at % width, at / width);
        let ends = |beside: Option<&u16>| beside.is_none_or(|&beside| beside != label);
        let is_edge = u == 0
            || u + 1 == width
            || ends(labels.get(at + 1))
            || ends(labels.get(at + width))
            || ends(at.checked_sub(1).map(|left| &labels[left]))
            || ends(at.checked_sub(width).map(|above| &labels[above]));
        if is_edge || (u + v) % HATCH == 0 {
            picture.pixels[at] = blend(picture.pixels[at], [255; 3], HATCH_SHARE);
        }
    }
}

/// `palette` has the colours of labels 0, 1, ..
fn tint_planes(picture: &mut Picture, labels: &[u16], palette: &[[u8; 3]], borders: bool) {
    for (at, &label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
        let tinted = blend(picture.pixels[at], palette[usize::from(label)], COLOUR_SHARE);
        let outlined = borders && is_border(labels, picture.width, at);
        picture.pixels[at] = if outlined { blend([0; 3], tinted, OUTLINE_SHARE) } else { tinted };
    }
}

/// Whether the pixel to the left or above carries another label: one pixel of outline between two
/// planes, and one around a plane's left and upper side.
fn is_border(labels: &[u16], width: usize, at: usize) -> bool {
    let u = at % width;
    let differs = |other: usize| labels[other] != labels[at];
    let ends = |other: usize| labels.get(other).is_some_and(|&label| label == 0);
    (u > 0 && differs(at - 1))
        || (at >= width && differs(at - width))
        || (u + 1 < width && ends(at + 1))
        || ends(at + width)
}
