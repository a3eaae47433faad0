//! The picture for people: the map in muted greys, planes over it in colour, a thin dark line where
//! labels change; with outlines these instead, in white.
//!
//! With a legend the picture grows to the right; without, it has exactly the map's size. The scene
//! itself is never covered, but for the small numbers that the legend refers to.

use super::colour::palette;
use super::picture::{Picture, blend};
use super::{Output, OutputError, Report, Writer, legend, lines, shade};
use depthplanes::Detection;

pub(super) const OUTPUT: Output = Output {
    name: "overlay",
    about: "picture: the map in grey, each plane in its colour",
    file: "overlay.png",
    needs_camera: false,
    writers: &[Writer { extension: "png", encode: |report| Ok(picture(report)?.png()) }],
};

/// Share of the plane's colour; the rest is the map's grey, so that relief stays visible.
const COLOUR_SHARE: f32 = 0.58;
/// How much an outline is darker than its plane.
const OUTLINE_SHARE: f32 = 0.5;

fn picture(report: &Report<'_>) -> Result<Picture, OutputError> {
    let detection = report.detection;
    let pixels = shade::greys(report.frame)?;
    let mut picture = Picture { width: detection.width, height: detection.height, pixels };
    tint_planes(&mut picture, detection, report.outlines.is_none());
    if let Some(outlines) = report.outlines {
        lines::draw_outlines(&mut picture, outlines);
    }
    if report.legend {
        legend::number_planes(&mut picture, detection);
        picture = legend::beside(&picture, detection);
    }
    Ok(picture)
}

fn tint_planes(picture: &mut Picture, detection: &Detection, borders: bool) {
    let palette = palette(detection.planes.len());
    for v in 0..detection.height {
        for u in 0..detection.width {
            let at = v * detection.width + u;
            let label = detection.labels[at];
            if label == 0 {
                continue;
            }
            let tinted = blend(picture.pixels[at], palette[usize::from(label)], COLOUR_SHARE);
            let outlined = borders && is_border(detection, u, v);
            picture.pixels[at] = if outlined { blend([0; 3], tinted, OUTLINE_SHARE) } else { tinted };
        }
    }
}

/// Whether the pixel to the left or above carries another label: one pixel of outline between two
/// planes, and one around a plane's left and upper side.
fn is_border(detection: &Detection, u: usize, v: usize) -> bool {
    let at = v * detection.width + u;
    let label = detection.labels[at];
    let differs = |other: usize| detection.labels[other] != label;
    let ends_right = u + 1 < detection.width && detection.labels[at + 1] == 0;
    let ends_below = v + 1 < detection.height && detection.labels[at + detection.width] == 0;
    (u > 0 && differs(at - 1)) || (v > 0 && differs(at - detection.width)) || ends_right || ends_below
}
