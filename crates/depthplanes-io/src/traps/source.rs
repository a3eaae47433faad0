//! Maps with more pixels than measurements, which `planar` works on at the size at which they were measured.

use depthplanes::noise::{EnlargementFinder, SparseFinder};
use depthplanes::with_view;

use super::probe::{FEW, Probe};
use crate::frame::Frame;

/// Pixels that were repeated.
pub(super) fn enlarged(frame: &Frame, _: &Probe) -> Option<String> {
    let mut finder = EnlargementFinder::default();
    let found = with_view!(frame.view().ok()?, view => finder.find(&view))?;
    let ([x, y], width, height) = (found.factor, found.columns.len(), found.rows.len());
    Some(format!(
        "the map was enlarged {} x {} times by repeating pixels: planar works on the {width} x {height} pixels that it was made \
         from, other methods on all",
        rounded(x),
        rounded(y)
    ))
}

/// Few pixels that were measured.
pub(super) fn sparse(frame: &Frame, probe: &Probe) -> Option<String> {
    let mut finder = SparseFinder::default();
    let [x, y] = with_view!(frame.view().ok()?, view => finder.find(&view))?.side;
    let measured = 1.0 - probe.missing_share();
    (probe.valid.len() >= FEW).then(|| {
        format!(
            "one pixel of {} was measured ({:.0} %): planar works on bins of {x} x {y} pixels, other methods on single ones; areas \
             are those of the measured pixels",
            if measured < 0.4 { measured.recip().round() } else { rounded(measured.recip()) },
            100.0 * measured
        )
    })
}

/// A number with one decimal at most.
fn rounded(number: f64) -> f64 {
    (10.0 * number).round() / 10.0
}
