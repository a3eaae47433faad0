//! The library's tables: what there is, with the names that are accepted.

use depthplanes::methods::METHODS;
use depthplanes::scene::{SCENES, SENSORS};
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::formats::FORMATS;
use depthplanes_io::outputs::{OUTPUTS, colour};
use depthplanes_io::presets::SENSOR_PRESETS;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The colours of labels 0 to `most`, sRGB.
#[pyfunction]
pub(crate) fn colours(py: Python<'_>, most: u16) -> Bound<'_, PyArray2<u8>> {
    let numbers: Vec<u8> = (0..=most).flat_map(colour).collect();
    Array2::from_shape_vec((usize::from(most) + 1, 3), numbers).expect("three for each label").into_pyarray(py)
}

/// All tables, JSON: rows of name and meaning; methods with their parameters.
#[pyfunction]
pub(crate) fn tables() -> String {
    let row = |name: &str, about: &str| json!({"name": name, "about": about});
    let methods: Vec<Value> = METHODS
        .iter()
        .map(|method| {
            let param = |param: &depthplanes::methods::Param| {
                json!({
                    "name": param.name.replace('-', "_"),
                    "default": param.default,
                    "unit": param.unit,
                    "accepted": param.accepted(),
                    "about": param.meaning,
                })
            };
            let parameters = method.params.iter().map(param).collect::<Vec<_>>();
            json!({"name": method.name, "about": method.about, "parameters": parameters})
        })
        .collect();
    json!({
        "methods": methods,
        "sensors": SENSOR_PRESETS.iter().map(|preset| row(preset.name, preset.about)).collect::<Vec<_>>(),
        "units": ENCODINGS.iter().map(|encoding| row(encoding.name, encoding.about)).collect::<Vec<_>>(),
        "formats": FORMATS.iter().map(|format| {
            json!({"name": format.name, "about": format.about, "extensions": format.extensions})
        }).collect::<Vec<_>>(),
        "outputs": OUTPUTS.iter().map(|output| {
            json!({"name": output.name, "about": output.about, "file": output.file})
        }).collect::<Vec<_>>(),
        "scenes": SCENES.iter().map(|scene| row(scene.name, scene.about)).collect::<Vec<_>>(),
        "scene_sensors": SENSORS.iter().map(|sensor| row(sensor.name, sensor.about)).collect::<Vec<_>>(),
    })
    .to_string()
}
