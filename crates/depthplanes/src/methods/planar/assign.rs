//! Stage "assign": every pixel goes to the plane that it lies on.
//!
//! In: the map in q, the regions of its tiles. Out: a region image, 0 = none, else region + 1. Pixels are looked at
//! in blocks of 8 x 8. Where all tiles around a block belong to one region, nothing is to be decided. Elsewhere each
//! pixel is compared with the planes of the tiles around it; where two planes meet at a crease, both explain the
//! pixels near it, and the line where they meet, which is known exactly, decides.

use super::block::{
    BLOCK, Candidates, DU, DV, HALF, INSIDE, Local, MOST_CANDIDATES, PIXELS, Pixels, STRETCH, are_inside,
};
use super::crease::{CreaseRule, is_near_both};
use super::grid::{Grid, NONE};
use super::layout::AffineMap;
use super::region::Planes;
use crate::util::parallel::{NumberedRows, map_reduce};
use crate::util::simd::vectorised;
use std::ops::Range;

/// Labels every pixel, on as many threads. `grids`: the tiles, and the blocks with the region that their tiles agree on.
pub(super) fn assign(affine: &AffineMap, grids: [&Grid; 2], planes: &Planes<'_>, threads: usize, image: &mut [u16]) {
    let per_row = BLOCK * affine.stride;
    let assign = |blocks: NumberedRows<'_, u16>| {
        let mut scratch = Scratch::default();
        for (row, image) in blocks.each() {
            let q = &affine.q[row * per_row..][..per_row];
            vectorised(
                #[inline(always)]
                || assign_row(affine.stride, grids, planes, row, q, &mut scratch, image),
            );
        }
    };
    map_reduce(threads, NumberedRows { first: 0, per_row, all: image }, assign, |(), ()| ());
}

#[inline(always)]
fn assign_row(
    stride: usize,
    [tiles, blocks]: [&Grid; 2],
    planes: &Planes<'_>,
    row: usize,
    q: &[f32],
    scratch: &mut Scratch,
    image: &mut [u16],
) {
    for first in (0..blocks.columns).step_by(STRETCH) {
        let inside = are_inside(blocks, first, row);
        let mut within = 0;
        while within < STRETCH {
            let (column, id) = (first + within, inside[within]);
            if id != NONE {
                let count = inside[within..].iter().take_while(|&&other| other == id).count();
                label_inside(stride, planes, id, column..column + count, row, q, image);
                within += count;
                continue;
            }
            let (near, at) = (Candidates::new(tiles, column, row), column * BLOCK);
            if near.count > 0 {
                let mut block =
                    Block { middle: [column, row].map(|place| (place * BLOCK) as f64 + HALF), q: [0.0; PIXELS] };
                for v in 0..BLOCK {
                    block.q[v * BLOCK..][..BLOCK].copy_from_slice(&q[v * stride + at..][..BLOCK]);
                }
                block.label(near.ids(), planes, scratch);
                for v in 0..BLOCK {
                    image[v * stride + at..][..BLOCK].copy_from_slice(&scratch.labels[v * BLOCK..][..BLOCK]);
                }
            } else {
                (0..BLOCK).for_each(|v| image[v * stride + at..][..BLOCK].fill(0));
            }
            within += 1;
        }
    }
}

/// Labels a stretch of blocks that have one region around them.
#[inline(always)]
fn label_inside(
    stride: usize,
    planes: &Planes<'_>,
    id: u32,
    columns: Range<usize>,
    row: usize,
    q: &[f32],
    image: &mut [u16],
) {
    let (region, label) = (planes.region(id), planes.label(id));
    let (first, end) = (columns.start * BLOCK, columns.end * BLOCK);
    let middle = region.at((first + end - 1) as f64 / 2.0, (row * BLOCK) as f64 + HALF);
    let most = (INSIDE * INSIDE * planes.inlier_threshold_squared(region, middle)) as f32;
    let a = region.abc[0] as f32;
    for v in 0..BLOCK {
        let part = v * stride + first..v * stride + end;
        let c = region.at(first as f64, (row * BLOCK + v) as f64) as f32;
        for ((&q, label_here), &du) in q[part.clone()].iter().zip(&mut image[part]).zip(&NUMBERS) {
            let off = q - (a * du + c);
            *label_here = if off * off <= most { label } else { 0 }; // not for NaN
        }
    }
}

