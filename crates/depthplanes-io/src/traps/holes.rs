//! What resizing does at the edges of holes.

use depthplanes::{DepthView, Pixel, ValueKind, with_view};

use super::picture::whole_range;
use super::probe::{Probe, is_small};
use crate::frame::Frame;

/// Edges of holes that say enough.
const EDGES: usize = 12;
/// Most that the pixel at the edge of a hole is of the next one, where values go up from 0 between the two.
const RISES: f64 = 0.8;
/// Least share of the edges with such values. Of resized maps all edges have them, of 200 recorded ones 0.04 at the most.
const SHARE: f64 = 0.8;
/// Least that the next pixel is of the median: where 0 is a measurement, values near it are.
const SURFACE: f64 = 0.1;

/// Values between 0 and the surface at the edges of holes, as resizing with interpolation makes them where 0 stands for nothing.
pub(super) fn interpolated(frame: &Frame, probe: &Probe) -> Option<String> {
    // Of grey levels, of relative depth and of disparity without a rig, 0 may be a value.
    let is_metric = matches!(frame.sensor.value_kind, ValueKind::Depth { .. } | ValueKind::InverseDepth { .. });
    if is_small(frame) || !is_metric || whole_range(frame, probe).is_some() {
        return None;
    }
    let least = SURFACE * probe.median()?;
    let [edges, rising] = with_view!(frame.view().ok()?, view => edges(view, least));
    (edges >= EDGES && rising as f64 > SHARE * edges as f64).then(|| {
        "values between 0 and the surface at the edges of holes: was the map resized with interpolation? Resize to the nearest \
         pixel, or give the map as it was before"
            .into()
    })
}

/// Edges of holes of 0 along rows and columns, and those at which values rise from 0.
fn edges<T: Pixel>(view: DepthView<'_, T>, least: f64) -> [usize; 2] {
    let mut found = [0; 2];
    let mut look = |three: [T; 3]| {
        if three[0].into() != 0.0 {
            return;
        }
        let [_, edge, next] = three.map(Into::<f64>::into);
        if edge > 0.0 && next >= least && next.is_finite() {
            found[0] += 1;
            found[1] += usize::from(edge < RISES * next);
        }
    };
    for v in 0..view.height() {
        for three in view.row(v).windows(3) {
            look([three[0], three[1], three[2]]);
            look([three[2], three[1], three[0]]);
        }
    }
    for v in 2..view.height() {
        let rows = [view.row(v - 2), view.row(v - 1), view.row(v)];
        for u in 0..view.width() {
            look([rows[0][u], rows[1][u], rows[2][u]]);
            look([rows[2][u], rows[1][u], rows[0][u]]);
        }
    }
    found
}
