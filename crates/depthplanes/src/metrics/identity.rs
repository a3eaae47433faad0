//! Whether planes keep their identity over the frames of a sequence whose truth is known.
//!
//! In: for each frame the true surface of every pixel, where it was in the frame before, the labels that were found, and the
//! id of each label. Out: the association measures of EVOPS (Kornilova et al. 2022), matched planes and matched points, and
//! how often a surface gets a new id.

use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

/// A frame of a sequence whose truth is known.
#[derive(Clone, Copy, Debug)]
pub struct IdentityFrame<'a> {
    /// The true surface of each pixel, the same number in all frames; 0 = none.
    pub surfaces: &'a [u32],
    /// For each pixel the one of the frame before that shows the same spot, if one does.
    pub before: &'a [Option<u32>],
    /// The label of each pixel, 0 = none.
    pub labels: &'a [u16],
    /// The ids of labels 1, 2, ..
    pub ids: &'a [u32],
}

/// Share of the smaller of two planes that lies in the other if both are one, and of the union of a surface and its plane.
const SAME: f64 = 0.5;

/// The measures of a sequence, frame by frame.
///
/// Each plane should have the id of the plane of the frame before that it shares most spots with, one to one, the largest
/// number first: by the truth's geometry, not by the picture. Planes of which neither lies mostly in the other are two.
///
/// ```
/// use depthplanes::metrics::{Identity, IdentityFrame};
/// let mut identity = Identity::default();
/// let (surfaces, labels) = ([vec![7; 60], vec![8; 40]].concat(), [vec![1; 60], vec![2; 40]].concat());
/// let before: Vec<Option<u32>> = (0..100).map(Some).collect(); // nothing moves
/// let frame = IdentityFrame { surfaces: &surfaces, before: &before, labels: &labels, ids: &[10, 11] };
/// identity.add(&frame)?;
/// identity.add(&IdentityFrame { ids: &[10, 12], ..frame })?; // the second one lost its id
/// assert_eq!((identity.matched_planes(), identity.matched_points()), (Some(0.5), Some(0.6)));
/// assert_eq!((identity.switches, identity.plane_frames), (1, 2));
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Identity {
    /// Planes that have one in the frame before.
    pub expected_planes: u64,
    /// Pixels of these planes.
    pub expected_points: u64,
    /// Those that have its id.
    pub kept_planes: u64,
    /// Pixels of those.
    pub kept_points: u64,
    /// Surfaces with a plane that had one in some earlier frame, over all frames. A plane is a surface's if they share half of
    /// their union.
    pub plane_frames: u64,
    /// Those whose plane has another id than the one before it, the mismatches of CLEAR MOT (Bernardin and Stiefelhagen 2008).
    pub switches: u64,
    /// Labels and ids of the frame before.
    last: (Vec<u16>, Vec<u32>),
    /// The id that each surface's plane had last.
    id_of_surface: BTreeMap<u32, u32>,
}

impl Identity {
    /// Adds a frame.
    ///
    /// # Errors
    /// [`Error::LabelCounts`] unless there are as many labels as surfaces and pixels before; [`Error::Labels`] for a label
    /// without an id.
    pub fn add(&mut self, frame: &IdentityFrame<'_>) -> Result<()> {
        let IdentityFrame { surfaces, before, labels, ids } = *frame;
        for count in [surfaces.len(), before.len()] {
            if count != labels.len() {
                return Err(Error::LabelCounts { truth: count, prediction: labels.len() });
            }
        }
        if let Some(&given) = labels.iter().find(|&&label| usize::from(label) > ids.len()) {
            return Err(Error::Labels { given: given.into(), pixels: ids.len() });
        }
        self.compare(before, labels, ids);
        self.count_switches(surfaces, labels, ids);
        self.last = (labels.to_vec(), ids.to_vec());
        Ok(())
    }

    fn compare(&mut self, before: &[Option<u32>], labels: &[u16], ids: &[u32]) {
        let (pixels, pixels_before) = (pixels_of(labels, ids.len()), pixels_of(&self.last.0, self.last.1.len()));
        let same_spot = |&at: &Option<u32>| at.and_then(|at| self.last.0.get(at as usize).copied()).unwrap_or(0);
        let pairs = before.iter().map(same_spot).zip(labels.iter().copied());
        let (mut is_taken, mut was_taken) = (BTreeSet::new(), BTreeSet::new());
        for ((was, is), spots) in ranked(pairs) {
            let smaller = pixels[usize::from(is)].min(pixels_before[usize::from(was)]);
            let is_same = spots as f64 >= SAME * smaller as f64;
            if !is_same || is_taken.contains(&is) || was_taken.contains(&was) {
                continue;
            }
            is_taken.insert(is);
            was_taken.insert(was);
            let kept = u64::from(self.last.1[usize::from(was) - 1] == ids[usize::from(is) - 1]);
            let points = pixels[usize::from(is)];
            self.expected_planes += 1;
            self.expected_points += points;
            self.kept_planes += kept;
            self.kept_points += kept * points;
        }
    }

    /// Surfaces and planes correspond if their intersection is at least [`SAME`] of their union: then no two correspond to one.
    fn count_switches(&mut self, surfaces: &[u32], labels: &[u16], ids: &[u32]) {
        let mut of_surface: BTreeMap<u32, u64> = BTreeMap::new();
        surfaces.iter().for_each(|&surface| *of_surface.entry(surface).or_default() += 1);
        let of_label = pixels_of(labels, ids.len());
        for ((surface, label), shared) in ranked(surfaces.iter().copied().zip(labels.iter().copied())) {
            let union = of_surface[&surface] + of_label[usize::from(label)] - shared;
            if (shared as f64) < SAME * union as f64 {
                continue;
            }
            let id = ids[usize::from(label) - 1];
            if let Some(last) = self.id_of_surface.insert(surface, id) {
                self.plane_frames += 1;
                self.switches += u64::from(last != id);
            }
        }
    }

    /// Share (0..=1) of the expected planes that have their id, EVOPS's matched planes; `None` without any.
    pub fn matched_planes(&self) -> Option<f64> {
        (self.expected_planes > 0).then(|| self.kept_planes as f64 / self.expected_planes as f64)
    }

    /// Share (0..=1) of their pixels, EVOPS's matched points; `None` without any.
    pub fn matched_points(&self) -> Option<f64> {
        (self.expected_points > 0).then(|| self.kept_points as f64 / self.expected_points as f64)
    }
}

/// Pixels of labels 0, 1, ..
fn pixels_of(labels: &[u16], planes: usize) -> Vec<u64> {
    let mut pixels = vec![0; planes + 1];
    labels.iter().for_each(|&label| pixels[usize::from(label)] += 1);
    pixels
}

/// The pairs without a 0 in them and how often they occur, those that occur most first.
fn ranked<A: Copy + Ord + Default>(pairs: impl Iterator<Item = (A, u16)>) -> Vec<((A, u16), u64)> {
    let mut counts: BTreeMap<(A, u16), u64> = BTreeMap::new();
    for pair in pairs.filter(|(a, label)| *a != A::default() && *label != 0) {
        *counts.entry(pair).or_default() += 1;
    }
    let mut ranked: Vec<((A, u16), u64)> = counts.into_iter().collect();
    ranked.sort_by_key(|&(pair, count)| (std::cmp::Reverse(count), pair));
    ranked
}
