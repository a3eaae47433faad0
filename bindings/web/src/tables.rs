//! The library's tables: what there is, with the names that are accepted.

use depthplanes::methods::{METHODS, MethodInfo};
use depthplanes::scene::{SCENES, SENSORS};
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::formats::FORMATS;
use depthplanes_io::outputs::OUTPUTS;
use depthplanes_io::page::parameter_record;
use depthplanes_io::presets::SENSOR_PRESETS;
use serde_json::{Value, json};

/// All tables: rows of name and meaning, in their order.
pub(crate) fn tables() -> Value {
    let row = |name: &str, about: &str| json!({"name": name, "about": about});
    let extensions =
        |writers: &[depthplanes_io::outputs::Writer]| writers.iter().map(|writer| writer.extension).collect::<Vec<_>>();
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "methods": METHODS.iter().map(|info| method(info)).collect::<Vec<_>>(),
        "sensors": SENSOR_PRESETS.iter().map(|preset| row(preset.name, preset.about)).collect::<Vec<_>>(),
        "units": ENCODINGS.iter().map(|encoding| row(encoding.name, encoding.about)).collect::<Vec<_>>(),
        "formats": FORMATS.iter().map(|format| {
            json!({"name": format.name, "about": format.about, "extensions": format.extensions})
        }).collect::<Vec<_>>(),
        "outputs": OUTPUTS.iter().map(|output| {
            json!({"name": output.name, "about": output.about, "extensions": extensions(output.writers)})
        }).collect::<Vec<_>>(),
        "scenes": SCENES.iter().map(|scene| row(scene.name, scene.about)).collect::<Vec<_>>(),
        "scene_sensors": SENSORS.iter().map(|sensor| row(sensor.name, sensor.about)).collect::<Vec<_>>(),
    })
}

fn method(method: &MethodInfo) -> Value {
    json!({
        "name": method.name,
        "about": method.about,
        "curved": method.tells_curved,
        "stages": method.stages,
        "parameters": method.params.iter().map(parameter_record).collect::<Vec<_>>(),
    })
}
