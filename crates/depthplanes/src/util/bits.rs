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

/// Calls `visit` with the place of each byte that is 1; the others are 0.
#[inline(always)]
pub(crate) fn each_one(ones: [u8; 16], mut visit: impl FnMut(usize)) {
    let mut rest = u128::from_le_bytes(ones);
    while rest != 0 {
        visit(rest.trailing_zeros() as usize / 8);
        rest &= rest - 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

    #[test]
    fn bits_are_those_that_a_look_at_each_finds() {
        let mut random = Random::new(9);
        for share in [0.0, 0.02, 0.5, 1.0] {
            for _ in 0..50 {
                let row: Vec<bool> = (0..192).map(|_| random.uniform() < share).collect();
                let word = |row: &[bool]| row.iter().rev().fold(0u64, |word, &bit| word << 1 | u64::from(bit));
                let words: Vec<u64> = row.chunks(64).map(word).collect();
                let set: Vec<usize> = (0..64).filter(|&at| row[at]).collect();
                assert_eq!(bits(words[0]).collect::<Vec<_>>(), set);
                let (mut rest, mut seen) = (words[0], Vec::new());
                while let Some(up_to) = next_bit(&mut rest) {
                    assert!(up_to.wrapping_add(1).is_power_of_two() || up_to == u64::MAX);
                    seen.push(up_to.count_ones() as usize - 1);
                }
                assert_eq!(seen, set);
                let moved = |by: isize, w: usize| {
                    let at = |bit: usize| row.get((64 * w + bit).wrapping_add_signed(by)) == Some(&true);
                    (0..64).filter(|&bit| at(bit)).fold(0u64, |word, bit| word | 1 << bit)
                };
                for w in 0..3 {
                    assert_eq!([1, 2].map(|by| ahead(&words, w, by)), [1, 2].map(|by| moved(by as isize, w)));
                    assert_eq!(behind(&words, w), moved(-1, w));
                }
                let ones: [u8; 16] = std::array::from_fn(|at| u8::from(row[at]));
                let mut seen = Vec::new();
                each_one(ones, |at| seen.push(at));
                assert_eq!(seen, (0..16).filter(|&at| row[at]).collect::<Vec<_>>());
            }
        }
    }
}
