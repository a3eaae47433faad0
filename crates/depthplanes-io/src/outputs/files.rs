//! Files that are whole or not there at all: what is checked before, and how several are written together.

use super::destination::{Destination, destination, folder_of};
use super::error::OutputError;
use super::output::{Output, Report};
use super::staged::{Staged, hidden_files_of_this_process};
use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

/// Writes several outputs of one frame: all are encoded before the first is written, and all are on
/// the disk before the first takes its name.
///
/// # Errors
/// [`OutputError`]; then none of the files has changed, unless the disk fails in the last step.
pub fn write_all(report: &Report<'_>, wanted: &[(&Output, PathBuf)]) -> Result<(), OutputError> {
    let encode = |(output, path): &(&Output, PathBuf)| (output.writer(path)?.encode)(report);
    let encoded = wanted.iter().map(encode).collect::<Result<Vec<_>, _>>()?;
    let files: Vec<(&Path, &[u8])> =
        wanted.iter().zip(&encoded).map(|((_, path), bytes)| (path.as_path(), &bytes[..])).collect();
    write_together(&files)
}

/// Writes one file, whole or not at all. When this returns it is on the disk.
///
/// # Errors
/// [`OutputError::Write`]; [`OutputError::Unwritable`] for what is no file.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    write_together(&[(path, bytes)])
}

/// Writes several files, all or none.
pub(super) fn write_together(files: &[(&Path, &[u8])]) -> Result<(), OutputError> {
    let stage = |(path, bytes): &(&Path, &[u8])| {
        let mut staged = Staged::begin(path)?;
        staged.write(bytes)?;
        Ok(staged)
    };
    commit(files.iter().map(stage).collect::<Result<_, OutputError>>()?)
}

/// Gives files their names, when all of them are on the disk.
pub(super) fn commit(mut staged: Vec<Staged>) -> Result<(), OutputError> {
    staged.iter().try_for_each(Staged::sync)?;
    let folders: BTreeSet<PathBuf> = staged.iter().filter_map(Staged::folder).collect();
    let named = {
        let mut held = hidden_files_of_this_process();
        staged.iter_mut().try_for_each(|file| file.commit(&mut held))
    };
    named?;
    // The new names are on the disk when their folder is. Not every file system can do that, and the files are whole anyway.
    folders.iter().for_each(|folder| drop(fs::File::open(folder).and_then(|folder| folder.sync_all())));
    Ok(())
}

/// Refuses a path that is a folder, a disk or a socket, or whose folder does not exist.
///
/// # Errors
/// [`OutputError::IsFolder`], [`OutputError::NoFolder`], [`OutputError::Unwritable`].
pub fn check_folder(path: &Path) -> Result<(), OutputError> {
    let target = match destination(path)? {
        Destination::Stream => return Ok(()),
        Destination::File(target) => target,
    };
    if target.is_dir() {
        return Err(OutputError::IsFolder(path.to_path_buf()));
    }
    let folder = folder_of(&target);
    if !folder.is_dir() {
        return Err(OutputError::NoFolder { path: path.to_path_buf(), folder: folder.to_path_buf() });
    }
    Ok(())
}

/// Refuses outputs that would overwrite an input or each other. `inputs` and `outputs` are pairs of
/// a path and what to call it.
///
/// # Errors
/// [`OutputError::SamePath`].
pub fn check_paths(inputs: &[(PathBuf, String)], outputs: &[(PathBuf, String)]) -> Result<(), OutputError> {
    let mut taken: HashMap<PathBuf, &str> = HashMap::new();
    taken.extend(inputs.iter().map(|(path, name)| (identity(path), name.as_str())));
    for (path, name) in outputs {
        if matches!(destination(path), Ok(Destination::Stream)) {
            continue;
        }
        if let Some(first) = taken.insert(identity(path), name) {
            return Err(OutputError::SamePath { path: path.clone(), first: first.into(), second: name.clone() });
        }
    }
    Ok(())
}

/// The one path that all spellings and links of a file share.
fn identity(path: &Path) -> PathBuf {
    let Ok(Destination::File(target)) = destination(path) else { return path.to_path_buf() };
    fs::canonicalize(&target).unwrap_or_else(|_| match (fs::canonicalize(folder_of(&target)), target.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => target,
    })
}
