//! A file's bytes on their way to their name.
//!
//! Bytes go to a hidden file beside the target, which then takes the target's name in one step. Whatever fails, the
//! hidden file is removed and what stood there before stays. A run that is interrupted can remove its hidden files
//! ([`remove_unfinished`]); one that is killed leaves them, and the next run that writes the same target removes them.
//! The new file has the permissions of the one that it replaces.

use super::destination::{Destination, destination, folder_of};
use super::error::OutputError;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The hidden files of this process. Who holds it keeps files from appearing and from getting their names.
static HIDDEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

pub(super) fn hidden_files_of_this_process() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    HIDDEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// For a process that is about to end because it was interrupted: removes the files that are not finished. Files of one
/// frame that are just getting their names all get them first. Nothing can be written after it: who tries waits for ever.
pub fn remove_unfinished() {
    let hidden = hidden_files_of_this_process();
    hidden.iter().for_each(|file| drop(fs::remove_file(file)));
    std::mem::forget(hidden); // stays locked
}

/// A file's bytes beside their target. Dropped before [`Staged::commit`], it leaves nothing.
#[derive(Debug)]
pub(super) struct Staged {
    /// What is written into; a hidden file is locked while it is open.
    file: File,
    /// The hidden file; none once it has its name, and for streams.
    hidden: Option<PathBuf>,
    target: PathBuf,
}

impl Staged {
    /// An empty file beside the target; the target itself, if it is a stream.
    pub(super) fn begin(path: &Path) -> Result<Self, OutputError> {
        let failed = |source| OutputError::Write { path: path.to_path_buf(), source };
        match destination(path)? {
            Destination::File(target) => {
                let (file, hidden) = create_beside(&target).map_err(failed)?;
                Ok(Staged { file, hidden: Some(hidden), target })
            }
            Destination::Stream => {
                let file = OpenOptions::new().write(true).truncate(true).open(path).map_err(failed)?;
                Ok(Staged { file, hidden: None, target: path.to_path_buf() })
            }
        }
    }

    /// The name that it will have.
    #[cfg(feature = "parquet")]
    pub(super) fn target(&self) -> &Path {
        &self.target
    }

    /// Adds bytes.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        self.file.write_all(bytes).map_err(|source| OutputError::Write { path: self.target.clone(), source })
    }

    /// Waits until the bytes are on the disk.
    pub(super) fn sync(&self) -> Result<(), OutputError> {
        if self.hidden.is_none() {
            return Ok(());
        }
        match self.file.sync_all() {
            // A file system that has no disk behind it.
            Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
            synced => synced.map_err(|source| OutputError::Write { path: self.target.clone(), source }),
        }
    }

    /// The folder that a new name comes into.
    pub(super) fn folder(&self) -> Option<PathBuf> {
        self.hidden.as_ref().map(|_| folder_of(&self.target).to_path_buf())
    }

    /// Gives the file its name, while the hidden files of this process are held.
    pub(super) fn commit(&mut self, held: &mut BTreeSet<PathBuf>) -> Result<(), OutputError> {
        if let Some(hidden) = &self.hidden {
            let failed = |source| OutputError::Write { path: self.target.clone(), source };
            fs::rename(hidden, &self.target).map_err(failed)?;
            held.remove(hidden);
            self.hidden = None;
        }
        Ok(())
    }
}

impl Write for Staged {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        if let Some(hidden) = &self.hidden {
            // Nothing more can be done about a file that cannot be removed.
            let _ = fs::remove_file(hidden);
            hidden_files_of_this_process().remove(hidden);
        }
    }
}

/// A new hidden file in the target's folder, under a name that no other writer has.
fn create_beside(target: &Path) -> io::Result<(File, PathBuf)> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let prefix = hidden_prefix(target.file_name().ok_or(io::ErrorKind::InvalidInput)?);
    remove_stale(folder_of(target), &prefix);
    loop {
        let mut name = prefix.clone();
        name.push(format!("{}-{}{SUFFIX}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        let hidden = target.with_file_name(name);
        let mut held = hidden_files_of_this_process();
        let file = match create_like(target, &hidden) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            created => created?,
        };
        held.insert(hidden.clone());
        drop(held);
        // Another run may have taken it for one that was left, before the lock: then it is gone, or about to be. File
        // systems without locks have to do without.
        let is_ours = !matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        if is_ours && hidden.exists() {
            return Ok((file, hidden));
        }
        hidden_files_of_this_process().remove(&hidden);
    }
}

