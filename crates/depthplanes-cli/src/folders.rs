//! Folders for results: made if they are not there yet, refused if they are files.

use crate::failure::{Failure, Outcome};
use std::path::Path;

/// Makes a folder for results, if it is not there yet.
///
/// # Errors
/// A file of that name, or a disk that refuses.
pub(crate) fn make_folder(folder: &Path) -> Outcome {
    refuse_file(folder)?;
    let failed = |error| Failure::machine(format!("{}: the folder cannot be made: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(failed)
}

/// Refuses a file where a folder is needed.
///
/// # Errors
/// A file of that name.
pub(crate) fn refuse_file(folder: &Path) -> Outcome {
    // In this order, since another job may be making the folder right now.
    if folder.exists() && !folder.is_dir() {
        return Err(Failure::request(format!("{}: --out-dir needs a folder, this is a file", folder.display())));
    }
    Ok(())
}
