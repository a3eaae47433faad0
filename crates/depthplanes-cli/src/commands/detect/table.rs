//! One table of the planes of all inputs.

use crate::args::Detect;
use crate::failure::Outcome;
use crate::inputs::Input;
use crate::manifest::Manifest;
use depthplanes_io::outputs::{TableFile, TableForm};
use std::path::Path;

/// The table of all inputs, if it is wanted.
#[derive(Default)]
pub(super) struct Table<'a> {
    file: Option<(TableFile, &'a Path)>,
    planes: usize,
    inputs: usize,
}

impl<'a> Table<'a> {
    pub(super) fn begin(wanted: &'a Detect, form: Option<TableForm>) -> Outcome<Self> {
        let (Some(form), Some(path)) = (form, &wanted.table) else { return Ok(Table::default()) };
        Ok(Table { file: Some((form.begin(path)?, path)), ..Table::default() })
    }

    /// Adds the rows of an input, of so many planes.
    pub(super) fn add(&mut self, rows: &str, planes: usize) -> Outcome {
        if let Some((file, _)) = &mut self.file {
            file.add(rows)?;
            self.planes += planes;
            self.inputs += 1;
        }
        Ok(())
    }

    /// Adds all inputs that are done, by whichever run.
    pub(super) fn add_all(&mut self, inputs: &[Input], manifest: &Manifest) -> Outcome {
        if self.file.is_none() {
            return Ok(());
        }
        for input in inputs {
            if let Some((rows, planes)) = manifest.rows(input)? {
                self.add(&rows, planes)?;
            }
        }
        Ok(())
    }

    /// What is in it, in a line for people; nothing is written where no input was good.
    pub(super) fn finish(self) -> Outcome<Option<String>> {
        let Some((file, path)) = self.file.filter(|_| self.inputs > 0) else { return Ok(None) };
        file.finish()?;
        let plural = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        let (planes, inputs) = (plural(self.planes, "plane"), plural(self.inputs, "input"));
        Ok(Some(format!("wrote {}: {planes} of {inputs}", path.display())))
    }
}
