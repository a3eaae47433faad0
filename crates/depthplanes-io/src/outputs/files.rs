//! Files that are whole or not there at all.
//!
//! Bytes go to a hidden file beside the target, which then takes the target's name in one step.
//! Whatever fails, the hidden file is removed and what stood there before stays.

use super::error::OutputError;
use super::output::{Output, Report};
use std::collections::HashMap;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes several outputs of one frame: all are encoded before the first is written, and all are on
/// the disk before the first takes its name.
///
/// # Errors
/// [`OutputError`]; then none of the files has changed, unless the disk fails in the last step.
pub fn write_all(report: &Report<'_>, wanted: &[(&Output, PathBuf)]) -> Result<(), OutputError> {
    let encode = |(output, path): &(&Output, PathBuf)| (output.writer(path)?.encode)(report);
    let encoded = wanted.iter().map(encode).collect::<Result<Vec<_>, _>>()?;
    let stage = |((_, path), bytes): (&(&Output, PathBuf), &Vec<u8>)| Staged::new(path, bytes);
    let staged = wanted.iter().zip(&encoded).map(stage).collect::<Result<Vec<_>, _>>()?;
    staged.into_iter().try_for_each(Staged::commit)
}

/// Writes one file, whole or not at all.
///
/// # Errors
/// [`OutputError::Write`].
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    Staged::new(path, bytes)?.commit()
}

/// Refuses a path that is a folder or whose folder does not exist.
///
/// # Errors
/// [`OutputError::IsFolder`], [`OutputError::NoFolder`].
pub fn check_folder(path: &Path) -> Result<(), OutputError> {
    if path.is_dir() {
        return Err(OutputError::IsFolder(path.to_path_buf()));
    }
    let folder = folder_of(path);
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
        if is_device(path) {
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
    fs::canonicalize(path).unwrap_or_else(|_| match (fs::canonicalize(folder_of(path)), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_path_buf(),
    })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Something like `/dev/null` or a pipe: written to directly, never replaced.
fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}

/// A file that grows beside its target and takes its name at the end. Dropped before [`Growing::commit`], it leaves
/// nothing.
#[derive(Debug)]
pub(super) struct Growing {
    staged: Staged,
    file: BufWriter<File>,
}

impl Growing {
    pub(super) fn new(path: &Path) -> Result<Self, OutputError> {
        let failed = |source| OutputError::Write { path: path.to_path_buf(), source };
        if is_device(path) {
            let file = OpenOptions::new().write(true).open(path).map_err(failed)?;
            let staged = Staged { temporary: None, target: path.to_path_buf() };
            return Ok(Growing { staged, file: BufWriter::new(file) });
        }
        let (staged, file) = Staged::begin(path)?;
        Ok(Growing { staged, file: BufWriter::new(file) })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        self.file.write_all(bytes).map_err(|source| OutputError::Write { path: self.staged.target.clone(), source })
    }

    pub(super) fn commit(mut self) -> Result<(), OutputError> {
        self.file.flush().map_err(|source| OutputError::Write { path: self.staged.target.clone(), source })?;
        self.staged.commit()
    }
}

/// A file's bytes, on the disk beside their target. Dropped before [`Staged::commit`], it leaves
/// nothing.
#[derive(Debug)]
struct Staged {
    temporary: Option<PathBuf>,
    target: PathBuf,
}

impl Staged {
    fn new(path: &Path, bytes: &[u8]) -> Result<Self, OutputError> {
        let failed = |source| OutputError::Write { path: path.to_path_buf(), source };
        if is_device(path) {
            fs::write(path, bytes).map_err(failed)?;
            return Ok(Staged { temporary: None, target: path.to_path_buf() });
        }
        let (staged, mut file) = Staged::begin(path)?;
        file.write_all(bytes).and_then(|()| file.flush()).map_err(failed)?;
        Ok(staged)
    }

    /// The empty file beside its target.
    fn begin(path: &Path) -> Result<(Self, File), OutputError> {
        // A link keeps pointing where it points: its target is what gets replaced.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        let created = create_beside(&target);
        let (file, temporary) = created.map_err(|source| OutputError::Write { path: path.to_path_buf(), source })?;
        Ok((Staged { temporary: Some(temporary), target }, file))
    }

    fn commit(mut self) -> Result<(), OutputError> {
        if let Some(temporary) = &self.temporary {
            let failed = |source| OutputError::Write { path: self.target.clone(), source };
            fs::rename(temporary, &self.target).map_err(failed)?;
            self.temporary = None;
        }
        Ok(())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            // Nothing more can be done about a file that cannot be removed.
            let _ = fs::remove_file(temporary);
        }
    }
}

/// A new hidden file in the target's folder, under a name that no other writer has.
fn create_beside(target: &Path) -> io::Result<(File, PathBuf)> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = target.file_name().ok_or(io::ErrorKind::InvalidInput)?;
    loop {
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        let temporary = target.with_file_name(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            opened => return opened.map(|file| (file, temporary)),
        }
    }
}
