//! A map that was read from a file, made of a scene, or taken from a video.

use crate::array::{lent, map_array};
use crate::error::Result;
use crate::reading::Reading;
use depthplanes::ValueKind;
use depthplanes::scene::Spec;
use depthplanes::track::CameraPose;
use depthplanes_io::{Frame as Pixels, ReadOptions, memory};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A map with all that is known of it.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Frame {
    pub(crate) frame: Arc<Pixels>,
    #[pyo3(get)]
    pub(crate) source: String,
    /// Seconds, of frames of a video.
    #[pyo3(get)]
    time_s: Option<f64>,
    pub(crate) pose: Option<CameraPose>,
    /// The direction that is up, camera coordinates.
    #[pyo3(get)]
    up: Option<[f64; 3]>,
    /// The labels of what is really there; of scenes.
    truth: Option<Vec<u16>>,
}

impl Frame {
    pub(crate) fn new(frame: Pixels, source: String) -> Self {
        Frame { frame: Arc::new(frame), source, time_s: None, pose: None, up: None, truth: None }
    }

    /// A frame of a video.
    pub(crate) fn of_video(video: depthplanes_video::VideoFrame) -> Self {
        let (time_s, pose, up) = (video.time_s, video.pose, video.up);
        Frame { time_s, pose, up, ..Frame::new(video.frame, video.name) }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// Those of the readers; memory that cannot be had.
    pub(crate) fn load(path: &Path, options: &ReadOptions) -> Result<Self> {
        memory::check_of_file(path, options.decode.limits.max_bytes as u64)?;
        Ok(Frame::new(depthplanes_io::read(path, options)?, path.display().to_string()))
    }
}

#[pymethods]
impl Frame {
    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, reading: &Reading) -> Result<Self> {
        py.detach(|| Frame::load(&path, &reading.options))
    }

    /// Reads a file that is in memory.
    #[staticmethod]
    fn decode(py: Python<'_>, bytes: PyBackedBytes, name: String, reading: &Reading) -> Result<Self> {
        py.detach(|| {
            let needed = memory::of_reading(bytes.len() as u64);
            memory::check(needed, needed)?;
            Ok(Frame::new(depthplanes_io::decode(&bytes, &name, &reading.options)?, name))
        })
    }

    /// Makes a synthetic frame.
    #[staticmethod]
    fn scene(py: Python<'_>, spec: &str) -> Result<Self> {
        py.detach(|| {
            let scene = spec.parse::<Spec>()?.frame()?;
            let truth = Some(scene.measured_labels());
            Ok(Frame { truth, ..Frame::new(scene.into(), format!("scene:{spec}")) })
        })
    }

    /// The numbers of the map, shape (height, width), without a copy.
    #[getter]
    fn depth<'py>(frame: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        map_array(&frame.get().frame, frame.as_any())
    }

    /// The labels of what is really there, without a copy; `None` unless it is a scene.
    fn truth<'py>(frame: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let of = frame.get();
        let size = [of.frame.height, of.frame.width];
        of.truth.as_ref().map(|truth| lent(frame.as_any(), truth, size)).transpose()
    }

    /// Columns and rows.
    #[getter]
    fn size(&self) -> (usize, usize) {
        (self.frame.width, self.frame.height)
    }

    /// fx, fy, cx, cy in pixels, if the camera is known.
    #[getter]
    fn camera(&self) -> Option<(f64, f64, f64, f64)> {
        self.frame.sensor.intrinsics.map(|camera| (camera.fx, camera.fy, camera.cx, camera.cy))
    }

    /// Names of the format and of the encoding, and who said that it is this one.
    #[getter]
    fn encoding(&self) -> (&'static str, &'static str, &str) {
        (self.frame.format, self.frame.encoding, &self.frame.provenance.encoding)
    }

    /// Metres in a unit of the map; `None` unless its numbers are depths.
    #[getter]
    fn metres_per_unit(&self) -> Option<f64> {
        match self.frame.sensor.value_kind {
            ValueKind::Depth { metres } => Some(metres),
            _ => None,
        }
    }

    /// The value that means "missing" beside 0, NaN and the infinities.
    #[getter]
    fn missing(&self) -> Option<f64> {
        self.frame.missing
    }

    /// What a person should know of the map.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.frame.warnings.clone()
    }

    /// The camera's rotation, row by row, and its place in metres, camera to world; of videos.
    #[getter]
    fn pose(&self) -> Option<([[f64; 3]; 3], [f64; 3])> {
        self.pose.map(|pose| (pose.rotation(), pose.translation_m()))
    }

    /// Depth in metres at each pixel, row by row, NaN where there is none.
    fn depth_m<'py>(&self, py: Python<'py>) -> Result<Bound<'py, numpy::PyArray2<f32>>> {
        crate::array::depth_m(py, self.frame.view()?, &self.frame.sensor)
    }
}
