//! One run at a time writes into the folder of a report.

use crate::failure::{Failure, Outcome, note};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::Path;

/// The file that is locked, within the folder. It stays; the lock goes with the process, however that ends.
const FILE: &str = ".lock";

/// Refuses what is there and no file: a pipe would be waited for without end.
///
/// # Errors
/// A pipe, a device or a folder of that name.
pub(super) fn refuse_no_file(path: &Path) -> Outcome {
    if path.exists() && !path.is_file() {
        let message = "no file, as a report's folder has it; take another folder, or move it away";
        return Err(Failure::request(format!("{}: {message}", path.display())));
    }
    Ok(())
}

/// A folder that is ours until this is dropped.
pub(super) struct Claim {
    _file: File,
}

impl Claim {
    /// Takes a folder.
    ///
    /// # Errors
    /// A folder that another run writes into, or a disk that refuses.
    pub(super) fn of(folder: &Path) -> Outcome<Self> {
        let path = folder.join(FILE);
        refuse_no_file(&path)?;
        let failed = |error| Failure::machine(format!("{}: {error}", path.display()));
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {
                let text = format!("{}\n", std::process::id());
                file.set_len(0)
                    .and_then(|()| file.rewind())
                    .and_then(|()| file.write_all(text.as_bytes()))
                    .map_err(failed)?;
            }
            Err(TryLockError::WouldBlock) => {
                let mut holder = String::new();
                let _ = file.read_to_string(&mut holder); // who it is only helps
                let who = match holder.trim().parse::<u32>() {
                    Ok(process) => format!("another run (process {process})"),
                    Err(_) => "another run".into(),
                };
                let message = format!("{who} writes into this folder; let it end, or give another --report");
                return Err(Failure::request(format!("{}: {message}", folder.display())));
            }
            Err(TryLockError::Error(error)) => note(&format!(
                "{}: cannot be locked ({error}); do not let two runs write into this folder at once",
                path.display()
            )),
        }
        Ok(Claim { _file: file })
    }
}
