//! A trial, which is some maps by some methods, and its results, as figures and claims take them.

use super::super::datasets::Item;
use super::super::report::plots::Plot;
use super::super::report::strips;
use super::super::rows::Row;
use super::super::tasks::Entry;
use crate::failure::Outcome;
use std::path::Path;

/// The paper's own method.
pub(super) const NGAF: &str = "ngaf";
/// A plane has more pixels than this: the paper's four values, section 3d.
pub(super) const MINS: [u32; 4] = [32, 64, 128, 256];
/// That of them at which methods are compared. Our choice: the paper names none.
pub(super) const COMPARED: u32 = 64;

/// Maps, and what is run on them.
pub(super) struct Trial {
    /// Stands for the set in the rows.
    pub(super) name: &'static str,
    pub(super) items: Vec<Item>,
    pub(super) entries: Vec<Entry>,
}

/// What came of a trial.
pub(super) struct Results<'a> {
    pub(super) trial: &'a Trial,
    pub(super) rows: Vec<&'a Row>,
}

impl<'a> Results<'a> {
    /// Those of one method.
    pub(super) fn of(&self, method: &str) -> Vec<&'a Row> {
        self.rows.iter().copied().filter(|row| row.key.method == method).collect()
    }

    /// Those that methods are compared by.
    pub(super) fn compared(&self) -> Vec<&'a Row> {
        self.rows.iter().copied().filter(|row| is_compared(&row.key.label)).collect()
    }

    /// A strip for each map.
    pub(super) fn strips(&self, folder: &Path, rows: &[&Row], rest: Option<[u8; 3]>) -> Outcome<Vec<strips::Strip>> {
        strips::of_maps(folder, rows, self.trial.items.iter(), rest)
    }

    /// A plot with the trial's name in its caption.
    pub(super) fn plot(&self, plot: Option<Plot>) -> Option<Plot> {
        plot.map(|plot| plot.of(self.trial.name))
    }
}

/// What a method with a `min` is called in the report.
pub(super) fn label(method: &str, min: u32) -> String {
    format!("{method} min {min}")
}

pub(super) fn is_compared(label: &str) -> bool {
    label.ends_with(&format!(" min {COMPARED}"))
}
