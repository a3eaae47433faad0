//! How many pixels each truth label shares with each predicted one.
//!
//! Sparse and sorted: most of the `planes * planes` pairs share nothing. A pass over the pixels
//! lists runs of equal pairs, which are few in label images; sorting adds them up.

use crate::error::{Error, Result};

/// A truth plane and the predicted plane that stands for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Match {
    /// Label in the truth.
    pub truth: u16,
    /// Label in the prediction.
    pub prediction: u16,
}

/// A label and its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Its value in the label image; 0 = no plane.
    pub label: u16,
    /// Pixels that carry it, at least 1.
    pub pixels: u64,
}

/// A truth region and a predicted one that share pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlap {
    /// The truth region.
    pub truth: Region,
    /// The predicted region.
    pub prediction: Region,
    /// Pixels that carry both labels, at least 1.
    pub pixels: u64,
}

impl Overlap {
    /// Shared pixels as a share (0..=1) of the truth region.
    pub fn share_of_truth(&self) -> f64 {
        self.pixels as f64 / self.truth.pixels as f64
    }

    /// Shared pixels as a share (0..=1) of the predicted region.
    pub fn share_of_prediction(&self) -> f64 {
        self.pixels as f64 / self.prediction.pixels as f64
    }

    /// Intersection over union, 0..=1.
    pub fn iou(&self) -> f64 {
        self.pixels as f64 / (self.truth.pixels + self.prediction.pixels - self.pixels) as f64
    }

    /// Dice coefficient, 0..=1: twice the intersection over the sum of the sizes.
    pub fn dice(&self) -> f64 {
        (2 * self.pixels) as f64 / (self.truth.pixels + self.prediction.pixels) as f64
    }

    /// Whether both regions are planes.
    fn is_of_planes(&self) -> bool {
        self.truth.label != 0 && self.prediction.label != 0
    }
}

/// The table of two label images. Everything in it is sorted by label.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contingency {
    truth: Vec<Region>,
    prediction: Vec<Region>,
    overlaps: Vec<Overlap>,
}

/// A pair of labels (truth, prediction) and how many pixels carry it.
type Count = ((u16, u16), u64);

/// Runs that are listed before they are added up for the first time.
const FIRST_MERGE: usize = 1 << 16;

impl Contingency {
    /// The table of a truth and a prediction, pixel by pixel in the same order.
    ///
    /// # Errors
    /// [`Error::LabelCounts`] if they differ in length.
    pub fn new(truth: &[u16], prediction: &[u16]) -> Result<Self> {
        if truth.len() != prediction.len() {
            return Err(Error::LabelCounts { truth: truth.len(), prediction: prediction.len() });
        }
        Ok(Self::of_pairs(truth.iter().copied().zip(prediction.iter().copied())))
    }

    /// The table of any pixels, each given as (truth label, predicted label): of those that a mask
    /// leaves, for example, or of several frames together.
    pub fn of_pairs(pairs: impl IntoIterator<Item = (u16, u16)>) -> Self {
        let (mut runs, mut limit) = (Vec::<Count>::new(), FIRST_MERGE);
        for pair in pairs {
            match runs.last_mut() {
                Some((last, pixels)) if *last == pair => *pixels += 1,
                _ => runs.push((pair, 1)),
            }
            // Noise makes a run of each pixel; the memory should grow with the distinct pairs only.
            if runs.len() >= limit {
                merge(&mut runs);
                limit = FIRST_MERGE.max(2 * runs.len());
            }
        }
        Self::of_counts(runs)
    }

    fn of_counts(mut counts: Vec<Count>) -> Self {
        merge(&mut counts);
        let truth = sizes(counts.iter().map(|&((truth, _), pixels)| (truth, pixels)));
        let prediction = sizes(counts.iter().map(|&((_, prediction), pixels)| (prediction, pixels)));
        let region = |sizes: &[u64], label: u16| Region { label, pixels: sizes[usize::from(label)] };
        let overlaps = counts.iter().map(|&((t, p), pixels)| Overlap {
            truth: region(&truth, t),
            prediction: region(&prediction, p),
            pixels,
        });
        Contingency { overlaps: overlaps.collect(), truth: regions(&truth), prediction: regions(&prediction) }
    }

    fn counts(&self) -> impl Iterator<Item = Count> {
        self.overlaps.iter().map(|overlap| ((overlap.truth.label, overlap.prediction.label), overlap.pixels))
    }

    /// This table with truth labels below `lowest` taken as "no plane". SegComp's and SynPEB's truth marks shadows
    /// and noise by labels below 10.
    pub fn truth_from(&self, lowest: u16) -> Self {
        let plane = |label| if label < lowest { 0 } else { label };
        Self::of_counts(
            self.counts().map(|((truth, prediction), pixels)| ((plane(truth), prediction), pixels)).collect(),
        )
    }

    /// The table of the pixels that lie on a truth plane, and of no others.
    pub fn on_truth_planes(&self) -> Self {
        Self::of_counts(self.counts().filter(|((truth, _), _)| *truth != 0).collect())
    }

    /// This table with truth and prediction exchanged.
    pub fn swapped(&self) -> Self {
        Self::of_counts(self.counts().map(|((truth, prediction), pixels)| ((prediction, truth), pixels)).collect())
    }

    /// All pixels.
    pub fn pixels(&self) -> u64 {
        self.truth.iter().map(|region| region.pixels).sum()
    }

    /// The truth's regions, "no plane" (0) among them if it occurs.
    pub fn truth(&self) -> &[Region] {
        &self.truth
    }

    /// The prediction's regions, "no plane" (0) among them if it occurs.
    pub fn prediction(&self) -> &[Region] {
        &self.prediction
    }

    /// The truth's planes.
    pub fn truth_planes(&self) -> &[Region] {
        planes(&self.truth)
    }

    /// The prediction's planes.
    pub fn predicted_planes(&self) -> &[Region] {
        planes(&self.prediction)
    }

    /// Regions that share pixels, by truth label, then by predicted label.
    pub fn overlaps(&self) -> &[Overlap] {
        &self.overlaps
    }

    /// Planes that share pixels, in the order of [`Contingency::overlaps`].
    pub fn overlaps_of_planes(&self) -> impl Iterator<Item = &Overlap> {
        self.overlaps.iter().filter(|overlap| overlap.is_of_planes())
    }
}

/// Sorts by labels and adds up equal ones.
fn merge(counts: &mut Vec<Count>) {
    counts.sort_unstable();
    counts.dedup_by(|next, kept| {
        let equal = next.0 == kept.0;
        kept.1 += if equal { next.1 } else { 0 };
        equal
    });
}

/// The pixels of each label up to the largest.
fn sizes(labels: impl Iterator<Item = (u16, u64)>) -> Vec<u64> {
    let mut sizes = Vec::new();
    for (label, pixels) in labels {
        let at = usize::from(label);
        if sizes.len() <= at {
            sizes.resize(at + 1, 0);
        }
        sizes[at] += pixels;
    }
    sizes
}

fn regions(sizes: &[u64]) -> Vec<Region> {
    let listed = (0..=u16::MAX).zip(sizes).map(|(label, &pixels)| Region { label, pixels });
    listed.filter(|region| region.pixels > 0).collect()
}

/// Regions are sorted, so that label 0 comes first.
fn planes(regions: &[Region]) -> &[Region] {
    match regions {
        [Region { label: 0, .. }, planes @ ..] => planes,
        planes => planes,
    }
}
