//! An input becomes a frame.

use crate::args::Reading;
use crate::failure::{Failure, Outcome};
use crate::inputs::Input;
use crate::patience::patiently;
use depthplanes::Intrinsics;
use depthplanes::noise::NoiseTable;
use depthplanes::scene::{ScenePixels, Spec};
use depthplanes_io::camera_file::read_camera;
use depthplanes_io::encoding::Stereo;
use depthplanes_io::formats::{DecodeOptions, Limits};
use depthplanes_io::{Frame, Pixels, Provenance, ReadOptions, memory, read_noise_table};
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
    options.stereo = stereo(reading, &options)?;
    Ok(options)
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

/// The rig: flags go before the camera file, and the camera's own focal length is the rig's unless
/// another is given.
fn stereo(reading: &Reading, options: &ReadOptions) -> Outcome<Option<Stereo>> {
    let given = [reading.baseline, reading.focal, reading.doffs];
    if given.iter().all(Option::is_none) {
        return Ok(options.stereo);
    }
    let lacking = |what| Failure::request(format!("a stereo rig needs its {what} as well"));
    let file = options.camera_file.as_ref();
    let known = file.and_then(|camera| camera.stereo);
    let baseline_m = reading.baseline.or(known.map(|rig| rig.baseline_m)).ok_or_else(|| lacking("--baseline"))?;
    let focal = reading
        .focal
        .or(known.map(|rig| rig.focal_px))
        .or(options.intrinsics.or(file.map(|camera| camera.intrinsics)).map(|camera| camera.fx.abs()));
    let focal_px = focal.ok_or_else(|| lacking("--focal (or --intrinsics)"))?;
    let doffs_px = reading.doffs.or(known.map(|rig| rig.doffs_px)).unwrap_or(0.0);
    Ok(Some(Stereo { focal_px, baseline_m, doffs_px }))
}

/// Reads an input.
///
/// # Errors
/// What is wrong with the file or the scene.
pub(crate) fn frame(input: &Input, options: &ReadOptions) -> Outcome<Frame> {
    match input {
        Input::File { path, .. } => {
            // Its bytes, the samples, the pixels and what is looked at in them.
            let needed =
                6 * std::fs::metadata(path).map_or(0, |about| about.len().min(options.decode.limits.max_bytes as u64));
            memory::check(needed, needed)?;
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
    let scene = spec.frame()?;
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
        provenance: Provenance { encoding: "a synthetic scene knows its own".into(), ..Provenance::default() },
        warnings: Vec::new(),
    })
}
