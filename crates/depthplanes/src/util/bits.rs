//! Sets as the bits of words, and as bytes of 0 and 1.

/// Clears the lowest set bit of `bits`; returns all bits up to and including it.
#[inline(always)]
pub(crate) fn next_bit(bits: &mut u64) -> Option<u64> {
    let up_to = *bits ^ bits.wrapping_sub(1);
    let any = *bits != 0;
    *bits &= bits.wrapping_sub(1);
    any.then_some(up_to)
}

/// The places of a word's bits.
#[inline(always)]
pub(crate) fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros() as usize;
        word &= word.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}

/// A word of a row's mask with every pixel moved `by` places to the left; 0 where there is no row.
#[inline(always)]
pub(crate) fn ahead(row: &[u64], word: usize, by: usize) -> u64 {
    let part = |word: usize| row.get(word).map_or(0, |&bits| u128::from(bits));
    ((part(word) | part(word + 1) << 64) >> by) as u64
}

/// A word of a row's mask with every pixel moved one place to the right.
#[inline(always)]
pub(crate) fn behind(row: &[u64], word: usize) -> u64 {
    let before = word.checked_sub(1).and_then(|word| row.get(word)).map_or(0, |before| before >> 63);
    row.get(word).map_or(0, |bits| bits << 1) | before
}
