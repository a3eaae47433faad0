//! Plane selection (paper, section 3d): a group is a plane if it has more than `min-pixels` pixels.
//!
//! In: [`Groups`]. Out: the groups that are kept, by decreasing size, and for every run of the map
//! the label of the plane it belongs to.

use crate::components::{Groups, Run};
use crate::error::{Error, Result};
use crate::limits::MAX_PLANES;
use crate::map::{DepthView, Pixel};
use crate::util::memory::reserve_to;

/// Groups that are looked at together.
const BLOCK: usize = 32;

/// A group that was kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// The group.
    pub group: u32,
    /// Its pixels.
    pub pixel_count: u32,
}

/// A stretch of one row that belongs to a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LabelledRun {
    /// Row.
    pub v: u32,
    /// First column.
    pub u_first: u32,
    /// Last column, inclusive.
    pub u_last: u32,
    /// The plane's label, 1 and up.
    pub label: u16,
}

impl LabelledRun {
    /// Its pixels in the map.
    #[inline(always)]
    pub(crate) fn of<'a, T: Pixel>(&self, map: &DepthView<'a, T>) -> &'a [T] {
        &map.row(self.v as usize)[self.u_first as usize..=self.u_last as usize]
    }
}

/// The groups that are planes; reuses its memory from map to map.
#[derive(Debug, Default)]
pub struct Selection {
    kept: Vec<Kept>,
    label_of_group: Vec<u16>,
    label_of_provisional: Vec<u16>,
    runs: Vec<LabelledRun>,
}

impl Selection {
    /// Keeps the groups with strictly more than `min-pixels` pixels.
    ///
    /// # Errors
    /// [`Error::TooManyPlanes`] if there are more than [`MAX_PLANES`]; nothing is selected then.
    pub fn select(&mut self, groups: &Groups, min_pixels: u32) -> Result<&[Kept]> {
        let most_groups = groups.width() * groups.height();
        reserve_to(&mut self.kept, MAX_PLANES.min(most_groups));
        reserve_to(&mut self.label_of_group, most_groups);
        reserve_to(&mut self.label_of_provisional, most_groups);
        let found = groups.sizes().iter().filter(|&&size| size > min_pixels).count();
        if found > MAX_PLANES {
            self.label_groups(groups);
            return Err(Error::TooManyPlanes { found, raise: "`min-pixels`".to_string() });
        }
        // Most groups of a noisy map are tiny: a block of them is passed over by one test.
        for (first, block) in (0u32..).step_by(BLOCK).zip(groups.sizes().chunks(BLOCK)) {
            if block.iter().fold(false, |any, &size| any | (size > min_pixels)) {
                let larger = (first..).zip(block).filter(|&(_, &size)| size > min_pixels);
                self.kept.extend(larger.map(|(group, &pixel_count)| Kept { group, pixel_count }));
            }
        }
        // Groups are counted by first pixel, so equal sizes are ordered by it.
        self.kept.sort_unstable_by_key(|kept| (std::cmp::Reverse(kept.pixel_count), kept.group));
        self.label_groups(groups);
        Ok(&self.kept)
    }

    /// Drops the kept groups that `keep` refuses; it is called in order of label. The labels of the others move up.
    pub fn retain(&mut self, groups: &Groups, mut keep: impl FnMut(usize) -> bool) {
        let mut index = 0..;
        self.kept.retain(|_| keep(index.next().expect("an endless range")));
        self.label_groups(groups);
    }

    /// Gives the planes other labels, of which several may be the same; 0 drops a plane. [`Selection::kept`] stays as it
    /// is.
    pub fn relabel(&mut self, new: impl Fn(u16) -> u16) {
        let labels = self.label_of_group.iter_mut().filter(|label| **label > 0);
        labels.for_each(|label| *label = new(*label));
    }

    fn label_groups(&mut self, groups: &Groups) {
        self.label_of_group.clear();
        self.label_of_group.resize(groups.count(), 0);
        for (label, kept) in (1..).zip(&self.kept) {
            self.label_of_group[kept.group as usize] = label;
        }
    }

    /// The kept groups; label 1 is the first.
    pub fn kept(&self) -> &[Kept] {
        &self.kept
    }

    /// Writes the label image, row by row, `width * height`.
    pub fn paint(&mut self, groups: &Groups, labels: &mut Vec<u16>) {
        labels.resize(groups.width() * groups.height(), 0);
        groups.paint(&self.label_of_group, &mut self.label_of_provisional, labels);
    }

    /// The runs of the kept groups in raster order, each with its plane's label.
    pub fn runs(&mut self, groups: &Groups) -> &[LabelledRun] {
        let Selection { runs, label_of_group, .. } = self;
        reserve_to(runs, groups.width() * groups.height());
        groups.each_run(|Run { v, u_first, u_last, group }| {
            let label = label_of_group[group as usize];
            if label > 0 {
                runs.push(LabelledRun { v, u_first, u_last, label });
            }
        });
        runs
    }
}
