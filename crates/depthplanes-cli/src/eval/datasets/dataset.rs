//! What a set of maps is: the row that names it, its maps and their truths, each loaded when it is needed.

use crate::failure::Outcome;
use depthplanes_io::{Frame, LabelImage};
use std::path::Path;

/// One row of [`DATASETS`](super::DATASETS).
pub(crate) struct Dataset {
    /// Its name on the command line.
    pub(crate) name: &'static str,
    /// One sentence: what it is, and where it is had.
    pub(crate) about: &'static str,
    /// Its usual folder within a folder of sets.
    pub(crate) folder: &'static str,
    /// How its folder has to look.
    pub(crate) layout: &'static str,
    /// Its maps.
    pub(crate) items: fn(&Path) -> Outcome<Vec<Item>>,
}

/// Loads something when it is needed.
pub(crate) type Load<T> = Box<dyn Fn() -> Outcome<T> + Send + Sync>;

/// A map of a set.
pub(crate) struct Item {
    /// The set's name.
    pub(crate) dataset: String,
    /// The map's name within it.
    pub(crate) name: String,
    pub(crate) frame: Load<Frame>,
    pub(crate) truth: Option<Load<TruthOf>>,
    /// Whether the maps of its set are frames of one recording in their order.
    pub(crate) is_sequence: bool,
}

/// The truth of a map.
pub(crate) struct TruthOf {
    pub(crate) labels: LabelImage,
    /// The lowest label that is a plane; lower ones are noise.
    pub(crate) from: u16,
    /// Where the planes are in space, if that is known.
    pub(crate) planes: Vec<depthplanes::scene::TruthPlane>,
    /// Where only some surfaces are labelled: groups of labels that are one plane. Measures that take what is not
    /// labelled for "no plane" make no sense then.
    pub(crate) partial: Option<Vec<Vec<u16>>>,
}
