//! Bounds-checked reading of numbers from a byte slice, shared by the readers of this crate.

/// A position in a byte slice; every read is `None` past its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Cursor { bytes, at }
    }

    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let taken = self.bytes.get(self.at..self.at.checked_add(count)?)?;
        self.at += count;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn i32(&mut self) -> Option<i32> {
        self.array().map(i32::from_le_bytes)
    }
}

/// A line of text and the rest, split at the first `\n`; a `\r` before it is dropped. `None` if
/// there is no line end within `longest` bytes or the line is not text.
pub(super) fn line(bytes: &[u8], longest: usize) -> Option<(&str, &[u8])> {
    let end = bytes.iter().take(longest).position(|&byte| byte == b'\n')?;
    let text = std::str::from_utf8(&bytes[..end]).ok()?;
    Some((text.trim_end_matches('\r'), &bytes[end + 1..]))
}

/// Whitespace-separated words of a PNM-like header; `#` starts a comment that ends with its line.
/// Exactly one whitespace byte after the last word belongs to the header.
pub(super) fn header_words<const N: usize>(bytes: &[u8]) -> Option<([&str; N], &[u8])> {
    let mut words = [""; N];
    let mut at = 0;
    for word in &mut words {
        loop {
            match bytes.get(at)? {
                b'#' => at += bytes[at..].iter().position(|&byte| byte == b'\n')?,
                byte if byte.is_ascii_whitespace() => at += 1,
                _ => break,
            }
        }
        let length = bytes[at..].iter().take(64).position(|byte| byte.is_ascii_whitespace())?;
        *word = std::str::from_utf8(&bytes[at..at + length]).ok()?;
        at += length;
    }
    Some((words, &bytes[at + 1..]))
}
