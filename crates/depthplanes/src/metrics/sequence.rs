//! How steady the planes of a sequence of frames are.
//!
//! In: label images of one size, frame after frame of a camera that moves little from one to the next. Out: how well
//! each large plane of a frame is found again in the next, and how the number of planes varies. No truth is needed,
//! so that any recording will do; but what is steadily wrong, such as a single plane for all pixels, is steady as
//! well, and a fast camera lowers the overlaps of a perfect detector too. Compare figures of the same recording only.

use super::contingency::Contingency;
use super::evops::IOU_FULL;
use crate::error::Result;

/// Pixels from which a plane is looked for in the next frame; smaller ones come and go with the noise and with what the
/// camera sees, and their borders are a large part of them.
pub const STEADY_PIXELS: u64 = 5000;

/// What became of a frame's large planes in the next frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NextFrame {
    /// For each plane of at least [`STEADY_PIXELS`] pixels its label and its best intersection over union (0..=1) with a
    /// plane of the next frame, 0 where there is none; by label.
    pub best_iou: Vec<(u16, f64)>,
    /// Planes of any size, in the frame and in the next one.
    pub planes: [usize; 2],
}

/// What became of a frame's planes: the table has the frame in the truth's place and the next one in the prediction's.
///
/// ```
/// use depthplanes::metrics::{Contingency, next_frame};
/// let frame = [[1; 6000], [2; 6000]].concat();
/// let next = [[8; 6000], [9; 6000]].concat();
/// let found = next_frame(&Contingency::new(&frame, &next)?);
/// assert_eq!((found.best_iou, found.planes), (vec![(1, 1.0), (2, 1.0)], [2, 2]));
/// # Ok::<(), depthplanes::Error>(())
/// ```
pub fn next_frame(table: &Contingency) -> NextFrame {
    let large = table.truth_planes().iter().filter(|region| region.pixels >= STEADY_PIXELS);
    let best = |label: u16| {
        let own = table.overlaps_of_planes().filter(|overlap| overlap.truth.label == label);
        own.map(|overlap| overlap.iou()).fold(0.0, f64::max)
    };
    NextFrame {
        best_iou: large.map(|region| (region.label, best(region.label))).collect(),
        planes: [table.truth_planes().len(), table.predicted_planes().len()],
    }
}

/// The measures of a sequence, frame by frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sequence {
    /// What became of the planes of each frame that has a next one.
    pub pairs: Vec<NextFrame>,
    /// Planes of any size of each frame.
    pub planes: Vec<usize>,
    last: Option<Vec<u16>>,
}

impl Sequence {
    /// Adds the next frame's labels, 0 = no plane, row by row.
    ///
    /// # Errors
    /// [`crate::Error::LabelCounts`] if the frame before had another number of pixels.
    pub fn add(&mut self, labels: Vec<u16>) -> Result<()> {
        if let Some(before) = &self.last {
            self.pairs.push(next_frame(&Contingency::new(before, &labels)?));
        }
        self.planes.push(Contingency::new(&labels, &labels)?.truth_planes().len());
        self.last = Some(labels);
        Ok(())
    }

    /// Marks the next frame as absent: the one after it is compared with none.
    pub fn skip(&mut self) {
        self.last = None;
    }

    /// Large planes of all frames that have a next one.
    pub fn large_planes(&self) -> usize {
        self.pairs.iter().map(|pair| pair.best_iou.len()).sum()
    }

    /// Mean of the best intersections over union of all large planes, 0..=1; `None` without such a plane.
    pub fn mean_iou(&self) -> Option<f64> {
        self.mean_of_planes(|iou| iou)
    }

    /// Large planes whose best intersection over union is above 0.75, as a share (0..=1); `None` without such a plane.
    pub fn kept_share(&self) -> Option<f64> {
        self.mean_of_planes(|iou| f64::from(u8::from(iou > IOU_FULL)))
    }

    /// Mean number of planes of any size, over all frames; `None` without a frame.
    pub fn mean_planes(&self) -> Option<f64> {
        mean(self.planes.iter().map(|&planes| planes as f64))
    }

    /// Standard deviation of the change of the number of planes from a frame to the next; `None` without a pair.
    pub fn change_of_planes(&self) -> Option<f64> {
        let changes = || self.pairs.iter().map(|pair| pair.planes[1] as f64 - pair.planes[0] as f64);
        let middle = mean(changes())?;
        Some(mean(changes().map(|change| (change - middle).powi(2)))?.sqrt())
    }

    fn mean_of_planes(&self, value: impl Fn(f64) -> f64) -> Option<f64> {
        mean(self.pairs.iter().flat_map(|pair| &pair.best_iou).map(|&(_, iou)| value(iou)))
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0u64, 0.0), |(count, sum), value| (count + 1, sum + value));
    (count > 0).then(|| sum / count as f64)
}
