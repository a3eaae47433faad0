//! Names of methods, sets and maps, each once and in the order in which they were asked for.

use super::super::rows::Row;

/// What the methods are called, in the order in which they were asked for.
pub(super) fn labels(rows: &[&Row]) -> Vec<String> {
    in_order(rows.iter().map(|row| row.key.label.as_str()))
}

/// Each name once, where it comes first.
pub(in super::super) fn in_order<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut seen: Vec<String> = Vec::new();
    for name in names {
        if !seen.iter().any(|other| other == name) {
            seen.push(name.to_string());
        }
    }
    seen
}
