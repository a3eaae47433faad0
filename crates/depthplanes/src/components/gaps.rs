//! Bridges over gaps: pieces of a region with nothing but missing pixels between them are one plane.
//!
//! In: the region image and its groups. Out: fewer groups. Groups are 4-connected, and where a sensor sees a surface
//! at a grazing angle half of the pixels are missing, so that what was measured of a plane falls apart. If gaps
//! are a pattern of the map ([`PATTERN`]), pieces are one over up to [`WIDEST`] missing pixels of a row or a column: a grid of
//! lines that nothing was measured on does not divide a wall. If its pixels
//! are missing at random, a plane holds together by its pixels' four next neighbours while 59 % are there, and by the
//! twelve that are one or two steps away while 29 % are (the thresholds of site percolation on the square lattice).

use super::connected_components::{ConnectedComponents, Groups};
use crate::util::bits::{ahead, behind, bits};
use crate::util::memory::reserve_to;
use crate::util::parallel::for_row_blocks;
use crate::util::simd::vectorised;
use std::ops::Range;

/// Rows of a part of the map; the parts are the same on any number of threads.
const ROWS: usize = 64;

/// Most missing pixels in a row or a column over which two pieces are one. Regions go on beyond one tile that is empty, so
/// that there may be so many between their pixels and two more.
const WIDEST: usize = 8;

/// Of so many pixels of planes one has to lie before such a gap of 2 missing pixels and more, along its row or its column, for
/// the gaps to be a pattern of the map. On recorded maps it is one of 50 at the most, the shadows of things among them,
/// behind which another surface begins; under lines of two missing pixels each 32 it is one of 16.
const PATTERN: usize = 32;

/// The steps to pixels two steps away, each with the pixels that lie between.
const STEPS: [([isize; 2], [[isize; 2]; 2]); 4] =
    [([2, 0], [[1, 0], [1, 0]]), ([0, 2], [[0, 1], [0, 1]]), ([1, 1], [[1, 0], [0, 1]]), ([-1, 1], [[-1, 0], [0, 1]])];

/// A map as rows of numbers, NaN where nothing was measured.
#[derive(Clone, Copy)]
pub(crate) struct Measured<'a> {
    pub(crate) numbers: &'a [f32],
    /// Numbers in a row; the last of them may lie beyond the map.
    pub(crate) stride: usize,
    pub(crate) height: usize,
}

/// Joins pieces over gaps; reuses its memory.
#[derive(Debug, Default)]
pub(crate) struct Bridge {
    parts: Vec<RowPairs>,
    /// Pairs of groups that belong to one plane.
    pairs: Vec<[u32; 2]>,
}

/// What is found in some rows of the map.
#[derive(Debug, Default)]
struct RowPairs {
    /// Pairs of groups that belong to one plane.
    pairs: Vec<[u32; 2]>,
    /// Pairs that do if wide gaps are a pattern, and pixels that lie before one.
    across: Vec<[u32; 2]>,
    before_gaps: usize,
}

impl Bridge {
    /// Unites the groups of a region image, on `threads` threads, over missing pixels only: a measured pixel between
    /// them that lies on no plane keeps them apart.
    pub(crate) fn join(&mut self, map: Measured<'_>, image: &[u16], grouper: &mut ConnectedComponents, threads: usize) {
        let Bridge { parts, pairs } = self;
        let groups = grouper.groups();
        let parts = for_row_blocks(threads, map.height, ROWS, parts, |part, rows| {
            vectorised(
                #[inline(always)]
                || part.list(rows, map, image, groups),
            );
        });
        reserve_to(pairs, 4 * image.len());
        parts.iter().for_each(|part| pairs.extend(&part.pairs));
        let before_gaps: usize = parts.iter().map(|part| part.before_gaps).sum();
        let pixels: usize = groups.sizes().iter().map(|&size| size as usize).sum();
        if before_gaps * PATTERN > pixels {
            parts.iter().for_each(|part| pairs.extend(&part.across));
        }
        grouper.unite(pairs);
    }
}

/// A word of a row's mask: for each pixel whether there is one of those 3 to `WIDEST + 1` places to its right.
#[inline(always)]
fn some_ahead(row: &[u64], word: usize) -> u64 {
    let part = |word: usize| row.get(word).map_or(0, |&bits| u128::from(bits));
    let from = (part(word) | part(word + 1) << 64) >> 3;
    (0..WIDEST - 1).fold(0, |any, by| any | from >> by) as u64
}

