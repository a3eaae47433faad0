//! A detector for the maps of one camera.

use crate::agreed::agreed;
use crate::array::{Borrowed, borrow, fingerprint};
use crate::error::{Error, Result};
use crate::found::{Found, Map};
use crate::frame::Frame;
use crate::pool::{Lent, Pool};
use crate::reading::Reading;
use crate::recipe::Recipe;
use depthplanes::AnyView;
use depthplanes_io::{Frame as Pixels, ReadOptions, Settled, SettledMaps, memory};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Finds planes in the maps of one camera.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Detector {
    options: Arc<ReadOptions>,
    pool: Arc<Pool>,
    known: Mutex<Known>,
}

/// What is known since the first maps.
#[derive(Default)]
struct Known {
    maps: SettledMaps,
    /// Bytes that there was memory for.
    memory: [u64; 2],
}

#[pymethods]
impl Detector {
    #[new]
    #[pyo3(signature = (reading, method, parameters, threads, curved, merge_coplanar))]
    fn new(
        reading: &Reading,
        method: &str,
        parameters: BTreeMap<String, f64>,
        threads: usize,
        curved: bool,
        merge_coplanar: Option<(f64, f64)>,
    ) -> Result<Self> {
        let recipe = Recipe::new(method, &parameters, threads, curved, merge_coplanar)?;
        let (options, pool) = (Arc::new(reading.options.clone()), Arc::new(Pool::new(recipe)));
        Ok(Detector { options, pool, known: Mutex::default() })
    }

    /// The planes of an array of two dimensions, and whether it is the first of its size and type.
    fn detect(&self, py: Python<'_>, array: &Bound<'_, PyAny>) -> Result<(Found, bool)> {
        let (array, map) = borrow(array)?;
        if let Some(view) = map.pixels().transpose()?
            && let Some(settled) = self.settled(&view)
        {
            let (lent, mark) = py.detach(|| {
                let lent = self.pool.detect(|| settled.view(view), settled.sensor())?;
                Ok::<_, depthplanes::Error>((lent, fingerprint(view)))
            })?;
            let map = Map::Array { array: array.unbind(), mark, options: self.options.clone() };
            return Ok((Found::new(lent, map, settled.sensor(), "array"), false));
        }
        self.detect_copied(py, map)
    }

    /// The planes of a map that was read, and knows what was stated then.
    fn detect_frame(&self, py: Python<'_>, frame: &Frame) -> Result<Found> {
        let (lent, map) = py.detach(|| {
            let map = agreed(&frame.frame, &self.options)?;
            Ok::<_, Error>((self.find(&map)?, map))
        })?;
        let sensor = map.sensor;
        Ok(Found::new(lent, Map::Frame(map), sensor, &frame.source))
    }

    /// Reads a file and finds its planes.
    fn detect_file(&self, py: Python<'_>, path: PathBuf) -> Result<Found> {
        let frame = py.detach(|| Frame::load(&path, &self.options))?;
        self.detect_frame(py, &frame)
    }

    /// Name of the method and the value of each of its parameters.
    fn parameters(&self) -> (&'static str, Vec<(&'static str, f64)>) {
        let Recipe { method, values, .. } = &self.pool.recipe;
        (method.name, method.params.iter().map(|param| param.name).zip(values.iter().copied()).collect())
    }
}

impl Detector {
    /// What is settled of maps like this one.
    fn settled(&self, map: &AnyView<'_>) -> Option<Arc<Settled>> {
        self.known().maps.of(map)
    }

    /// The planes of a map that is read as a file is: the first of its size and type, or one whose numbers are converted.
    fn detect_copied(&self, py: Python<'_>, map: Borrowed<'_>) -> Result<(Found, bool)> {
        let frame = Arc::new(map.frame(py, &self.options)?);
        let view = map.pixels().transpose()?;
        let lent = py.detach(|| self.find(&frame))?;
        let is_first = self.known().maps.add(&frame, view.as_ref(), &self.options);
        Ok((Found::new(lent, Map::Frame(frame.clone()), frame.sensor, "array"), is_first))
    }

    /// The planes of a frame, if there is memory for it.
    fn find(&self, frame: &Pixels) -> Result<Lent> {
        let needed = memory::of_detection(self.pool.recipe.method, frame.width, frame.height);
        if needed > self.known().memory {
            memory::check(needed[0], needed[1])?;
            let mut known = self.known();
            known.memory = known.memory.max(needed);
        }
        Ok(self.pool.detect(|| frame.view(), frame.sensor)?)
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
