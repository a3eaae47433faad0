//! Provisional labels for the runs of one row, from where they touch the runs above.
//!
//! In: the row's links and run starts, and the labels of the row above. Out: a label for each run.
//! Only the first pixel of each touching pair of runs matters. A run's first such contact hands it the
//! label above without any search, for until then it has none; the few later ones unite two labels.

use super::kernels::{Isa, SLACK};
use super::strip::{DENSE, Strip};
use super::{forest, reserve_to};

/// What only a row and its neighbours need.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub(super) above: RowLinks,
    pub(super) here: RowLinks,
    pub(super) below: RowLinks,
    /// Last pixels of runs.
    pub(super) ends: Vec<u64>,
    /// First and last column of each run.
    pub(super) columns: [Vec<u16>; 2],
    /// First contacts of runs with those above.
    pub(super) contacts: Vec<u64>,
    /// All other contacts.
    pub(super) later_contacts: Vec<u64>,
    any_later_contacts: bool,
    /// Last pixels of runs without a contact.
    orphans: Vec<u64>,
    any_orphans: bool,
    /// Labels handed down, in order of contacts.
    inherited: Vec<u32>,
}

/// The links of one row, one bit a pixel, and the runs before each word.
#[derive(Debug, Default)]
pub(super) struct RowLinks {
    /// To the left neighbour. One word more than the row has, which stays 0.
    pub(super) left: Vec<u64>,
    /// To the neighbour above.
    pub(super) up: Vec<u64>,
    pub(super) runs_before: Vec<u32>,
}

impl Scratch {
    pub(super) fn prepare(&mut self, width: usize) {
        let words = width.div_ceil(64);
        for row in [&mut self.above, &mut self.here, &mut self.below] {
            row.left.clear();
            row.left.resize(words + 1, 0);
            row.up.resize(words, 0);
            row.runs_before.resize(words, 0);
        }
        for masks in [&mut self.ends, &mut self.contacts, &mut self.later_contacts, &mut self.orphans] {
            masks.resize(words, 0);
        }
        self.columns.iter_mut().for_each(|columns| reserve_to(columns, width + SLACK));
        self.inherited.resize(width + SLACK, 0);
    }

    /// Finds the pixels at which two runs first touch: linked upwards, and without a left neighbour in
    /// the same two runs that is too. Of these the first of each run go to `contacts`, the others to
    /// `later_contacts`; runs without any are marked in `orphans`, at their ends.
    ///
    /// A run's pixels behind its first are a block of ones in `left`. Adding a one to a block carries
    /// through to its end, so the ones that the sum clears lie behind the contact that was added.
    #[inline(always)]
    pub(super) fn find_contacts(&mut self) {
        let words = self.ends.len();
        let (contacts, later) = (&mut self.contacts[..words], &mut self.later_contacts[..words]);
        let (ends, orphans) = (&self.ends[..words], &mut self.orphans[..words]);
        let (up, left, left_above) = (&self.here.up[..words], &self.here.left[..words], &self.above.left[..words]);
        let mut up_left = 0;
        for w in 0..words {
            contacts[w] = up[w] & !((up[w] << 1 | up_left) & left[w] & left_above[w]);
            up_left = up[w] >> 63;
        }
        // A flood reaches into the next word through the pixel there that is linked to the left.
        let (mut reaching, mut any_later, mut any_orphans) = (0, 0, 0);
        for w in 0..words {
            let contact = contacts[w];
            let behind = (contact << 1 | reaching) & left[w];
            let covered = (left[w] & !left[w].wrapping_add(behind)) | behind;
            reaching = (contact | covered) >> 63;
            (contacts[w], later[w]) = (contact & !covered, contact & covered);
            orphans[w] = ends[w] & !(contact | covered);
            any_orphans |= orphans[w];
            any_later |= later[w];
        }
        (self.any_orphans, self.any_later_contacts) = (any_orphans != 0, any_later != 0);
    }
}

