//! What a map's numbers look like, and which of the usual traps it may have fallen into.
//!
//! In: a [`Frame`]. Out: a [`Summary`] for people. Nothing here changes a map: a trap is a
//! suspicion with the option to try, never a correction.

use depthplanes::{AnyView, DepthView, Measure, Pixel, with_view};

use crate::encoding;
use crate::error::Result;
use crate::frame::{Frame, Pixels};

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
    /// The same in metres, in the same order, where the measure is metric.
    pub range_m: Option<[f64; 3]>,
    /// Number of different valid values.
    pub distinct: usize,
    /// Equal bars from the smallest to the largest value.
    pub histogram: Vec<Bin>,
    /// The frame's warnings, and the traps, each with the option to try.
    pub warnings: Vec<String>,
}

const MOST_PIXELS: usize = 1 << 22;
const QUICK_PIXELS: usize = 1 << 12;

/// Looks at a map; `bins` bars in the histogram.
///
/// # Errors
/// [`crate::Error::Library`] if the frame is not a map the library accepts.
pub fn summary(frame: &Frame, bins: usize) -> Result<Summary> {
    let mut probe = Probe::of(frame, MOST_PIXELS)?;
    probe.valid.sort_by(f64::total_cmp);
    let valid = &probe.valid;
    let range = valid.first().map(|first| [*first, valid[valid.len() / 2], valid[valid.len() - 1]]);
    let (likely, likely_reason) = encoding::likely(&frame.pixels, frame.format, false);
    let mut warnings = frame.warnings.clone();
    for trap in traps(frame, &probe) {
        if !warnings.contains(&trap) {
            warnings.push(trap);
        }
    }
    let distinct = valid.chunk_by(|a, b| a == b).count();
    if distinct > 0 && distinct < 32 && valid.len() > 4096 {
        warnings.push(format!("only {distinct} different values: is this a label image?"));
    }
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
        missing: probe.missing(),
        range,
        range_m: range.and_then(|range| metres(frame, range)),
        distinct,
        histogram: histogram(valid, bins),
        warnings,
    })
}

