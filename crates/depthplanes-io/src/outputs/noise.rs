//! The noise that a method expected, for the record and in words.

use super::output::Report;
use crate::frame::Source;
use depthplanes::noise::SensorNoise;
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct NoiseRecord {
    white: PartRecord,
    smooth: Option<PartRecord>,
    lateral_noise_px: f64,
}

/// One part of the noise. Of depth: base and growth in metres and 1/m, or rows of range and standard deviation in metres;
/// of all else: the standard deviation in map units.
#[derive(Serialize)]
struct PartRecord {
    from: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    base_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    growth_per_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rows_m: Option<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sigma: Option<f64>,
}

impl PartRecord {
    fn new(noise: SensorNoise, from: &'static str) -> Self {
        let none = PartRecord { from, base_m: None, growth_per_m: None, rows_m: None, sigma: None };
        match noise {
            SensorNoise::Depth { base, growth } => {
                PartRecord { base_m: Some(base), growth_per_m: Some(growth), ..none }
            }
            SensorNoise::Value { sigma } => PartRecord { sigma: Some(sigma), ..none },
            SensorNoise::Table(table) => PartRecord { rows_m: Some(table.into()), ..none },
        }
    }
}

impl NoiseRecord {
    pub(super) fn of(report: &Report<'_>) -> Option<Self> {
        let noise = report.detection.noise?;
        let (white, smooth) = origins(report)?;
        Some(NoiseRecord {
            white: PartRecord::new(noise.white, white),
            smooth: noise.smooth.zip(smooth).map(|(noise, from)| PartRecord::new(noise, from)),
            lateral_noise_px: noise.lateral_noise_px,
        })
    }
}

/// Who said what the white and the smooth part are: `estimated` from the map, `stated`, or the `preset`.
fn origins(report: &Report<'_>) -> Option<(&'static str, Option<&'static str>)> {
    let noise = report.detection.noise?;
    let is_parameter = |name: &str| {
        let mut given = report.method.params.iter().zip(report.parameters);
        given.any(|(param, value)| param.name.strip_suffix("-growth").unwrap_or(param.name) == name && *value > 0.0)
    };
    let from = |is_estimated: bool, parameter: &str, source: Option<Source>| match source {
        _ if is_estimated => "estimated",
        Some(Source::Preset) if !is_parameter(parameter) => "preset",
        _ => "stated",
    };
    let frame = &report.frame.provenance;
    let white = from(noise.white_is_estimated, "noise", frame.noise);
    let smooth = noise.smooth.map(|_| from(noise.smooth_is_estimated, "smooth-noise", frame.smooth_noise));
    Some((white, smooth))
}

/// In words: `noise of preset kinect1`; `None` of methods that need none.
pub fn noise_in_words(report: &Report<'_>) -> Option<String> {
    let preset = report.frame.provenance.preset.unwrap_or_default();
    Some(match origins(report)? {
        ("preset", None | Some("preset")) => format!("noise of preset {preset}"),
        ("preset", Some(smooth)) => format!("noise of preset {preset} (smooth part {smooth})"),
        (white, Some("preset")) => format!("noise of preset {preset} (white part {white})"),
        (white, Some(smooth)) if white != smooth => format!("noise {white} (smooth part {smooth})"),
        (white, _) => format!("noise {white}"),
    })
}
