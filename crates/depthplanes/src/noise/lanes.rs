//! Numbers that are computed side by side.

/// How many are computed side by side: enough for the compiler to use vectors.
pub(super) const LANES: usize = 32;
/// One number in each lane.
pub(super) type Lanes = [f64; LANES];

/// Up to [`LANES`] numbers in lanes.
#[inline(always)]
pub(super) fn lanes(numbers: &[f32]) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes.iter_mut().zip(numbers).for_each(|(lane, &number)| *lane = number.into());
    lanes
}
