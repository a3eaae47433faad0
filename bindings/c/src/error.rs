//! Errors of the library on their way to C: a code by whose fault it is, and the text.

use std::any::Any;

/// What a call came to.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum dp_status {
    /// It did what it says.
    DP_OK = 0,
    /// A pointer is null that must not be.
    DP_NULL_POINTER = 1,
    /// A value that is not accepted: a size, a stride, a name, a number, a camera.
    DP_INVALID_ARGUMENT = 2,
    /// Metres are asked for, and the unit of the numbers or the camera is not known.
    DP_NOT_METRIC = 3,
    /// More planes than labels of 16 bits can name.
    DP_TOO_MANY_PLANES = 4,
    /// Memory that cannot be had.
    DP_OUT_OF_MEMORY = 5,
    /// A file that the system refuses.
    DP_FILE = 6,
    /// A fault of the library. The detector can be used further.
    DP_INTERNAL = 7,
}

use dp_status::{
    DP_FILE, DP_INTERNAL, DP_INVALID_ARGUMENT, DP_NOT_METRIC, DP_NULL_POINTER, DP_OUT_OF_MEMORY, DP_TOO_MANY_PLANES,
};

/// An error with its code.
#[derive(Debug)]
pub(crate) struct Error {
    pub(crate) status: dp_status,
    pub(crate) text: String,
}

/// `Result` with the crate's [`Error`].
pub(crate) type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// A value that is not accepted.
    pub(crate) fn invalid(text: impl Into<String>) -> Self {
        Error { status: DP_INVALID_ARGUMENT, text: text.into() }
    }

    /// An argument that is a null pointer.
    pub(crate) fn null(argument: &str) -> Self {
        Error { status: DP_NULL_POINTER, text: format!("`{argument}` is a null pointer") }
    }

    /// What a panic says.
    pub(crate) fn of_panic(panic: &(dyn Any + Send)) -> Self {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or(panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Error { status: DP_INTERNAL, text: format!("a fault of depthplanes, please report it: {said}") }
    }
}

impl From<depthplanes::Error> for Error {
    fn from(error: depthplanes::Error) -> Self {
        let status = match &error {
            depthplanes::Error::NotMetric { .. } => DP_NOT_METRIC,
            depthplanes::Error::TooManyPlanes { .. } => DP_TOO_MANY_PLANES,
            _ => DP_INVALID_ARGUMENT,
        };
        Error { status, text: error.to_string() }
    }
}

impl From<depthplanes_io::Error> for Error {
    fn from(error: depthplanes_io::Error) -> Self {
        let status = match error.kind() {
            depthplanes_io::Error::Io { .. } => DP_FILE,
            depthplanes_io::Error::Memory { .. } => DP_OUT_OF_MEMORY,
            depthplanes_io::Error::Library(error) => Error::from(error.clone()).status,
            _ => DP_INVALID_ARGUMENT,
        };
        Error { status, text: error.to_string() }
    }
}
