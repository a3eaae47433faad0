//! Pictures that are no depth maps: those of 8 bits, and those that fill the range of their type.

use depthplanes::ValueKind;

use super::probe::Probe;
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
    // A value for "nothing" lies apart from what is measured.
    let next = probe.valid[..probe.valid.len() - count].last()?;
    let is_whole = match frame.pixels {
        Pixels::U8(_) => return None,
        Pixels::U16(_) => largest > 60_000.0 && *lowest < 6_500.0,
        Pixels::F32(_) => (0.9..=1.0).contains(&largest) && *lowest < 0.1,
    };
    (frame.provenance.is_guess() && is_whole && 1.25 * next > largest && probe.levels().len() > 256).then(|| {
        "the values fill a whole range, as relative depth of a network does: try --encoding inverse-depth if large values are \
         near; if they are far, there are no metres without the unit (--scale)"
            .to_string()
    })
}