/// 0, 1, ..
const NUMBERS: [f32; STRETCH * BLOCK] = {
    let mut numbers = [0.0; STRETCH * BLOCK];
    let mut at = 0;
    while at < numbers.len() {
        numbers[at] = at as f32;
        at += 1;
    }
    numbers
};

/// A block's pixels.
struct Block {
    middle: [f64; 2],
    q: Pixels<f32>,
}

/// Memory for one block.
#[derive(Debug)]
struct Scratch {
    planes: [Local; MOST_CANDIDATES],
    /// For each plane the pixels' squared distances in units of `most`; infinite beyond.
    squares: [Pixels<f32>; MOST_CANDIDATES],
    /// How many other planes go before it.
    beaten: [Pixels<f32>; MOST_CANDIDATES],
    labels: Pixels<u16>,
}

impl Default for Scratch {
    fn default() -> Self {
        let nothing = [[0.0; PIXELS]; MOST_CANDIDATES];
        Scratch { planes: [Local::default(); MOST_CANDIDATES], squares: nothing, beaten: nothing, labels: [0; PIXELS] }
    }
}

impl Block {
    /// Each pixel gets the plane within reach that the fewest others go before, of several the nearest.
    #[inline(always)]
    fn label(&self, ids: &[u32], planes: &Planes<'_>, scratch: &mut Scratch) {
        let Scratch { planes: here, squares, beaten, labels } = scratch;
        let mut count = 0;
        for &id in ids {
            here[count] = self.local(id, planes);
            count += usize::from(self.measure(&here[count], &mut squares[count]));
        }
        if count < 2 {
            let label = if count > 0 { planes.label(here[0].id) } else { 0 };
            for at in 0..PIXELS {
                labels[at] = if squares[0][at] <= 1.0 { label } else { 0 };
            }
            return;
        }
        beaten[..count].fill([0.0; PIXELS]);
        for j in 1..count {
            for i in 0..j {
                let (first, second) = beaten.split_at_mut(j);
                let [one, other] = [i, j].map(|at| planes.region(here[at].id));
                if overlap(&squares[i], &squares[j]) {
                    CreaseRule::between(one, other, &here[i], &here[j]).apply(
                        [&squares[i], &squares[j]],
                        &mut first[i],
                        &mut second[0],
                    );
                }
            }
        }
        let mut best = [f32::INFINITY; PIXELS];
        let mut chosen = [0u32; PIXELS];
        for i in 0..count {
            let label = u32::from(planes.label(here[i].id));
            for at in 0..PIXELS {
                // Being beaten goes first: distances are at most 1.
                let score = 1.001 * beaten[i][at] + squares[i][at];
                chosen[at] = if score < best[at] { label } else { chosen[at] };
                best[at] = if score < best[at] { score } else { best[at] };
            }
        }
        for at in 0..PIXELS {
            labels[at] = chosen[at] as u16;
        }
    }

    #[inline(always)]
    fn local(&self, id: u32, planes: &Planes<'_>) -> Local {
        let (region, [u, v]) = (planes.region(id), self.middle);
        let c = region.at(u, v);
        let most = planes.inlier_threshold_squared(region, c) as f32;
        Local { id, a: region.abc[0] as f32, b: region.abc[1] as f32, c: c as f32, most }
    }

    /// Measures the pixels' distances from a plane; whether some are within reach.
    #[inline(always)]
    fn measure(&self, plane: &Local, squares: &mut Pixels<f32>) -> bool {
        let per_most = 1.0 / plane.most;
        let mut any = 0u32;
        for at in 0..PIXELS {
            let off = self.q[at] - (plane.a * DU[at] + plane.b * DV[at] + plane.c);
            let square = off * off * per_most;
            squares[at] = if square <= 1.0 { square } else { f32::INFINITY };
            any |= u32::from(square <= 1.0);
        }
        any > 0
    }
}

/// Whether some pixels are within reach of both of two planes.
#[inline(always)]
fn overlap(a: &Pixels<f32>, b: &Pixels<f32>) -> bool {
    let both = a.iter().zip(b).fold(0u32, |any, (a, b)| any | u32::from(is_near_both(*a, *b)));
    both > 0
}
