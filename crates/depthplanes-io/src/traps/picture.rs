//! Pictures that are no depth maps: label images, and pictures of 8 bits.

use depthplanes::Measure;

use super::probe::{FEW, Probe, is_small};
use crate::frame::{Frame, Pixels};

/// Few values, each alike over whole regions, that jump at borders: a label image.
pub(super) fn labels(frame: &Frame, probe: &Probe) -> Option<String> {
    let levels = probe.levels();
    // Disparity of whole pixels has few values, too.
    let may_be = matches!(frame.sensor.measure, Measure::Depth { .. }) || frame.encoding == "grey";
    if is_small(frame) || !probe.is_integer || !may_be || !(2..64).contains(&levels.len()) {
        return None;
    }
    let rank = |value: f64| levels.partition_point(|&level| level < value) as i64;
    let changes: Vec<i64> =
        probe.pairs.iter().filter(|[a, b]| a != b).map(|[a, b]| (rank(*a) - rank(*b)).abs()).collect();
    let jumps = changes.iter().filter(|&&levels| levels > 1).count();
    // Surfaces of few levels change by one level at a time; labels of neighbours have nothing to do with each other.
    let is_alike = changes.len() * 5 < probe.pairs.len();
    let is_labels = probe.pairs.len() >= FEW && is_alike && (levels.len() == 2 || jumps * 3 > changes.len());
    is_labels.then(|| {
        let count = levels.len();
        format!(
            "only {count} different values, in regions of one value each: is this a label image or a mask, not depth?"
        )
    })
}

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
    let metres = match frame.sensor.measure {
        Measure::Depth { metres } => metres,
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
    let Measure::Depth { .. } = frame.sensor.measure else { return None };
    let (lowest, (largest, _)) = (probe.valid.first()?, probe.largest()?);
    let is_whole = match frame.pixels {
        Pixels::U8(_) => return None,
        Pixels::U16(_) => largest > 60_000.0 && *lowest < 6_500.0,
        Pixels::F32(_) => (0.9..=1.0).contains(&largest) && *lowest < 0.1,
    };
    (frame.provenance.is_guess() && is_whole && probe.levels().len() > 256).then(|| {
        "the values fill a whole range, as relative depth of a network does: try --encoding inverse-depth if large values are \
         near; if they are far, there are no metres without the unit (--scale)"
            .to_string()
    })
}
