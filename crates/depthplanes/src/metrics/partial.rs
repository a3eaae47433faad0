//! What became of the labelled surfaces of a frame whose truth is partial.
//!
//! In: a table of a truth in which [`UNLABELLED`] pixels are not known, [`NOT_PLANAR`] ones are known to lie on no plane,
//! and every other label is a surface; and which surfaces are one plane in space. Out: a class for each surface, and how
//! many of the pixels that are not planar have a plane.
//!
//! Recorded frames are labelled by hand, and only where a person is sure. [`super::segcomp`] and [`super::evops`]
//! would count planes on what nobody labelled as wrong. Here a predicted plane is compared with labelled pixels only,
//! and planes outside of them cost nothing. It does not tell how good a border is: 80 % of a surface will do.

use super::contingency::{Contingency, Overlap, Region};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::AddAssign;

/// The truth label of pixels that nobody labelled.
pub const UNLABELLED: u16 = 0;

/// The truth label of pixels that are known to lie on no plane.
pub const NOT_PLANAR: u16 = u16::MAX;

/// Percent of a surface that one plane, or its pieces together, have to cover, and percent of a plane that has to lie on
/// it: SegComp's common tolerance.
const MOST: u64 = 80;

/// Percent of a plane that has to lie on a surface for the plane to be a piece of it.
const MAINLY: u64 = 50;

/// Percent of a surface that a plane has to cover to count as a piece: less is a border or a speck.
const PIECE: u64 = 5;

/// What became of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fate {
    /// One plane covers at least 80 % of it, and at least 80 % of that plane's labelled pixels lie on it or on surfaces
    /// that are coplanar with it.
    Correct,
    /// One plane covers at least 80 % of it, but more than 20 % of that plane's labelled pixels lie elsewhere.
    Merged,
    /// No single plane covers 80 % of it, but the planes with at least half of their labelled pixels on it do together.
    Split,
    /// Everything else.
    Missed,
}

/// A labelled surface and what became of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Surface {
    /// Its label and its pixels.
    pub region: Region,
    /// What became of it.
    pub fate: Fate,
    /// Planes that cover at least 5 % of it.
    pub pieces: usize,
}

/// The measures of one frame.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Partial {
    /// The labelled surfaces, by label.
    pub surfaces: Vec<Surface>,
    /// Pixels that are known to lie on no plane.
    pub not_planar: u64,
    /// Those of them that have a plane.
    pub not_planar_covered: u64,
}

impl Partial {
    /// Counts over the surfaces of at least so many pixels.
    pub fn of_at_least(&self, pixels: u64) -> SurfaceCounts {
        let mut counts = SurfaceCounts::default();
        self.surfaces.iter().filter(|surface| surface.region.pixels >= pixels).for_each(|one| counts.count(one));
        counts
    }

    /// Pixels that lie on no plane and have one, as a share (0..=1) of those that lie on none; `None` without such pixels.
    pub fn not_planar_share(&self) -> Option<f64> {
        share(self.not_planar_covered, self.not_planar)
    }
}

/// Surfaces by what became of them. Those of several frames are added up, so that a frame weighs as much as it has surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SurfaceCounts {
    /// All surfaces.
    pub surfaces: u64,
    /// [`Fate::Correct`] ones.
    pub correct: u64,
    /// [`Fate::Merged`] ones.
    pub merged: u64,
    /// [`Fate::Split`] ones.
    pub split: u64,
    /// [`Fate::Missed`] ones.
    pub missed: u64,
    /// Pieces of all surfaces.
    pub pieces: u64,
    /// Pixels of all surfaces.
    pub pixels: u64,
    /// Pixels of the correct surfaces.
    pub correct_pixels: u64,
}

impl SurfaceCounts {
    fn count(&mut self, surface: &Surface) {
        let pixels = surface.region.pixels;
        self.surfaces += 1;
        self.pixels += pixels;
        self.pieces += surface.pieces as u64;
        match surface.fate {
            Fate::Correct => {
                self.correct += 1;
                self.correct_pixels += pixels;
            }
            Fate::Merged => self.merged += 1,
            Fate::Split => self.split += 1,
            Fate::Missed => self.missed += 1,
        }
    }

    /// Correct surfaces as a share (0..=1) of all; `None` without a surface.
    pub fn correct_share(&self) -> Option<f64> {
        share(self.correct, self.surfaces)
    }

    /// Pixels of the correct surfaces as a share (0..=1) of the pixels of all; `None` without a surface.
    pub fn correct_pixel_share(&self) -> Option<f64> {
        share(self.correct_pixels, self.pixels)
    }

