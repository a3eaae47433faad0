//! Stage "assign", third part: regions whose pixels touch and that one plane explains become one.
//!
//! In: regions and the region image. Out: the image with fewer regions. Merging looked at tiles; on a strip thinner than
//! a tile two pieces of a floor may meet that had no tiles side by side.

use super::field::Field;
use super::grow::Region;
use super::merge::{BEND, bend};
use crate::group::{reserve_to, vectorised};

/// Pixels of a row that are looked at together.
const ABREAST: usize = 16;
/// Slots of the table of pairs that were just met; a power of two.
const RECENT: usize = 256;

/// Joins regions that touch; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Contacts {
    /// Labels of regions that touch, the smaller first.
    pairs: Vec<[u16; 2]>,
    recent: Vec<[u16; 2]>,
    /// For each group of pixels of a row, whether one touches another region.
    any: Vec<bool>,
    /// For each label the one that it becomes.
    into: Vec<u16>,
}

impl Contacts {
    /// Joins regions in the image, and their sums.
    pub(super) fn join(&mut self, field: &Field, all: &mut [Region], image: &mut [u16]) {
        reserve_to(&mut self.into, image.len());
        self.into.extend(0..=all.len() as u16);
        self.list_pairs(field, image);
        let Contacts { pairs, into, .. } = self;
        let region = |label: u16| usize::from(label) - 1;
        pairs.retain(|pair| {
            let [a, b] = pair.map(region);
            bend(&all[a], &all[b]) <= BEND
        });
        let mut any = false;
        for pair in pairs.iter() {
            let [a, b] = pair.map(|label| root(into, label));
            if a != b && bend(&all[region(a)], &all[region(b)]) <= BEND {
                let other = all[region(b)];
                all[region(a)].absorb(&other);
                into[usize::from(b)] = a;
                any = true;
            }
        }
        if any {
            (0..into.len()).for_each(|label| into[label] = root(into, label as u16));
            vectorised(
                #[inline(always)]
                || relabel(image, into),
            );
        }
    }

    /// The label that a region has now.
    pub(super) fn label(&self, id: u32) -> u16 {
        self.into[id as usize + 1]
    }

    fn list_pairs(&mut self, field: &Field, image: &[u16]) {
        let Contacts { pairs, recent, any, .. } = self;
        reserve_to(pairs, 2 * field.width * field.height);
        recent.clear();
        recent.resize(RECENT, [0; 2]);
        let mut touch = |a: u16, b: u16| {
            if a != b && a.min(b) > 0 {
                let pair = [a.min(b), a.max(b)];
                let recent = &mut recent[usize::from(pair[0].wrapping_mul(31).wrapping_add(pair[1])) % RECENT];
                if *recent != pair {
                    *recent = pair;
                    pairs.push(pair);
                }
            }
        };
        any.resize(field.stride / ABREAST, false);
        for v in 0..field.height {
            let row = v * field.stride;
            vectorised(
                #[inline(always)]
                || any_touch(image, row, field.stride, any),
            );
            for (first, _) in (0..field.width).step_by(ABREAST).zip(&*any).filter(|(_, any)| **any) {
                let at = row + first;
                let here = &image[at..at + ABREAST];
                let right = image[at + 1..].iter().chain(&[0]);
                for (((u, &own), &right), below) in (first..).zip(here).zip(right).zip(at + field.stride..) {
                    if own != right && u + 1 < field.width {
                        touch(own, right);
                    }
                    if v + 1 < field.height && own != image[below] {
                        touch(own, image[below]);
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
    }
}

/// The label that one has become.
fn root(into: &[u16], mut label: u16) -> u16 {
    while into[usize::from(label)] != label {
        label = into[usize::from(label)];
    }
    label
}

/// Gives every pixel the label that its own has become.
#[inline(always)]
fn relabel(image: &mut [u16], into: &[u16]) {
    for group in image.as_chunks_mut::<ABREAST>().0 {
        // Most groups are of one region.
        let first = group[0];
        if group.iter().fold(true, |all, &label| all & (label == first)) {
            *group = [into[usize::from(first)]; ABREAST];
        } else {
            group.iter_mut().for_each(|label| *label = into[usize::from(*label)]);
        }
    }
}

/// For each [`ABREAST`] pixels of the row that begins at `row`, whether one of them and its right or lower neighbour are of
/// two regions; may say so at the end of a row.
#[inline(always)]
fn any_touch(image: &[u16], row: usize, stride: usize, any: &mut [bool]) {
    let differ = |a: u16, b: u16| (a != b) & (a > 0) & (b > 0);
    for (group, any) in any.iter_mut().enumerate() {
        let at = row + group * ABREAST;
        let some = |first: usize| image.get(first..).and_then(|from| from.first_chunk::<ABREAST>());
        let here = some(at).expect("rows of whole groups");
        let (right, below) = (some(at + 1), some(at + stride).unwrap_or(here));
        *any = right.is_none_or(|right| {
            let mut any = 0u16;
            for i in 0..ABREAST {
                any |= u16::from(differ(here[i], right[i]) | differ(here[i], below[i]));
            }
            any > 0
        });
    }
}
