//! Results that nobody should take for granted: what the planes say of how the map was read.
//!
//! In: a [`Report`]. Out: notes, each with the flag to try. What can be seen before is a trap ([`crate::traps`]).

mod planes;
mod reading;
mod steps;

use crate::outputs::Report;

/// What a person should know of a result.
pub fn doubts(report: &Report<'_>) -> Vec<String> {
    // Of few values any reading makes planes.
    let reading = steps::coarse(report).or_else(|| reading::better(report)).or_else(|| reading::grows_below(report));
    [planes::out_of_sight(report), planes::huge(report), planes::scattered(report), reading]
        .into_iter()
        .flatten()
        .collect()
}
