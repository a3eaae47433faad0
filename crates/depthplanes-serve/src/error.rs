//! What can go wrong before the page is there.

/// The crate's one error type.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The library refused a parameter.
    #[error(transparent)]
    Library(#[from] depthplanes::Error),
    /// The operating system refused.
    #[error("{doing}: {source}")]
    Io {
        /// What was asked of it.
        doing: &'static str,
        /// What it said.
        source: std::io::Error,
    },
}

/// `Result` with the crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// Names what was asked of the system.
    pub(crate) fn io(doing: &'static str) -> impl FnOnce(std::io::Error) -> Error {
        move |source| Error::Io { doing, source }
    }
}
