//! Pictures that are no depth maps: those of 8 bits, and those that fill the range of their type.

use depthplanes::ValueKind;

use super::probe::{Probe, is_small};
use crate::frame::{Frame, Pixels};

/// Grey levels.
pub(super) fn eight_bits(frame: &Frame, _: &Probe) -> Option<String> {
    let is_guess = frame.encoding == "grey" && frame.provenance.is_guess();
    if is_guess && matches!(frame.pixels, Pixels::U8(_)) {
        return Some(
            "8 bits a pixel: a picture to look at, a photograph or a label image rather than depth? It is read as grey \
             levels, without metres; state --encoding if it is depth or disparity"
                .into(),
        );
    }
    let metres = match frame.sensor.value_kind {
        ValueKind::Depth { metres } => metres,
        _ => return None,
    };
    let is_coarse = matches!(frame.pixels, Pixels::U8(_)) && metres * 255.0 < 0.3;
    is_coarse.then(|| {
        let most = metres * 255.0;
        format!("8 bits of {metres} m reach {most:.3} m only: try --scale (units per metre), or --encoding grey")
    })
}

/// Values over the whole range of a type, as programs make that scale relative depth for a picture.
pub(super) fn whole_range(frame: &Frame, probe: &Probe) -> Option<String> {
    let ValueKind::Depth { .. } = frame.sensor.value_kind else { return None };
    let (lowest, (largest, count)) = (probe.valid.first()?, probe.largest()?);
    // A value for "nothing" lies apart from what is measured, and stray values are few.
    let next = probe.valid[..probe.valid.len() - count].last()?;
    let is_whole = match &frame.pixels {
        Pixels::U8(_) => return None,
        Pixels::U16(values) => {
            let is_high = probe.valid[probe.valid.len() * 49 / 50] > 30_000.0;
            is_high && *lowest < 6_500.0 && values.iter().any(|&value| value > 60_000)
        }
        Pixels::F32(_) => (0.9..=1.0).contains(&largest) && *lowest < 0.1,
    };
    (frame.provenance.is_guess() && is_whole && 1.25 * next > largest && probe.levels().len() > 64).then(|| {
        "the values fill a whole range, as relative depth of a network does: try --encoding inverse-depth or --disparity if large \
         values are near; if they are far, there are no metres without the unit (--scale)"
            .to_string()
    })
}

/// Floats from 0 to 1 that nobody said to be metres: depth as a share of something, or a renderer's depth buffer.
pub(super) fn shares(frame: &Frame, probe: &Probe) -> Option<String> {
    let Pixels::F32(_) = frame.pixels else { return None };
    let (lowest, (largest, _)) = (probe.valid.first()?, probe.largest()?);
    let is_metres = frame.sensor.value_kind == ValueKind::Depth { metres: 1.0 };
    if !frame.provenance.is_guess() || !is_metres || frame.provenance.scale.is_some() || frame.format == "pcd" {
        return None;
    }
    let what = match probe.valid[probe.valid.len() / 50] {
        _ if is_small(frame) || !(0.9..=1.0).contains(&largest) => return None,
        0.8.. => "a renderer's depth buffer? turn it into depth first, z = near far / (far - value (far - near))",
        _ => {
            "a share of the largest depth, or inverse depth (--encoding inverse-depth)? Of a share, --scale states map units \
             per metre: 1 / the largest depth in metres"
        }
    };
    Some(format!(
        "all values lie from {lowest:.3} to {largest:.3}: read as metres that is nearer than most depth cameras see; {what}; \
         state --encoding metre if it is right"
    ))
}
