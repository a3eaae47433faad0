//! How planes are looked for: words of JavaScript as a detector, with its memory.

use crate::error::{InputError, Result};
use crate::memory::check_of_detection;
use crate::options;
use crate::reading::{Words, take};
use depthplanes::methods::{self, MethodInfo};
use depthplanes::{Coplanar, Detection, Detector, Error};
use depthplanes_io::outputs::{Report, explanation_record};
use depthplanes_io::{Frame, doubts};
use serde_json::Value;

/// A detector of a method, and what it was made of.
pub(crate) struct Finder {
    words: Words,
    method: &'static MethodInfo,
    /// The value of each of its parameters.
    values: Vec<f64>,
    coplanar: Option<Coplanar>,
    detector: Detector,
    /// What it found last.
    pub(crate) found: Detection,
    /// Pixels of the largest map that it has seen.
    pixels: usize,
}

impl Finder {
    /// All words have to be about finding: `method`, `curved`, `merge_coplanar`, and parameters of the method, in which `_` is
    /// the same as `-`.
    ///
    /// # Errors
    /// An unknown method or parameter, a value that is not accepted.
    pub(crate) fn new(words: &Words) -> Result<Self> {
        let mut left = words.clone();
        let method = match take::<String>(&mut left, "method", "the name of a method")? {
            Some(name) => methods::find(&name)?,
            None => methods::default(),
        };
        let curved = take(&mut left, "curved", "true or false")?.unwrap_or(false);
        if curved && !method.tells_curved {
            let others = methods::METHODS.iter().filter(|method| method.tells_curved).map(|method| method.name);
            let accepted = others.collect::<Vec<_>>().join(", ");
            return Err(Error::NoCurved { method: method.name, accepted }.into());
        }
        let within = take::<(f64, f64)>(&mut left, "merge_coplanar", "[degrees, metres], numbers")?;
        let coplanar = within.map(|(angle_deg, distance_m)| Coplanar::new(angle_deg, distance_m)).transpose()?;
        let values = values(method, &left)?;
        let mut detector = Detector::new(method.of_values(&values)?)?.curved(curved);
        if let Some(within) = coplanar {
            detector = detector.merge_coplanar(within)?;
        }
        Ok(Finder { words: words.clone(), method, values, coplanar, detector, found: Detection::default(), pixels: 0 })
    }

    /// Whether it is the one for these words.
    pub(crate) fn is_for(&self, words: &Words) -> bool {
        self.words == *words
    }

    /// Finds the planes of a frame; `observer` is told the name of each stage as it ends.
    ///
    /// # Errors
    /// What the library says of the map; too little memory.
    pub(crate) fn find(&mut self, frame: &Frame, observer: &mut (dyn FnMut(&'static str) + Send)) -> Result<()> {
        if frame.width * frame.height > self.pixels {
            check_of_detection(self.method, frame.width, frame.height)?;
            *self = Finder::new(&self.words)?; // the memory for smaller maps is given back
            self.pixels = frame.width * frame.height;
        }
        self.detector.set_sensor(frame.sensor);
        self.detector.detect_observed(frame.view()?, observer)?;
        self.found = self.detector.exchange(std::mem::take(&mut self.found));
        Ok(())
    }

    /// Does something with the report of what it found in a frame.
    pub(crate) fn report<T>(&self, frame: &Frame, name: &str, act: impl FnOnce(&Report<'_>) -> T) -> T {
        let report = Report::new(name, frame, self.method, &self.values, &self.found);
        let report = Report { coplanar: self.coplanar, ..report };
        let notes = doubts(&report);
        act(&Report { notes: &notes, ..report })
    }

    /// Why a pixel has a plane or none, `depthplanes.explain/1`.
    ///
    /// # Errors
    /// A pixel outside of the map, and as [`Finder::find`].
    pub(crate) fn explain(&mut self, frame: &Frame, name: &str, at: [usize; 2]) -> Result<Value> {
        self.detector.set_sensor(frame.sensor);
        let why = self.detector.explain(frame.view()?, at)?;
        Ok(explanation_record(name, self.method, &self.values, &why))
    }
}

/// A value for each parameter of a method.
fn values(method: &'static MethodInfo, given: &Words) -> Result<Vec<f64>> {
    let mut values = method.defaults();
    for (option, value) in given.iter().filter(|(_, value)| !value.is_null()) {
        let name = option.replace('_', "-");
        let at = method.position(&name).ok_or_else(|| options::unknown_of_detector(option, method))?;
        let refused = || InputError(format!("{} is {value}; accepted: a number", options::of_parameter(option)));
        let value = value.as_f64().ok_or_else(refused)?;
        drop(method.with(&[(name.as_str(), value)])?);
        values[at] = value;
    }
    Ok(values)
}
