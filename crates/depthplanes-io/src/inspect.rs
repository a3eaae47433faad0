//! What a map's numbers look like.
//!
//! In: a [`Frame`]. Out: a [`Summary`] for people.

use crate::choice::likely;
use crate::error::Result;
use crate::frame::{Frame, Pixels};
use crate::traps::Probe;

/// One bar of a histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Smallest value, map units.
    pub low: f64,
    /// Largest value; only the last bar includes it.
    pub high: f64,
    /// Valid pixels in between.
    pub count: usize,
}

/// A map at a glance. Counts and statistics are over every pixel of maps up to 4 million pixels
/// and over evenly spaced ones of larger maps.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `u8`, `u16` or `f32`.
    pub pixel_type: &'static str,
    /// Name of the format.
    pub format: &'static str,
    /// Name of the encoding in use.
    pub encoding: &'static str,
    /// Name of the encoding that would be assumed without a word from the user.
    pub likely_encoding: &'static str,
    /// Why.
    pub likely_reason: String,
    /// Pixels looked at.
    pub pixels: usize,
    /// Share of them without a measurement, 0 to 1.
    pub missing: f64,
    /// Smallest, middle and largest valid value, map units; `None` if all are missing.
    pub range: Option<[f64; 3]>,
    /// The same in metres, in the same order, where the value kind is metric.
    pub range_m: Option<[f64; 3]>,
    /// Number of different valid values.
    pub distinct: usize,
    /// Equal bars from the smallest to the largest value.
    pub histogram: Vec<Bin>,
    /// The frame's warnings, and the traps, each with the option to try.
    pub warnings: Vec<String>,
}

const MOST_PIXELS: usize = 1 << 22;

/// Looks at a map; `bins` bars in the histogram.
///
/// # Errors
/// [`crate::Error::Library`] if the frame is not a map the library accepts.
pub fn summary(frame: &Frame, bins: usize) -> Result<Summary> {
    let probe = Probe::of(frame, MOST_PIXELS)?;
    let valid = &probe.valid;
    let range = valid.first().map(|first| [*first, valid[valid.len() / 2], valid[valid.len() - 1]]);
    let (likely, likely_reason) = likely(&frame.pixels, frame.width, frame.format, false);
    let warnings = frame.warnings.clone();
    let distinct = valid.chunk_by(|a, b| a == b).count();
    Ok(Summary {
        width: frame.width,
        height: frame.height,
        pixel_type: match &frame.pixels {
            Pixels::U8(_) => "u8",
            Pixels::U16(_) => "u16",
            Pixels::F32(_) => "f32",
        },
        format: frame.format,
        encoding: frame.encoding,
        likely_encoding: likely.name,
        likely_reason,
        pixels: probe.pixels,
        missing: probe.missing_share(),
        range,
        range_m: range.and_then(|range| metres(frame, range)),
        distinct,
        histogram: histogram(valid, bins),
        warnings,
    })
}

fn metres(frame: &Frame, range: [f64; 3]) -> Option<[f64; 3]> {
    let depth = |value| frame.sensor.value_kind.depth_m(value);
    Some([depth(range[0])?, depth(range[1])?, depth(range[2])?])
}

/// Equal bars over sorted values.
fn histogram(sorted: &[f64], bins: usize) -> Vec<Bin> {
    let (Some(&low), Some(&high), 1..) = (sorted.first(), sorted.last(), bins) else {
        return Vec::new();
    };
    let edge = |bin: usize| low + (high - low) * (bin as f64 / bins as f64);
    let below =
        |bin: usize| if bin == bins { sorted.len() } else { sorted.partition_point(|&value| value < edge(bin)) };
    (0..bins).map(|bin| Bin { low: edge(bin), high: edge(bin + 1), count: below(bin + 1) - below(bin) }).collect()
}
