//! One table of the planes of many frames, written frame by frame: CSV with a row for each plane, or JSON Lines with a
//! line for each frame.
//!
//! The file has its name only when it is finished; what stood there before stays until then.

use super::error::OutputError;
use super::files::commit;
use super::output::Report;
use super::planes;
use super::staged::Staged;
use std::path::Path;

/// A form of the table.
#[derive(Debug)]
struct Form {
    extension: &'static str,
    head: fn() -> String,
    rows: fn(&Report<'_>) -> String,
}

/// All forms.
const FORMS: &[Form] = &[
    Form { extension: "csv", head: planes::csv_head, rows: planes::csv_rows },
    Form { extension: "jsonl", head: String::new, rows: |report| planes::line(report) + "\n" },
];

/// The form of a table, by the name of its file.
#[derive(Clone, Copy, Debug)]
pub struct TableForm(&'static Form);

impl TableForm {
    /// The form for a path's extension, `.csv` or `.jsonl`.
    ///
    /// # Errors
    /// [`OutputError::Extension`] with the extensions there are.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        let given = path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default();
        let found = FORMS.iter().find(|form| form.extension == given);
        let dotted: Vec<String> = FORMS.iter().map(|form| format!(".{}", form.extension)).collect();
        found.map(TableForm).ok_or_else(|| OutputError::Extension {
            output: "table",
            path: path.to_path_buf(),
            accepted: dotted.join(" or "),
        })
    }

    /// What a frame adds to the table; empty in CSV if it has no planes.
    pub fn rows(&self, report: &Report<'_>) -> String {
        (self.0.rows)(report)
    }

    /// Begins the table, in a file of another name beside `path`.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn begin(&self, path: &Path) -> Result<TableFile, OutputError> {
        let mut file = Staged::begin(path)?;
        file.write((self.0.head)().as_bytes())?;
        Ok(TableFile(file))
    }
}

/// A table that is being written. Dropped before [`TableFile::finish`], it leaves nothing.
#[derive(Debug)]
pub struct TableFile(Staged);

impl TableFile {
    /// Adds the rows of a frame, as [`TableForm::rows`] makes them.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn add(&mut self, rows: &str) -> Result<(), OutputError> {
        self.0.write(rows.as_bytes())
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn finish(self) -> Result<(), OutputError> {
        commit(vec![self.0])
    }
}
