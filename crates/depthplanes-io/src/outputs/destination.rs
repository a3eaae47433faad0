//! Where a path leads: to a file that is replaced, or to something that is written into.

use super::error::OutputError;
use std::fs::{self, FileType};
use std::io;
use std::path::{Path, PathBuf};

/// What stands at the end of a path.
pub(super) enum Destination {
    /// A file, there or not, at the end of all links: a link keeps pointing where it points.
    File(PathBuf),
    /// Something like `/dev/null` or a pipe: written into, never replaced.
    Stream,
}

/// More links than this lead in a circle; Linux gives up there as well.
const MOST_LINKS: usize = 40;

/// Names of what the process has open: a file behind one of them is another's, and is not replaced.
const OPEN: [&str; 5] = ["/dev/fd", "/dev/stdin", "/dev/stdout", "/dev/stderr", "/proc"];

/// Follows a path.
///
/// # Errors
/// [`OutputError::Unwritable`] for disks and sockets; [`OutputError::Write`] for links in a circle.
pub(super) fn destination(path: &Path) -> Result<Destination, OutputError> {
    if let Ok(about) = fs::metadata(path) {
        let unwritable = |what| OutputError::Unwritable { path: path.to_path_buf(), what };
        match refused(about.file_type()) {
            Some(what) => return Err(unwritable(what)),
            None if about.is_dir() => return Ok(Destination::File(path.to_path_buf())),
            None if !about.is_file() || OPEN.iter().any(|open| path.starts_with(open)) => {
                return Ok(Destination::Stream);
            }
            None => (),
        }
    }
    let mut at = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&at) {
            Ok(next) => at = at.with_file_name(next),
            Err(_) => return Ok(Destination::File(at)),
        }
    }
    let source = io::Error::other("its links lead in a circle");
    Err(OutputError::Write { path: path.to_path_buf(), source })
}

/// The folder that a path's last part stands in.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Whether a path is something that is written into, such as `/dev/null` or a pipe.
pub(super) fn is_stream(path: &Path) -> bool {
    matches!(destination(path), Ok(Destination::Stream))
}

/// What is never written to.
#[cfg(unix)]
fn refused(kind: FileType) -> Option<&'static str> {
    use std::os::unix::fs::FileTypeExt;
    match kind {
        _ if kind.is_block_device() => Some("a disk"),
        _ if kind.is_socket() => Some("a socket"),
        _ => None,
    }
}

#[cfg(not(unix))]
fn refused(_: FileType) -> Option<&'static str> {
    None
}
