//! What can be wrong with an output: the name asked for, what is known of the frame, the disk.

use std::path::PathBuf;

/// Why an output was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The name's extension belongs to no writer of this output.
    #[error("{}: `{output}` is written as {accepted}; end the name in one of them", path.display())]
    Extension {
        /// Name of the output.
        output: &'static str,
        /// The path asked for.
        path: PathBuf,
        /// The extensions accepted.
        accepted: String,
    },
    /// Metric output of a frame whose numbers or camera are not known.
    #[error("a point cloud needs {missing}")]
    NeedsCamera {
        /// What is not known, and how to give it.
        missing: &'static str,
    },
    /// Curved regions that were not looked for.
    #[error("curved regions were not looked for; ask the detector for them (--curved)")]
    NeedsCurved,
    /// Two files under one name.
    #[error("{}: {second} would overwrite {first}; give it another name", path.display())]
    SamePath {
        /// The path both have.
        path: PathBuf,
        /// What has the path.
        first: String,
        /// What was to be written there.
        second: String,
    },
    /// The path is a folder.
    #[error("{}: this is a folder, a file name is needed", .0.display())]
    IsFolder(PathBuf),
    /// The folder to write into does not exist.
    #[error("{}: the folder `{}` does not exist; make it first", path.display(), folder.display())]
    NoFolder {
        /// The path asked for.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// The path is something that is never written to.
    #[error("{}: this is {what}, a file name is needed", path.display())]
    Unwritable {
        /// The path asked for.
        path: PathBuf,
        /// What is there: a disk, a socket.
        what: &'static str,
    },
    /// A detection of a map of another size.
    #[error("the map is {} x {} pixels, the detection is of one of {} x {}; give the map that was looked at", map[0], map[1], found[0], found[1])]
    Size {
        /// Columns and rows of the map.
        map: [usize; 2],
        /// Those of the detection.
        found: [usize; 2],
    },
    /// The frame itself is not a map.
    #[error(transparent)]
    Map(#[from] depthplanes::Error),
    /// The disk refused.
    #[error("{}: cannot be written: {source}; nothing was left there", path.display())]
    Write {
        /// The path asked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl OutputError {
    /// Whether the request was wrong, rather than the disk.
    pub fn is_usage(&self) -> bool {
        !matches!(self, OutputError::Write { .. })
    }
}
