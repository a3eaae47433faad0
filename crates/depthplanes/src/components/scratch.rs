//! The masks of a block of rows while its runs are found and labelled.

use super::isa::{Isa, SLACK};
use crate::util::memory::reserve_to;

/// What only a block of rows and its neighbours need, one bit a pixel.
///
/// `left`, `up` and `contacts` begin with the row above the block and end with the one below; the
/// others have the block's rows only.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Links to the left neighbour.
    pub(super) left: Vec<u64>,
    /// Links to the neighbour above.
    pub(super) up: Vec<u64>,
    /// Pixels at which two runs first touch.
    pub(super) contacts: Vec<u64>,
    /// Pixels behind contacts that are linked to them.
    behind: Vec<u64>,
    /// Last pixels of runs.
    pub(super) ends: Vec<u64>,
    /// Last pixels of runs without a contact.
    pub(super) orphans: Vec<u64>,
    /// One pixel of each run: its first contact, or its end if it has none.
    pub(super) marks: Vec<u64>,
    /// First and last column of each run of a dense row.
    pub(super) columns: [Vec<u16>; 2],
    /// Labels inherited in a dense row, in order of contacts.
    pub(super) inherited: Vec<u32>,
}

impl Scratch {
    pub(super) fn prepare(&mut self, width: usize, block_words: usize) {
        let words = width.div_ceil(64);
        for masks in [&mut self.left, &mut self.up, &mut self.contacts] {
            masks.clear();
            masks.resize(block_words + 2 * words, 0);
        }
        for masks in [&mut self.behind, &mut self.ends, &mut self.orphans, &mut self.marks] {
            masks.resize(block_words, 0);
        }
        self.columns.iter_mut().for_each(|columns| reserve_to(columns, width + SLACK));
        self.inherited.resize(width + SLACK, 0);
    }

    /// Finds the pixels at which two runs first touch: those linked upwards whose left neighbour is not linked
    /// upwards within the same two runs. Of these the first of each run is marked; runs without any are marked at
    /// their ends, as orphans.
    ///
    /// A run's pixels after its first are a block of ones in `left`. Adding a one to a block carries through to its
    /// end, so the ones that the sum clears lie behind the contact that was added. The rows form one long number: a
    /// carry out of a row is lost in the next, whose first pixel has no left link.
    #[inline(always)]
    pub(super) fn find_contacts<I: Isa>(&mut self, count: usize, words: usize) {
        let (left_above, left) = (&self.left[..count], &self.left[words..][..count]);
        let (up_before, up) = (&self.up[words - 1..][..count], &self.up[words..][..count]);
        let contacts = &mut self.contacts[words..][..count];
        for w in 0..count {
            contacts[w] = up[w] & !((up[w] << 1 | up_before[w] >> 63) & left[w] & left_above[w]);
        }
        let (before, contacts) = (&self.contacts[words - 1..][..count], &self.contacts[words..][..count]);
        let (behind, sums) = (&mut self.behind[..count], &mut self.marks[..count]);
        for w in 0..count {
            behind[w] = (contacts[w] << 1 | before[w] >> 63) & left[w];
        }
        I::add(left, behind, sums);
        let (ends, orphans, marks) = (&self.ends[..count], &mut self.orphans[..count], sums);
        for w in 0..count {
            let covered = (left[w] & !marks[w]) | behind[w];
            orphans[w] = ends[w] & !(contacts[w] | covered);
            marks[w] = (contacts[w] & !covered) | orphans[w];
        }
    }
}
