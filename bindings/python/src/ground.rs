//! The floor, and what stands on it.

use crate::array::lent;
use crate::error::Result;
use crate::found::Found;
use depthplanes::ground::{self, GridMapper, Occupancy, Up};
use depthplanes_io::outputs;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Finds the ground in one result after the other.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct GroundFinder {
    finder: ground::GroundFinder,
    up: Up,
}

#[pymethods]
impl GroundFinder {
    #[new]
    fn new(up: Option<[f64; 3]>, camera_height: Option<f64>) -> Result<Self> {
        let up = up.map_or(Ok(Up::Estimated), Up::known)?;
        Ok(GroundFinder { finder: ground::GroundFinder::default().up(up).camera_height_m(camera_height)?, up })
    }

    /// The ground of what was found.
    fn find(&self, py: Python<'_>, found: Py<Found>) -> Result<Ground> {
        let (of, mut finder) = (found.get(), self.finder.clone());
        let frame = of.frame(py)?;
        let ground = py
            .detach(|| Ok::<_, crate::error::Error>(finder.find(frame.view()?, of.detection(), &of.sensor)?.clone()))?;
        Ok(Ground { ground, found, up: self.up })
    }
}

/// The ground of a frame.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Ground {
    ground: ground::Ground,
    found: Py<Found>,
    up: Up,
}

#[pymethods]
impl Ground {
    /// The record, JSON.
    fn record(&self, source: &str) -> String {
        outputs::ground_record(source, &self.ground, self.up).to_string()
    }

    /// What each pixel is, without a copy; `None` without a floor.
    fn marks<'py>(ground: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let of = ground.get();
        let found = of.found.get().detection();
        let marks = of.ground.floor.as_ref().map(|_| &of.ground.marks);
        marks.map(|marks| lent(ground.as_any(), marks, [found.height, found.width])).transpose()
    }

    /// The floor from above: cells (-1 unknown, 0 free, 100 occupied), rows along y and columns along x, and the place of the
    /// first cell's corner, metres.
    fn grid<'py>(&self, py: Python<'py>, resolution_m: f64) -> Result<(Bound<'py, PyArray2<i8>>, [f64; 2])> {
        let found = self.found.get();
        let frame = found.frame(py)?;
        let mut mapper = GridMapper::default().resolution_m(resolution_m)?;
        let grid = mapper.grid(frame.view()?, &found.sensor, &self.ground)?;
        let of = |cell: &Occupancy| match cell {
            Occupancy::Unknown => -1,
            Occupancy::Free => 0,
            Occupancy::Occupied => 100,
        };
        let cells = grid.cells.iter().map(of).collect();
        let cells = Array2::from_shape_vec((grid.height, grid.width), cells).expect("as many cells as the size says");
        Ok((cells.into_pyarray(py), grid.origin_m))
    }

    /// The picture of the ground, a PNG file.
    fn png<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyBytes>> {
        let found = self.found.get();
        let frame = found.frame(py)?;
        let png = outputs::ground_png(frame.view()?, &found.sensor, found.detection(), &self.ground)?;
        Ok(PyBytes::new(py, &png))
    }
}
