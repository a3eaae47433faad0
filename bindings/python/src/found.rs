//! What was found in a map, with the map.

use crate::array::{Borrowed, borrow, depth_m, fingerprint, lent};
use crate::error::{Error, Result};
use crate::outlines::Outlines;
use crate::pool::Lent;
use depthplanes::outline::Outliner;
use depthplanes::{Detection, Plane, Sensor};
use depthplanes_io::outputs::{self, OUTPUTS, Output, Report};
use depthplanes_io::{Frame as Pixels, ReadOptions, doubts};
use numpy::ndarray::{Array1, Array2, Array3};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// The map that was searched.
pub(crate) enum Map {
    /// Python's array, and what tells whether it was written to since.
    Array { array: Py<PyAny>, mark: u64, options: Arc<ReadOptions> },
    /// A map of our own.
    Frame(Arc<Pixels>),
}

/// What was found in a map.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Found {
    lent: Lent,
    map: Map,
    /// The whole result, if this is a selection of its planes.
    whole: Option<Py<Found>>,
    /// The map as a frame, once it was asked for.
    frame: OnceLock<Arc<Pixels>>,
    /// What a person should know of the result, once it was looked for, which takes as long as the detection.
    notes: OnceLock<Vec<String>>,
    pub(crate) sensor: Sensor,
    source: String,
}

impl Found {
    pub(crate) fn new(lent: Lent, map: Map, sensor: Sensor, source: &str) -> Self {
        let (frame, notes) = (OnceLock::new(), OnceLock::new());
        Found { lent, map, whole: None, frame, notes, sensor, source: source.to_string() }
    }

    pub(crate) fn detection(&self) -> &Detection {
        &self.lent.detection
    }

    /// The map as a frame, as files are read.
    ///
    /// # Errors
    /// [`Error::Input`] if the array was written to since.
    pub(crate) fn frame(&self, py: Python<'_>) -> Result<&Arc<Pixels>> {
        if let Some(frame) = self.frame.get() {
            return Ok(frame);
        }
        let frame = match &self.map {
            Map::Frame(frame) => frame.clone(),
            Map::Array { array, mark, options } => {
                let (_, map) = borrow(array.bind(py))?;
                unchanged(&map, *mark, self.detection())?;
                Arc::new(map.frame(py, options)?)
            }
        };
        Ok(self.frame.get_or_init(|| frame))
    }

    /// Rows of N numbers, NaN where a plane has none.
    fn column<'py, const N: usize>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Plane) -> Option<[f64; N]>,
    ) -> Bound<'py, PyArray2<f64>> {
        let planes = &self.detection().planes;
        let numbers: Vec<f64> = planes.iter().flat_map(|plane| of(plane).unwrap_or([f64::NAN; N])).collect();
        Array2::from_shape_vec((planes.len(), N), numbers).expect("a row for each plane").into_pyarray(py)
    }

    fn number<'py>(&self, py: Python<'py>, of: impl Fn(&Plane) -> Option<f64>) -> Bound<'py, PyArray1<f64>> {
        let planes = &self.detection().planes;
        Array1::from_iter(planes.iter().map(|plane| of(plane).unwrap_or(f64::NAN))).into_pyarray(py)
    }

    /// Does something with the report of it.
    fn report<T: Send>(
        &self,
        py: Python<'_>,
        source: Option<&str>,
        outlines: Option<(f64, usize)>,
        legend: bool,
        act: impl FnOnce(&Report<'_>) -> Result<T> + Send,
    ) -> Result<T> {
        let (frame, notes) = (self.frame(py)?, self.doubts(py)?);
        py.detach(|| {
            let outlines = outlines.map(|wanted| self.outlined(wanted)).transpose()?;
            let source = source.unwrap_or(&self.source);
            act(&Report { source, notes, legend, outlines: outlines.as_ref(), ..self.plain_report(frame) })
        })
    }

    /// What a person should know of the whole result.
    fn doubts(&self, py: Python<'_>) -> Result<&[String]> {
        if let Some(whole) = &self.whole {
            return whole.get().doubts(py);
        }
        let frame = self.frame(py)?;
        Ok(py.detach(|| self.notes.get_or_init(|| doubts(&self.plain_report(frame)))))
    }

    fn plain_report<'a>(&'a self, frame: &'a Pixels) -> Report<'a> {
        let recipe = &self.lent.pool.recipe;
        let report = Report::new(&self.source, frame, recipe.method, &recipe.values, self.detection());
        Report { coplanar: recipe.coplanar, ..report }
    }

    fn outlined(&self, (tolerance_px, min_hole_px): (f64, usize)) -> Result<depthplanes::outline::Outlines> {
        let mut outliner = Outliner::new(tolerance_px)?.min_hole_px(min_hole_px);
        Ok(outliner.outline_seen_by(self.detection(), &self.sensor)?.clone())
    }
}

