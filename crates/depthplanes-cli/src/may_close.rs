//! Standard output beside files: whoever reads it may stop, and the files are written nevertheless.

use std::io::{self, Write};

/// Standard output, or silence once nobody reads it.
pub(crate) struct MayClose<'a> {
    out: &'a mut dyn Write,
    is_closed: bool,
}

impl<'a> MayClose<'a> {
    pub(crate) fn new(out: &'a mut dyn Write) -> Self {
        MayClose { out, is_closed: false }
    }

    fn unless_closed<T>(&mut self, instead: T, act: impl FnOnce(&mut dyn Write) -> io::Result<T>) -> io::Result<T> {
        if self.is_closed {
            return Ok(instead);
        }
        match act(self.out) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                self.is_closed = true;
                Ok(instead)
            }
            done => done,
        }
    }
}

impl Write for MayClose<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.unless_closed(bytes.len(), |out| out.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.unless_closed((), |out| out.flush())
    }
}
