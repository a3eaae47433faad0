//! A row of a method's table of parameters, for sliders.

use depthplanes::methods::{Param, ParamKind};
use serde_json::{Value, json};

/// A parameter as JSON: `name`, `default`, `min`, `max` (`null` for no end), `kind` (`real`, `whole`, `odd`), `unit`, `meaning`,
/// `accepted` (in words).
pub fn parameter_record(of: &Param) -> Value {
    json!({
        "name": of.name,
        "default": of.default,
        "min": of.min,
        "max": (of.max < f64::MAX).then_some(of.max),
        "kind": match of.kind {
            ParamKind::Whole => "whole",
            ParamKind::OddOrOff => "odd",
            _ => "real",
        },
        "unit": of.unit,
        "meaning": of.meaning,
        "accepted": of.accepted(),
    })
}
