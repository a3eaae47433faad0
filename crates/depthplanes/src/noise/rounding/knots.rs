//! Steps that are known at some q, and the steps between them.

use super::sample::SHIFT;

/// Entries of a table over q: eight octaves of eight entries.
pub(super) const BINS: usize = 64;
/// Units in the last place by which a value may lie below an eighth of an octave and belong to it: single precision
/// puts 1/0.8 below 1.25.
const NEAR: u32 = 16;
/// Fewest gaps of a stretch.
pub(super) const ENOUGH: usize = 12;
/// The quantile of the gaps: fewer than a fifth of them are shorter than a step, next to values between the steps;
/// and a fifth of the gaps is one step long as long as a fifth of the values is seen.
pub(super) const QUANTILE: f64 = 0.2;

/// A step and where it was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Knot {
    /// The middle of its levels.
    pub(super) q: f64,
    pub(super) step: f64,
}

/// The eighth of an octave in which q lies, from 2^-127 on.
#[inline(always)]
pub(super) fn bin(q: f32) -> u32 {
    ((q.to_bits() & 0x7fff_ffff) + NEAR) >> SHIFT
}

/// The middle of an eighth of an octave.
pub(super) fn middle(bin: u32) -> f64 {
    let [low, high] = [bin, bin + 1].map(|bin| f64::from(f32::from_bits(bin << SHIFT)));
    (low * high).sqrt()
}

/// The mean of the gaps near `low`: steps of one and a half millimetres stored as whole ones are gaps of one and of
/// two. Gaps of two steps do not count, for a value may be missing between; and where many are missing, a gap of one
/// unit is taken as one unit.
pub(super) fn sharpened(gaps: &[f64], low: f64, unit: f64, is_dense: bool) -> f64 {
    if low <= 1.5 * unit && !is_dense {
        return unit;
    }
    let [from, to] = [(0.7 * low).min(low - 1.2 * unit), (1.4 * low).max(low + 1.2 * unit)];
    let near = gaps.iter().filter(|gap| (from..=to).contains(*gap));
    let (count, sum) = near.fold((0.0, 0.0), |(count, sum), gap| (count + 1.0, sum + gap));
    sum / count
}

/// The step at q, interpolated linearly between the middles of stretches; beyond the outermost it follows a power of q.
pub(super) fn between(knots: &[Knot], q: f64) -> f64 {
    let after = knots.partition_point(|knot| knot.q < q);
    let before = after.checked_sub(1).map(|before| knots[before]);
    match (before, knots.get(after)) {
        (Some(low), Some(high)) => low.step + (high.step - low.step) * (q - low.q) / (high.q - low.q),
        (None, Some(first)) => beyond(first, knots.get(1), q),
        (Some(last), None) => beyond(&last, after.checked_sub(2).map(|at| &knots[at]), q),
        (None, None) => 0.0,
    }
}

/// The step at q beyond the middle of the outermost stretch, by the power of q that leads to the step of the next
/// stretch: 0 as for disparity, 1, or 2 as for depth. It uses no logarithm, which differs between machines.
fn beyond(outermost: &Knot, next: Option<&Knot>, q: f64) -> f64 {
    let Some(next) = next.filter(|next| next.step > 0.0 && outermost.step > 0.0) else { return outermost.step };
    let [low, high] = if next.q < outermost.q { [next, outermost] } else { [outermost, next] };
    let (grown, by) = (high.step / low.step, high.q / low.q);
    let power = i32::from(grown * grown > by) + i32::from(grown * grown > by.powi(3));
    outermost.step * (q / outermost.q).powi(power)
}
