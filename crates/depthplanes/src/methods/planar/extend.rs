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
use super::region::{CURVED_LABEL, Planes, Region};
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
        boundary: &Boundary,
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
            boundary.each_open(rows, |place| area.ask_around(place));
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
            if label > 0 && label != CURVED_LABEL && label != own {
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
    /// Parts of this map; the others are of larger ones.
    used: usize,
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
        if a > 0 && a != b && b != CURVED_LABEL {
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
    pub(super) fn list(&mut self, boundary: &Boundary, image: &[u16], threads: usize) {
        // A pixel makes two pairs, with its left and its upper neighbour.
        let per_row = 2 * image.len() / boundary.rows();
        let used = for_row_blocks(threads, boundary.rows(), ROWS_AT_A_TIME, &mut self.parts, |part, rows| {
            part.prepare(rows.len() * per_row);
            boundary.each(rows, image, |a, b| part.touch(a, b));
        });
        self.used = used.len();
    }

    /// Joins the listed regions in the image, and their sums; with those that touch elsewhere.
    pub(super) fn join<'a>(
        &mut self,
        elsewhere: impl Iterator<Item = &'a Touching>,
        all: &mut [Region],
        image: &mut [u16],
        threads: usize,
    ) {
        let Contacts { parts, used, pairs, into } = self;
        reserve_to(pairs, 6 * image.len());
        parts[..*used].iter().for_each(|part| pairs.extend(&part.pairs));
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

/// Gives every pixel the label that its own has become; [`CURVED_LABEL`] stays.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, THRESHOLD, bands, noise, planes};
    use crate::util::random::Random;

    /// A floor.
    fn plane(u: usize, v: usize) -> f64 {
        40.0 + 0.02 * u as f64 - 0.03 * v as f64
    }

    /// Regions of a clean floor: the left half, and the right one, so many deviations higher.
    fn floor(deviations: f64) -> Stages {
        let step = |u: usize| if u < 64 { 0.0 } else { deviations * SIGMA };
        let mut stages = Stages::tiles(&Made::exact([128, 64], |u, v| plane(u, v) + step(u)), noise(0.0));
        stages.divide(|column, _| u32::from(column >= 16));
        stages
    }

    /// What planes reach of a map whose pixels have some labels so far, and the pairs of regions that touch there.
    fn flood(
        stages: &Stages,
        made: &Made,
        labels: &[u16],
        bands: &[Range<usize>],
        threads: usize,
    ) -> (Vec<u16>, Vec<[u16; 2]>) {
        let affine = Stages::tiles(made, noise(0.0)).run.affine;
        let mut image = vec![0; affine.q.len()];
        for (row, labels) in image.chunks_mut(affine.stride).zip(labels.chunks(made.width)) {
            row[..made.width].copy_from_slice(labels);
        }
        let (mut boundary, mut flood) = (Boundary::default(), Flood::default());
        boundary.find(&image, affine.stride, threads);
        flood.flood(&affine, &planes(stages.all(), &stages.noise), &boundary, bands, &mut image, threads);
        let labels = image.chunks(affine.stride).take(made.height).flat_map(|row| row[..made.width].to_vec()).collect();
        let mut pairs: Vec<[u16; 2]> = flood.touching().flat_map(|touching| touching.pairs.clone()).collect();
        pairs.sort_unstable();
        pairs.dedup();
        (labels, pairs)
    }

    #[test]
    fn a_strip_of_one_pixel_that_continues_a_plane_is_taken_in_and_one_that_is_off_it_is_not() {
        for (off, expected) in [(0.0, true), (3.0, true), (-3.0, true), (6.0, false), (-6.0, false)] {
            // From the floor on the left to the right and round a corner, over a band's edge.
            let is_strip = |u: usize, v: usize| v == 10 && (40..100).contains(&u) || u == 99 && (10..60).contains(&v);
            let made = Made::exact([128, 64], |u, v| match () {
                _ if u < 40 => plane(u, v),
                _ if is_strip(u, v) => plane(u, v) + off * SIGMA,
                _ => plane(u, v) + 5.0,
            });
            let labels: Vec<u16> = (0..128 * 64).map(|at| u16::from(at % 128 < 40)).collect();
            for bands in [bands(&[0, 4]), bands(&[0, 1, 3, 4])] {
                let (image, touching) = flood(&floor(0.0), &made, &labels, &bands, 1);
                for (at, &label) in image.iter().enumerate() {
                    let [u, v] = [at % 128, at / 128];
                    assert_eq!(
                        label,
                        u16::from(u < 40 || expected && is_strip(u, v)),
                        "{u}, {v}, {off} deviations off"
                    );
                }
                assert_eq!(touching, [[0; 2]; 0]);
            }
        }
    }

    #[test]
    fn a_plane_reaches_what_a_plain_flood_reaches_over_pixels_that_lie_on_it() {
        let mut random = Random::new(4);
        for round in 0..12 {
            let share = random.between(0.5, 0.75);
            let made = Made::exact([128, 64], |u, v| match random.uniform() {
                x if x < share => plane(u, v) + SIGMA * random.between(-3.9, 3.9),
                x if x < share + 0.1 => f64::NAN,
                _ => plane(u, v) + SIGMA * (4.1 + random.uniform()),
            });
            let labels: Vec<u16> = (0..128 * 64)
                .map(|_| if random.uniform() < 0.003 { 1 } else { u16::from(random.uniform() < 0.01) * CURVED_LABEL })
                .collect();
            let stages = floor(0.0);
            let mut expected = labels.clone();
            let mut queue: Vec<usize> = (0..128 * 64).filter(|&at| labels[at] == 1).collect();
            while let Some(at) = queue.pop() {
                let [u, v] = [at % 128, at / 128];
                let beside = [(u > 0, -1), (u < 127, 1), (v > 0, -128), (v < 63, 128)];
                for beside in beside.into_iter().filter(|(is, _)| *is).map(|(_, step)| at.wrapping_add_signed(step)) {
                    let off =
                        f64::from(made.q[beside]) - stages.all()[0].at((beside % 128) as f64, (beside / 128) as f64);
                    if expected[beside] == 0 && off.abs() <= THRESHOLD * SIGMA {
                        expected[beside] = 1;
                        queue.push(beside);
                    }
                }
            }
            let bands = bands([&[0, 4][..], &[0, 1, 2, 4]][round % 2]);
            for threads in [1, 2] {
                let (image, _) = flood(&stages, &made, &labels, &bands, threads);
                let differs: Vec<usize> = (0..128 * 64).filter(|&at| image[at] != expected[at]).collect();
                // Over a band's edge planes reach on once, and what they reach there in one band goes on in both.
                assert_eq!(differs, [0; 0], "round {round}");
            }
            assert!(
                expected.iter().filter(|&&label| label == 1).count()
                    > 2 * labels.iter().filter(|&&label| label == 1).count()
            );
        }
    }

    #[test]
    fn regions_that_turn_little_by_little_are_not_joined_hand_in_hand() {
        // Three strips, each turned against the one before by the most that is one plane; all three are not.
        let strips = |turn: f64| {
            let slope = |u: f64| turn * ((u - 32.0).max(0.0) + (u - 64.0).max(0.0));
            let made = Made::exact([96, 64], |u, v| plane(u, v) + SIGMA * slope(u as f64));
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, _| column as u32 / 8);
            stages
        };
        let cost = |turn: f64| merge_cost(&strips(turn).all()[0], &strips(turn).all()[1]);
        let most = (1..200).map(|step| 0.01 * f64::from(step)).take_while(|&turn| cost(turn) < 0.95).last().unwrap();
        let mut stages = strips(most);
        let costs = [[0, 1], [1, 2], [0, 2]].map(|[a, b]| merge_cost(&stages.all()[a], &stages.all()[b]));
        assert!(costs[0] <= 1.0 && costs[1] <= 1.0 && costs[2] > 1.0, "{costs:?}");
        let stride = stages.run.affine.stride;
        let mut image: Vec<u16> =
            (0..stages.run.affine.q.len()).map(|at| (1 + at % stride / 32).min(3) as u16).collect();
        let (mut boundary, mut contacts) = (Boundary::default(), Contacts::default());
        boundary.find(&image, stride, 1);
        contacts.list(&boundary, &image, 1);
        contacts.join([].into_iter(), &mut stages.run.regions.all, &mut image, 1);
        assert_eq!([0, 1, 2].map(|id| contacts.label(id)), [1, 1, 3]);
    }

    #[test]
    fn a_pixel_between_two_planes_goes_to_the_nearer_and_they_are_listed_as_touching() {
        // The strip in the middle lies on both planes, which are five deviations apart, nearer to the one or the other.
        for (off, expected) in [(1.5, 1), (3.5, 2)] {
            let stages = floor(5.0);
            let made = Made::exact([128, 64], |u, v| plane(u, v) + if u == 64 { off * SIGMA } else { 0.0 });
            let labels: Vec<u16> =
                (0..128 * 64).map(|at| [1, 0, 2][usize::from(at % 128 > 63) + usize::from(at % 128 > 64)]).collect();
            let (image, touching) = flood(&stages, &made, &labels, &bands(&[0, 4]), 1);
            assert!((0..64).all(|v| image[v * 128 + 64] == expected), "{off} deviations");
            assert_eq!(touching, [[1, 2]]);
        }
    }

    #[test]
    fn regions_of_one_plane_whose_pixels_touch_become_one_and_those_of_two_planes_do_not() {
        for (deviations, touch, is_one) in [(0.0, true, true), (0.0, false, false), (8.0, true, false)] {
            let mut stages = floor(deviations);
            stages.run.regions.all.push(stages.all()[0]);
            let (before, stride) = (stages.all().to_vec(), stages.run.affine.stride);
            let edge = if touch { 65 } else { 66 };
            // Curved regions lie below; a third region touches nothing.
            let label = |[u, v]: [usize; 2]| match () {
                _ if v >= 60 => CURVED_LABEL,
                _ if v >= 50 => 3 * u16::from((70..80).contains(&u) && v < 58 && v > 52),
                _ if u < 65 => 1,
                _ if u >= edge => 2,
                _ => 0,
            };
            let mut image: Vec<u16> =
                (0..stages.run.affine.q.len()).map(|at| label([at % stride, at / stride])).collect();
            let labels = image.clone();
            let (mut boundary, mut contacts) = (Boundary::default(), Contacts::default());
            for threads in [1, 2] {
                image.copy_from_slice(&labels);
                stages.run.regions.all.copy_from_slice(&before);
                boundary.find(&image, stride, threads);
                contacts.list(&boundary, &image, threads);
                contacts.join([].into_iter(), &mut stages.run.regions.all, &mut image, threads);
                let expected: Vec<u16> =
                    labels.iter().map(|&label| if label == 2 && is_one { 1 } else { label }).collect();
                assert!(image == expected, "{deviations} deviations, touching: {touch}");
                assert_eq!([0, 1, 2].map(|id| contacts.label(id)), [1, if is_one { 1 } else { 2 }, 3]);
                let pixels = before[0].sums.n + if is_one { before[1].sums.n } else { 0.0 };
                assert_eq!(stages.all()[0].sums.n, pixels);
            }
            // What touches where planes reached on counts as well.
            image.copy_from_slice(&labels);
            stages.run.regions.all.copy_from_slice(&before);
            let mut elsewhere = Touching::default();
            elsewhere.prepare(8);
            for (a, b) in [(2, 1), (1, 1), (0, 1), (1, CURVED_LABEL), (2, 1)] {
                elsewhere.touch(a, b);
            }
            assert_eq!(elsewhere.pairs, [[1, 2]]);
            contacts.join([&elsewhere].into_iter(), &mut stages.run.regions.all, &mut image, 1);
            assert_eq!(contacts.label(1) == 1, deviations == 0.0);
        }
    }
}