impl RowPairs {
    #[inline(always)]
    fn list(&mut self, rows: Range<usize>, map: Measured<'_>, image: &[u16], groups: &Groups) {
        // On a chequered image every second pixel is two steps from four others.
        reserve_to(&mut self.pairs, 2 * ROWS * map.stride);
        reserve_to(&mut self.across, 2 * ROWS * map.stride);
        self.before_gaps = 0;
        for v in rows {
            let [here, below, second] = [v, v + 1, v + 2].map(|v| groups.masks(v));
            for word in 0..here[0].len() {
                let [own, starts] = here.map(|row| row[word]);
                let (right, under) = (ahead(here[0], word, 1), ahead(below[0], word, 0));
                // A run goes on with the same label.
                let goes_on = right & !ahead(here[1], word, 1);
                let ways = [
                    own & !right & ahead(here[0], word, 2),
                    own & !under & ahead(second[0], word, 0),
                    own & !goes_on & ahead(below[0], word, 1) & !(right & under),
                    own & starts & behind(below[0], word) & !(behind(here[0], word) & under),
                ];
                for (way, (to, between)) in ways.into_iter().zip(STEPS) {
                    bits(way).for_each(|bit| self.list_pair([64 * word + bit, v], to, between, map, image, groups));
                }
                let mut ends = own & !right & !ahead(here[0], word, 2);
                ends = if ends == 0 { 0 } else { ends & some_ahead(here[0], word) };
                while ends != 0 {
                    let bit = ends.trailing_zeros() as usize;
                    ends &= ends - 1;
                    self.list_across([64 * word + bit, v], [1, 0], map, image, groups);
                }
                let mut ends = own & !under & !ahead(second[0], word, 0);
                if ends != 0 {
                    let mut any = 0;
                    for row in 3..WIDEST + 2 {
                        any |= ahead(groups.masks(v + row)[0], word, 0);
                    }
                    ends &= any;
                }
                while ends != 0 {
                    let bit = ends.trailing_zeros() as usize;
                    ends &= ends - 1;
                    self.list_across([64 * word + bit, v], [0, 1], map, image, groups);
                }
            }
        }
    }

    /// Lists the groups of a pixel and of the next one along a row or a column that was measured, if both have one label.
    #[inline(always)]
    fn list_across(&mut self, from: [usize; 2], along: [usize; 2], map: Measured<'_>, image: &[u16], groups: &Groups) {
        let Measured { numbers, stride, height } = map;
        let [u, v] = from;
        let room = if along[0] > 0 { stride - u } else { height - v };
        let step = along[0] + along[1] * stride;
        let at = v * stride + u;
        let mut steps = 1;
        while steps < room.min(WIDEST + 2) && numbers[at + steps * step].is_nan() {
            steps += 1;
        }
        let is_measured = (3..room.min(WIDEST + 2)).contains(&steps);
        if is_measured && image[at + steps * step] == image[at] {
            let pair @ [a, b] =
                [from, [0, 1].map(|axis| from[axis] + steps * along[axis])].map(|place| groups.at(place));
            self.before_gaps += 1;
            if a != b && self.across.last() != Some(&pair) {
                self.across.push(pair);
            }
        }
    }

