//! Maps with more pixels than measurements, which `planar` works on at the size at which they were measured.

use depthplanes::noise::{EnlargementFinder, SparseFinder};
use depthplanes::{DepthView, Pixel, with_view};

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

/// Fewest repeated columns, and rows, that tell.
const REPEATED: usize = 8;

/// Some of the columns and rows that were repeated: an enlargement by less than 2, which `planar` does not undo.
pub(super) fn enlarged_a_little(frame: &Frame, _: &Probe) -> Option<String> {
    let [columns, rows] = with_view!(frame.view().ok()?, view => repeated(&view))?;
    let [x, y] =
        [(frame.width, columns), (frame.height, rows)].map(|(side, repeated)| side as f64 / (side - repeated) as f64);
    let rounded = |factor: f64| (100.0 * factor).round() / 100.0;
    Some(format!(
        "the map was enlarged {} x {} times by repeating some of its pixels, which makes steps of planes: give the map of {} x {} \
         pixels that it was made from, with its camera",
        rounded(x),
        rounded(y),
        frame.width - columns,
        frame.height - rows
    ))
}

/// How many columns and rows are those before them once more, if these are evenly spaced over the map.
fn repeated<T: Pixel>(view: &DepthView<'_, T>) -> Option<[usize; 2]> {
    let (width, height, validity) = (view.width(), view.height(), view.validity());
    let is_same = |a: T, b: T| a == b || !validity.holds(a) && !validity.holds(b);
    let mut columns = vec![true; width];
    columns[0] = false;
    for v in 0..height {
        let row = view.row(v);
        for (at, two) in (1..).zip(row.windows(2)) {
            columns[at] &= is_same(two[0], two[1]);
        }
        if v % 16 == 0 && columns.iter().filter(|same| **same).count() < REPEATED {
            return None;
        }
    }
    let is_row = |v: usize| v > 0 && view.row(v - 1).iter().zip(view.row(v)).all(|(&a, &b)| is_same(a, b));
    let rows: Vec<bool> = (0..height).map(is_row).collect();
    Some([evenly_spaced(&columns)?, evenly_spaced(&rows)?])
}

/// How many there are, if one follows another after as many or one more, two at least, from end to end.
fn evenly_spaced(marks: &[bool]) -> Option<usize> {
    let at: Vec<usize> = (0..marks.len()).filter(|&at| marks[at]).collect();
    let gaps = || at.windows(2).map(|two| two[1] - two[0]);
    let (least, most) = (gaps().min()?, gaps().max()?);
    let reaches_ends = at[0] <= most && marks.len() - at[at.len() - 1] <= most;
    (at.len() >= REPEATED && least >= 2 && most <= least + 1 && reaches_ends).then_some(at.len())
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
