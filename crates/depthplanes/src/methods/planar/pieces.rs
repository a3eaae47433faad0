//! Stage "group", second part: pieces of a region that are two steps apart are one plane.
//!
//! In: the region image and its groups. Out: fewer groups. Groups are 4-connected, and where a sensor sees a surface at a
//! grazing angle half of the pixels are missing: what was measured of a plane falls apart. A plane whose pixels are missing
//! at random holds together by its four next pixels while 59 % are there, and by the twelve that are one or two steps
//! off while 29 % are (the thresholds of site percolation on the square lattice).

use super::field::Field;
use super::planes::BENT;
use crate::group::{Grouper, Groups, reserve_to, vectorised};
use crate::parallel::in_rows;
use std::ops::Range;

/// Pixels of a row that are looked at together.
const ABREAST: usize = 32;

/// Pixels that have to follow an image of rows of `stride`, for what lies two rows and two columns on to be there.
pub(super) fn slack(stride: usize) -> usize {
    2 * stride + ABREAST
}

/// Rows of a part of the map; the parts are the same on any number of threads.
const ROWS: usize = 64;

/// Joins pieces; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    parts: Vec<Part>,
    /// Groups that are one.
    pairs: Vec<[u32; 2]>,
}

/// What is found in some rows of the map.
#[derive(Debug, Default)]
struct Part {
    /// Groups that are one.
    pairs: Vec<[u32; 2]>,
}

impl Pieces {
    /// Joins the groups of a region image, on as many threads, over missing pixels only: what was measured between and lies
    /// on no plane parts them. The image is followed by [`slack`] pixels.
    pub(super) fn join(&mut self, field: &Field, image: &[u16], grouper: &mut Grouper, threads: usize) {
        let Pieces { parts, pairs } = self;
        let groups = grouper.groups();
        in_rows(threads, field.height, ROWS, parts, |part, rows| {
            vectorised(
                #[inline(always)]
                || part.list(rows, field, image, groups),
            );
        });
        reserve_to(pairs, 2 * image.len());
        parts.iter().for_each(|part| pairs.extend(&part.pairs));
        grouper.unite(pairs);
    }
}

impl Part {
    #[inline(always)]
    fn list(&mut self, rows: Range<usize>, field: &Field, image: &[u16], groups: &Groups) {
        let Field { width, height, stride, ref q, .. } = *field;
        let is_missing = |[u, v]: [usize; 2]| q[v * stride + u].is_nan();
        let Part { pairs } = self;
        // On a chequered image every second pixel is two steps from four others.
        reserve_to(pairs, 2 * ROWS * stride);
        for v in rows {
            for start in (0..stride).step_by(ABREAST) {
                let Some(apart) = find_apart(image, v * stride + start, stride) else { continue };
                for (first, eight) in (start..).step_by(8).zip(apart.as_chunks::<8>().0) {
                    let mut rest = u64::from_le_bytes(*eight);
                    while rest != 0 {
                        let shift = rest.trailing_zeros() & !7;
                        let ways = (rest >> shift) as u8;
                        rest &= !(0xff << shift);
                        let u = first + shift as usize / 8;
                        // Where each leads, and what lies between.
                        let (right, below, left) = ([u + 1, v], [u, v + 1], [u.wrapping_sub(1), v]);
                        let to = [
                            ([u + 2, v], [right, right]),
                            ([u, v + 2], [below, below]),
                            ([u + 1, v + 1], [right, below]),
                            ([u.wrapping_sub(1), v + 1], [left, below]),
                        ];
                        for (way, ([x, y], between)) in to.into_iter().enumerate() {
                            let is_there = ways >> way & 1 > 0 && x < width && y < height;
                            if is_there && between.into_iter().any(is_missing) {
                                list(groups.at([u, v]), groups.at([x, y]), pairs);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Lists two groups, if they are two.
#[inline(always)]
fn list(a: u32, b: u32, pairs: &mut Vec<[u32; 2]>) {
    if a != b && pairs.last() != Some(&[a, b]) {
        pairs.push([a, b]);
    }
}

/// For each pixel from `at` on, as bits, which of the four that are two steps off, below or to the right, have its label
/// where none between has; `None` where all have one label. What it says at the ends of a row and of the image may be wrong.
#[inline(always)]
fn find_apart(image: &[u16], at: usize, stride: usize) -> Option<[u8; ABREAST]> {
    let part = |first: usize| image[first..].first_chunk::<ABREAST>().expect("pixels that follow the image");
    let (here, right, below) = (part(at), part(at + 1), part(at + stride));
    let mut any = 0;
    for i in 0..ABREAST {
        any |= (here[i] ^ right[i]) | (here[i] ^ below[i]);
    }
    if any == 0 {
        return None;
    }
    let (second, lower) = (part(at + 2), part(at + 2 * stride));
    let (across, back) = (part(at + stride + 1), part(at + stride - 1));
    let left = part(at.saturating_sub(1));
    let (corner, foot) = (part(at + stride + 2), part(at + 2 * stride + 1));
    let mut apart = [0; ABREAST];
    for i in 0..ABREAST {
        let own = here[i];
        let is_plane = (own != 0) & (own != BENT);
        let [by_right, by_below] = [right[i] != own, below[i] != own];
        // Around a lone hole they are one group for sure.
        let around = (below[i] == own) & (across[i] == own) & (corner[i] == own);
        let beside = (right[i] == own) & (across[i] == own) & (foot[i] == own);
        let to = [
            by_right & (second[i] == own) & !around,
            by_below & (lower[i] == own) & !beside,
            by_right & by_below & (across[i] == own),
            by_below & (left[i] != own) & (back[i] == own),
        ];
        let ways = u8::from(to[0]) | u8::from(to[1]) << 1 | u8::from(to[2]) << 2 | u8::from(to[3]) << 3;
        apart[i] = if is_plane { ways } else { 0 };
    }
    Some(apart)
}
