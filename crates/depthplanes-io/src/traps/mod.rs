//! The usual traps: what a map's numbers look like if they are not what they are taken for.
//!
//! In: a [`Frame`] as it is read. Out: notes, each with the option to try. They are looked for in every map, whatever was
//! stated. A trap is a suspicion and changes nothing; only values that no camera measures are left out, which
//! [`missing::not_measured`] does before.
//!
//! A new trap is a function in one of the files and a row of [`TRAPS`].

mod camera;
mod labels;
pub(crate) mod missing;
mod packing;
mod picture;
mod probe;
mod unit;

pub(crate) use probe::{Probe, is_small};
pub(crate) use unit::{doubt_of_depth, length};

use crate::frame::Frame;

/// A look at a map; a note if it fell into the trap.
type Look = fn(&Frame, &Probe) -> Option<String>;

/// All traps. Of a row the first that is found is told, since it explains the others.
const TRAPS: &[&[Look]] = &[
    &[missing::negative, missing::far_clip, missing::mostly],
    &[
        packing::swapped,
        packing::kinect_raw,
        picture::eight_bits,
        packing::multiples,
        packing::grey_levels,
        picture::whole_range,
        unit::median,
    ],
    &[camera::of_disparity],
    &[camera::folds],
];

/// The traps that a map may have fallen into.
pub(crate) fn traps(frame: &Frame) -> Vec<String> {
    let Some(probe) = Probe::some(frame) else { return Vec::new() };
    // What numbers mean is no question where they are names of regions.
    if let Some(note) = labels::labels(frame, &probe) {
        return vec![note];
    }
    TRAPS.iter().filter_map(|row| row.iter().find_map(|look| look(frame, &probe))).collect()
}
