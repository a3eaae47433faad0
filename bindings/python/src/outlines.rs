//! Outlines of planes as arrays.

use depthplanes::outline::{Outline, Rectangle, Ring};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;

/// The outlines of the planes of a detection.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Outlines(pub(crate) depthplanes::outline::Outlines);

type Points<'py> = Bound<'py, PyArray2<f64>>;

/// Centre, two axes, two sides.
type Sides = (Vec<f64>, [Vec<f64>; 2], [f64; 2]);

#[pymethods]
impl Outlines {
    /// Outer ring and holes of each part of a plane; `None` if they are wanted in metres and not known so.
    fn polygons<'py>(&self, py: Python<'py>, label: u16, metric: bool) -> Option<Vec<(Points<'py>, Vec<Points<'py>>)>> {
        let outline = self.outline(label, metric)?;
        let points = |ring: &Ring<'_>| points(py, ring, metric);
        let parts =
            outline.polygons().map(|part| (points(&part.outer()), part.holes().map(|hole| points(&hole)).collect()));
        Some(parts.collect())
    }

    /// The convex hull of a plane.
    fn hull<'py>(&self, py: Python<'py>, label: u16, metric: bool) -> Option<Points<'py>> {
        Some(points(py, &self.outline(label, metric)?.hull(), metric))
    }

    /// The rectangle of least area around a plane.
    fn rectangle(&self, label: u16, metric: bool) -> Option<Sides> {
        let outline = self.outline(label, metric)?;
        if metric { outline.rectangle_m().map(sides) } else { Some(sides(outline.rectangle_px())) }
    }
}

impl Outlines {
    fn outline(&self, label: u16, metric: bool) -> Option<Outline<'_>> {
        self.0.get(label).filter(|outline| !metric || outline.is_metric())
    }
}

fn points<'py>(py: Python<'py>, ring: &Ring<'_>, metric: bool) -> Points<'py> {
    if metric { array(py, ring.points_m().into_iter().flatten()) } else { array(py, ring.points_px()) }
}

fn array<'py, const N: usize>(py: Python<'py>, points: impl Iterator<Item = [f64; N]>) -> Points<'py> {
    let numbers: Vec<f64> = points.flatten().collect();
    Array2::from_shape_vec((numbers.len() / N, N), numbers).expect("N numbers for each point").into_pyarray(py)
}

fn sides<const N: usize>(of: Rectangle<N>) -> Sides {
    (of.centre.to_vec(), of.axes.map(|axis| axis.to_vec()), of.sides)
}
