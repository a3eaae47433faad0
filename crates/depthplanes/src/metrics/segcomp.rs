//! SegComp: which truth planes are found, and what became of the others.
//!
//! Hoover et al., *An Experimental Comparison of Range Image Segmentation Algorithms*, PAMI 18(7),
//! 1996, section 2.4, with the averages as the authors' program `compare.c` takes them. The paper's
//! machine-segmented region is our predicted plane.
//!
//! f and k of SynPEB (Schaefer et al., *A Maximum Likelihood Approach to Extract Finite Planes from
//! 3-D Laser Scans*, ICRA 2019) follow from the correct ones.

use super::contingency::{Contingency, Match, Overlap};
use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

/// The share of a region that an overlap has to exceed, 0.51..=0.95.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance(f64);

impl Tolerance {
    /// A checked tolerance. Above one half a region has at most one partner that covers enough of
    /// it; the paper's range is that of its plots.
    ///
    /// # Errors
    /// [`Error::Parameter`] below 0.51, above 0.95 and for NaN.
    pub fn new(share: f64) -> Result<Self> {
        if (0.51..=0.95).contains(&share) {
            return Ok(Tolerance(share));
        }
        Err(Error::Parameter { name: "tolerance", given: share, accepted: "a number from 0.51 to 0.95".into() })
    }

    /// The share.
    pub fn share(self) -> f64 {
        self.0
    }
}

impl Default for Tolerance {
    /// 0.8, at which results are commonly reported.
    fn default() -> Self {
        Tolerance(0.8)
    }
}

/// A region of one image and those of the other that make it up.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Split {
    /// The region's label.
    pub whole: u16,
    /// Labels of its parts in the other image, at least two, ascending.
    pub parts: Vec<u16>,
}

/// The classes. Each truth plane is in exactly one of `correct`, `over_segmented`, the parts of
/// `under_segmented` and `missed`; each predicted plane in exactly one of `correct`, the parts of
/// `over_segmented`, `under_segmented` and `noise`. All are sorted by label.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct SegComp {
    /// Truth planes found by one predicted plane.
    pub correct: Vec<Match>,
    /// Truth planes that are cut into several predicted ones.
    pub over_segmented: Vec<Split>,
    /// Predicted planes that join several truth planes.
    pub under_segmented: Vec<Split>,
    /// Truth planes in none of these.
    pub missed: Vec<u16>,
    /// Predicted planes in none of these.
    pub noise: Vec<u16>,
    /// SynPEB's f: correct truth planes as a share (0..=1) of all; `None` without a truth plane.
    pub f: Option<f64>,
    /// SynPEB's k: pixels of the correct truth planes as a share (0..=1) of the pixels of all;
    /// `None` without a truth plane.
    pub k: Option<f64>,
}

/// A split and the average of its metric pair.
type Candidates = BTreeMap<u16, (Split, f64)>;

/// Averages that differ by no more than rounding are equal.
const ROUNDING: f64 = 1e-12;

/// Classifies the planes of both images.
///
/// With O the shared pixels, G a truth plane, M a predicted one and T the tolerance:
/// - correct: O > T |G| and O > T |M|;
/// - over-segmented G: at least two M with O > T |M|, which together cover more than T of G;
/// - under-segmented M: the same the other way round.
///
/// A plane that is in several classes keeps the one whose metric pair has the largest average; equal
/// ones go to `correct`, then to `over_segmented` (our choice).
pub fn segcomp(table: &Contingency, tolerance: Tolerance) -> SegComp {
    let Tolerance(share) = tolerance;
    let mut over = splits(table, share);
    let mut under = splits(&table.swapped(), share);
    let mut correct = Vec::new();
    // Above one half a plane is in two classes only where it is correct: two groups of parts that
    // each cover more than half of it share a part.
    for pair in table.overlaps_of_planes().filter(|o| o.share_of_truth() > share && o.share_of_prediction() > share) {
        let (truth, prediction) = (pair.truth.label, pair.prediction.label);
        let average = (pair.share_of_truth() + pair.share_of_prediction()) / 2.0;
        let of = |candidates: &Candidates, label| candidates.get(&label).map_or(0.0, |(_, average)| *average);
        let kept = first_of_the_largest([average, of(&over, truth), of(&under, prediction)]);
        if kept == 0 {
            correct.push(Match { truth, prediction });
        }
        if kept != 1 {
            over.remove(&truth);
        }
        if kept != 2 {
            under.remove(&prediction);
        }
    }
    let splits = |candidates: Candidates| candidates.into_values().map(|(split, _)| split).collect();
    with_the_rest(table, correct, splits(over), splits(under))
}

/// The truth planes that at least two predicted ones make up, by label.
fn splits(table: &Contingency, tolerance: f64) -> Candidates {
    let planes: Vec<&Overlap> = table.overlaps_of_planes().collect();
    let mut found = Candidates::new();
    for of_one in planes.chunk_by(|a, b| a.truth == b.truth) {
        let parts: Vec<&Overlap> = of_one.iter().copied().filter(|o| o.share_of_prediction() > tolerance).collect();
        let truth = of_one[0].truth;
        let covered = parts.iter().map(|part| part.pixels).sum::<u64>() as f64 / truth.pixels as f64;
        if parts.len() >= 2 && covered > tolerance {
            let mean = parts.iter().map(|part| part.share_of_prediction()).sum::<f64>() / parts.len() as f64;
            let parts = parts.iter().map(|part| part.prediction.label).collect();
            found.insert(truth.label, (Split { whole: truth.label, parts }, (mean + covered) / 2.0));
        }
    }
    found
}

fn first_of_the_largest(averages: [f64; 3]) -> usize {
    let largest = averages.into_iter().fold(0.0, f64::max);
    averages.iter().position(|average| *average >= largest - ROUNDING).expect("the largest is one of them")
}

/// What is in no class is missed or noise.
fn with_the_rest(table: &Contingency, correct: Vec<Match>, over: Vec<Split>, under: Vec<Split>) -> SegComp {
    let whole = |split: &Split| split.whole;
    let parts = |split: &Split| split.parts.clone();
    let mut truth: BTreeSet<u16> = correct.iter().map(|pair| pair.truth).collect();
    let found = truth.clone();
    truth.extend(over.iter().map(whole).chain(under.iter().flat_map(parts)));
    let mut prediction: BTreeSet<u16> = correct.iter().map(|pair| pair.prediction).collect();
    prediction.extend(under.iter().map(whole).chain(over.iter().flat_map(parts)));

    let planes = table.truth_planes();
    let pixels = |of: &dyn Fn(u16) -> bool| -> u64 {
        planes.iter().filter(|region| of(region.label)).map(|region| region.pixels).sum()
    };
    let share = |part: u64, all: u64| (all > 0).then(|| part as f64 / all as f64);
    SegComp {
        missed: planes.iter().map(|region| region.label).filter(|label| !truth.contains(label)).collect(),
        noise: table.predicted_planes().iter().map(|r| r.label).filter(|label| !prediction.contains(label)).collect(),
        f: share(correct.len() as u64, planes.len() as u64),
        k: share(pixels(&|label| found.contains(&label)), pixels(&|_| true)),
        correct,
        over_segmented: over,
        under_segmented: under,
    }
}
