//! Lines of a name and what is behind it, as many tools print them: `name: value`, `name = value`, `name,value`.

use super::names::{plain, words};

/// A line's name, without case and signs, and what stands behind it.
pub(super) fn pairs(text: &str) -> impl Iterator<Item = (String, &str)> {
    text.lines().filter_map(|line| {
        let at = line.find([':', '=', ','])?;
        Some((plain(&line[..at]), line[at + 1..].trim()))
    })
}

/// The number behind the first line of that name.
pub(super) fn number(text: &str, name: &str) -> Option<f64> {
    pairs(text).find(|(key, _)| key == name).and_then(|(_, value)| match words(value)?[..] {
        [number] => Some(number),
        _ => None,
    })
}

/// The numbers behind the first line of that name.
pub(super) fn numbers(text: &str, name: &str) -> Option<Vec<f64>> {
    pairs(text).find(|(key, _)| key == name).and_then(|(_, value)| words(value))
}
