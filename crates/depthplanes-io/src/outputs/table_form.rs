//! What a form of the table of many frames is; `table` lists them.

use super::error::OutputError;
use super::output::Report;
use super::staged::Staged;
use std::fmt::Debug;

/// A form of the table.
#[derive(Debug)]
pub(super) struct Form {
    pub(super) extension: &'static str,
    /// What a frame adds, as text.
    pub(super) rows: fn(&Report<'_>) -> String,
    pub(super) begin: fn(Staged) -> Result<Box<dyn Rows>, OutputError>,
}

/// A table that takes rows.
pub(super) trait Rows: Debug + Send {
    /// Takes what [`Form::rows`] made of a frame.
    fn add(&mut self, rows: &str) -> Result<(), OutputError>;

    /// The whole file.
    fn finish(self: Box<Self>) -> Result<Staged, OutputError>;
}
