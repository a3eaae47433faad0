//! An estimate of a sensor's noise as JSON.

use depthplanes::ValueKind;
use depthplanes::noise::{Estimate, SensorNoise};
use serde_json::{Value, json};

/// Ranges that the standard deviation is told at, metres.
pub const NOISE_RANGES_M: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

/// The noise of the frames that an estimate is of, as JSON; docs/noise.md tells the fields.
pub fn noise_record(estimate: &Estimate) -> Value {
    let [model, smooth, wide] = [estimate.model(), estimate.smooth_model(), estimate.wide_model()];
    let at = |z: f64| {
        let [white, smooth, wide] = [&model, &smooth, &wide].map(|part| part.depth_sigma_m(z));
        json!({"range_m": z, "sigma_m": white, "smooth_m": smooth, "wide_m": wide})
    };
    let mut record = json!({
        "space": space(estimate.value_kind),
        "blocks": estimate.blocks,
        "range": estimate.range,
        "step": estimate.step,
        "lateral_noise_px": estimate.lateral_noise_px,
        "depth": NOISE_RANGES_M.map(at),
    });
    for (part, noise) in [("", estimate.noise), ("smooth_", estimate.smooth), ("wide_", estimate.wide)] {
        match noise {
            SensorNoise::Depth { base, growth } => {
                record[format!("{part}base_m")] = json!(base);
                record[format!("{part}growth_per_m")] = json!(growth);
            }
            SensorNoise::Value { sigma } => record[format!("{part}sigma")] = json!(sigma),
            SensorNoise::Table(_) => (),
        }
    }
    record
}

fn space(value_kind: ValueKind) -> &'static str {
    if matches!(value_kind, ValueKind::Depth { .. }) { "inverse_depth" } else { "value" }
}