impl Map {
    fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Map::Array { array, mark, options } => {
                Map::Array { array: array.clone_ref(py), mark: *mark, options: options.clone() }
            }
            Map::Frame(frame) => Map::Frame(frame.clone()),
        }
    }
}

/// The planes that `names` gives a new label, 0 for none, with their pixels.
fn selected(from: &Detection, names: &[u16]) -> Detection {
    let renamed = |plane: &Plane| {
        let label = names[usize::from(plane.label)];
        (label > 0).then(|| {
            let mut plane = plane.clone();
            plane.label = label;
            plane
        })
    };
    let mut found = from.clone();
    found.labels.iter_mut().for_each(|label| *label = names[usize::from(*label)]);
    found.planes = from.planes.iter().filter_map(renamed).collect();
    found.planes.sort_by_key(|plane| plane.label);
    found.parts.retain(|part| names[usize::from(part.of)] > 0);
    found.parts.iter_mut().for_each(|part| part.of = names[usize::from(part.of)]);
    found.parts.sort_by_key(|part| part.of);
    found
}

/// Refuses an array that was written to since its planes were found.
fn unchanged(map: &Borrowed<'_>, mark: u64, found: &Detection) -> Result<()> {
    let view = map.pixels().transpose()?;
    let is_same = view
        .is_some_and(|view| [view.width(), view.height()] == [found.width, found.height] && fingerprint(view) == mark);
    let text = "the array was written to since its planes were found, and this reads it again; accepted: an array that stays as \
         it is, such as a copy: detector(depth.copy())";
    if is_same { Ok(()) } else { Err(Error::Input(text.into())) }
}

/// The columns and the pixels of a picture of three channels.
fn base(picture: &PyReadonlyArray3<'_, u8>) -> (usize, Vec<[u8; 3]>) {
    let picture = picture.as_array();
    (picture.dim().1, picture.rows().into_iter().map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect())
}

/// The output of that name.
fn output(name: &str) -> Result<&'static Output> {
    OUTPUTS.iter().find(|output| output.name == name).ok_or_else(|| {
        let accepted = OUTPUTS.iter().map(|output| output.name).collect::<Vec<_>>().join(", ");
        depthplanes::Error::Unknown { what: "output", given: name.into(), accepted }.into()
    })
}

#[pymethods]
impl Found {
    fn __len__(&self) -> usize {
        self.detection().planes.len()
    }

