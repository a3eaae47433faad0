//! `depthplanes explain`: why a pixel of a map belongs to a plane or to none.
//!
//! In: one map, as `detect` takes it, and a pixel. Out: what each stage saw there, the verdict and what to change, as
//! lines or as JSON.

use crate::args::Explain;
use crate::failure::{Failure, Outcome};
use crate::inputs::{self, Input};
use crate::load;
use crate::run::Recipe;
use crate::show::significant;
use crate::terminal::plain;
use depthplanes::Explanation;
use depthplanes::explanation::{Finding, Quantity, Suggestion};
use depthplanes::noise::SensorNoise;
use depthplanes_io::memory;
use depthplanes_io::outputs::explanation_record;
use std::io::Write;

pub(super) fn run(wanted: &Explain, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, 1)?;
    let input = only(inputs::expand(std::slice::from_ref(&wanted.input), false)?)?;
    let mut options = load::options(&wanted.reading)?;
    options.noise = load::noise_table(wanted.noise_table.as_deref())?.map(SensorNoise::Table);
    let name = input.name();
    let named = |failure: Failure| failure.of_input(&name);
    let frame = load::frame(&input, &options).map_err(named)?;
    let [used, reserved] = recipe.memory(&frame);
    memory::check(used, reserved).map_err(|error| named(error.into()))?;
    let why = recipe.detector().sensor(frame.sensor).explain(frame.view()?, wanted.at);
    let why = why.map_err(Failure::from).map_err(named)?;
    let text = if wanted.json {
        format!("{:#}\n", explanation_record(&name, recipe.method, &recipe.values, &why))
    } else {
        readable(&name, &why)
    };
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}

fn only(mut inputs: Vec<Input>) -> Outcome<Input> {
    match (inputs.pop(), inputs.len()) {
        (Some(input), 0) => Ok(input),
        (_, others) => Err(Failure::request(format!("`explain` looks at one map; {} were given", others + 1))),
    }
}

/// The findings with the stage in front, then the verdict and what to change.
fn readable(name: &str, why: &Explanation) -> String {
    let [u, v] = why.at;
    let mut text = format!("{}: column {u}, row {v}, by {}\n", plain(name), why.method);
    let has_noise =
        why.findings.iter().flat_map(|finding| &finding.quantities).any(|of| of.unit == "standard deviations");
    if has_noise {
        text += "(sd: standard deviations of the noise expected there; ! refuses)\n";
    }
    let width = why.findings.iter().map(|finding| finding.stage.len()).max().unwrap_or(0);
    let mut last = "";
    for finding in &why.findings {
        let stage = if finding.stage == last { "" } else { finding.stage };
        last = finding.stage;
        let mark = if finding.refuses { '!' } else { ' ' };
        text += &format!("{mark} {stage:<width$}  {}\n", sentence(finding));
    }
    text += &format!("\n{}\n", why.verdict);
    for suggestion in &why.suggestions {
        text += &advice(suggestion);
    }
    text
}

fn sentence(finding: &Finding) -> String {
    let mut parts: Vec<String> = finding.quantities.iter().map(shown).collect();
    if !finding.outcome.is_empty() {
        parts.push(finding.outcome.clone());
    }
    format!("{}: {}", finding.subject, parts.join(", "))
}

fn shown(quantity: &Quantity) -> String {
    let (value, unit) = match quantity.unit {
        // Four digits of a noise would say more than is known.
        "standard deviations" if quantity.value < 1.0 => (format!("{:.2}", quantity.value), " sd"),
        "standard deviations" => (format!("{:.1}", quantity.value), " sd"),
        _ => (significant(quantity.value), quantity.unit),
    };
    let space = if unit.is_empty() || unit.starts_with(' ') { "" } else { " " };
    let unit = format!("{space}{unit}");
    let limit = quantity.limit.map(|limit| {
        let (kind, bound) = limit.words();
        format!(" ({kind} {})", significant(bound))
    });
    format!("{} {value}{unit}{}", quantity.name, limit.unwrap_or_default())
}

fn advice(suggestion: &Suggestion) -> String {
    let flags = suggestion.parameters.iter().map(|(name, value)| format!("--{} {value}", name.replace('_', "-")));
    let flags: Vec<String> = flags.collect();
    let Suggestion { plane_pixels, planes_before, planes_after, .. } = suggestion;
    format!(
        "Try {}: the pixel is then on a plane of {plane_pixels} pixels ({planes_after} planes in the map instead of {planes_before}).\n",
        flags.join(" ")
    )
}
