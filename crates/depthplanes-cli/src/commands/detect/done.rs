//! What one input of `detect` came to.

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
