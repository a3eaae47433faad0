//! What can go wrong on the way between bytes and frames, by whose fault it is: the machine, the
//! file, a limit, an option, or the library's own checks.
//!
//! Every message says what was given, what is accepted and, where there is one, the way out.

use std::io;

/// The crate's one error type.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: String,
        /// What the system said.
        source: io::Error,
    },
    /// The bytes are not what they claim to be, or not a depth map.
    #[error("not a readable {format}: {wrong}; accepted: {accepted}")]
    Unreadable {
        /// The format that the bytes claim.
        format: &'static str,
        /// What is wrong, with the numbers that disagree.
        wrong: String,
        /// What is accepted, and what to do.
        accepted: &'static str,
    },
    /// The input asks for more than the stated limit.
    #[error("{what} is {given}, the limit is {limit}")]
    Limit {
        /// The quantity.
        what: &'static str,
        /// What the input asks for.
        given: u64,
        /// The most that is allowed.
        limit: u64,
    },
    /// A pipe or a device that goes on where its map has ended.
    #[error(
        "by its header the map ends after {end} bytes, and more follow without an end; accepted: one map, as from `head -c {end}`"
    )]
    Endless {
        /// The bytes of the map.
        end: u64,
    },
    /// Memory that cannot be had.
    #[error("{} of {what} are needed and cannot be had; free some, or raise the limit of the process (ulimit -v)", megabytes(*bytes))]
    Memory {
        /// Memory, or address space.
        what: &'static str,
        /// How many bytes are needed at once.
        bytes: u64,
    },
    /// An option's value, or a combination of options.
    #[error("{option} is {}; accepted: {accepted}", quoted(given))]
    Parameter {
        /// The option's name.
        option: &'static str,
        /// The value given.
        given: String,
        /// What is accepted, and what to do.
        accepted: String,
    },
    /// The library refused the map or the camera.
    #[error(transparent)]
    Library(#[from] depthplanes::Error),
    /// Any of the above, and the file it happened in.
    #[error("{path}: {error}")]
    In {
        /// The file.
        path: String,
        /// What happened.
        error: Box<Error>,
    },
}

/// `Result` with the crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// The same error with the file's name in front; an error that names its file stays as it is.
    pub fn in_file(self, path: &str) -> Error {
        match self {
            Error::Io { .. } | Error::In { .. } => self,
            error => Error::In { path: path.to_string(), error: Box::new(error) },
        }
    }

    /// The same error of a file whose name was not known yet.
    pub(crate) fn named(self, path: &str) -> Error {
        match self {
            Error::Io { source, .. } => Error::Io { path: path.to_string(), source },
            error => error.in_file(path),
        }
    }

    /// The error without the file's name, to match on.
    pub fn kind(&self) -> &Error {
        match self {
            Error::In { error, .. } => error.kind(),
            error => error,
        }
    }

    /// An [`Error::Parameter`].
    pub fn parameter(option: &'static str, given: impl ToString, accepted: impl ToString) -> Error {
        Error::Parameter { option, given: given.to_string(), accepted: accepted.to_string() }
    }
}

/// A value as it was given, or the words that say what was.
fn quoted(given: &str) -> String {
    let is_said = ["not ", "for "].iter().any(|start| given.starts_with(start));
    if is_said { given.to_string() } else { format!("`{given}`") }
}

/// Bytes as people count them.
fn megabytes(bytes: u64) -> String {
    format!("{} MB", bytes.div_ceil(1_000_000))
}