    /// Those of the planes whose places are given, in that order, with labels 1, 2, ..; the others are no planes any more.
    fn select(whole: &Bound<'_, Self>, places: Vec<usize>) -> Result<Found> {
        let (py, of) = (whole.py(), whole.get());
        let from = of.detection();
        let mut names = vec![0u16; from.planes.len() + 1];
        for (&place, label) in places.iter().zip(1..) {
            let name = names.get_mut(place + 1).expect("Python looked up the places");
            if std::mem::replace(name, label) != 0 {
                return Err(Error::Input(format!("plane {place} is asked for twice; accepted: each plane once")));
            }
        }
        let (map, frame) = (of.map.clone_ref(py), of.frame.clone());
        let detection = py.detach(|| selected(from, &names));
        let lent = Lent { detection, seconds: of.lent.seconds, pool: of.lent.pool.clone() };
        let whole = Some(of.whole.as_ref().map_or_else(|| whole.clone().unbind(), |whole| whole.clone_ref(py)));
        Ok(Found { whole, frame, ..Found::new(lent, map, of.sensor, &of.source) })
    }

    /// Columns and rows of the map.
    #[getter]
    fn size(&self) -> (usize, usize) {
        (self.detection().width, self.detection().height)
    }

    /// How long the reading and the detection took, seconds.
    #[getter]
    fn seconds(&self) -> f64 {
        self.lent.seconds
    }

