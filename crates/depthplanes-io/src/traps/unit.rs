//! Metres for millimetres and the other way round, wherever the unit comes from.

use depthplanes::ValueKind;

use super::probe::{FEW, Probe};
use crate::encoding;
use crate::frame::Frame;
use crate::presets::{self, SensorPreset};

/// Median depths that a camera may have: a close-up, and the far side of a valley.
const USUAL_M: std::ops::RangeInclusive<f64> = 0.05..=100.0;
/// Median depth that no room has, metres. Of recorded frames of rooms, read right, it is 3.4 m at the most.
const FAR_M: f64 = 12.0;
/// Median depth that most cameras do not see, metres. Of recorded frames it is 0.69 m at the least.
const NEAR_M: f64 = 0.4;
/// Median depths of which another unit is doubted, and those that the preset's own unit has to make then, metres.
const NEAR_OF_PRESET_M: f64 = 0.5;
const OF_ROOMS_M: std::ops::RangeInclusive<f64> = 0.6..=10.0;
/// Median depths that a flag is proposed for: from a desk to a street.
const LIKELY_M: std::ops::RangeInclusive<f64> = 0.15..=60.0;

/// A median depth that no camera has, or not the preset's; a median disparity that is wider than the map.
pub(super) fn median(frame: &Frame, probe: &Probe) -> Option<String> {
    if probe.valid.len() < FEW {
        return None;
    }
    let median = probe.median()?;
    if let (ValueKind::InverseDepth { slope, .. }, Some(rig)) = (frame.sensor.value_kind, frame.provenance.stereo) {
        let (pixels, width) = (median * slope * rig.focal_px * rig.baseline_m, frame.width);
        if pixels > width as f64 {
            return Some(format!(
                "the median disparity would be {pixels:.0} pixels in {width} columns: try --scale 16 or 256 (map units per pixel \
                 of disparity)"
            ));
        }
    }
    let median_m = frame.sensor.value_kind.depth_m(median)?;
    if let Some(doubt) = doubt_of_depth(frame, median_m) {
        return Some(format!("the median depth would be {}: {doubt}", length(median_m)));
    }
    let from = &frame.provenance;
    let Some(preset) = from.preset.and_then(|name| presets::by_name(name).ok()) else {
        // The same unit that is guessed for all maps of 16 bits.
        let is_guess = from.is_guess() && frame.encoding == "millimetre" && from.scale.is_none();
        if is_guess && median_m < NEAR_M {
            return Some(format!(
                "the median depth would be {} in millimetres, nearer than most depth cameras see: centimetres (--scale 100)? State \
                 --encoding millimetre if it is right",
                length(median_m)
            ));
        }
        let is_far = median_m > FAR_M && is_guess;
        return is_far.then(|| {
            format!(
                "the median depth would be {} in millimetres, farther than rooms are: if this is one, these are no millimetres. The \
                 numbers do not say what they are: a finer unit (4000, 5000 and 10000 units per metre are common: --scale), or \
                 normalised, inverted or logarithmic depth, which has to be turned back first. State --encoding millimetre if \
                 it is right",
                length(median_m)
            )
        });
    };
    if let Some(note) = other_unit(frame, probe, preset, median_m) {
        return Some(note);
    }
    let limit = match (preset.near_m, preset.far_m) {
        (Some(near_m), _) if median_m < near_m => format!("from {} on", length(near_m)),
        (_, Some(far_m)) if median_m > far_m => format!("about {}", length(far_m)),
        _ => return None,
    };
    Some(format!(
        "the median depth would be {}, and the preset's sensor sees {limit}: check --scale, --depth-scale and --encoding",
        length(median_m)
    ))
}