/// How the runs of a row hang together with those above.
pub struct Links<'a> {
    /// First contacts.
    pub contacts: &'a [u64],
    /// Last pixels of runs without a contact.
    pub orphans: &'a [u64],
    /// Last pixels of runs.
    pub ends: &'a [u64],
    /// First pixels of the runs above.
    pub starts_above: &'a [u64],
}

/// Where the runs of a row start.
struct Row<'a> {
    starts: &'a [u64],
    /// Runs before each word.
    before: &'a [u32],
}

impl Row<'_> {
    /// The run at the highest of the bits `up_to` of word w: as many as there are run starts up to it.
    #[inline(always)]
    fn run_at(&self, w: usize, up_to: u64) -> usize {
        (self.before[w] + (self.starts[w] & up_to).count_ones() - 1) as usize
    }
}

/// Labels the runs of a row.
#[inline(always)]
pub(super) fn label_runs<I: Isa>(strip: &mut Strip, row: usize) {
    let words = strip.words;
    let (first, end) = (strip.row_first_run[row] as usize, strip.end_run);
    let scratch = &mut strip.scratch;
    let (labels, forest, sizes) = (&mut strip.labels[..], &mut strip.forest, &mut strip.sizes);
    let row_above = row.saturating_sub(1);
    let here = Row { starts: &strip.starts[row * words..][..words], before: &scratch.here.runs_before };
    let above = Row { starts: &strip.starts[row_above * words..][..words], before: &scratch.above.runs_before };
    let new_label = forest.len() as u32;
    let new_labels = if I::HAS_DENSE_LABELS && row > 0 && (end - first) * DENSE > strip.width {
        let (contacts, orphans, ends) = (&scratch.contacts, &scratch.orphans, &scratch.ends);
        let links = Links { contacts, orphans, ends, starts_above: above.starts };
        let (labels_above, labels_here) = labels.split_at_mut(first);
        let labels_above = &labels_above[strip.row_first_run[row_above] as usize - 1..];
        I::dense_labels(&links, labels_above, &mut scratch.inherited, labels_here, new_label)
    } else {
        sparse_labels(scratch, &here, &above, labels, new_label)
    };
    forest.extend(new_label..new_label + new_labels);
    sizes.resize(forest.len(), 0);
    for w in 0..if scratch.any_later_contacts { words } else { 0 } {
        let mut later = scratch.later_contacts[w];
        while let Some(up_to) = next_bit(&mut later) {
            forest::unite(forest, labels[here.run_at(w, up_to)], labels[above.run_at(w, up_to)]);
        }
    }
    let [first_columns, last_columns] = &scratch.columns;
    for (&label, (first, last)) in labels[first..end].iter().zip(first_columns.iter().zip(last_columns)) {
        sizes[label as usize] += u32::from(last - first) + 1;
    }
}

/// Labels runs one by one; how many labels are new.
#[inline(always)]
fn sparse_labels(scratch: &Scratch, here: &Row<'_>, above: &Row<'_>, labels: &mut [u32], new_label: u32) -> u32 {
    let words = here.starts.len();
    for w in 0..words {
        let mut contacts = scratch.contacts[w];
        while let Some(up_to) = next_bit(&mut contacts) {
            labels[here.run_at(w, up_to)] = labels[above.run_at(w, up_to)];
        }
    }
    let mut new_labels = 0;
    for w in 0..if scratch.any_orphans { words } else { 0 } {
        let mut orphans = scratch.orphans[w];
        while let Some(up_to) = next_bit(&mut orphans) {
            // An orphan is marked at its end. A run that reaches into the word ends in it first.
            let ended_before = here.before[w] - (scratch.here.left[w] & 1) as u32;
            let run = ended_before + (scratch.ends[w] & up_to).count_ones() - 1;
            labels[run as usize] = new_label + new_labels;
            new_labels += 1;
        }
    }
    new_labels
}

/// Takes the lowest set bit away; the bits up to and including it.
#[inline(always)]
pub(super) fn next_bit(bits: &mut u64) -> Option<u64> {
    let up_to = *bits ^ bits.wrapping_sub(1);
    let any = *bits != 0;
    *bits &= bits.wrapping_sub(1);
    any.then_some(up_to)
}
