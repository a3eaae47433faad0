//! What can go wrong with a source of frames.

/// The crate's one error type.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A frame, or a file of it, could not be read.
    #[error(transparent)]
    Read(#[from] depthplanes_io::Error),
    /// The library refused a scene, a camera or a map.
    #[error(transparent)]
    Library(#[from] depthplanes::Error),
    /// The operating system refused.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// The source is not what it seems to be, or ends in the middle.
    #[error("{path}: {wrong}; accepted: {accepted}")]
    Source {
        /// The file or folder, and the line where there is one.
        path: String,
        /// What is wrong.
        wrong: String,
        /// What is accepted, and what to do.
        accepted: String,
    },
}

/// `Result` with the crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An [`Error::Source`].
    pub(crate) fn source(path: impl ToString, wrong: impl ToString, accepted: impl ToString) -> Error {
        Error::Source { path: path.to_string(), wrong: wrong.to_string(), accepted: accepted.to_string() }
    }

    /// An [`Error::Io`].
    pub(crate) fn io(path: &std::path::Path, source: std::io::Error) -> Error {
        Error::Io { path: path.display().to_string(), source }
    }
}

/// The beginning of a text from a file, for messages.
pub(crate) fn short(text: &str) -> String {
    const MOST: usize = 80;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_string(),
    }
}