    /// Lists the groups of a pixel and of one two steps away, if both have one label and some pixel between is missing.
    #[inline(always)]
    fn list_pair(
        &mut self,
        from: [usize; 2],
        to: [isize; 2],
        between: [[isize; 2]; 2],
        Measured { numbers, stride, .. }: Measured<'_>,
        image: &[u16],
        groups: &Groups,
    ) {
        let place = |step: [isize; 2]| [0, 1].map(|axis| from[axis].wrapping_add_signed(step[axis]));
        let at = |[u, v]: [usize; 2]| v * stride + u;
        let is_missing = |step| numbers[at(place(step))].is_nan();
        if image[at(from)] == image[at(place(to))] && between.into_iter().any(is_missing) {
            let pair @ [a, b] = [from, place(to)].map(|place| groups.at(place));
            if a != b && self.pairs.last() != Some(&pair) {
                self.pairs.push(pair);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::Connectivity;
    use crate::map::DepthView;
    use crate::util::random::Random;

    /// Whether one of 32 pixels lies before a gap of two missing pixels and more with its own label behind it.
    fn are_a_pattern(image: &[u16], q: &[f32], stride: usize, [width, height]: [usize; 2]) -> bool {
        let places = (0..height).flat_map(|v| (0..width).map(move |u| [u, v]));
        let labelled = places.filter(|[u, v]| image[v * stride + u] > 0);
        let (mut pixels, mut before) = (0, 0);
        for [u, v] in labelled {
            pixels += 1;
            for (step, room) in [(1, width - u), (stride, height - v)] {
                let at = |steps: usize| v * stride + u + steps * step;
                let next = (1..room.min(WIDEST + 2)).find(|&steps| !q[at(steps)].is_nan());
                before += usize::from(next.is_some_and(|steps| steps > 2 && image[at(steps)] == image[at(0)]));
            }
        }
        before * 32 > pixels
    }

    /// The group of each pixel by a plain flood, numbered by first pixels: over the four neighbours of the same label, and
    /// over gaps.
    fn flood(
        image: &[u16],
        q: &[f32],
        stride: usize,
        [width, height]: [usize; 2],
        over_gaps: bool,
    ) -> Vec<Option<u32>> {
        // Along a row or a column all pixels between have to be missing, on a diagonal one of two.
        let mut steps: Vec<([isize; 2], Vec<[isize; 2]>)> =
            vec![([1, 1], vec![[1, 0], [0, 1]]), ([-1, 1], vec![[-1, 0], [0, 1]])];
        let widest = if are_a_pattern(image, q, stride, [width, height]) { WIDEST } else { 1 };
        for length in 1..=widest as isize + 1 {
            steps.push(([length, 0], (1..length).map(|step| [step, 0]).collect()));
            steps.push(([0, length], (1..length).map(|step| [0, step]).collect()));
        }
        let mut group = vec![None; width * height];
        let mut groups = 0;
        for first in 0..width * height {
            if group[first].is_some() || image[first / width * stride + first % width] == 0 {
                continue;
            }
            group[first] = Some(groups);
            let mut queue = vec![first];
            while let Some(at) = queue.pop() {
                for (step, between) in &steps {
                    for way in [1, -1] {
                        let place = |[u, v]: [isize; 2]| {
                            let [u, v] = [(at % width) as isize + way * u, (at / width) as isize + way * v];
                            let is_here = (0..width as isize).contains(&u) && (0..height as isize).contains(&v);
                            is_here.then_some([u as usize, v as usize])
                        };
                        let Some([u, v]) = place(*step) else { continue };
                        let is_missing =
                            |step: &[isize; 2]| place(*step).is_some_and(|[u, v]| q[v * stride + u].is_nan());
                        let is_diagonal = step[0] * step[1] != 0;
                        let are_missing =
                            if is_diagonal { between.iter().any(is_missing) } else { between.iter().all(is_missing) };
                        let joins = between.is_empty() || over_gaps && are_missing;
                        let same = image[v * stride + u] == image[at / width * stride + at % width];
                        if joins && same && group[v * width + u].is_none() {
                            group[v * width + u] = Some(groups);
                            queue.push(v * width + u);
                        }
                    }
                }
            }
            groups += 1;
        }
        group
    }

    #[test]
    fn pieces_are_joined_over_missing_pixels_as_a_plain_flood_joins_them() {
        let (mut random, mut bridge, mut grouper) = (Random::new(6), Bridge::default(), ConnectedComponents::default());
        for round in 0..60 {
            // More rows than a part has; more columns than a word has.
            let [width, height]: [usize; 2] = [[1, 1], [130, 70], [64, 5], [63, 130], [2, 9]][round % 5];
            let stride = width.next_multiple_of(64);
            let (missing, off) =
                (random.between(0.0, 0.85) * f64::from(u8::from(round % 3 > 0)), random.between(0.0, 0.3));
            let size = random.whole(2, 20);
            let (mut image, mut q) = (vec![0; stride * height], vec![f32::NAN; stride * height]);
            for (v, u) in (0..height).flat_map(|v| (0..width).map(move |u| (v, u))) {
                let draw = random.uniform();
                if draw >= missing {
                    q[v * stride + u] = 1.0;
                    // What was measured and lies on no plane has no label.
                    let label = [1, 2, 1, 7][(u / size + v / size * 3) % 4];
                    image[v * stride + u] = if random.uniform() < off { 0 } else { label };
                }
            }
            let view = DepthView::with_stride(&image, width, height, stride).unwrap().valid_range(1, 65_534).unwrap();
            let map = Measured { numbers: &q, stride, height };
            for threads in [1, 3] {
                grouper.group(&view, &Connectivity::new(view.validity(), 0.0).unwrap(), threads);
                for over_gaps in [false, true] {
                    if over_gaps {
                        bridge.join(map, &image, &mut grouper, threads);
                    }
                    let expected = flood(&image, &q, stride, [width, height], over_gaps);
                    let groups = grouper.groups();
                    for (at, &expected) in expected.iter().enumerate() {
                        let [u, v] = [at % width, at / width];
                        let found = (image[v * stride + u] > 0).then(|| groups.at([u, v]));
                        assert_eq!(found, expected, "at {u}, {v} of {width} x {height}, over gaps: {over_gaps}");
                    }
                    let count = expected.iter().flatten().max().map_or(0, |last| *last as usize + 1);
                    assert_eq!(groups.count(), count);
                    for (group, &size) in groups.sizes().iter().enumerate() {
                        assert_eq!(expected.iter().filter(|&&own| own == Some(group as u32)).count(), size as usize);
                    }
                }
            }
        }
    }
}
