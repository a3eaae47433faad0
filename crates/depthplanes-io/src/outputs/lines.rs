//! Thin lines on a picture: the outlines of planes.
//!
//! In: rings of points in pixel coordinates. Out: lines of one pixel's width, smoothed by the share
//! of each pixel that they cover. A line between two pixels is half on either.

use super::picture::{Picture, blend};
use depthplanes::outline::{Outlines, Ring};

const INK: [u8; 3] = [255; 3];
/// The line's share where it covers a pixel.
const STRENGTH: f32 = 0.9;

/// How far from a line's middle its ink ends, pixels.
const REACH: f64 = 1.0;

/// Draws every ring of every plane.
pub(super) fn draw_outlines(picture: &mut Picture, outlines: &Outlines) {
    // Where lines meet the picture is covered once, not once for each.
    let mut cover = vec![0.0; picture.width * picture.height];
    for polygon in outlines.iter().flat_map(|outline| outline.polygons()) {
        add_ring(&mut cover, picture, &polygon.outer());
        polygon.holes().for_each(|hole| add_ring(&mut cover, picture, &hole));
    }
    for (pixel, &cover) in picture.pixels.iter_mut().zip(&cover) {
        if cover > 0.0 {
            *pixel = blend(*pixel, INK, STRENGTH * cover);
        }
    }
}

fn add_ring(cover: &mut [f32], picture: &Picture, ring: &Ring<'_>) {
    let mut last = ring.points_px().last();
    for point in ring.points_px() {
        if let Some(last) = last {
            add_line(cover, picture, last, point);
        }
        last = Some(point);
    }
}

fn add_line(cover: &mut [f32], picture: &Picture, a: [f64; 2], b: [f64; 2]) {
    let rows = pixels_near(a[1].min(b[1]), a[1].max(b[1]), picture.height);
    for v in rows {
        let y = v as f64;
        // The part of the line that can reach this row.
        let at = |y: f64| if a[1] == b[1] { 0.0 } else { ((y - a[1]) / (b[1] - a[1])).clamp(0.0, 1.0) };
        let (from, to) = if a[1] == b[1] { (0.0, 1.0) } else { (at(y - REACH), at(y + REACH)) };
        let [left, right] = [from, to].map(|t| a[0] + t * (b[0] - a[0]));
        for u in pixels_near(left.min(right), left.max(right), picture.width) {
            let share = (REACH - distance([u as f64, y], a, b)).clamp(0.0, 1.0) as f32;
            let pixel = &mut cover[v * picture.width + u];
            *pixel = pixel.max(share);
        }
    }
}

/// The pixels of a row or column that a line from `low` to `high` can reach.
fn pixels_near(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    let end = ((high + REACH).floor() + 1.0).clamp(0.0, count as f64);
    (low - REACH).ceil().clamp(0.0, end) as usize..end as usize
}

fn distance([u, v]: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (way, from) = ([b[0] - a[0], b[1] - a[1]], [u - a[0], v - a[1]]);
    let squared = way[0] * way[0] + way[1] * way[1];
    let t = ((from[0] * way[0] + from[1] * way[1]) / squared).clamp(0.0, 1.0);
    (from[0] - t * way[0]).hypot(from[1] - t * way[1])
}
