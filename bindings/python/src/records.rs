//! Records of what is no detection, as JSON: noise, and scores.

use crate::error::{Error, Result};
use crate::frame::Frame;
use depthplanes::metrics::{Contingency, Tolerance};
use depthplanes::noise::Estimator;
use depthplanes_io::measures::{Scores, families};
use depthplanes_io::outputs::noise_record;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// The noise of the sensor that made some frames, JSON.
#[pyfunction]
pub(crate) fn noise(py: Python<'_>, frames: Vec<PyRef<'_, Frame>>) -> Result<String> {
    let frames: Vec<_> = frames.iter().map(|frame| frame.frame.clone()).collect();
    py.detach(|| {
        let mut estimator = Estimator::default();
        for frame in &frames {
            estimator.add(frame.view()?, frame.sensor.value_kind)?;
        }
        Ok(noise_record(&estimator.estimate()?).to_string())
    })
}

/// The measures of a label image against the truth, JSON: an object for each family.
#[pyfunction]
pub(crate) fn score(
    truth: PyReadonlyArray2<'_, u16>,
    prediction: PyReadonlyArray2<'_, u16>,
    tolerance: f64,
    truth_from: u16,
) -> Result<String> {
    let tolerance = Tolerance::new(tolerance)?;
    let [of_truth, of_prediction] = [&truth, &prediction].map(|labels| [labels.shape()[1], labels.shape()[0]]);
    if of_truth != of_prediction {
        let [[width, height], [others, rows]] = [of_prediction, of_truth];
        let text =
            format!("{width} x {height} labels, but the truth has {others} x {rows}; both must be of the same map");
        return Err(Error::Input(text));
    }
    let slice = |labels: &PyReadonlyArray2<'_, u16>| labels.as_array().iter().copied().collect::<Vec<u16>>();
    let table = Contingency::new(&slice(&truth), &slice(&prediction))?.truth_from(truth_from);
    let scores = Scores::of(&table, tolerance);
    Ok(serde_json::Value::from(families(|measure| measure.json(&scores))).to_string())
}