/// Another unit than the preset's, or a preset of another unit, where that makes depths near.
fn other_unit(frame: &Frame, probe: &Probe, preset: &SensorPreset, median_m: f64) -> Option<String> {
    let (from, median) = (&frame.provenance, probe.median()?);
    preset.near_m?;
    let (own_m, in_mm) = match preset.encoding {
        "millimetre" => (1e-3 * median, 1e-3 * median),
        "tum" => (2e-4 * median, 1e-3 * median),
        _ => return None,
    };
    if let Some(scale) = from.scale {
        let is_odd = median_m < NEAR_OF_PRESET_M && OF_ROOMS_M.contains(&own_m);
        return is_odd.then(|| {
            format!(
                "the median depth would be {} by --scale {scale}, and {} in the preset's own unit: leave --scale out?",
                length(median_m),
                length(own_m)
            )
        });
    }
    // The data set has millimetres times 5.
    let multiples = probe.valid.iter().filter(|value| *value % 5.0 == 0.0).count();
    let is_tum = preset.name.starts_with("tum") && frame.encoding == "tum" && from.encoding == "preset";
    let is_other = is_tum && 2 * multiples < probe.valid.len() && 2.0 * median_m < 3.0 && OF_ROOMS_M.contains(&in_mm);
    is_other.then(|| {
        format!(
            "the median depth would be {}, and the values are no multiples of 5, as TUM RGB-D's are: millimetres, {}? try --encoding \
             millimetre",
            length(median_m),
            length(in_mm)
        )
    })
}

/// What to try where something lies at a depth that no camera sees; `None` where one may.
pub(crate) fn doubt_of_depth(frame: &Frame, depth_m: f64) -> Option<String> {
    (!USUAL_M.contains(&depth_m)).then(|| remedy(frame, depth_m))
}

/// The flag that is likely wrong.
fn remedy(frame: &Frame, depth_m: f64) -> String {
    let from = &frame.provenance;
    let is_likely = |factor: f64| LIKELY_M.contains(&(depth_m * factor));
    match frame.sensor.value_kind {
        ValueKind::Depth { metres } => {
            if let Some(scale) = from.scale {
                // A scale the other way up, or of millimetres instead of metres.
                if is_likely(scale * scale) {
                    return format!("--scale is in map units per metre; try --depth-scale {scale} (metres per unit)");
                }
                let scale = [1e3, 1e-3].into_iter().find(|factor| is_likely(1.0 / factor)).map(|factor| factor * scale);
                return scale.map_or("check --scale".into(), |scale| format!("try --scale {scale}"));
            }
            // A value spread over channels keeps its encoding, in another unit.
            if encoding::by_name(frame.encoding).is_ok_and(|encoding| encoding.channels) {
                let finer = [1e3, 1e2, 1e1, 1e4, 1e6].into_iter().find(|finer| OF_ROOMS_M.contains(&(depth_m / finer)));
                return finer.map_or("check --encoding and --scale".into(), |finer| {
                    format!("try --scale {} (map units per metre)", (finer / metres).round())
                });
            }
            let units = [("metre", 1.0), ("millimetre", 1e-3), ("tum", 2e-4)];
            let named = units.iter().find(|(name, unit)| *name != frame.encoding && is_likely(unit / metres));
            match named {
                Some((name, _)) if from.encoding == "stated" => {
                    format!("--encoding {} is likely wrong; try --encoding {name}, or --scale", frame.encoding)
                }
                Some((name, _)) => format!("try --encoding {name}, --scale or --disparity"),
                None => "check --encoding and --scale, or try --disparity".into(),
            }
        }
        ValueKind::InverseDepth { .. } => match from.stereo {
            Some(rig) if is_likely(1e-3) => {
                format!("--baseline is in metres; try --baseline {}", rig.baseline_m / 1e3)
            }
            Some(rig) if is_likely(1e3) => format!("is the baseline right? try --baseline {}", rig.baseline_m * 1e3),
            Some(_) => "check --scale (map units per pixel of disparity), --focal and --baseline".into(),
            None => "check --encoding".into(),
        },
        _ => "check --encoding".into(),
    }
}

/// A length with the unit that suits it.
pub(crate) fn length(metres: f64) -> String {
    match metres {
        1e6.. => format!("{metres:.0e} m"),
        10.0.. => format!("{metres:.0} m"),
        1.0.. => format!("{metres:.1} m"),
        0.1.. => format!("{:.0} mm", 1e3 * metres),
        1e-5.. => format!("{:.2} mm", 1e3 * metres),
        _ => format!("{:.1e} mm", 1e3 * metres),
    }
}
