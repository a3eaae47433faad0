//! Numbers that are computed at a time.

/// What is computed at a time: enough for the compiler to make vectors of it.
pub(super) const LANES: usize = 32;
/// One number of each.
pub(super) type Lanes = [f64; LANES];

/// Up to so many numbers.
#[inline(always)]
pub(super) fn lanes(numbers: &[f32]) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes.iter_mut().zip(numbers).for_each(|(lane, &number)| *lane = number.into());
    lanes
}
