//! An explanation as JSON.

use depthplanes::Explanation;
use depthplanes::explanation::{Finding, Quantity, Suggestion};
use depthplanes::methods::MethodInfo;
use serde_json::{Map, Value, json};

/// Why a pixel of one input has a plane or none, as JSON, `depthplanes.explain/1`. `source` is what the input is called,
/// `values` has one for each parameter of the method.
pub fn explanation_record(source: &str, method: &MethodInfo, values: &[f64], why: &Explanation) -> Value {
    let parameters = method.params.iter().zip(values);
    let parameters: Map<String, Value> = parameters.map(|(param, value)| (param.name.into(), json!(value))).collect();
    json!({
        "schema": "depthplanes.explain/1",
        "source": source,
        "method": why.method,
        "parameters": parameters,
        "at": why.at,
        "findings": why.findings.iter().map(finding_record).collect::<Vec<_>>(),
        "verdict": {"kind": why.verdict.kind(), "text": why.verdict.to_string()},
        "suggestions": why.suggestions.iter().map(suggestion_record).collect::<Vec<_>>(),
    })
}

fn finding_record(finding: &Finding) -> Value {
    json!({
        "stage": finding.stage,
        "subject": finding.subject,
        "quantities": finding.quantities.iter().map(quantity_record).collect::<Vec<_>>(),
        "outcome": finding.outcome,
        "refuses": finding.refuses,
    })
}

fn quantity_record(quantity: &Quantity) -> Value {
    let mut record = json!({"name": quantity.name, "value": quantity.value, "unit": quantity.unit});
    if let Some(limit) = quantity.limit {
        let (kind, bound) = limit.words();
        record["limit"] = json!({"kind": kind.replace(' ', "_"), "value": bound, "holds": limit.holds(quantity.value)});
    }
    record
}

fn suggestion_record(suggestion: &Suggestion) -> Value {
    let parameters: Map<String, Value> =
        suggestion.parameters.iter().map(|&(name, value)| (name.to_string(), json!(value))).collect();
    json!({
        "parameters": parameters,
        "plane_pixels": suggestion.plane_pixels,
        "planes_before": suggestion.planes_before,
        "planes_after": suggestion.planes_after,
    })
}
