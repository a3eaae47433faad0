//! Stage "assign", last part: regions whose pixels touch and that one plane explains become one.
//!
//! In: regions, the region image, and the labels that touch. Out: the image with fewer regions. Merging looked at tiles;
//! on a strip thinner than a tile two pieces of a floor may meet that had no tiles side by side.

use super::grow::Region;
use super::merge::bend;
use super::planes::BENT;
use super::seams::Seams;
use super::switches::is_on;
use crate::group::{reserve_to, vectorised};
use crate::parallel::{in_parts, in_rows};

/// Pixels that get their labels together.
const ABREAST: usize = 32;
/// Slots of the table of pairs that were just met; a power of two.
const RECENT: usize = 256;

/// Rows of an image that are looked through at a time.
const ROWS: usize = 64;

/// Joins regions that touch; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Contacts {
    /// What touches in some rows each.
    parts: Vec<Touching>,
    pairs: Vec<[u16; 2]>,
    /// For each label the one that it becomes.
    into: Vec<u16>,
}

/// Labels of regions that touch, the smaller first.
#[derive(Debug, Default)]
pub(super) struct Touching {
    pairs: Vec<[u16; 2]>,
    recent: Vec<[u16; 2]>,
}

impl Touching {
    /// Makes room for so many pairs.
    pub(super) fn prepare(&mut self, most: usize) {
        reserve_to(&mut self.pairs, most);
        self.recent.clear();
        self.recent.resize(RECENT, [0; 2]);
    }

    /// Lists two regions, if they are two planes.
    #[inline(always)]
    pub(super) fn touch(&mut self, a: u16, b: u16) {
        let pair @ [a, b] = [a.min(b), a.max(b)];
        if a > 0 && a != b && b != BENT {
            let recent = &mut self.recent[usize::from(a.wrapping_mul(31).wrapping_add(b)) % RECENT];
            if *recent != pair {
                *recent = pair;
                self.pairs.push(pair);
            }
        }
    }
}

impl Contacts {
    /// Lists the regions that touch in an image, on as many threads.
    pub(super) fn list(&mut self, seams: &Seams, image: &[u16], threads: usize) {
        // A pixel makes two pairs, with its left and its upper neighbour.
        let per_row = 2 * image.len() / seams.rows();
        in_rows(threads, seams.rows(), ROWS, &mut self.parts, |part, rows| {
            part.prepare(rows.len() * per_row);
            seams.each(rows, image, |a, b| part.touch(a, b));
        });
    }

    /// Joins the listed regions in the image, and their sums; with those that touch elsewhere.
    pub(super) fn join<'a>(
        &mut self,
        elsewhere: impl Iterator<Item = &'a Touching>,
        all: &mut [Region],
        image: &mut [u16],
        threads: usize,
    ) {
        let Contacts { parts, pairs, into } = self;
        reserve_to(pairs, 6 * image.len());
        parts.iter().for_each(|part| pairs.extend(&part.pairs));
        elsewhere.for_each(|touching| pairs.extend(&touching.pairs));
        reserve_to(into, image.len());
        into.extend(0..=all.len() as u16);
        pairs.sort_unstable();
        pairs.dedup();
        let region = |label: u16| usize::from(label) - 1;
        pairs.retain(|pair| {
            let [a, b] = pair.map(region);
            is_on("contact") && bend(&all[a], &all[b]) <= 1.0
        });
        let mut any = false;
        for pair in pairs.iter() {
            let [a, b] = pair.map(|label| root(into, label));
            if a != b && bend(&all[region(a)], &all[region(b)]) <= 1.0 {
                let other = all[region(b)];
                all[region(a)].absorb(&other);
                into[usize::from(b)] = a;
                any = true;
            }
        }
        if any {
            (0..into.len()).for_each(|label| into[label] = root(into, label as u16));
            let relabel = |groups: &mut [[u16; ABREAST]]| {
                vectorised(
                    #[inline(always)]
                    || relabel(groups, into),
                );
            };
            // An image has whole groups.
            in_parts(threads, image.as_chunks_mut().0, relabel, |(), ()| ());
        }
    }

    /// The label that a region has now.
    pub(super) fn label(&self, id: u32) -> u16 {
        self.into[id as usize + 1]
    }
}

/// The label that one has become.
fn root(into: &[u16], mut label: u16) -> u16 {
    while into[usize::from(label)] != label {
        label = into[usize::from(label)];
    }
    label
}

/// Gives every pixel the label that its own has become; [`BENT`] stays.
#[inline(always)]
fn relabel(groups: &mut [[u16; ABREAST]], into: &[u16]) {
    let now = |label: u16| into.get(usize::from(label)).map_or(label, |&into| into);
    for group in groups {
        // Most groups are of one region, and most regions stay what they are.
        let first = group[0];
        if *group != [first; ABREAST] {
            group.iter_mut().for_each(|label| *label = now(*label));
        } else if now(first) != first {
            *group = [now(first); ABREAST];
        }
    }
}
