//! `depthplanes inspect`: what is in a file, and how it could be read.

use super::next;
use crate::args::{Inputs, Reading};
use crate::failure::{Failure, Outcome};
use crate::run::{Recipe, Runner};
use crate::terminal::plain;
use crate::{inputs, load};
use depthplanes::methods;
use depthplanes_io::inspect::{Summary, summary};
use depthplanes_io::outputs::Report;
use depthplanes_io::{Frame, ReadOptions, doubts};
use serde_json::json;
use std::io::Write;

/// Bars of the histogram.
const BARS: usize = 16;
/// Longest bar, characters.
const BAR_WIDTH: usize = 40;

pub(super) fn run(wanted: &Inputs, reading: &Reading, as_json: bool, out: &mut dyn Write) -> Outcome {
    let inputs = inputs::expand(&wanted.words, wanted.recursive)?;
    let options = load::options(reading)?;
    let mut failed = 0;
    for input in &inputs {
        match look(input, &options).map_err(|failure| failure.of_input(&input.name())) {
            Ok((_, seen)) if as_json => writeln!(out, "{}", record(&input.name(), &seen))?,
            Ok((frame, seen)) => out.write_all(readable(&input.name(), &frame, &seen, reading).as_bytes())?,
            Err(failure) if inputs.len() == 1 => return Err(failure),
            Err(failure) => {
                out.flush()?;
                failure.report();
                failed += 1;
            }
        }
    }
    match failed {
        0 => Ok(()),
        _ => Err(Failure::request(format!("{failed} of {} inputs could not be read", inputs.len()))),
    }
}

fn look(input: &inputs::Input, options: &ReadOptions) -> Outcome<(Frame, Summary)> {
    let frame = load::frame(input, options)?;
    let mut seen = summary(&frame, BARS)?;
    if frame.format != "scene" {
        seen.warnings.extend(doubts_of_planes(&frame)?);
    }
    Ok((frame, seen))
}

/// What planes found with the defaults say of how the frame is read.
fn doubts_of_planes(frame: &Frame) -> Outcome<Vec<String>> {
    let recipe = Recipe::new(methods::default(), &[], 1)?;
    let found = Runner::new(&recipe).detect(frame, 0)?;
    Ok(doubts(&Report::new("", frame, recipe.method, &recipe.values, &found.detection)))
}

fn record(name: &str, seen: &Summary) -> serde_json::Value {
    let bar = |bin: &depthplanes_io::inspect::Bin| json!({"low": bin.low, "high": bin.high, "count": bin.count});
    json!({
        "schema": "depthplanes.inspect/1",
        "source": name,
        "width": seen.width,
        "height": seen.height,
        "pixel_type": seen.pixel_type,
        "format": seen.format,
        "encoding": seen.encoding,
        "likely_encoding": seen.likely_encoding,
        "likely_reason": seen.likely_reason,
        "missing_share": seen.missing,
        "range": seen.range,
        "range_m": seen.range_m,
        "distinct": seen.distinct,
        "histogram": seen.histogram.iter().map(bar).collect::<Vec<_>>(),
        "warnings": seen.warnings,
    })
}

fn readable(name: &str, frame: &Frame, seen: &Summary, reading: &Reading) -> String {
    let mut text = format!("{}\n", plain(name));
    let mut line = |what: &str, value: String| text += &format!("  {what:<10} {value}\n");
    line("map", format!("{} x {}, {}, format {}", seen.width, seen.height, seen.pixel_type, seen.format));
    line("encoding", encoding(seen));
    if let Some(camera) = frame.sensor.intrinsics {
        line("camera", format!("fx {}, fy {}, cx {}, cy {}", camera.fx, camera.fy, camera.cx, camera.cy));
        if let Some(lens) = frame.sensor.distortion {
            let coefficients: Vec<String> = lens.coefficients().iter().map(f64::to_string).collect();
            let given = coefficients.iter().rposition(|k| k != "0").map_or(0, |last| last + 1);
            line("lens", format!("{} {}", lens.model().name(), coefficients[..given].join(" ")));
        }
    }
    line("missing", format!("{:.1} % of the pixels", 100.0 * seen.missing));
    match seen.range {
        Some([low, middle, high]) => {
            line("values", format!("{low} to {high}, median {middle}, {} different", seen.distinct))
        }
        None => line("values", "no pixel is valid".into()),
    }
    if let Some([low, middle, high]) = seen.range_m {
        line("depth", format!("{low:.3} m to {high:.3} m, median {middle:.3} m"));
    }
    text += &histogram(seen);
    for warning in &seen.warnings {
        text += &format!("  note: {}\n", plain(warning));
    }
    for (i, line) in next::lines(name, frame, seen, reading).iter().enumerate() {
        text += &format!("  {:<10} {line}\n", if i == 0 { "type next" } else { "" });
    }
    text + "\n"
}

fn encoding(seen: &Summary) -> String {
    if seen.encoding == seen.likely_encoding {
        format!("{} ({})", seen.encoding, seen.likely_reason)
    } else {
        format!("{}; by itself it would be taken for {} ({})", seen.encoding, seen.likely_encoding, seen.likely_reason)
    }
}

/// One bar a line: the lowest value, the bar, its share of the valid pixels.
fn histogram(seen: &Summary) -> String {
    let most = seen.histogram.iter().map(|bin| bin.count).max().unwrap_or(0);
    let all: usize = seen.histogram.iter().map(|bin| bin.count).sum();
    if most == 0 || seen.distinct < 2 {
        return String::new();
    }
    let lows: Vec<String> = seen.histogram.iter().map(|bin| edge(bin.low, bin.high - bin.low)).collect();
    let width = lows.iter().map(String::len).max().unwrap_or(0);
    let mut text = String::new();
    for (bin, low) in seen.histogram.iter().zip(lows) {
        let bar = "#".repeat((bin.count * BAR_WIDTH).div_ceil(most));
        let share = 100.0 * bin.count as f64 / all as f64;
        text += &format!("  {low:>width$} | {bar:<BAR_WIDTH$} {share:5.1} %\n");
    }
    text
}

/// A bar's edge with as many digits as its width asks for.
fn edge(value: f64, width: f64) -> String {
    let digits = (1 - width.log10().floor() as i32).clamp(0, 9) as usize;
    format!("{value:.digits$}")
}
