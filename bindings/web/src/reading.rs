//! What is stated of a map beside its numbers: words of JavaScript as the readers take them.

use crate::error::{InputError, Result};
use crate::options;
use depthplanes::Intrinsics;
use depthplanes::noise::{NoiseTable, SensorNoise};
use depthplanes_io::ReadOptions;
use depthplanes_io::camera_file;
use depthplanes_io::formats::DecodeOptions;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// Names and values, as an object of JavaScript has them.
pub(crate) type Words = Map<String, Value>;

/// Takes a word's value out; `accepted` says what it may be.
///
/// # Errors
/// A value of another kind.
pub(crate) fn take<T: DeserializeOwned>(words: &mut Words, name: &str, accepted: &str) -> Result<Option<T>> {
    match words.remove(name) {
        None | Some(Value::Null) => Ok(None),
        Some(given) => match T::deserialize(&given) {
            Ok(value) => Ok(Some(value)),
            Err(_) => Err(InputError(format!("{name} is {given}; accepted: {accepted}"))),
        },
    }
}

const NUMBER: &str = "a number";
const YES_OR_NO: &str = "true or false";
const SIZE: &str = "[width, height], whole numbers";

/// Takes out what is about reading. The words are those of the Python package, which are the program's flags but for `sensor`
/// (`--preset`), `unit` (`--encoding`) and `camera` (`--intrinsics`, or what stands in the file of `--camera`).
///
/// # Errors
/// Values that are not accepted.
pub(crate) fn reading(words: &mut Words) -> Result<ReadOptions> {
    let mut options = ReadOptions {
        decode: DecodeOptions {
            member: take(words, "member", "the name of a file in the archive")?,
            raw_size: take(words, "raw_size", SIZE)?,
            raw_type: take(words, "raw_type", "the name of a type of numbers")?,
            ..DecodeOptions::default()
        },
        preset: take(words, "sensor", "the name of a sensor")?,
        encoding: take(words, "unit", "the name of a unit")?,
        scale: take(words, "scale", NUMBER)?,
        depth_scale: take(words, "depth_scale", NUMBER)?,
        ray_distance: take(words, "ray_distance", YES_OR_NO)?.unwrap_or(false),
        disparity: take(words, "disparity", YES_OR_NO)?.unwrap_or(false),
        swap_bytes: take(words, "swap_bytes", YES_OR_NO)?.unwrap_or(false),
        missing: take(words, "missing", NUMBER)?,
        valid_range: take(words, "valid_range", "[low, high], numbers")?,
        camera_size: take(words, "camera_size", SIZE)?,
        rectified: take(words, "rectified", YES_OR_NO)?,
        ..ReadOptions::default()
    };
    if let Some(rows) = take::<Vec<[f64; 2]>>(words, "noise_table", "rows of range and standard deviation, metres")? {
        options.noise = Some(SensorNoise::Table(NoiseTable::new(&rows)?));
    }
    match words.remove("camera") {
        None | Some(Value::Null) => (),
        Some(Value::String(text)) => options = options.camera(&camera_file::parse(&text)?),
        Some(given) => options.intrinsics = Some(intrinsics(&given)?),
    }
    if options.camera_size.is_some() && options.intrinsics.is_none() && options.camera_file.is_none() {
        return Err(InputError("camera_size needs the camera that it is of: state camera".into()));
    }
    options.check()?;
    let [focal, baseline, doffs] = ["focal", "baseline", "doffs"].map(|name| take(words, name, NUMBER));
    Ok(options.rig(focal?, baseline?, doffs?)?)
}

/// Refuses words that say nothing of how a map is read.
///
/// # Errors
/// With the first of them.
pub(crate) fn refuse_others(left: &Words) -> Result<()> {
    left.keys().next().map_or(Ok(()), |name| Err(options::unknown_of_reading(name)))
}

/// The camera of four numbers.
fn intrinsics(given: &Value) -> Result<Intrinsics> {
    let accepted = "[fx, fy, cx, cy] in pixels, or what stands in a camera file";
    let numbers = <[f64; 4] as serde::Deserialize>::deserialize(given);
    let [fx, fy, cx, cy] = numbers.map_err(|_| InputError(format!("camera is {given}; accepted: {accepted}")))?;
    Ok(Intrinsics::new(fx, fy, cx, cy)?)
}
