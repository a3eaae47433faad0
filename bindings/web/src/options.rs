//! Names of options, and what is said of a name that is none.

use crate::error::InputError;
use depthplanes::methods::{METHODS, MethodInfo};

/// What is stated of a map.
pub(crate) const READING: [&str; 19] = [
    "sensor",
    "unit",
    "camera",
    "camera_size",
    "rectified",
    "scale",
    "depth_scale",
    "ray_distance",
    "disparity",
    "focal",
    "baseline",
    "doffs",
    "missing",
    "valid_range",
    "noise_table",
    "swap_bytes",
    "member",
    "raw_size",
    "raw_type",
];

/// How planes are looked for, beside the parameters of the method.
const SEARCH: [&str; 3] = ["method", "curved", "merge_coplanar"];

/// The option of a parameter.
pub(crate) fn of_parameter(name: &str) -> String {
    name.replace('-', "_")
}

/// There is no such option of a detector with that method.
pub(crate) fn unknown_of_detector(name: &str, method: &MethodInfo) -> InputError {
    let own = method.params.iter().map(|param| of_parameter(param.name));
    let accepted: Vec<String> = READING.iter().chain(&SEARCH).map(|&name| name.into()).chain(own).collect();
    let is_of = |other: &&MethodInfo| other.params.iter().any(|param| of_parameter(param.name) == of_parameter(name));
    let others: Vec<&str> = METHODS.iter().copied().filter(is_of).map(|other| other.name).collect();
    let why = match others.is_empty() {
        true => meant(name, &accepted),
        false => format!("the method `{}` has no such parameter, {} has", method.name, others.join(", ")),
    };
    refusal(name, &why, &accepted)
}

/// There is no such option of reading.
pub(crate) fn unknown_of_reading(name: &str) -> InputError {
    let accepted = READING.map(String::from);
    refusal(name, &meant(name, &accepted), &accepted)
}

fn refusal(name: &str, why: &str, accepted: &[String]) -> InputError {
    let why = if why.is_empty() { String::new() } else { format!("; {why}") };
    InputError(format!("there is no option `{name}`{why}; accepted: {}", accepted.join(", ")))
}

/// Asks whether the nearest of the names was meant; nothing if none is near.
fn meant(name: &str, accepted: &[String]) -> String {
    let letters = |name: &str| name.to_lowercase().replace(['_', '-'], "");
    let given = letters(name);
    let away = |other: &String| {
        let other = letters(other);
        // The first letters of a name are as good as one wrong letter.
        if given.len() > 2 && other.starts_with(&given) { 1 } else { edits(&given, &other) }
    };
    let nearest = accepted.iter().min_by_key(|other| away(other)).filter(|other| away(other) <= 1 + given.len() / 4);
    nearest.map_or_else(String::new, |other| format!("did you mean `{other}`?"))
}

/// Letters to insert, delete or replace to make one word of the other: Levenshtein's distance.
fn edits(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (at, letter) in one.chars().enumerate() {
        let mut corner = std::mem::replace(&mut row[0], at + 1);
        for (column, of) in other.iter().enumerate() {
            let replaced = corner + usize::from(letter != *of);
            corner = row[column + 1];
            row[column + 1] = replaced.min(corner + 1).min(row[column] + 1);
        }
    }
    row[other.len()]
}
