//! Plane selection (paper, section 3d): a group is a plane if it has more than `min` pixels.
//!
//! In: [`Groups`]. Out: the groups that are kept, by decreasing size, and for every run of the map
//! the label of the plane it belongs to.

use crate::error::{Error, Result};
use crate::group::{Groups, Run, SLACK, reserve_to};

/// Most planes that 16-bit labels can name.
pub const MAX_PLANES: usize = u16::MAX as usize;

/// A group that was kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// The group.
    pub group: u32,
    /// Its pixels.
    pub pixel_count: u32,
}

/// The groups that are planes; reuses its memory from map to map.
#[derive(Debug, Default)]
pub struct Selection {
    kept: Vec<Kept>,
    label_of_group: Vec<u16>,
    /// Of run i at i + 1, with room to read beyond the end.
    labels: Vec<u16>,
}

impl Selection {
    /// Keeps the groups with strictly more than `min` pixels.
    ///
    /// # Errors
    /// [`Error::TooManyPlanes`] if there are more than [`MAX_PLANES`]; nothing is selected then.
    pub fn select(&mut self, groups: &Groups, min: u32) -> Result<&[Kept]> {
        self.kept.clear();
        let most_runs = groups.width() * groups.height();
        reserve_to(&mut self.label_of_group, most_runs);
        reserve_to(&mut self.labels, most_runs + SLACK + 1);
        let found = groups.sizes().iter().filter(|&&size| size > min).count();
        if found > MAX_PLANES {
            return Err(Error::TooManyPlanes { found });
        }
        self.kept.reserve(MAX_PLANES);
        let larger = (0u32..).zip(groups.sizes()).filter(|&(_, &size)| size > min);
        self.kept.extend(larger.map(|(group, &pixel_count)| Kept { group, pixel_count }));
        // Groups are counted by first pixel, so equal sizes are ordered by first pixel.
        self.kept.sort_unstable_by_key(|kept| (std::cmp::Reverse(kept.pixel_count), kept.group));
        self.label_runs(groups);
        Ok(&self.kept)
    }

    /// Drops the kept groups that `keep` refuses; it is called in order of label. The others move up.
    pub fn retain(&mut self, groups: &Groups, mut keep: impl FnMut(usize) -> bool) {
        let before = self.kept.len();
        let mut index = 0..;
        self.kept.retain(|_| keep(index.next().expect("an endless range")));
        if self.kept.len() < before {
            self.label_runs(groups);
        }
    }

    fn label_runs(&mut self, groups: &Groups) {
        let labels = &mut self.label_of_group;
        labels.clear();
        labels.resize(groups.count(), 0);
        for (label, kept) in (1..).zip(&self.kept) {
            labels[kept.group as usize] = label;
        }
        self.labels.clear();
        self.labels.push(0);
        self.labels.extend(groups.group_of_run().iter().map(|&group| labels[group as usize]));
        self.labels.resize(1 + groups.run_count() + SLACK, 0);
    }

    /// The kept groups; label 1 is the first.
    pub fn kept(&self) -> &[Kept] {
        &self.kept
    }

    /// For each run of the map in raster order its plane's label, 0 for none.
    pub fn label_of_run(&self) -> &[u16] {
        &self.labels[1..self.labels.len() - SLACK]
    }

    /// Writes the label image, row by row, `width * height`.
    pub fn paint(&self, groups: &Groups, labels: &mut Vec<u16>) {
        labels.resize(groups.width() * groups.height(), 0);
        groups.paint(&self.labels, labels);
    }
}

/// The runs of the kept groups in raster order, each with its plane's label, 1 and up.
pub fn labelled_runs<'a>(groups: &'a Groups, selection: &'a Selection) -> impl Iterator<Item = (Run, u16)> + 'a {
    groups.runs().zip(selection.label_of_run().iter().copied()).filter(|&(_, label)| label > 0)
}
