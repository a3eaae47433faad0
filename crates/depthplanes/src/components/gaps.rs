//! Bridges over gaps: pieces of a region that are two steps apart are one plane.
//!
//! In: the region image and its groups. Out: fewer groups. Groups are 4-connected, and where a sensor sees a surface
//! at a grazing angle half of the pixels are missing, so that what was measured of a plane falls apart. If its pixels
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
}

impl Bridge {
    /// Unites the groups of a region image, on `threads` threads, over missing pixels only: a measured pixel between
    /// them that lies on no plane keeps them apart.
    pub(crate) fn join(&mut self, map: Measured<'_>, image: &[u16], grouper: &mut ConnectedComponents, threads: usize) {
        let Bridge { parts, pairs } = self;
        let groups = grouper.groups();
        for_row_blocks(threads, map.height, ROWS, parts, |part, rows| {
            vectorised(
                #[inline(always)]
                || part.list(rows, map, image, groups),
            );
        });
        reserve_to(pairs, 2 * image.len());
        parts.iter().for_each(|part| pairs.extend(&part.pairs));
        grouper.unite(pairs);
    }
}

impl RowPairs {
    #[inline(always)]
    fn list(&mut self, rows: Range<usize>, map: Measured<'_>, image: &[u16], groups: &Groups) {
        // On a chequered image every second pixel is two steps from four others.
        reserve_to(&mut self.pairs, 2 * ROWS * map.stride);
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
