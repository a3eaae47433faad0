//! Why a request has no answer: the text of the error of Rust.

use std::error::Error;

/// What is wrong, in words.
#[derive(Debug)]
pub(crate) struct InputError(pub(crate) String);

/// `Result` with the crate's [`InputError`].
pub(crate) type Result<T> = std::result::Result<T, InputError>;

impl<E: Error> From<E> for InputError {
    fn from(error: E) -> Self {
        InputError(error.to_string())
    }
}
