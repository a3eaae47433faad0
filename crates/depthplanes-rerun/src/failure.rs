//! What went wrong, and whose fault it is.

use std::fmt;

/// Why the program did not do all that was asked.
#[derive(Debug)]
pub(crate) struct Failure {
    /// 2 for a wrong request or input, 1 for the machine.
    pub(crate) exit_code: u8,
    message: String,
}

/// What a step returns.
pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// The request or an input is wrong.
    pub(crate) fn request(message: impl Into<String>) -> Self {
        Failure { exit_code: 2, message: message.into() }
    }

    /// The machine failed.
    pub(crate) fn machine(message: impl Into<String>) -> Self {
        Failure { exit_code: 1, message: message.into() }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl<E: Into<depthplanes_video::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        Failure::request(error.into().to_string())
    }
}
