//! Packed bits and bytes, and numbers that another program scales.

use depthplanes::ValueKind;

use super::probe::{FEW, Probe};
use crate::frame::{Frame, Pixels};

/// Bytes in the wrong order.
pub(super) fn swapped(frame: &Frame, probe: &Probe) -> Option<String> {
    let Pixels::U16(_) = frame.pixels else { return None };
    let mean_step = |of: fn(u16) -> u16| {
        let steps = probe.pairs.iter().map(|[a, b]| f64::from(of(*a as u16).abs_diff(of(*b as u16))));
        steps.sum::<f64>() / probe.pairs.len() as f64
    };
    let (stored, swapped) = (mean_step(|value| value), mean_step(u16::swap_bytes));
    (probe.pairs.len() >= FEW && stored > 256.0 && swapped * 8.0 < stored)
        .then(|| "neighbours differ far less with their bytes swapped: try --swap-bytes".to_string())
}

/// A Kinect's raw disparity, 11 bits with 2047 for nothing, taken for millimetres.
pub(super) fn kinect_raw(frame: &Frame, probe: &Probe) -> Option<String> {
    let (Pixels::U16(_), ValueKind::Depth { .. }) = (&frame.pixels, frame.sensor.value_kind) else { return None };
    let (largest, count) = probe.largest()?;
    let next = probe.valid[..probe.valid.len() - count].last()?;
    let is_raw = largest == 2047.0 && count * 200 > probe.pixels && (300.0..1_200.0).contains(next);
    is_raw.then(|| {
        "values up to 1,100, and 2047 for nothing, are a Kinect's raw disparity: try --preset kinect1-raw, or --encoding \
         kinect-raw"
            .to_string()
    })
}

/// Bits that say which player a pixel is of, in Kinect SDK 1.
const PLAYER_BITS: u16 = 7;

/// 16 bits that are read as Kinect SDK 1 packs them and are not: it has a player in few pixels, so that the lowest three
/// bits of most are 0.
pub(crate) fn not_packed(pixels: &Pixels, encoding: &str) -> Option<String> {
    let Pixels::U16(values) = pixels else { return None };
    if encoding != "kinect-sdk" {
        return None;
    }
    let mut pixels_of = [0usize; PLAYER_BITS as usize + 1];
    for &value in values.iter().filter(|&&value| value != 0) {
        pixels_of[usize::from(value & PLAYER_BITS)] += 1;
    }
    let valid: usize = pixels_of.iter().sum();
    let common = pixels_of.iter().filter(|&&pixels| 20 * pixels >= valid).count();
    (valid >= FEW && common > 6).then(|| {
        "the lowest three bits of the values are everything from 0 to 7, and Kinect SDK 1 keeps the number of a player there: \
         are these plain millimetres? try --encoding millimetre"
            .into()
    })
}

/// 16 bits that hold 8.
pub(super) fn grey_levels(frame: &Frame, probe: &Probe) -> Option<String> {
    let Pixels::U16(_) = frame.pixels else { return None };
    let (largest, _) = probe.largest()?;
    let ValueKind::Depth { metres } = frame.sensor.value_kind else { return None };
    (largest < 256.0 && metres * largest < 0.3 && probe.valid.len() >= FEW).then(|| {
        format!(
            "16 bits but no value above {largest}: centimetres (--scale 100), or grey levels or labels (--encoding grey)?"
        )
    })
}

/// A median from which on millimetres that are multiples of 5, 8 or 10 are rather finer units: few rooms are so deep, and in
/// units of 1/5000 m it is 0.9 m.
const FAR_MM: f64 = 4500.0;

/// Millimetres that are multiples of 257, 8, 10 or 5.
pub(super) fn multiples(frame: &Frame, probe: &Probe) -> Option<String> {
    let is_millimetres = frame.sensor.value_kind == ValueKind::Depth { metres: 0.001 };
    if !probe.is_integer || !is_millimetres || frame.encoding != "millimetre" || probe.levels().len() < 8 {
        return None;
    }
    // Not quite all: player bits and distances above 8 m leave other remainders.
    let multiples_of = |of: f64| {
        let multiples = probe.valid.iter().filter(|value| *value % of == 0.0).count();
        probe.valid.len() >= FEW && multiples * 100 >= probe.valid.len() * 95
    };
    let median = probe.median()?;
    if multiples_of(257.0) {
        let widened = "the values are multiples of 257, as a picture of 8 bits has when it is widened to 16";
        return Some(format!("{widened}: grey levels, not depth? try --encoding grey"));
    }
    // Millimetres in steps of 8 or 10 are multiples as well, but nearer.
    if median < FAR_MM {
        return None;
    }
    if multiples_of(8.0) {
        let packed = "the values are multiples of 8, as Kinect SDK 1 and SUN RGB-D pack them";
        return Some(format!("{packed}: try --encoding kinect-sdk or sun-rgbd"));
    }
    if multiples_of(10.0) {
        let tenths = "the values are multiples of 10, as millimetres in units of 0.1 mm are";
        return Some(format!("{tenths}: try --depth-scale 0.0001, or --encoding tum for 1/5000 m"));
    }
    multiples_of(5.0)
        .then(|| "the values are multiples of 5, as in TUM RGB-D (5000 a metre): try --encoding tum".to_string())
}