fn metres(frame: &Frame, range: [f64; 3]) -> Option<[f64; 3]> {
    let depth = |value| frame.sensor.measure.depth_m(value);
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

/// The traps by a few thousand pixels, cheap enough for every frame whose encoding is a guess.
pub(crate) fn quick_traps(frame: &Frame) -> Vec<String> {
    Probe::of(frame, QUICK_PIXELS).map(|probe| traps(frame, &probe)).unwrap_or_default()
}

/// Evenly spaced pixels of a map.
struct Probe {
    pixels: usize,
    valid: Vec<f64>,
    /// Pixels that are 65535.
    all_ones: usize,
    /// Mean step between valid neighbours in a row, as stored and with the bytes swapped; 16-bit only.
    steps: Option<(f64, f64)>,
}

impl Probe {
    fn of(frame: &Frame, most: usize) -> Result<Probe> {
        let stride = ((frame.width * frame.height).div_ceil(most)) | 1; // Odd, so as not to stay in a few columns.
        let mut probe = match frame.view()? {
            AnyView::U16(view) => Probe { steps: steps(view, stride), ..Probe::values(view, stride) },
            view => with_view!(view, view => Probe::values(view, stride)),
        };
        if let Pixels::U16(values) = &frame.pixels {
            probe.all_ones = values.iter().step_by(stride).filter(|&&value| value == u16::MAX).count();
        }
        Ok(probe)
    }

    fn values<T: Pixel>(view: DepthView<'_, T>, stride: usize) -> Probe {
        let valid = view.validity();
        let mut probe = Probe { pixels: 0, valid: Vec::new(), all_ones: 0, steps: None };
        for value in view.rows().flatten().step_by(stride) {
            probe.pixels += 1;
            if valid.holds(*value) {
                probe.valid.push((*value).into());
            }
        }
        probe
    }

    fn missing(&self) -> f64 {
        1.0 - self.valid.len() as f64 / self.pixels.max(1) as f64
    }
}

fn steps(view: DepthView<'_, u16>, stride: usize) -> Option<(f64, f64)> {
    let valid = view.validity();
    let pairs = view.rows().flat_map(|row| row.windows(2)).step_by(stride);
    let (mut count, mut stored, mut swapped) = (0u32, 0.0, 0.0);
    for pair in pairs.filter(|pair| valid.holds(pair[0]) && valid.holds(pair[1])) {
        count += 1;
        stored += f64::from(pair[0].abs_diff(pair[1]));
        swapped += f64::from(pair[0].swap_bytes().abs_diff(pair[1].swap_bytes()));
    }
    (count >= 64).then(|| (stored / f64::from(count), swapped / f64::from(count)))
}

fn traps(frame: &Frame, probe: &Probe) -> Vec<String> {
    let mut found = Vec::new();
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let all_ones = probe.all_ones as f64 / probe.pixels.max(1) as f64;
    let ones_missing = frame.missing == Some(65_535.0) || frame.valid_range.is_some_and(|(_, high)| high < 65_535.0);
    if all_ones > 0.005 && !ones_missing {
        found.push(format!(
            "{} of the pixels are 65535, often the value for missing: try --missing 65535",
            percent(all_ones)
        ));
    }
    if probe.missing() > 0.5 {
        let share = percent(probe.missing());
        found.push(format!("{share} of the pixels are missing: check --missing, --valid-range and --encoding"));
    }
    if probe.valid.len() >= 64 {
        integer_traps(frame, probe, &mut found);
        unit_traps(frame, probe, &mut found);
    }
    found
}

/// Packed bits and bytes.
fn integer_traps(frame: &Frame, probe: &Probe, found: &mut Vec<String>) {
    let Pixels::U16(_) = frame.pixels else {
        return;
    };
    if let Some((stored, swapped)) = probe.steps
        && stored > 256.0
        && swapped * 8.0 < stored
    {
        found.push("neighbours differ far less with their bytes swapped: try --swap-bytes".to_string());
        return;
    }
    let values: Vec<u32> = probe.valid.iter().map(|value| *value as u32).filter(|value| *value != 65_535).collect();
    let largest = values.iter().max().copied().unwrap_or(0);
    if largest < 256 {
        found.push(format!("16 bits but no value above {largest}: grey levels or labels? try --encoding grey"));
        return;
    }
    let mut levels = values.clone();
    levels.sort_unstable();
    levels.dedup();
    if frame.encoding != "millimetre" || levels.len() < 8 {
        return; // The other encodings were stated by someone who knows.
    }
    // Not quite all: player bits and distances above 8 m leave other remainders.
    let multiples = |of: u32| values.iter().filter(|value| value.is_multiple_of(of)).count() * 100 >= values.len() * 95;
    if multiples(8) {
        let packed = "the values are multiples of 8, as Kinect SDK 1 and SUN RGB-D pack them";
        found.push(format!("{packed}: try --encoding kinect-sdk or sun-rgbd"));
    } else if multiples(5) {
        found.push("the values are multiples of 5, as in TUM RGB-D (5000 a metre): try --encoding tum".to_string());
    }
}

/// Metres for millimetres and the other way round.
fn unit_traps(frame: &Frame, probe: &Probe, found: &mut Vec<String>) {
    let Measure::Depth { metres } = frame.sensor.measure else {
        return;
    };
    let mut sorted = probe.valid.clone();
    let middle = sorted.len() / 2;
    let (_, median, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
    let median_m = *median * metres;
    if median_m > 100.0 {
        found.push(format!("the median depth would be {median_m:.0} m: try --encoding millimetre or tum"));
    } else if median_m < 0.05 {
        found.push(format!(
            "the median depth would be {:.1} mm: try --encoding metre, or --disparity",
            1000.0 * median_m
        ));
    }
}
