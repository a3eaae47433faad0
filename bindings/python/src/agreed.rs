//! A frame that was read, and a detector that states something of maps: what either knows holds for both.
//!
//! What the frame only looked like gives way to what the detector states. Where both are sure, they have to agree.

use crate::error::{Error, Result};
use depthplanes::{Intrinsics, ValueKind};
use depthplanes_io::{Frame, Pixels, ReadOptions, encoding, frame_of_samples};
use std::fmt::Display;
use std::sync::Arc;

/// The frame, with what `options` state where it says nothing.
///
/// # Errors
/// [`Error::Input`] with both values where they contradict each other, and those of the readers.
pub(crate) fn agreed(frame: &Arc<Frame>, options: &ReadOptions) -> Result<Arc<Frame>> {
    if *options == ReadOptions::default() {
        return Ok(frame.clone());
    }
    let has_unit = states_unit(options) || options.preset.is_some() || options.ray_distance || options.swap_bytes;
    if has_unit && is_open(frame, options) { reread(frame, options) } else { completed(frame, options) }.map(Arc::new)
}

/// Whether it is stated what the numbers count.
fn states_unit(options: &ReadOptions) -> bool {
    let counted = options.scale.is_some() || options.depth_scale.is_some() || options.stereo.is_some();
    counted || options.encoding.is_some() || options.disparity
}

/// Whether nobody has stated the frame's unit, or the rig that its disparities are of.
fn is_open(frame: &Frame, options: &ReadOptions) -> bool {
    let lacks_rig = frame.sensor.value_kind == ValueKind::Disparity && options.encoding.is_none();
    is_as_read(frame) && !frame.provenance.ray_distance && (frame.provenance.is_guess() || lacks_rig)
}

/// Whether its numbers are those of the file, in an encoding that can be stated; a scene has none.
fn is_as_read(frame: &Frame) -> bool {
    encoding::by_name(frame.encoding).is_ok_and(|encoding| !encoding.unpacks)
}

/// Such a frame, read again as the options say.
fn reread(frame: &Frame, options: &ReadOptions) -> Result<Frame> {
    let mut options = options.clone();
    if !frame.provenance.is_guess() {
        options.encoding = Some(frame.encoding.into());
        options.scale = options.scale.or(frame.provenance.scale);
    }
    options.missing = options.missing.or(frame.missing);
    options.valid_range = options.valid_range.or(frame.valid_range);
    if options.intrinsics.is_none() && options.camera_file.is_none() {
        options.intrinsics = frame.sensor.intrinsics;
    }
    let mut told = again(frame, &options)?;
    camera_of_both(frame, &options, &mut told)?;
    Ok(told)
}

/// A frame that knows its unit, with the camera and the noise that the options state.
fn completed(frame: &Frame, options: &ReadOptions) -> Result<Frame> {
    for (name, is_new) in
        [("ray_distance", options.ray_distance && !frame.provenance.ray_distance), ("swap_bytes", options.swap_bytes)]
    {
        if is_new {
            let text =
                format!("{name} is True for a frame whose unit is known; accepted: depthplanes.read(.., {name}=True)");
            return Err(Error::Input(text));
        }
    }
    let mut asking = ReadOptions { ray_distance: false, ..options.clone() };
    if asking.encoding.is_none() && is_as_read(frame) {
        asking.encoding = Some(frame.encoding.into());
        asking.scale = asking.scale.or(frame.provenance.scale.filter(|_| asking.depth_scale.is_none()));
    }
    let asked = again(frame, &asking)?;
    let (known, stated) = (frame.sensor.value_kind, asked.sensor.value_kind);
    if states_unit(options) && known != stated {
        return Err(contradiction("unit", meaning(stated, asked.encoding), meaning(known, frame.encoding)));
    }
    let mut told = frame.clone();
    (told.sensor.intrinsics, told.sensor.distortion) = (asked.sensor.intrinsics, asked.sensor.distortion);
    camera_of_both(frame, options, &mut told)?;
    told.sensor.noise = frame.sensor.noise.or(asked.sensor.noise);
    told.sensor.smooth_noise = frame.sensor.smooth_noise.or(asked.sensor.smooth_noise);
    told.missing = options.missing.or(frame.missing);
    told.valid_range = options.valid_range.or(frame.valid_range);
    if asked.encoding == frame.encoding {
        let notes = asked.warnings.into_iter().filter(|note| !frame.warnings.contains(note));
        told.warnings.extend(notes);
    }
    told.view()?;
    Ok(told)
}

/// The frame's numbers, read as an array is.
fn again(frame: &Frame, options: &ReadOptions) -> Result<Frame> {
    let (samples, sample) = match &frame.pixels {
        Pixels::U8(values) => (values.clone(), "uint8"),
        Pixels::U16(values) => (values.iter().flat_map(|value| value.to_le_bytes()).collect(), "uint16"),
        Pixels::F32(values) => (values.iter().flat_map(|value| value.to_le_bytes()).collect(), "float32"),
    };
    Ok(frame_of_samples(&samples, sample, (frame.width, frame.height), options)?)
}

/// Gives `told` the frame's camera, if that is known; another one is refused, if it is more than a preset's.
fn camera_of_both(frame: &Frame, options: &ReadOptions, told: &mut Frame) -> Result<()> {
    let Some(known) = frame.sensor.intrinsics else { return Ok(()) };
    let is_stated = options.intrinsics.is_some() || options.camera_file.is_some();
    if let Some(stated) = told.sensor.intrinsics.filter(|stated| is_stated && *stated != known) {
        return Err(contradiction("camera", numbers(stated), numbers(known)));
    }
    (told.sensor.intrinsics, told.sensor.distortion) = (frame.sensor.intrinsics, frame.sensor.distortion);
    Ok(())
}

fn contradiction(name: &str, stated: impl Display, known: impl Display) -> Error {
    Error::Input(format!(
        "{name} is {stated} by the detector, and {known} by the frame that was read; accepted: the same, or to state it once; \
         frame.depth is the array without what was stated"
    ))
}

fn numbers(Intrinsics { fx, fy, cx, cy }: Intrinsics) -> String {
    format!("({fx}, {fy}, {cx}, {cy})")
}

/// What the numbers count.
fn meaning(kind: ValueKind, encoding: &str) -> String {
    match kind {
        ValueKind::Depth { metres } => format!("\"{encoding}\" ({metres} m)"),
        _ => format!("\"{encoding}\""),
    }
}
