//! What one input of `detect` came to.

use crate::manifest::{Counts, Entry};
use std::path::PathBuf;

/// What one input came to.
pub(super) struct Done {
    pub(super) text: String,
    pub(super) notes: Vec<String>,
    /// An output that goes to standard output; the text goes to standard error then.
    pub(super) bytes: Option<Vec<u8>>,
    /// What it adds to the table of all inputs.
    pub(super) rows: String,
    /// The files that were written.
    pub(super) written: Vec<PathBuf>,
    pub(super) planes: usize,
    /// What a camera would add; said once for many inputs.
    pub(super) hint: String,
}

impl Done {
    /// What the manifest says of it.
    pub(super) fn entry(&self) -> Entry<'_> {
        let counts = Counts { planes: self.planes, frames: None, failed_frames: None };
        Entry { counts, written: &self.written, rows: &self.rows }
    }
}