/// A new file that may be read and written by those who may the target; where there is none, by the process's own rule (umask).
#[cfg(unix)]
fn create_like(target: &Path, hidden: &Path) -> io::Result<File> {
    use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};
    let about = fs::metadata(target).ok().filter(fs::Metadata::is_file);
    let Some(mode) = about.map(|about| about.permissions().mode() & 0o777) else {
        return OpenOptions::new().write(true).create_new(true).open(hidden);
    };
    // Never more than the target's, not even before the bytes are there; then all of them, whatever the umask.
    let file = OpenOptions::new().write(true).create_new(true).mode(mode).open(hidden)?;
    if file.metadata()?.permissions().mode() & 0o777 != mode {
        // Where there are no permissions (FAT) there are none to keep.
        let _ = file.set_permissions(fs::Permissions::from_mode(mode));
    }
    Ok(file)
}

#[cfg(not(unix))]
fn create_like(_: &Path, hidden: &Path) -> io::Result<File> {
    OpenOptions::new().write(true).create_new(true).open(hidden)
}

/// How names of hidden files end; before it stand the process and a number of its own.
const SUFFIX: &str = ".part";

/// A name of so many bytes stands in the hidden one as it is. File systems take 255.
const LONGEST: usize = 200;

/// What the hidden names of a target begin with: its name, shortened and with a checksum if it is long.
fn hidden_prefix(name: &OsStr) -> OsString {
    let mut prefix = OsString::from(".");
    if name.len() <= LONGEST {
        prefix.push(name);
    } else {
        let text = name.to_string_lossy();
        prefix.push(&text[..cut(&text, LONGEST - 40)]);
        prefix.push(format!("~{:016x}", fnv(name.as_encoded_bytes())));
    }
    prefix.push(".");
    prefix
}

/// The last place for a cut of a text that leaves `most` bytes at the most.
fn cut(text: &str, most: usize) -> usize {
    (0..=most.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

/// FNV-1a.
fn fnv(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Removes hidden files of this target that killed runs have left.
fn remove_stale(folder: &Path, prefix: &OsStr) {
    /// Hidden files by folder, as this run found them first.
    static LEFT: Mutex<BTreeMap<PathBuf, Vec<OsString>>> = Mutex::new(BTreeMap::new());
    let mut left = LEFT.lock().unwrap_or_else(PoisonError::into_inner);
    let left = left.entry(folder.to_path_buf()).or_insert_with(|| hidden_files(folder));
    left.retain(|name| {
        let rest = name.as_encoded_bytes().strip_prefix(prefix.as_encoded_bytes());
        match rest.and_then(owner) {
            Some(process) => {
                remove_if_left(&folder.join(name), process);
                false
            }
            None => true,
        }
    });
}

fn hidden_files(folder: &Path) -> Vec<OsString> {
    let is_hidden = |name: &OsString| {
        let name = name.as_encoded_bytes();
        name.starts_with(b".") && name.ends_with(SUFFIX.as_bytes())
    };
    let entries = folder.read_dir().into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name()).filter(is_hidden).collect()
}

/// The process by what follows the prefix: `PROCESS-NUMBER.part`.
fn owner(rest: &[u8]) -> Option<u32> {
    let numbers = std::str::from_utf8(rest).ok()?.strip_suffix(SUFFIX)?;
    let (process, number) = numbers.split_once('-')?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    if is_number(number) && is_number(process) { process.parse().ok() } else { None }
}

/// Removes a hidden file unless somebody writes it: its process lives, or it is locked.
fn remove_if_left(hidden: &Path, process: u32) {
    let lives = process != std::process::id() && Path::new("/proc").join(process.to_string()).exists();
    if lives || !fs::symlink_metadata(hidden).is_ok_and(|about| about.is_file()) {
        return;
    }
    let Ok(file) = OpenOptions::new().write(true).open(hidden) else { return };
    if file.try_lock().is_ok() {
        let _ = fs::remove_file(hidden); // if it cannot be removed it harms nobody
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_our_own_names_are_taken_for_ours() {
        let prefix = hidden_prefix(OsStr::new("l.png"));
        assert_eq!(prefix, ".l.png.");
        let owner = |name: &str| super::owner(name.as_bytes().strip_prefix(prefix.as_encoded_bytes())?);
        assert_eq!(owner(".l.png.12-3.part"), Some(12));
        for other in [".l.png.part", ".l.png.12.part", ".l.png.a-3.part", ".l.png.12-3.part~", ".l.png.2.12-3.part"] {
            assert_eq!(owner(other), None, "{other}");
        }
    }

    #[test]
    fn hidden_names_of_long_names_differ_and_are_short_enough() {
        let long = |last: &str| hidden_prefix(OsStr::new(&("ä".repeat(125) + last)));
        assert!(long("a").len() + 30 <= 255);
        assert_ne!(long("a"), long("b"));
    }
}
