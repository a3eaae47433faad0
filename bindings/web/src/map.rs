//! The map that a request is about.

use crate::error::Result;
use crate::memory::{check_of_reading, check_of_scene};
use depthplanes::ValueKind;
use depthplanes::scene::Spec;
use depthplanes_io::{Frame, ReadOptions, frame_of_samples};
use serde::Deserialize;
use serde_json::{Value, json};

/// What the bytes of a request are.
#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum MapOf {
    /// Those of a file of that name.
    File(String),
    /// Numbers of an array, by the name of their type.
    Array { sample: String, width: usize, height: usize },
    /// None: a synthetic scene.
    Scene(String),
}

impl MapOf {
    /// What the map is called.
    pub(crate) fn name(&self) -> String {
        match self {
            MapOf::File(name) => name.clone(),
            MapOf::Array { .. } => "array".into(),
            MapOf::Scene(spec) => format!("scene:{spec}"),
        }
    }

    /// What making a frame of it is called in the list of times.
    pub(crate) fn stage(&self) -> &'static str {
        match self {
            MapOf::File(_) | MapOf::Array { .. } => "read",
            MapOf::Scene(_) => "scene",
        }
    }

    /// The map as a frame.
    ///
    /// # Errors
    /// Those of the readers and of scenes.
    pub(crate) fn frame(&self, bytes: &[u8], options: &ReadOptions) -> Result<Frame> {
        match self {
            MapOf::File(name) => {
                check_of_reading(bytes.len())?;
                Ok(depthplanes_io::decode(bytes, name, options)?)
            }
            MapOf::Array { sample, width, height } => {
                check_of_reading(bytes.len())?;
                Ok(frame_of_samples(bytes, sample, (*width, *height), options)?)
            }
            MapOf::Scene(spec) => {
                let spec = spec.parse::<Spec>()?;
                check_of_scene(spec.width, spec.height)?;
                let mut frame = Frame::from(spec.frame()?);
                if *options != ReadOptions::default() {
                    let note = "a synthetic scene knows its own unit and camera: what is stated of reading is not used";
                    frame.warnings.push(note.into());
                }
                Ok(frame)
            }
        }
    }
}

/// What is known of the numbers of a frame and of its camera.
pub(crate) fn known(frame: &Frame) -> Value {
    let metres_per_unit = match frame.sensor.value_kind {
        ValueKind::Depth { metres } => Some(metres),
        _ => None,
    };
    json!({
        "unit": frame.encoding,
        "why_unit": frame.provenance.encoding,
        "metres_per_unit": metres_per_unit,
        "camera": frame.sensor.intrinsics.map(|camera| [camera.fx, camera.fy, camera.cx, camera.cy]),
        "missing": frame.missing,
    })
}
