//! `depthplanes noise`: how noisy a sensor is, by frames of it.
//!
//! In: maps, as `detect` takes them. Out: the estimate for each and for all together, as a table or as JSON, and the
//! flags that hand it to `detect`.

use crate::args::{Inputs, Reading};
use crate::failure::{Failure, Outcome};
use crate::inputs::Input;
use crate::show::{length, significant};
use crate::table::{Align, aligned, row};
use crate::{inputs, load};
use depthplanes::ValueKind;
use depthplanes::noise::{Estimate, Estimator, SensorNoise};
use depthplanes_io::ReadOptions;
use depthplanes_io::outputs::{NOISE_RANGES_M, noise_record};
use serde_json::json;
use std::io::Write;

pub(super) fn run(wanted: &Inputs, reading: &Reading, as_json: bool, out: &mut dyn Write) -> Outcome {
    let inputs = inputs::expand(&wanted.words, wanted.recursive)?;
    let options = load::options(reading)?;
    let mut together = Estimator::default();
    let mut found = Vec::new();
    for input in &inputs {
        match look(input, &options, &mut together).map_err(|failure| failure.of_input(&input.name())) {
            Ok(estimate) => found.push((input.name(), estimate)),
            Err(failure) if inputs.len() == 1 => return Err(failure),
            Err(failure) => failure.report(),
        }
    }
    let all = together.estimate()?;
    let text = if as_json { record(&found, &all) } else { readable(&found, &all) };
    out.write_all(text.as_bytes())?;
    out.flush()?;
    match inputs.len() - found.len() {
        0 => Ok(()),
        failed => Err(Failure::request(format!("{failed} of {} inputs have no estimate", inputs.len()))),
    }
}

/// One input's own estimate; its blocks go to those of all as well.
fn look(input: &Input, options: &ReadOptions, together: &mut Estimator) -> Outcome<Estimate> {
    let frame = load::frame(input, options)?;
    let mut alone = Estimator::default();
    alone.add(frame.view()?, frame.sensor.value_kind)?;
    let estimate = alone.estimate()?;
    together.add(frame.view()?, frame.sensor.value_kind)?;
    Ok(estimate)
}

fn record(found: &[(String, Estimate)], all: &Estimate) -> String {
    let frame = |(name, estimate): &(String, Estimate)| {
        let mut record = noise_record(estimate);
        record["source"] = json!(name);
        record
    };
    let mut together = noise_record(all);
    together["flags"] = json!(flags(all));
    let record = json!({
        "schema": "depthplanes.noise/1",
        "frames": found.iter().map(frame).collect::<Vec<_>>(),
        "all": together,
    });
    format!("{record:#}\n")
}

fn readable(found: &[(String, Estimate)], all: &Estimate) -> String {
    let mut rows = vec![row(["input", "blocks", "range", "at 1 m", "at 2 m", "at 3 m", "at 4 m", "lateral"])];
    rows.extend(found.iter().map(|(name, estimate)| cells(name, estimate)));
    if found.len() > 1 {
        rows.push(cells("all together", all));
    }
    let mut columns = vec![Align::Right; rows[0].len()];
    columns[0] = Align::Left;
    let what = match all.value_kind {
        ValueKind::Depth { .. } => "depth, found in inverse depth; z is the range in metres",
        ValueKind::InverseDepth { .. } => "the map's values, and of depth",
        ValueKind::Disparity => "the map's values; --focal and --baseline tell what it is in depth",
    };
    let steps = match (all.step, all.value_kind) {
        (0.0, _) => String::new(),
        (step, ValueKind::Depth { metres }) => format!(" Rounding to steps of {} comes on top.", length(step * metres)),
        (step, _) => format!(" Rounding to steps of {} map units comes on top.", significant(step)),
    };
    let mut text = aligned(&columns, &rows);
    text += &format!("\nStandard deviations of {what}: of single pixels, and of what neighbours share.{steps}\n");
    text += &format!("All together: {} and {}.\n", formula(all.noise), formula(all.wide));
    text += &match flags(all) {
        Some(flags) => {
            format!(
                "The flags state the smooth part as means over 16 x 16 pixels have it, edges in the scene included: `detect` needs it so, and finds longer waves by itself.\nTo use it: depthplanes detect {flags}\n"
            )
        }
        None => "There is no noise beside rounding, and nothing to tell `detect`.\n".to_string(),
    };
    text
}

fn cells(name: &str, estimate: &Estimate) -> Vec<String> {
    let (model, smooth) = (estimate.model(), estimate.wide_model());
    let mut cells = row([name, &estimate.blocks.to_string(), &range(estimate)]);
    cells.extend(NOISE_RANGES_M.map(|z| match (model.depth_sigma_m(z), smooth.depth_sigma_m(z)) {
        (Some(white), Some(smooth)) => format!("{:.1} and {:.1} mm", 1e3 * white, 1e3 * smooth),
        _ => "-".to_string(),
    }));
    cells.push(estimate.lateral_noise_px.map_or("-".to_string(), |ray| format!("{ray:.2} px")));
    cells
}

/// What the blocks span: metres, or map units.
fn range(estimate: &Estimate) -> String {
    let [low, high] = estimate.range;
    match estimate.value_kind {
        ValueKind::Depth { .. } => format!("{:.1} to {:.1} m", high.recip(), low.recip()),
        _ => format!("{} to {}", significant(low), significant(high)),
    }
}

/// A part of the noise as a formula.
fn formula(noise: SensorNoise) -> String {
    match noise {
        SensorNoise::Depth { base, growth } => format!("{:.2} + {:.2} z^2 mm", 1e3 * base, 1e3 * growth),
        SensorNoise::Value { sigma } => format!("{} map units", significant(sigma)),
        SensorNoise::Table(_) => "table".into(),
    }
}

/// The flags of `detect` for this noise and ray; `None` if all are what it would expect without them. A part that rounding
/// makes is not told, since `detect` finds the rounding by itself.
fn flags(estimate: &Estimate) -> Option<String> {
    // In full: on clutter the fourth digit may decide whether two pieces are one.
    let flag = |name: &str, value: f64| format!("--{name} {}", (value as f32) + 0.0);
    let mut flags = Vec::new();
    for (part, noise) in [("noise", estimate.beside_rounding), ("smooth-noise", estimate.smooth)] {
        match noise {
            SensorNoise::Depth { base, growth } if base + growth > 1e-9 => {
                flags.extend([flag(part, base), flag(&format!("{part}-growth"), growth)]);
            }
            SensorNoise::Value { sigma } if sigma > 1e-9 => flags.push(flag(part, sigma)),
            _ => (),
        }
    }
    flags.extend(estimate.lateral_noise_px.map(|pixels| flag("lateral-noise", pixels)));
    (!flags.is_empty()).then(|| flags.join(" "))
}
