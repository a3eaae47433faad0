//! An input becomes a frame.

use crate::args::Reading;
use crate::failure::{Failure, Outcome};
use crate::inputs::Input;
use crate::patience::patiently;
use depthplanes::Intrinsics;
use depthplanes::noise::NoiseTable;
use depthplanes::scene::Spec;
use depthplanes_io::camera_file::read_camera;
use depthplanes_io::formats::{DecodeOptions, Limits};
use depthplanes_io::{Frame, ReadOptions, memory, read_noise_table};
use std::path::Path;

/// The flags as the reading library takes them; reads the camera file.
///
/// # Errors
/// A camera file that cannot be read, intrinsics that no camera has, half a stereo rig.
pub(crate) fn options(reading: &Reading) -> Outcome<ReadOptions> {
    let mut options = ReadOptions {
        decode: DecodeOptions {
            limits: Limits { max_pixels: reading.max_pixels, max_bytes: reading.max_bytes },
            member: reading.member.clone(),
            raw_size: reading.raw_size,
            raw_type: reading.raw_type.clone(),
            ..DecodeOptions::default()
        },
        preset: reading.preset.clone(),
        encoding: reading.encoding.clone(),
        scale: reading.scale,
        depth_scale: reading.depth_scale,
        ray_distance: reading.ray_distance,
        disparity: reading.disparity,
        swap_bytes: reading.swap_bytes,
        missing: reading.missing,
        valid_range: reading.valid_range.map(|[low, high]| (low, high)),
        ..ReadOptions::default()
    };
    if let Some(path) = &reading.camera {
        refuse_numbers(path)?;
        options = options.camera(&patiently(path.as_ref(), || read_camera(path))?);
    }
    if let Some([fx, fy, cx, cy]) = reading.intrinsics {
        options.intrinsics = Some(Intrinsics::new(fx, fy, cx, cy)?);
    }
    options.camera_size = reading.camera_size;
    options.rectified = reading.rectified;
    if options.camera_size.is_some() && options.intrinsics.is_none() && options.camera_file.is_none() {
        return Err(Failure::request("--camera-size needs the camera that it is of: --intrinsics or --camera"));
    }
    Ok(options.rig(reading.focal, reading.baseline, reading.doffs)?)
}

/// The table of the noise, if one is given.
///
/// # Errors
/// What is wrong with the file.
pub(crate) fn noise_table(path: Option<&Path>) -> Outcome<Option<NoiseTable>> {
    Ok(path.map(|path| patiently(path, || read_noise_table(path))).transpose()?)
}

/// Refuses the numbers of a camera in the place of its file.
fn refuse_numbers(path: &Path) -> Outcome {
    let text = path.to_string_lossy();
    let parts: Vec<&str> = text.split(',').collect();
    let are_numbers = parts.len() == 4 && parts.iter().all(|part| part.trim().parse::<f64>().is_ok());
    if are_numbers && !path.exists() {
        return Err(Failure::request(format!(
            "--camera takes a file; for the numbers themselves: --intrinsics={text}"
        )));
    }
    Ok(())
}

/// Reads an input.
///
/// # Errors
/// What is wrong with the file or the scene.
pub(crate) fn frame(input: &Input, options: &ReadOptions) -> Outcome<Frame> {
    match input {
        Input::File { path, .. } => {
            memory::check_of_file(path, options.decode.limits.max_bytes as u64)?;
            patiently(path, || depthplanes_io::read(path, options)).map_err(refusal)
        }
        Input::Standard => depthplanes_io::read_stream(std::io::stdin().lock(), "-", options).map_err(refusal),
        Input::Scene(spec) => {
            let mut frame = scene(spec)?;
            let ReadOptions { noise, smooth_noise, .. } = *options;
            (frame.sensor.noise, frame.sensor.smooth_noise) = (noise, smooth_noise);
            let decode = DecodeOptions { limits: options.decode.limits, ..DecodeOptions::default() };
            if *options != (ReadOptions { noise, smooth_noise, decode, ..ReadOptions::default() }) {
                frame
                    .warnings
                    .push("a synthetic scene knows its own unit and camera: flags on reading are not used".into());
            }
            Ok(frame)
        }
    }
}

/// What is wrong with a map; for limits, the flag that raises them.
fn refusal(error: depthplanes_io::Error) -> Failure {
    let flag = match error.kind() {
        depthplanes_io::Error::Limit { what, .. } if what.contains("pixels") => Some("--max-pixels"),
        depthplanes_io::Error::Limit { .. } => Some("--max-bytes"),
        _ => None,
    };
    match flag {
        Some(flag) => Failure::request(format!("{error}; if the file is trusted, raise it with {flag} N")),
        None => error.into(),
    }
}

/// A synthetic scene as a frame; it knows its own unit and camera.
pub(crate) fn scene(spec: &str) -> Outcome<Frame> {
    let spec = spec.parse::<Spec>()?;
    let needed = 64 * (spec.width * spec.height) as u64;
    memory::check(needed, needed)?;
    Ok(spec.frame()?.into())
}
