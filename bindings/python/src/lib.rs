//! What the Python package `depthplanes` asks of the library; its Python sources, in `python/depthplanes`, are the interface.
//!
//! Arrays go in and out without a copy where their rows lie in memory as maps do. Every call that takes time lets other
//! threads of Python run.

mod agreed;
mod array;
mod detector;
mod error;
mod found;
mod frame;
mod ground;
mod outlines;
mod pool;
mod reading;
mod recipe;
mod records;
mod tables;
mod tracker;
mod video;

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the program: the words of a command line, the name of the program first; the exit code.
#[pyfunction]
fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| depthplanes_cli::main(words))
}

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<detector::Detector>()?;
    module.add_class::<found::Found>()?;
    module.add_class::<frame::Frame>()?;
    module.add_class::<ground::GroundFinder>()?;
    module.add_class::<ground::Ground>()?;
    module.add_class::<outlines::Outlines>()?;
    module.add_class::<reading::Reading>()?;
    module.add_class::<tracker::Tracker>()?;
    module.add_class::<video::Video>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(recipe::forked, module)?)?;
    module.add_function(wrap_pyfunction!(records::noise, module)?)?;
    module.add_function(wrap_pyfunction!(records::score, module)?)?;
    module.add_function(wrap_pyfunction!(tables::colours, module)?)?;
    module.add_function(wrap_pyfunction!(tables::tables, module)?)?;
    Ok(())
}
