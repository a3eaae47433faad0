//! What tables, plots and texts read off the rows: what was found, and numbers of it.

use super::super::rows::{Found, Made, Row};

/// What was found, unless the method refused.
pub(in super::super) fn found(row: &Row) -> Option<&Found> {
    match &row.outcome {
        Made::Found(found) => Some(found),
        Made::Refused(_) => None,
    }
}

/// What a method found.
pub(in super::super) fn by<'a>(rows: &[&'a Row], label: &str) -> Vec<(&'a Row, &'a Found)> {
    let own = rows.iter().filter(|row| row.key.label == label);
    own.filter_map(|row| Some((*row, found(row)?))).collect()
}

/// The mean of those that have a value.
pub(in super::super) fn mean(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let known: Vec<f64> = values.flatten().collect();
    (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
}

/// Milliseconds for each million pixels.
pub(super) fn per_megapixel(row: &Row, found: &Found) -> f64 {
    found.median_ms / (row.size[0] * row.size[1]) as f64 * 1e6
}

/// Share of the valid pixels that have a plane.
pub(in super::super) fn share(row: &Row, found: &Found) -> f64 {
    found.labelled_pixels as f64 / row.valid_pixels.max(1) as f64
}
