//! Values that stand for "nothing measured": named, and left out where they cannot be a measurement.

use depthplanes::ValueKind;

use super::probe::{FEW, Probe, is_small, percent};
use crate::frame::{Frame, Pixels};

/// From this many metres on no camera measures depth, whatever the unit: the largest value that a file of millimetres or
/// metres can mean is less.
const NO_DEPTH: f32 = 1e9;
/// The largest value of 16-bit floats, which programs clip to.
const LARGEST_HALF: f32 = 65_504.0;
/// -16 as 16 unsigned bits: OpenCV's matchers write (smallest disparity - 1) x 16 where they match nothing.
const MINUS_16: u16 = 65_520;
/// Share of the pixels from which on such a value is no accident.
const SHARE: f64 = 0.005;

/// The value of a map that no sensor measures but programs write for "nothing there", with a note, if the user said
/// nothing of missing values.
pub(crate) fn not_measured(pixels: &Pixels, value_kind: ValueKind) -> Option<(f64, String)> {
    let is_depth = matches!(value_kind, ValueKind::Depth { .. });
    let (value, count, what) = match pixels {
        Pixels::U16(values) if is_depth => (f64::from(u16::MAX), count(values, u16::MAX), "the largest of 16 bits"),
        Pixels::U16(values) => (f64::from(MINUS_16), count(values, MINUS_16), "-16 of a stereo matcher in 16 bits"),
        Pixels::F32(values) => largest_float(values, is_depth)?,
        Pixels::U8(_) => return None,
    };
    let share = count as f64 / pixels.len().max(1) as f64;
    (share >= SHARE).then(|| {
        let (share, shown) = (percent(share), shown(value));
        let note = format!(
            "{share} of the pixels are {shown}, {what}: taken as missing, as --missing {shown} says; state --valid-range \
             if they are measured"
        );
        (value, note)
    })
}

fn count<T: PartialEq>(values: &[T], wanted: T) -> usize {
    values.iter().filter(|&value| *value == wanted).count()
}

/// The largest value of a map of floats, if it is none that was measured.
fn largest_float(values: &[f32], is_depth: bool) -> Option<(f64, usize, &'static str)> {
    let largest = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max);
    let what = match largest {
        NO_DEPTH.. => "more than any depth or disparity",
        LARGEST_HALF if is_depth => "the largest of 16-bit floats",
        65_535.0 if is_depth => "the largest of 16 bits",
        _ => return None,
    };
    Some((f64::from(largest), count(values, largest), what))
}

/// The shortest text that is read as the same value.
pub(super) fn shown(value: f64) -> String {
    let single = value as f32;
    match f64::from(single) == value {
        true if value.abs() >= 1e7 => format!("{single:e}"),
        true => single.to_string(),
        false => value.to_string(),
    }
}

/// Values below 0, which count as missing.
pub(super) fn negative(_: &Frame, probe: &Probe) -> Option<String> {
    let share = probe.negative as f64 / probe.pixels as f64;
    let what = match share {
        0.95.. => "a depth or a disparity with the other sign? turn it round before it is saved",
        0.05.. => "coordinates of another frame than the camera's, or a program's value for nothing?",
        _ => return None,
    };
    Some(format!("{} of the pixels are below 0 and count as missing: {what}", percent(share)))
}

/// Most of the map is missing, and not because a value is known to stand for that.
pub(super) fn mostly(frame: &Frame, probe: &Probe) -> Option<String> {
    let share = probe.missing_share();
    let most = if is_small(frame) { 0.5 } else { 0.49 };
    if share <= most || share - known_share(frame) <= most {
        return None;
    }
    let is_apart = probe.valid.len() >= FEW && 5 * probe.pairs.len() < probe.valid.len();
    let advice = if is_apart {
        "the measured ones stand apart, and areas are those of the measured pixels"
    } else {
        "check --missing, --valid-range and --encoding"
    };
    Some(format!("{} of the pixels are missing: {advice}", percent(share)))
}

/// Share of the pixels that have the value for "missing" that is known of the map.
fn known_share(frame: &Frame) -> f64 {
    let Some(missing) = frame.missing else { return 0.0 };
    let count = match &frame.pixels {
        Pixels::U8(values) => count(values, missing as u8),
        Pixels::U16(values) => count(values, missing as u16),
        Pixels::F32(values) => count(values, missing as f32),
    };
    count as f64 / frame.pixels.len().max(1) as f64
}
