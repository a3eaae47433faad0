//! The results of a video on their way to their name: a hidden folder beside it, which takes the name in one step.
//!
//! A run that fails or is interrupted removes its hidden folders; one that is killed leaves them, and the next run on the same
//! video removes them.

use crate::failure::{Failure, Outcome};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The hidden folders of this process. Who holds it keeps folders from appearing and from getting their names.
static HIDDEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// For a process that is about to end because it was interrupted. No folder gets its name after it: who tries waits for ever.
pub(super) fn remove_all() {
    let hidden = HIDDEN.lock().unwrap_or_else(PoisonError::into_inner);
    hidden.iter().for_each(|folder| drop(fs::remove_dir_all(folder)));
    std::mem::forget(hidden); // stays locked
}

/// A folder without its name. Dropped before [`Unfinished::finish`], it leaves nothing.
pub(super) struct Unfinished {
    hidden: PathBuf,
    target: PathBuf,
    /// Locked as long as it is worked on.
    _lock: Option<File>,
}

impl Unfinished {
    /// An empty folder beside the target.
    ///
    /// # Errors
    /// Another run at work on it; what the machine says.
    pub(super) fn begin(target: &Path) -> Outcome<Self> {
        let hidden = beside(target, "partial");
        let failed = |error| Failure::machine(format!("{}: the folder cannot be made: {error}", target.display()));
        fs::create_dir_all(target.parent().unwrap_or(Path::new(""))).map_err(failed)?;
        let mut all = HIDDEN.lock().unwrap_or_else(PoisonError::into_inner);
        if lock(&hidden).is_err() {
            let message = "another run is at work on this video; wait for it, or take another --out-dir";
            return Err(Failure::request(format!("{}: {message}", target.display())));
        }
        // What a killed run has left.
        for left in [&hidden, &beside(target, "replaced")] {
            match fs::remove_dir_all(left) {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(failed(error)),
                _ => (),
            }
        }
        fs::create_dir(&hidden).map_err(failed)?;
        let lock = lock(&hidden).ok().flatten();
        all.insert(hidden.clone());
        Ok(Unfinished { hidden, target: target.into(), _lock: lock })
    }

    /// The folder while it is worked on.
    pub(super) fn folder(&self) -> &Path {
        &self.hidden
    }

    /// Waits until its files are on the disk.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn sync(&self) -> Outcome {
        let failed = |error| Failure::machine(format!("{}: {error}", self.target.display()));
        for entry in fs::read_dir(&self.hidden).map_err(failed)? {
            File::open(entry.map_err(failed)?.path()).and_then(|file| file.sync_all()).map_err(failed)?;
        }
        Ok(())
    }

    /// Takes the name from what has it, so that nobody takes old results for new ones.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn displace(&self) -> Outcome {
        if !self.target.exists() {
            return Ok(());
        }
        let failed = |error| Failure::machine(format!("{}: {error}", self.target.display()));
        fs::rename(&self.target, beside(&self.target, "replaced")).map_err(failed)
    }

    /// Gives the folder its name, which nothing has; what had it before goes.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn finish(self) -> Outcome {
        let failed = |error| Failure::machine(format!("{}: {error}", self.target.display()));
        let mut all = HIDDEN.lock().unwrap_or_else(PoisonError::into_inner);
        fs::rename(&self.hidden, &self.target).map_err(failed)?;
        all.remove(&self.hidden);
        drop(all);
        match fs::remove_dir_all(beside(&self.target, "replaced")) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(failed(error)),
            _ => Ok(()),
        }
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        let mut all = HIDDEN.lock().unwrap_or_else(PoisonError::into_inner);
        if all.remove(&self.hidden) {
            // Nothing more can be done about a folder that cannot be removed.
            let _ = fs::remove_dir_all(&self.hidden);
        }
    }
}

/// A hidden name beside a folder.
fn beside(target: &Path, what: &str) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(format!(".{what}"));
    target.with_file_name(name)
}

/// The lock of a folder; none where it is not there, or where folders have none.
fn lock(folder: &Path) -> Result<Option<File>, ()> {
    let Ok(file) = File::open(folder) else { return Ok(None) };
    match file.try_lock() {
        Err(fs::TryLockError::WouldBlock) => Err(()),
        Err(fs::TryLockError::Error(_)) => Ok(None),
        Ok(()) => Ok(Some(file)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_has_its_name_once_it_is_whole() {
        let root = std::env::temp_dir().join(format!("depthplanes_unfinished_{}", std::process::id()));
        let target = root.join("deep/video");
        drop(Unfinished::begin(&target).unwrap());
        assert_eq!(fs::read_dir(root.join("deep")).unwrap().count(), 0, "what is not finished leaves nothing");
        for text in ["first", "second"] {
            let unfinished = Unfinished::begin(&target).unwrap();
            fs::write(unfinished.folder().join(text), text).unwrap();
            assert!(!target.join(text).exists());
            assert!(Unfinished::begin(&target).is_err(), "two at once");
            unfinished.sync().unwrap();
            unfinished.displace().unwrap();
            assert!(!target.exists());
            unfinished.finish().unwrap();
            let names: Vec<_> = fs::read_dir(&target).unwrap().map(|entry| entry.unwrap().file_name()).collect();
            assert_eq!(names, [text], "what was there before is gone");
        }
        assert_eq!(fs::read_dir(root.join("deep")).unwrap().count(), 1);
        // As a killed run leaves it.
        fs::create_dir(root.join("deep/.video.partial")).unwrap();
        fs::write(root.join("deep/.video.partial/old"), "old").unwrap();
        let unfinished = Unfinished::begin(&target).unwrap();
        assert_eq!(fs::read_dir(unfinished.folder()).unwrap().count(), 0);
        drop(unfinished);
        fs::remove_dir_all(&root).unwrap();
    }
}
