//! Medians by partial sorting, of numbers in single precision.

/// The median of numbers.
#[inline(always)]
pub(super) fn median(memory: &mut Vec<f32>, numbers: impl Iterator<Item = f32>) -> f64 {
    memory.clear();
    memory.extend(numbers);
    middle_of(memory)
}

/// The middle one of the sorted numbers, of which there is at least one.
#[inline(always)]
pub(super) fn middle_of(numbers: &mut [f32]) -> f64 {
    let at = numbers.len() / 2;
    (*numbers.select_nth_unstable_by(at, f32::total_cmp).1).into()
}

/// The bits of a number as an integer that sorts as [`f32::total_cmp`] does.
#[inline(always)]
fn order(number: f32) -> i32 {
    let bits = number.to_bits() as i32;
    bits ^ (((bits >> 31) as u32) >> 1) as i32
}

/// A pair as one integer that sorts by the first number ([`f32::total_cmp`]), then by the second.
#[inline(always)]
pub(super) fn pair_order(first: f32, second: f32) -> i64 {
    let [first, second] = [first, second].map(|number| i64::from(order(number)));
    (first << 32) + second
}