    /// Mean number of pieces of a surface; `None` without one.
    pub fn mean_pieces(&self) -> Option<f64> {
        share(self.pieces, self.surfaces)
    }
}

impl AddAssign for SurfaceCounts {
    fn add_assign(&mut self, other: Self) {
        self.surfaces += other.surfaces;
        self.correct += other.correct;
        self.merged += other.merged;
        self.split += other.split;
        self.missed += other.missed;
        self.pieces += other.pieces;
        self.pixels += other.pixels;
        self.correct_pixels += other.correct_pixels;
    }
}

fn share(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

/// Classifies the labelled surfaces of a truth.
///
/// `coplanar` has groups of truth labels that are one plane in space, such as a floor on both sides of a table's leg: a
/// detector may give them one label or several. A label may stand in several groups; labels that do not occur do no harm.
///
/// Only labelled pixels count: those of [`UNLABELLED`] are of no surface and of no plane; those of [`NOT_PLANAR`] are
/// of planes only, so that a plane that runs on over a ball counts as merged.
///
/// ```
/// use depthplanes::metrics::{Contingency, Fate, partial};
/// let truth      = [1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 0, 0, 65535, 65535];
/// let prediction = [7, 7, 7, 7, 0, 3, 3, 4, 4, 4, 7, 4,     5,     0];
/// let found = partial(&Contingency::new(&truth, &prediction)?, &[]);
/// let fates: Vec<Fate> = found.surfaces.iter().map(|surface| surface.fate).collect();
/// assert_eq!(fates, [Fate::Correct, Fate::Split]);
/// assert_eq!(found.not_planar_share(), Some(0.5));
/// # Ok::<(), depthplanes::Error>(())
/// ```
pub fn partial(table: &Contingency, coplanar: &[Vec<u16>]) -> Partial {
    let labelled = table.on_truth_planes();
    let mut planes_on: BTreeMap<u16, Vec<&Overlap>> = BTreeMap::new();
    for overlap in labelled.overlaps_of_planes() {
        planes_on.entry(overlap.truth.label).or_default().push(overlap);
    }
    let on = |label: u16| planes_on.get(&label).map_or(&[][..], |planes| planes);
    let surfaces = labelled.truth_planes().iter().filter(|region| region.label != NOT_PLANAR);
    let surface = |&region: &Region| {
        let planes = on(region.label);
        let fate = fate(region, planes, |plane| {
            let same = coplanar_with(region.label, coplanar);
            same.iter().flat_map(|&label| on(label)).filter(|o| o.prediction.label == plane).map(|o| o.pixels).sum()
        });
        let pieces = planes.iter().filter(|overlap| reaches(overlap.pixels, PIECE, region.pixels)).count();
        Surface { region, fate, pieces }
    };
    Partial {
        surfaces: surfaces.map(surface).collect(),
        not_planar: labelled.truth().iter().filter(|r| r.label == NOT_PLANAR).map(|region| region.pixels).sum(),
        not_planar_covered: on(NOT_PLANAR).iter().map(|overlap| overlap.pixels).sum(),
    }
}

/// What became of a surface by the planes on it; `on_same` tells how many pixels of a plane lie on it or on what is
/// coplanar with it.
fn fate(surface: Region, planes: &[&Overlap], on_same: impl Fn(u16) -> u64) -> Fate {
    // Above one half at most one plane covers so much.
    if let Some(whole) = planes.iter().find(|overlap| reaches(overlap.pixels, MOST, surface.pixels)) {
        let plane = whole.prediction;
        return if reaches(on_same(plane.label), MOST, plane.pixels) { Fate::Correct } else { Fate::Merged };
    }
    // None of them covers enough alone, so that those that do together are at least two.
    let parts = planes.iter().filter(|overlap| reaches(overlap.pixels, MAINLY, overlap.prediction.pixels));
    let covered = parts.map(|overlap| overlap.pixels).sum();
    if reaches(covered, MOST, surface.pixels) { Fate::Split } else { Fate::Missed }
}

/// The label itself and those of its groups, each once, without [`NOT_PLANAR`].
fn coplanar_with(label: u16, groups: &[Vec<u16>]) -> BTreeSet<u16> {
    let own = groups.iter().filter(|group| group.contains(&label)).flatten().copied();
    own.chain([label]).filter(|&label| label != NOT_PLANAR).collect()
}

/// Whether a part is at least so many percent of a whole, exactly.
fn reaches(part: u64, percent: u64, whole: u64) -> bool {
    100 * u128::from(part) >= u128::from(percent) * u128::from(whole)
}
