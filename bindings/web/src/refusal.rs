//! Why a question has no answer: the text of the error of Rust.

use std::error::Error;

/// What is wrong, in words.
#[derive(Debug)]
pub(crate) struct Refusal(pub(crate) String);

/// `Result` with the crate's [`Refusal`].
pub(crate) type Result<T> = std::result::Result<T, Refusal>;

impl<E: Error> From<E> for Refusal {
    fn from(error: E) -> Self {
        Refusal(error.to_string())
    }
}
