//! Pipes with a name: reading one waits for whoever writes into it, and a person is told so.

use crate::failure::note;
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// So long nothing is said.
const QUIET: Duration = Duration::from_secs(1);

/// Runs `read`, which reads this path. If that is a pipe (FIFO) and takes longer than a second, a note says what it waits for.
pub(crate) fn patiently<R>(path: &Path, read: impl FnOnce() -> R) -> R {
    if !is_pipe(path) {
        return read();
    }
    std::thread::scope(|scope| {
        let (done, waits) = channel::<()>();
        let name = path.display();
        let watch = move || {
            if waits.recv_timeout(QUIET) == Err(RecvTimeoutError::Timeout) {
                note(&format!("{name}: waiting: this is a pipe, and no program has written a whole file into it yet"));
            }
        };
        // Without a thread nothing is said.
        let _ = std::thread::Builder::new().spawn_scoped(scope, watch);
        let outcome = read();
        drop(done);
        outcome
    })
}

#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    std::fs::metadata(path).is_ok_and(|about| about.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_pipe(_: &Path) -> bool {
    false
}
