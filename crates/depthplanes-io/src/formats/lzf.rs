//! LZF decompression (M. Lehmann's liblzf), as the Point Cloud Library uses it.

/// Unpacks to exactly `size` bytes; `None` if the data say otherwise. A byte unpacks to at most 88,
/// so nothing is allocated for a size that the data cannot reach.
pub(super) fn decompress(packed: &[u8], size: usize) -> Option<Vec<u8>> {
    if size > packed.len().checked_mul(88)? {
        return None;
    }
    let mut out: Vec<u8> = Vec::with_capacity(size);
    let mut bytes = packed.iter();
    while let Some(&control) = bytes.next() {
        let control = usize::from(control);
        if control < 32 {
            let rest = bytes.as_slice();
            let literal = rest.get(..control + 1)?;
            out.extend_from_slice(literal);
            bytes = rest[control + 1..].iter();
        } else {
            let mut length = control >> 5;
            if length == 7 {
                length += usize::from(*bytes.next()?);
            }
            let back = ((control & 31) << 8 | usize::from(*bytes.next()?)) + 1;
            let from = out.len().checked_sub(back)?;
            let length = length + 2;
            if length <= back {
                out.extend_from_within(from..from + length);
            } else {
                // The copied bytes overlap the ones being written.
                for at in from..from + length {
                    out.push(out[at]);
                }
            }
        }
        if out.len() > size {
            return None;
        }
    }
    (out.len() == size).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::decompress;

    #[test]
    fn literals_and_overlapping_references() {
        // "ab", then 5 bytes from 2 back.
        assert_eq!(decompress(&[1, b'a', b'b', 3 << 5, 1], 7).unwrap(), b"abababa");
        assert_eq!(decompress(&[1, b'a', b'b', 3 << 5, 1], 8), None);
        assert_eq!(decompress(&[1, b'a', b'b', 3 << 5, 9], 7), None);
        assert_eq!(decompress(&[5, b'a'], 6), None);
    }
}
