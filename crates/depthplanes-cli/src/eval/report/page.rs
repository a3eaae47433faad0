//! What stands on the page of a report, whatever form it is written in.

use super::plots::Plot;
use super::strips::Strip;
use super::table::Table;

/// What is in a report.
pub(super) struct Page<'a> {
    pub(super) title: &'a str,
    /// Where, when and how: a heading and a value each.
    pub(super) facts: Vec<[String; 2]>,
    pub(super) sections: &'a [Section],
    pub(super) refusals: Vec<String>,
}

/// A part of a report.
#[derive(Default)]
pub(in super::super) struct Section {
    pub(in super::super) title: String,
    /// What it is about, paragraphs with an empty line between; empty for nothing.
    pub(in super::super) text: String,
    pub(in super::super) tables: Vec<Table>,
    pub(in super::super) plots: Vec<Plot>,
    pub(in super::super) strips: Vec<Strip>,
}
