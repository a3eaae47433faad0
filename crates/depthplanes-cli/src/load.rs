//! An input becomes a frame.

use crate::args::Reading;
use crate::failure::{Failure, Outcome};
use crate::inputs::Input;
use depthplanes::scene::{ScenePixels, Spec};
use depthplanes_io::formats::Limits;
use depthplanes_io::{Frame, Pixels, ReadOptions};
use std::io::Read;

/// Reads an input as the flags say.
///
/// # Errors
/// What is wrong with the file, the scene or the flags.
pub(crate) fn frame(input: &Input, reading: &Reading) -> Outcome<Frame> {
    match input {
        Input::File(path) => Ok(depthplanes_io::read(path, &options(reading)?)?),
        Input::Standard => {
            let bytes = standard_input()?;
            Ok(depthplanes_io::decode(&bytes, "-", &options(reading)?)?)
        }
        Input::Scene(spec) => scene(spec),
    }
}

/// All of standard input, up to the limit of a file.
fn standard_input() -> Outcome<Vec<u8>> {
    let most = Limits::default().max_bytes as u64 + 1;
    let mut bytes = Vec::new();
    let failed = |error| Failure::request(format!("-: standard input cannot be read: {error}"));
    std::io::stdin().lock().take(most).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// A made-up scene as a frame; it knows its own unit and camera.
pub(crate) fn scene(spec: &str) -> Outcome<Frame> {
    let scene = spec.parse::<Spec>()?.frame()?;
    let pixels = match scene.pixels {
        ScenePixels::U8(pixels) => Pixels::U8(pixels),
        ScenePixels::U16(pixels) => Pixels::U16(pixels),
        ScenePixels::F32(pixels) => Pixels::F32(pixels),
    };
    Ok(Frame {
        width: scene.width,
        height: scene.height,
        pixels,
        missing: None,
        valid_range: None,
        sensor: scene.sensor,
        format: "scene",
        encoding: "scene",
        warnings: Vec::new(),
    })
}