    /// Name of the method.
    #[getter]
    fn method(&self) -> &'static str {
        self.lent.pool.recipe.method.name
    }

    /// What the map is called.
    #[getter]
    fn source(&self) -> &str {
        &self.source
    }

    /// fx, fy, cx, cy in pixels, if the camera is known.
    #[getter]
    fn camera(&self) -> Option<(f64, f64, f64, f64)> {
        self.sensor.intrinsics.map(|camera| (camera.fx, camera.fy, camera.cx, camera.cy))
    }

    /// The label image, without a copy.
    fn labels<'py>(found: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let detection = found.get().detection();
        lent(found.as_any(), &detection.labels, [detection.height, detection.width])
    }

    /// The label image of curved surfaces, without a copy; `None` unless they were asked for.
    fn curved<'py>(found: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let detection = found.get().detection();
        let size = [detection.height, detection.width];
        detection.curved.as_ref().map(|curved| lent(found.as_any(), &curved.labels, size)).transpose()
    }

    fn normals<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.column(py, |plane| plane.normal())
    }

    fn distances<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.number(py, |plane| plane.distance_m())
    }

    fn areas<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.number(py, |plane| plane.metric?.area_m2)
    }

    fn rms<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.number(py, |plane| Some(plane.metric?.rms_m))
    }

    fn centroids<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.column(py, |plane| Some(plane.metric?.centroid_m))
    }

    fn centroids_px<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.column(py, |plane| Some(plane.centroid))
    }

    fn covariances<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<f64>> {
        let planes = &self.detection().planes;
        let of = |plane: &Plane| plane.metric.map_or([[f64::NAN; 4]; 4], |metric| metric.covariance);
        let numbers: Vec<f64> = planes.iter().flat_map(|plane| of(plane).into_iter().flatten()).collect();
        Array3::from_shape_vec((planes.len(), 4, 4), numbers).expect("16 numbers for each plane").into_pyarray(py)
    }

    /// Gradients along u and v, offset and rms of the fits in map units.
    fn fits<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.column(py, |plane| plane.fit.map(|fit| [fit.gradient[0], fit.gradient[1], fit.offset, fit.rms]))
    }

    fn pixel_counts<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        Array1::from_iter(self.detection().planes.iter().map(|plane| plane.pixel_count as i64)).into_pyarray(py)
    }

    /// Boxes of pixels: first column and row, and those behind the last.
    fn boxes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<i64>> {
        let of = |plane: &Plane| {
            let pixels = plane.bounding_box;
            [pixels.u_min, pixels.v_min, pixels.u_max + 1, pixels.v_max + 1].map(i64::from)
        };
        let planes = &self.detection().planes;
        let numbers = planes.iter().flat_map(of).collect();
        Array2::from_shape_vec((planes.len(), 4), numbers).expect("a row for each plane").into_pyarray(py)
    }

    /// Depth in metres at each pixel, NaN where there is none.
    fn depth_m<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArray2<f32>>> {
        depth_m(py, self.frame(py)?.view()?, &self.sensor)
    }

    /// x/z and y/z of the ray through each pixel, NaN where there is none; `None` without a camera.
    fn rays<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray3<f64>>> {
        let (width, height) = self.size();
        self.sensor.intrinsics?;
        let ray = |at: usize| {
            let ray = self.sensor.ray((at % width) as f64, (at / width) as f64);
            ray.map_or([f64::NAN; 2], |[x, y, _]| [x, y])
        };
        let numbers: Vec<f64> = py.detach(|| (0..width * height).flat_map(ray).collect());
        Some(Array3::from_shape_vec((height, width, 2), numbers).expect("two for each pixel").into_pyarray(py))
    }

    /// The outlines of the planes.
    fn outlines(&self, py: Python<'_>, tolerance_px: f64, min_hole_px: usize) -> Result<Outlines> {
        py.detach(|| Ok(Outlines(self.outlined((tolerance_px, min_hole_px))?)))
    }

    /// What a person should know of the map and of the result.
    fn notes(&self, py: Python<'_>) -> Result<Vec<String>> {
        self.report(py, None, None, false, |report| {
            Ok(report.frame.warnings.iter().chain(report.notes).cloned().collect())
        })
    }

    /// The bytes of an output, in the form of an extension.
    #[pyo3(signature = (name, extension, source=None, outlines=None, legend=false))]
    fn encode<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        extension: &str,
        source: Option<&str>,
        outlines: Option<(f64, usize)>,
        legend: bool,
    ) -> Result<Bound<'py, PyBytes>> {
        let writer = output(name)?.writer(&PathBuf::from(format!("planes.{extension}")))?;
        let bytes = self.report(py, source, outlines, legend, |report| Ok((writer.encode)(report)?))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes outputs by name, all or none.
    #[pyo3(signature = (files, source=None, outlines=None, legend=false))]
    fn write(
        &self,
        py: Python<'_>,
        files: Vec<(String, PathBuf)>,
        source: Option<&str>,
        outlines: Option<(f64, usize)>,
        legend: bool,
    ) -> Result<()> {
        let wanted = files.into_iter().map(|(name, path)| Ok((output(&name)?, path)));
        let wanted = wanted.collect::<Result<Vec<_>>>()?;
        for (output, path) in &wanted {
            output.writer(path)?;
            outputs::check_folder(path)?;
        }
        let named: Vec<_> = wanted.iter().map(|(output, path)| (path.clone(), output.name.to_string())).collect();
        outputs::check_paths(&[], &named)?;
        self.report(py, source, outlines, legend, |report| Ok(outputs::write_all(report, &wanted)?))
    }

    /// The picture of the map, or another one, (height, width, 3), with the planes in colour.
    fn overlay<'py>(
        &self,
        py: Python<'py>,
        picture: Option<PyReadonlyArray3<'py, u8>>,
    ) -> Result<Bound<'py, PyArray3<u8>>> {
        let ((width, height), frame) = (self.size(), self.frame(py)?);
        let picture = picture.map(|picture| base(&picture));
        let pixels = py.detach(|| {
            Ok::<_, Error>(outputs::overlay_pixels(frame.view()?, &self.sensor, self.detection(), picture)?)
        })?;
        let numbers = pixels.into_iter().flatten().collect();
        Ok(Array3::from_shape_vec((height, width, 3), numbers).expect("three for each pixel").into_pyarray(py))
    }

    /// Why a pixel has a plane or none, as JSON.
    fn explain(&self, py: Python<'_>, u: usize, v: usize) -> Result<String> {
        let (frame, recipe) = (self.frame(py)?, &self.lent.pool.recipe);
        py.detach(|| {
            let why = recipe.detector().sensor(frame.sensor).explain(frame.view()?, [u, v])?;
            Ok(outputs::explanation_record(&self.source, recipe.method, &recipe.values, &why).to_string())
        })
    }
}
