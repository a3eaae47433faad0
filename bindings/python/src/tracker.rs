//! Planes that keep their identity from frame to frame.

use crate::error::Result;
use crate::found::Found;
use depthplanes::track::{self, CameraPose, KEPT_FRAMES};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, PoisonError};

/// Follows planes from frame to frame.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Tracker(Mutex<track::Tracker>);

/// Ids of the planes, a dictionary for each that is followed, and the label image.
type Tracked<'py> = (Vec<u32>, Vec<Bound<'py, PyDict>>, Bound<'py, PyArray2<u16>>);

#[pymethods]
impl Tracker {
    #[new]
    #[pyo3(signature = (kept_frames=KEPT_FRAMES))]
    fn new(kept_frames: u32) -> Self {
        Tracker(Mutex::new(track::Tracker::default().kept_frames(kept_frames)))
    }

    /// Takes in the next frame's planes: their ids, a dictionary for each plane that is followed, and the label image whose
    /// borders do not flicker.
    fn track<'py>(
        &self,
        py: Python<'py>,
        found: &Found,
        pose: Option<([[f64; 3]; 3], [f64; 3])>,
    ) -> Result<Tracked<'py>> {
        let pose = pose.map(|(rotation, translation_m)| CameraPose::new(rotation, translation_m)).transpose()?;
        let mut tracker = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (map, detection) = (found.frame(py)?.view()?, found.detection());
        let tracks = tracker.track_with_map(map, detection, &found.sensor, pose.as_ref())?;
        let planes = tracks.planes.iter().map(|plane| record(py, plane)).collect::<PyResult<Vec<_>>>()?;
        let labels = Array2::from_shape_vec((detection.height, detection.width), tracks.labels.clone());
        Ok((tracks.ids.clone(), planes, labels.expect("a label for each pixel").into_pyarray(py)))
    }
}

fn record<'py>(py: Python<'py>, plane: &track::TrackedPlane) -> PyResult<Bound<'py, PyDict>> {
    let record = PyDict::new(py);
    record.set_item("id", plane.id)?;
    record.set_item("state", plane.state.name())?;
    record.set_item("label", plane.label)?;
    record.set_item("age", plane.age)?;
    record.set_item("seen", plane.seen)?;
    record.set_item("unseen", plane.unseen)?;
    record.set_item("subsumed_by", plane.subsumed_by)?;
    record.set_item("split_from", plane.split_from)?;
    record.set_item("normal", plane.plane.map(|plane| plane.normal))?;
    record.set_item("distance", plane.plane.map(|plane| plane.distance))?;
    record.set_item("covariance", plane.plane.map(|_| plane.covariance))?;
    Ok(record)
}
