//! Detectors and memory that threads share: each thread of Python takes what is idle, or makes its own.
//!
//! A detection that Python has done with comes back, so that later frames allocate nothing.

use crate::recipe::Recipe;
use depthplanes::{AnyView, Detection, Detector, Sensor};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Most detections that are kept for later frames: as many as a loop holds that looks back at the frame before, and some.
const MOST_SPARES: usize = 4;

/// Detectors of one recipe that are idle, and detections that nobody needs any more.
pub(crate) struct Pool {
    pub(crate) recipe: Recipe,
    idle: Mutex<Vec<Detector>>,
    spares: Mutex<Vec<Detection>>,
}

/// A detection that is on loan; its memory goes back when it is dropped.
pub(crate) struct Lent {
    pub(crate) detection: Detection,
    /// How long the reading and the detection took, seconds.
    pub(crate) seconds: f64,
    pub(crate) pool: Arc<Pool>,
}

impl Pool {
    pub(crate) fn new(recipe: Recipe) -> Self {
        Pool { recipe, idle: Mutex::default(), spares: Mutex::default() }
    }

    /// Finds the planes of a map, once its reading has said which of its pixels are valid.
    ///
    /// # Errors
    /// Those of the reading and of the detection.
    pub(crate) fn detect<'m>(
        self: &Arc<Self>,
        map: impl FnOnce() -> depthplanes::Result<AnyView<'m>>,
        sensor: Sensor,
    ) -> depthplanes::Result<Lent> {
        let idle = locked(&self.idle).pop();
        let mut detector = idle.unwrap_or_else(|| self.recipe.detector()).threads(self.recipe.threads());
        detector.set_sensor(sensor);
        let start = Instant::now();
        detector.detect(map()?)?;
        let seconds = start.elapsed().as_secs_f64();
        let spare = locked(&self.spares).pop().unwrap_or_default();
        let detection = detector.exchange(spare);
        locked(&self.idle).push(detector);
        Ok(Lent { detection, seconds, pool: self.clone() })
    }
}

impl Drop for Lent {
    fn drop(&mut self) {
        let mut spares = locked(&self.pool.spares);
        if spares.len() < MOST_SPARES {
            spares.push(std::mem::take(&mut self.detection));
        }
    }
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}
