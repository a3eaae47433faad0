//! Metres for millimetres and the other way round, wherever the unit comes from.

use depthplanes::ValueKind;

use super::probe::{FEW, Probe};
use crate::frame::Frame;
use crate::presets;

/// Median depths that a camera may have: a close-up, and the far side of a valley.
const USUAL_M: std::ops::RangeInclusive<f64> = 0.05..=100.0;
/// Median depth that no room has, metres. Of recorded frames of rooms, read right, it is 3.4 m at the most.
const FAR_M: f64 = 12.0;
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
        let is_far = median_m > FAR_M && from.is_guess() && frame.encoding == "millimetre" && from.scale.is_none();
        return is_far.then(|| {
            format!(
                "the median depth would be {} in millimetres, farther than rooms are: if this is one, its unit is finer (--scale 4000, \
                 5000 or 10000 units per metre); state --encoding millimetre if it is right",
                length(median_m)
            )
        });
    };
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
        1e-5.. => format!("{:.2} mm", 1e3 * metres),
        _ => format!("{:.1e} mm", 1e3 * metres),
    }
}
