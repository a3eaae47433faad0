//! Planes that keep their identity from frame to frame.

use crate::error::Result;
use crate::found::Found;
use depthplanes::track::{self, CameraPose, KEPT_FRAMES};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, PoisonError};

/// Follows planes from frame to frame.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Tracker(Mutex<track::Tracker>);

#[pymethods]
impl Tracker {
    #[new]
    #[pyo3(signature = (kept_frames=KEPT_FRAMES))]
    fn new(kept_frames: u32) -> Self {
        Tracker(Mutex::new(track::Tracker::default().kept_frames(kept_frames)))
    }

    /// Takes in the next frame's planes: their ids, and a dictionary for each plane that is followed.
    fn track<'py>(
        &self,
        py: Python<'py>,
        found: &Found,
        pose: Option<([[f64; 3]; 3], [f64; 3])>,
    ) -> Result<(Vec<u32>, Vec<Bound<'py, PyDict>>)> {
        let pose = pose.map(|(rotation, translation_m)| CameraPose::new(rotation, translation_m)).transpose()?;
        let mut tracker = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let tracks = tracker.track(found.detection(), &found.sensor, pose.as_ref())?;
        let planes = tracks.planes.iter().map(|plane| record(py, plane)).collect::<PyResult<Vec<_>>>()?;
        Ok((tracks.ids.clone(), planes))
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
