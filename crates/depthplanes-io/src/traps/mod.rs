//! The usual traps: what a map's numbers look like if they are not what they are taken for.
//!
//! In: a [`Frame`] as it is read. Out: notes, each with the option to try. They are looked for in every map, whatever was
//! stated. A trap is a suspicion and changes nothing; only values that no camera measures are left out, which
//! [`missing::not_measured`] does before.
//!
//! A new trap is a function in one of the files and a row of [`TRAPS`].

mod camera;
mod holes;
mod labels;
pub(crate) mod missing;
pub(crate) mod packing;
mod picture;
mod probe;
mod sentinel;
mod source;
mod unit;

pub(crate) use probe::{Probe, is_small};
pub(crate) use sentinel::EXACTLY;
pub(crate) use unit::{doubt_of_depth, length};

use crate::frame::Frame;

/// A look at a map; a note if it fell into the trap.
type Look = fn(&Frame, &Probe) -> Option<String>;

/// What explains all that is odd about a map, and is told alone: what numbers mean is no question where they are names of
/// regions.
const ALONE: &[Look] = &[labels::labels, packing::kinect_raw];

/// All other traps. Of a row the first that is found is told, since it explains the others.
const TRAPS: &[&[Look]] = &[
    &[missing::negative, sentinel::sentinel, source::sparse, missing::mostly],
    &[source::enlarged, source::enlarged_a_little, holes::interpolated],
    &[
        packing::swapped,
        picture::eight_bits,
        packing::multiples,
        packing::grey_levels,
        picture::whole_range,
        picture::shares,
        unit::median,
    ],
    &[camera::of_disparity],
    &[camera::folds],
];

/// The traps that a map may have fallen into.
pub(crate) fn traps(frame: &Frame) -> Vec<String> {
    let Some(probe) = Probe::some(frame) else { return Vec::new() };
    if let Some(note) = ALONE.iter().find_map(|look| look(frame, &probe)) {
        return vec![note];
    }
    TRAPS.iter().filter_map(|row| row.iter().find_map(|look| look(frame, &probe))).collect()
}
