//! One table of the planes of many frames, written frame by frame: CSV or Parquet with a row for each plane, or JSON Lines with
//! a line for each frame.
//!
//! The file has its name only when it is finished; what stood there before stays until then.

use super::error::OutputError;
use super::files::commit;
use super::output::Report;
#[cfg(feature = "parquet")]
use super::parquet;
use super::planes;
use super::staged::Staged;
use super::table_form::{Form, Rows};
use std::fmt::Debug;
use std::path::Path;

/// All forms.
const FORMS: &[Form] = &[
    Form {
        extension: "csv",
        rows: planes::csv_rows,
        begin: |mut file| {
            file.write(planes::csv_head().as_bytes())?;
            Ok(Box::new(file))
        },
    },
    Form { extension: "jsonl", rows: |report| planes::line(report) + "\n", begin: |file| Ok(Box::new(file)) },
    #[cfg(feature = "parquet")]
    parquet::FORM,
];

/// Text is the rows themselves.
impl Rows for Staged {
    fn add(&mut self, rows: &str) -> Result<(), OutputError> {
        self.write(rows.as_bytes())
    }

    fn finish(self: Box<Self>) -> Result<Staged, OutputError> {
        Ok(*self)
    }
}

/// The form of a table, by the name of its file.
#[derive(Clone, Copy, Debug)]
pub struct TableForm(&'static Form);

impl TableForm {
    /// The form for a path's extension: `.csv`, `.jsonl`, or `.parquet` with the feature `parquet`.
    ///
    /// # Errors
    /// [`OutputError::Extension`] with the extensions there are.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        let given = path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default();
        let found = FORMS.iter().find(|form| form.extension == given);
        found.map(TableForm).ok_or_else(|| OutputError::Extension {
            output: "table",
            path: path.to_path_buf(),
            accepted: Self::accepted(),
        })
    }

    /// The extensions that there are: `.csv or .jsonl`, with the feature `parquet` that of Parquet as well.
    pub fn extensions() -> String {
        FORMS.iter().map(|form| format!(".{}", form.extension)).collect::<Vec<_>>().join(" or ")
    }

    /// The extensions; a build without Parquet says so.
    fn accepted() -> String {
        let without = " (this build has no Parquet; the packages have it, and builds with `--features parquet`)";
        Self::extensions() + if cfg!(feature = "parquet") { "" } else { without }
    }

    /// The form's name: its extension.
    pub fn name(&self) -> &'static str {
        self.0.extension
    }

    /// What a frame adds to the table, as text; empty in tables of planes if it has none.
    pub fn rows(&self, report: &Report<'_>) -> String {
        (self.0.rows)(report)
    }

    /// Begins the table, in a file of another name beside `path`.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn begin(&self, path: &Path) -> Result<TableFile, OutputError> {
        Ok(TableFile((self.0.begin)(Staged::begin(path)?)?))
    }
}

/// A table that is being written. Dropped before [`TableFile::finish`], it leaves nothing.
#[derive(Debug)]
pub struct TableFile(Box<dyn Rows>);

impl TableFile {
    /// Adds the rows of a frame, as [`TableForm::rows`] makes them.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn add(&mut self, rows: &str) -> Result<(), OutputError> {
        self.0.add(rows)
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn finish(self) -> Result<(), OutputError> {
        commit(vec![self.0.finish()?])
    }
}
