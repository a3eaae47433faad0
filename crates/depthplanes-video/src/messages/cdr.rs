//! CDR, as ROS 2 encodes messages: plain CDR of either version and byte order (OMG DDS-XTypes 1.3, section 7.4).

/// Fields one after the other, each aligned to its size.
pub(super) struct Cdr<'a> {
    /// Behind the four bytes that say the encoding: alignment counts from there.
    bytes: &'a [u8],
    at: usize,
    is_big_endian: bool,
    /// The widest alignment.
    widest: usize,
}

impl<'a> Cdr<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, String> {
        let (is_big_endian, widest) = match bytes.get(..4) {
            Some([0, 0, ..]) => (true, 8),
            Some([0, 1, ..]) => (false, 8),
            Some([0, 6, ..]) => (true, 4),
            Some([0, 7, ..]) => (false, 4),
            Some(other) => return Err(format!("an encoding {other:?} that is no plain CDR")),
            None => return Err(format!("a message of {} bytes", bytes.len())),
        };
        Ok(Cdr { bytes: &bytes[4..], at: 0, is_big_endian, widest })
    }

    fn take(&mut self, count: usize, align: usize) -> Result<&'a [u8], String> {
        let at = self.at.next_multiple_of(align.min(self.widest));
        let taken = at.checked_add(count).and_then(|end| self.bytes.get(at..end));
        let taken = taken
            .ok_or_else(|| format!("{count} bytes are needed, {} are left", self.bytes.len().saturating_sub(at)))?;
        self.at = at + count;
        Ok(taken)
    }

    fn number<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes: [u8; N] = self.take(N, N)?.try_into().expect("as many were taken");
        if self.is_big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    pub(super) fn u8(&mut self) -> Result<u8, String> {
        self.number().map(u8::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Result<u32, String> {
        self.number().map(u32::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Result<f64, String> {
        self.number().map(f64::from_le_bytes)
    }

    /// Numbers, of which there are so many.
    pub(super) fn f64s(&mut self, count: usize) -> Result<Vec<f64>, String> {
        (0..count).map(|_| self.f64()).collect()
    }

    /// Three numbers.
    pub(super) fn vector(&mut self) -> Result<[f64; 3], String> {
        Ok([self.f64()?, self.f64()?, self.f64()?])
    }

    pub(super) fn bytes(&mut self) -> Result<&'a [u8], String> {
        let count = self.u32()?;
        self.take(count as usize, 1)
    }

    /// Text, which ends with a 0.
    pub(super) fn text(&mut self) -> Result<String, String> {
        let bytes = self.bytes()?;
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        std::str::from_utf8(text).map(str::to_string).map_err(|_| "text that is no UTF-8".to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::Cdr;

    #[test]
    fn fields_are_aligned_to_their_size_in_both_byte_orders_and_versions() {
        // A byte, then a double, which version 1 aligns to 8 bytes and version 2 to 4; then text.
        for (kind, double) in [(0, 8), (1, 8), (6, 4), (7, 4)] {
            let is_big_endian = kind % 6 == 0;
            let [mut number, mut length] = [2.5f64.to_le_bytes().to_vec(), 3u32.to_le_bytes().to_vec()];
            if is_big_endian {
                number.reverse();
                length.reverse();
            }
            let mut bytes = vec![0, kind, 0, 0, 9];
            bytes.resize(4 + double, 0);
            bytes.extend([number, length, b"ab\0".to_vec()].concat());
            let mut cdr = Cdr::new(&bytes).unwrap();
            assert_eq!((cdr.u8(), cdr.f64(), cdr.text()), (Ok(9), Ok(2.5), Ok("ab".into())), "{kind}");
            assert_eq!(cdr.u8().unwrap_err(), "1 bytes are needed, 0 are left");
        }
        assert!(Cdr::new(&[0, 3, 0, 0]).is_err() && Cdr::new(&[0]).is_err());
    }
}
