//! Why a request has no answer: the text of the error of Rust.

use depthplanes_io::memory;
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

/// Whether memory can be had for work that uses `used` bytes at once and reserves `reserved`.
///
/// # Errors
/// With how much there is of it.
pub(crate) fn check_memory([used, reserved]: [u64; 2]) -> Result<()> {
    memory::check(used, reserved).map_err(|_| {
        let needed = used.max(reserved).div_ceil(1_000_000);
        InputError(format!(
            "{needed} MB of memory are needed; accepted: what fits into the 4294 MB of a WebAssembly module"
        ))
    })
}
