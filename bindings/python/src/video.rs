//! The frames of folders, data sets, recordings and synthetic cameras.

use crate::error::Result;
use crate::frame::Frame;
use crate::reading::Reading;
use depthplanes_video::{Source, SourceOptions, open};
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Frames, one after the other.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Video {
    source: Mutex<Box<dyn Source>>,
    frames: Option<u64>,
}

#[pymethods]
impl Video {
    #[new]
    fn new(py: Python<'_>, word: &str, reading: &Reading) -> Result<Self> {
        let options = SourceOptions::default().read(reading.options.clone());
        let source = py.detach(|| open(word, &options))?;
        let frames = source.frames();
        Ok(Video { source: Mutex::new(source), frames })
    }

    /// How many frames there are, if that is known.
    #[getter]
    fn frames(&self) -> Option<u64> {
        self.frames
    }

    /// The next frame; `None` at the end.
    fn next(&self, py: Python<'_>) -> Result<Option<Frame>> {
        let next = || self.source.lock().unwrap_or_else(PoisonError::into_inner).next_frame();
        Ok(py.detach(next).transpose()?.map(Frame::of_video))
    }
}
