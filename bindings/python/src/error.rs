//! Errors of the library as exceptions of Python, by whose fault it is, with the library's text in Python's words.

use depthplanes_io::outputs::OutputError;
use pyo3::prelude::*;
use std::io;

/// An error of the library, on its way to Python.
pub(crate) enum Error {
    /// A wrong value: `InputError`, a `ValueError`.
    Input(String),
    /// A wrong type or keyword: `InputTypeError`, a `TypeError`.
    Type(String),
    /// A file that the system refuses: `FileError`, an `OSError`.
    File(String, io::ErrorKind),
    /// Memory that cannot be had: `OutOfMemoryError`, a `MemoryError`.
    Memory(String),
    /// What Python itself raised.
    Python(PyErr),
}

/// `Result` with the crate's [`Error`].
pub(crate) type Result<T> = std::result::Result<T, Error>;

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        match error {
            Error::Input(text) => raised("InputError", text),
            Error::Type(text) => raised("InputTypeError", text),
            Error::File(text, io::ErrorKind::NotFound) => raised("MissingFileError", text),
            Error::File(text, _) => raised("FileError", text),
            Error::Memory(text) => raised("OutOfMemoryError", text),
            Error::Python(error) => error,
        }
    }
}

/// The exception of that name in the package, which speaks of keywords where the library speaks of flags.
fn raised(name: &str, text: String) -> PyErr {
    Python::attach(|py| {
        let made = || {
            let text = py.import("depthplanes._words")?.call_method1("in_python", (text,))?;
            py.import("depthplanes._errors")?.getattr(name)?.call1((text,))
        };
        made().map_or_else(|error| error, PyErr::from_value)
    })
}

impl From<PyErr> for Error {
    fn from(error: PyErr) -> Self {
        Error::Python(error)
    }
}

impl From<depthplanes::Error> for Error {
    fn from(error: depthplanes::Error) -> Self {
        match &error {
            depthplanes::Error::Unknown { what: "parameter", .. } => Error::Type(error.to_string()),
            _ => Error::Input(error.to_string()),
        }
    }
}

impl From<depthplanes_io::Error> for Error {
    fn from(error: depthplanes_io::Error) -> Self {
        let text = error.to_string();
        match error.kind() {
            depthplanes_io::Error::Io { source, .. } => Error::File(text, source.kind()),
            depthplanes_io::Error::Memory { .. } => Error::Memory(text),
            _ => Error::Input(text),
        }
    }
}

impl From<depthplanes_video::Error> for Error {
    fn from(error: depthplanes_video::Error) -> Self {
        match error {
            depthplanes_video::Error::Read(error) => error.into(),
            depthplanes_video::Error::Library(error) => error.into(),
            depthplanes_video::Error::Io { ref source, .. } => Error::File(error.to_string(), source.kind()),
            error => Error::Input(error.to_string()),
        }
    }
}

impl From<OutputError> for Error {
    fn from(error: OutputError) -> Self {
        let text = error.to_string();
        match error {
            OutputError::Write { source, .. } => Error::File(text, source.kind()),
            OutputError::NoFolder { .. } => Error::File(text, io::ErrorKind::NotFound),
            OutputError::IsFolder(_) | OutputError::Unwritable { .. } => Error::File(text, io::ErrorKind::Other),
            _ => Error::Input(text),
        }
    }
}
