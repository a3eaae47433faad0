//! Steps of surfaces without noise whose rows, or columns, have one value each: as a camera that stands level renders them.
//!
//! In: a map. Out: gaps between terraces, pixels beside each other that have one value. On such a surface values hardly
//! repeat anywhere else, whatever they are rounded to. Where a value goes on for two pixels or more and the next one does so
//! too, they are a step apart.

use super::knots::{BINS, ENOUGH, Knot, QUANTILE, bin, middle, sharpened};
use crate::map::{DepthView, Pixel};
use crate::noise::space::Space;
use crate::util::memory::reserve_to;

/// Rows, and columns, that are looked at.
const LINES: usize = 64;
/// Most gaps that are kept.
const MOST: usize = 1 << 13;
/// Fewest pixels of a terrace.
const WIDE: usize = 2;

/// The gap of q between two terraces, and q where it is.
#[derive(Clone, Copy, Debug)]
struct Gap {
    q: f64,
    size: f64,
}

/// Looks for terraces; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Terraces {
    gaps: Vec<Gap>,
    sizes: Vec<f64>,
}

impl Terraces {
    /// Makes room, so that a later map finds it.
    pub(super) fn reserve(&mut self) {
        reserve_to(&mut self.gaps, MOST);
        reserve_to(&mut self.sizes, MOST);
    }

    /// The steps of a map over q, with their number; its values are multiples of `unit`.
    pub(super) fn knots<T: Pixel>(&mut self, map: &DepthView<'_, T>, space: Space, unit: f64) -> ([Knot; BINS], usize) {
        let Terraces { gaps, sizes } = self;
        for v in (0..map.height()).step_by(map.height().div_ceil(LINES)) {
            walk(map.row(v).iter().copied(), map, space, gaps);
        }
        for u in (0..map.width()).step_by(map.width().div_ceil(LINES)) {
            walk((0..map.height()).map(|v| map.row(v)[u]), map, space, gaps);
        }
        gaps.sort_unstable_by(|a, b| a.q.total_cmp(&b.q));
        let (mut knots, mut count) = ([Knot::default(); BINS], 0);
        let mut rest = &gaps[..];
        while rest.len() >= ENOUGH && count < BINS {
            let ends = |at: &usize| bin(rest[*at].q as f32) != bin(rest[*at - 1].q as f32);
            let end = (ENOUGH..rest.len()).find(ends).filter(|end| rest.len() - end >= ENOUGH).unwrap_or(rest.len());
            let stretch = &rest[..end];
            rest = &rest[end..];
            sizes.clear();
            sizes.extend(stretch.iter().map(|gap| gap.size));
            let low = *sizes.select_nth_unstable_by((QUANTILE * end as f64) as usize, f64::total_cmp).1;
            let [first, last] = [stretch[0].q, stretch[end - 1].q].map(|q| bin(q as f32));
            let q = middle(first.midpoint(last));
            knots[count] = Knot { q, step: sharpened(sizes, low, unit * space.unit(q), true) };
            count += 1;
        }
        (knots, count)
    }
}

/// Adds the gaps between terraces along a line.
fn walk<T: Pixel>(line: impl Iterator<Item = T>, map: &DepthView<'_, T>, space: Space, gaps: &mut Vec<Gap>) {
    let validity = map.validity();
    let q = |value: T| space.q(value.into()).abs();
    // The terrace before, and the run of equal pixels that may become one.
    let (mut before, mut run): (Option<T>, Option<(T, usize)>) = (None, None);
    for pixel in line.map(Some).chain([None]) {
        let pixel = pixel.filter(|&pixel| validity.holds(pixel));
        if let (Some((value, length)), Some(pixel)) = (run.as_mut(), pixel)
            && *value == pixel
        {
            *length += 1;
            continue;
        }
        let terrace = run.filter(|&(_, length)| length >= WIDE).map(|(value, _)| value);
        if let (Some(a), Some(b)) = (before, terrace)
            && gaps.len() < MOST
        {
            gaps.push(Gap { q: 0.5 * (q(a) + q(b)), size: (q(a) - q(b)).abs() });
        }
        before = terrace;
        run = pixel.map(|pixel| (pixel, 1));
    }
}
