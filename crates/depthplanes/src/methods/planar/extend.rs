//! Stage "assign", second part: planes extend along strips that are too thin for a tile, and regions become one whose
//! pixels touch and which one plane explains.
//!
//! In: the map in q and its region image. Out: the image, in which a pixel without a region that has a neighbour on a
//! plane goes to that plane if it lies on it, and so on from pixel to pixel: neighbour grouping (section 3c) by the
//! distance from the plane instead of by the value. Blocks ask only the planes of tiles nearby; the floor below a
//! ball at the map's edge has none there. Merging looked at tiles; on a strip thinner than a tile, two pieces of a
//! floor may meet that had no tiles side by side.

use super::layout::{AffineMap, ROWS, finer, for_each_band};
use super::merge::merge_cost;
use super::region::{BENT, Planes, Region};
use crate::components::boundary::Boundary;
use crate::util::memory::reserve_to;
use crate::util::parallel::{for_row_blocks, map_reduce};
use crate::util::simd::vectorised;
use crate::util::switches::is_on;
use crate::util::union_find::find;
use std::ops::Range;

/// Lets planes reach on; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Flood {
    /// For each band.
    works: Vec<Work>,
}

/// Memory of a band.
#[derive(Debug, Default)]
struct Work {
    /// Pixels that were just reached, whose neighbours are still to be asked.
    queue: Vec<[usize; 2]>,
    touching: Touching,
}

impl Flood {
    /// Lets planes reach on, though not into curved regions, and lists the regions that they touch there: band by band on as
    /// many threads, and then over the bands' edges.
    pub(super) fn flood(
        &mut self,
        affine: &AffineMap,
        planes: &Planes<'_>,
        seams: &Boundary,
        bands: &[Range<usize>],
        image: &mut [u16],
        threads: usize,
    ) {
        let &AffineMap { width, height, stride, .. } = affine;
        self.works.resize_with(bands.len(), Work::default);
        for_each_band(bands, &mut self.works, [(&mut *image, ROWS * stride)], threads, |band, work, [image]| {
            reserve_to(&mut work.queue, image.len());
            work.touching.prepare(4 * image.len());
            let rows = finer(band, ROWS);
            let rows = rows.start..rows.end.min(height);
            let mut area = Area { affine, planes, rows: rows.clone(), image, work };
            seams.each_open(rows, |place| area.ask_around(place));
        });
        for (band, work) in bands.iter().zip(&mut self.works).skip(1) {
            let edge = finer(band, ROWS).start;
            let mut area = Area { affine, planes, rows: 0..height, image, work };
            (edge - 1..edge + 1).for_each(|v| (0..width).for_each(|u| area.ask_around([u, v])));
        }
    }

    /// The regions that touch where planes reached on.
    pub(super) fn touching(&self) -> impl Iterator<Item = &Touching> {
        self.works.iter().map(|work| &work.touching)
    }
}

/// Rows over which planes reach on; there is nothing beyond them.
struct Area<'a> {
    affine: &'a AffineMap,
    planes: &'a Planes<'a>,
    rows: Range<usize>,
    image: &'a mut [u16],
    work: &'a mut Work,
}

impl Area<'_> {
    /// Asks a pixel, and its neighbours if it is reached, and so on.
    #[inline(always)]
    fn ask_around(&mut self, place: [usize; 2]) {
        self.ask(place);
        while let Some(place) = self.work.queue.pop() {
            self.neighbours(place).into_iter().for_each(|place| self.ask(place));
        }
    }

    /// Gives a pixel without a region the nearest of the planes of its neighbours that it lies on, if any.
    #[inline(always)]
    fn ask(&mut self, place: [usize; 2]) {
        let at = self.at(place);
        let q = self.affine.q[place[1] * self.affine.stride + place[0]];
        if self.image[at] > 0 || !q.is_finite() {
            return;
        }
        let (q, [u, v]) = (f64::from(q), place.map(|place| place as f64));
        let labels = self.neighbours(place).map(|place| self.image[self.at(place)]);
        let (mut own, mut best) = (0, f64::INFINITY);
        for label in labels {
            if label > 0 && label != BENT && label != own {
                let region = self.planes.region(u32::from(label) - 1);
                let on_plane = region.at(u, v);
                let off = (q - on_plane).powi(2);
                if off < best && off <= self.planes.inlier_threshold_squared(region, on_plane) {
                    (own, best) = (label, off);
                }
            }
        }
        if own > 0 {
            self.image[at] = own;
            self.work.queue.push(place);
            labels.into_iter().for_each(|label| self.work.touching.touch(own, label));
        }
    }

    /// Where a pixel stands in the image.
    #[inline(always)]
    fn at(&self, [u, v]: [usize; 2]) -> usize {
        (v - self.rows.start) * self.affine.stride + u
    }

    /// The four neighbours of a pixel; at the edge itself in place of those that are missing.
    #[inline(always)]
    fn neighbours(&self, [u, v]: [usize; 2]) -> [[usize; 2]; 4] {
        let [right, below] = [(u + 1).min(self.affine.width - 1), (v + 1).min(self.rows.end - 1)];
        [[u.saturating_sub(1), v], [right, v], [u, v.saturating_sub(1).max(self.rows.start)], [u, below]]
    }
}

/// Pixels that get their labels together.
const LANES: usize = 32;
/// Slots of the table of pairs that were just met; a power of two.
const RECENT: usize = 256;

/// Rows of an image that are looked through at a time.
const ROWS_AT_A_TIME: usize = 64;

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
    pub(super) fn list(&mut self, seams: &Boundary, image: &[u16], threads: usize) {
        // A pixel makes two pairs, with its left and its upper neighbour.
        let per_row = 2 * image.len() / seams.rows();
        for_row_blocks(threads, seams.rows(), ROWS_AT_A_TIME, &mut self.parts, |part, rows| {
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
            is_on("touching") && merge_cost(&all[a], &all[b]) <= 1.0
        });
        let mut any = false;
        for pair in pairs.iter() {
            let [a, b] = pair.map(|label| find(into, label));
            if a != b && merge_cost(&all[region(a)], &all[region(b)]) <= 1.0 {
                let other = all[region(b)];
                all[region(a)].absorb(&other);
                into[usize::from(b)] = a;
                any = true;
            }
        }
        if any {
            (0..into.len()).for_each(|label| into[label] = find(into, label as u16));
            let relabel = |groups: &mut [[u16; LANES]]| {
                vectorised(
                    #[inline(always)]
                    || relabel(groups, into),
                );
            };
            // An image has whole groups.
            map_reduce(threads, image.as_chunks_mut().0, relabel, |(), ()| ());
        }
    }

    /// The label that a region has now.
    pub(super) fn label(&self, id: u32) -> u16 {
        self.into[id as usize + 1]
    }
}

/// Gives every pixel the label that its own has become; [`BENT`] stays.
#[inline(always)]
fn relabel(groups: &mut [[u16; LANES]], into: &[u16]) {
    let now = |label: u16| into.get(usize::from(label)).map_or(label, |&into| into);
    for group in groups {
        // Most groups are of one region, and most regions stay what they are.
        let first = group[0];
        if *group != [first; LANES] {
            group.iter_mut().for_each(|label| *label = now(*label));
        } else if now(first) != first {
            *group = [now(first); LANES];
        }
    }
}
