//! Values that stand for "nothing measured": named, and left out where they cannot be a measurement.

use depthplanes::{AnyView, DepthView, Pixel, ValueKind, with_view};

use super::probe::{FEW, Probe, is_small, percent};
use crate::frame::Frame;

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
pub(crate) fn not_measured(map: AnyView<'_>, value_kind: ValueKind) -> Option<(f64, String)> {
    let is_depth = matches!(value_kind, ValueKind::Depth { .. });
    let (value, count, what) = match &map {
        AnyView::U16(map) if is_depth => (f64::from(u16::MAX), count(map, u16::MAX), "the largest of 16 bits"),
        AnyView::U16(map) => (f64::from(MINUS_16), count(map, MINUS_16), "-16 of a stereo matcher in 16 bits"),
        AnyView::F32(map) => largest_float(map, is_depth)?,
        AnyView::U8(_) => return None,
    };
    is_many(count, map.width() * map.height()).then(|| {
        let share = count as f64 / (map.width() * map.height()) as f64;
        let (share, shown) = (percent(share), shown(value));
        let note = format!(
            "{share} of the pixels are {shown}, {what}: taken as missing, as --missing {shown} says; state --valid-range \
             if they are measured"
        );
        (value, note)
    })
}

/// Whether so many of the pixels are no accident.
fn is_many(count: usize, pixels: usize) -> bool {
    count as f64 >= SHARE * pixels as f64
}

fn count<T: Pixel>(map: &DepthView<'_, T>, wanted: T) -> usize {
    count_where(map, |value| value == wanted)
}

/// How many pixels a condition holds for. Every frame is counted: sums of so many pixels fit 16 bits, and are vectorised.
fn count_where<T: Pixel>(map: &DepthView<'_, T>, holds: impl Fn(T) -> bool) -> usize {
    let of = |pixels: &[T]| pixels.iter().map(|&value| u16::from(holds(value))).sum::<u16>();
    map.rows().flat_map(|row| row.chunks(1 << 15)).map(|pixels| usize::from(of(pixels))).sum()
}

/// The largest value of a map of floats, if it is none that was measured.
fn largest_float(map: &DepthView<'_, f32>, is_depth: bool) -> Option<(f64, usize, &'static str)> {
    // No value that is looked for is less; most maps have none of these.
    let large = count_where(map, |value| (LARGEST_HALF..f32::INFINITY).contains(&value));
    if !is_many(large, map.area()) {
        return None;
    }
    let largest = map.rows().flatten().copied().filter(|value| value.is_finite()).fold(0.0, f32::max);
    let what = match largest {
        NO_DEPTH.. => "more than any depth or disparity",
        LARGEST_HALF if is_depth => "the largest of 16-bit floats",
        65_535.0 if is_depth => "the largest of 16 bits",
        _ => return None,
    };
    Some((f64::from(largest), count(map, largest), what))
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
    let Ok(map) = frame.view() else { return 0.0 };
    let count = with_view!(map, map => count(&map, Pixel::from_f64(missing)));
    count as f64 / frame.pixels.len().max(1) as f64
}
