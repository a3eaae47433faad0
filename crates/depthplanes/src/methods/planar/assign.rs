//! Stage "assign": every pixel goes to the plane that it lies on.
//!
//! In: the map in q, the regions of its tiles. Out: a region image, 0 = none, else region + 1. Pixels are looked at in
//! blocks of 8 x 8. Where all tiles around are of one region nothing is to be decided. Elsewhere each pixel is held
//! against the planes of the tiles around it; where two planes meet at a crease, both explain the
//! pixels near it, and the line where they meet, which is known exactly, decides.

use super::field::{COLUMNS, Field};
use super::grid::{Grid, NONE};
use super::planes::Planes;
use super::rule::{Rule, is_near_both};
use super::tiles::SIDE;
use crate::group::vectorised;
use crate::parallel::{Rows, in_parts};
use std::ops::Range;

/// How much further from its plane a pixel may lie where no other plane is near, as a factor.
const INSIDE: f64 = 2.0;
/// Most planes that a block's pixels are held against.
const MOST: usize = 12;
/// Columns and rows of a block.
const BLOCK: usize = 2 * SIDE;
/// Pixels of a block.
pub(super) const PIXELS: usize = BLOCK * BLOCK;
/// A block's pixels, row by row.
pub(super) type Pixels<T> = [T; PIXELS];

/// Labels every pixel, on as many threads. `grids`: the tiles, and the blocks with the region that their tiles agree on.
pub(super) fn assign(field: &Field, grids: [&Grid; 2], planes: &Planes<'_>, threads: usize, image: &mut [u16]) {
    let per_row = BLOCK * field.stride;
    let assign = |part: BlockRows<'_>| {
        let mut scratch = Scratch::default();
        for (row, image) in (part.first..).zip(part.image.chunks_exact_mut(per_row)) {
            let q = &field.q[row * per_row..][..per_row];
            vectorised(
                #[inline(always)]
                || assign_row(field.stride, grids, planes, row, q, &mut scratch, image),
            );
        }
    };
    in_parts(threads, BlockRows { first: 0, per_row, image }, assign, |(), ()| ());
}

/// The image's pixels in some rows of blocks.
struct BlockRows<'a> {
    first: usize,
    /// Pixels of a row of blocks.
    per_row: usize,
    image: &'a mut [u16],
}

impl Rows for BlockRows<'_> {
    fn rows(&self) -> usize {
        self.image.len() / self.per_row
    }

    fn cut(self, rows: usize) -> (Self, Self) {
        let BlockRows { first, per_row, image } = self;
        let (above, below) = image.split_at_mut(rows * per_row);
        (BlockRows { first, per_row, image: above }, BlockRows { first: first + rows, per_row, image: below })
    }
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
            let (near, at) = (Near::new(tiles, column, row), column * BLOCK);
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

/// Blocks of a row that are looked at together, a multiple of which it has; the noise is taken to be the same in all that
/// are labelled at a time.
const STRETCH: usize = 8;
const _: () = assert!(COLUMNS.is_multiple_of(STRETCH * BLOCK));

/// For each block from `first` on its region, if all tiles of it and of the blocks around it are of that one.
#[inline(always)]
fn are_inside(blocks: &Grid, first: usize, row: usize) -> [u32; STRETCH] {
    let rows = [row.saturating_sub(1), row, (row + 1).min(blocks.rows - 1)];
    let [above, own, below] = rows.map(|row| {
        let row = &blocks.region[row * blocks.columns..][..blocks.columns];
        let mut around = [NONE; STRETCH + 2];
        around[0] = row[first.saturating_sub(1)];
        around[1..=STRETCH].copy_from_slice(&row[first..first + STRETCH]);
        around[STRETCH + 1] = row[(first + STRETCH).min(blocks.columns - 1)];
        around
    });
    let mut same = [NONE; STRETCH + 2];
    for x in 0..STRETCH + 2 {
        same[x] = if (above[x] == own[x]) & (below[x] == own[x]) { own[x] } else { NONE };
    }
    let mut inside = [NONE; STRETCH];
    for x in 0..STRETCH {
        inside[x] = if (same[x] == same[x + 1]) & (same[x + 1] == same[x + 2]) { same[x + 1] } else { NONE };
    }
    inside
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
    let most = (INSIDE * INSIDE * planes.reach(region, middle)) as f32;
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

/// The planes that a pixel is held against: the regions' numbers, and the middle of its block, which decides on the
/// noise.
pub(super) struct Held {
    pub(super) ids: Vec<u32>,
    pub(super) middle: [f64; 2],
    /// How much further off than elsewhere it may lie.
    pub(super) factor: f64,
}

/// Which planes [`assign`] holds the pixel in column `u`, row `v` against.
pub(super) fn held_against(grids: [&Grid; 2], [u, v]: [usize; 2]) -> Held {
    let [column, row] = [u / BLOCK, v / BLOCK];
    let near = Near::new(grids[0], column, row);
    let middle = [column, row].map(|place| (place * BLOCK) as f64 + HALF);
    let is_inside = are_inside(grids[1], column - column % STRETCH, row)[column % STRETCH] != NONE;
    Held { ids: near.ids().to_vec(), middle, factor: if is_inside { INSIDE } else { 1.0 } }
}

/// Tiles of a row that are looked at for a block: its own two, two on either side, and two that do not count.
const AROUND: usize = 8;

/// The regions of the tiles of a block and of those up to two tiles around it, the smallest number first.
struct Near {
    ids: [u32; MOST],
    count: usize,
}

impl Near {
    #[inline(always)]
    fn new(tiles: &Grid, column: usize, row: usize) -> Self {
        let mut near = Near { ids: [NONE; MOST], count: 0 };
        let first = (2 * column).saturating_sub(2).min(tiles.columns - AROUND);
        // Regions are fewer than labels; as short numbers they are compared twice as many at a time.
        let mut left = [[u16::MAX; AROUND]; 6];
        // All bits of those that do not count.
        let far: [u16; AROUND] = std::array::from_fn(|x| {
            let is_near = (first + x + 2 >= 2 * column) & (first + x <= 2 * column + 3);
            if is_near { 0 } else { u16::MAX }
        });
        for (y, left) in left.iter_mut().enumerate() {
            let y = (2 * row + y).saturating_sub(2).min(tiles.rows - 1);
            let ids = tiles.region[y * tiles.columns + first..].first_chunk::<AROUND>().expect("so many tiles");
            for x in 0..AROUND {
                left[x] = ids[x] as u16 | far[x];
            }
        }
        while near.count < MOST {
            let least = left.as_flattened().iter().fold(u16::MAX, |least, &id| least.min(id));
            if least == u16::MAX {
                break;
            }
            near.ids[near.count] = least.into();
            near.count += 1;
            left.as_flattened_mut().iter_mut().for_each(|id| *id = if *id == least { u16::MAX } else { *id });
        }
        near
    }

    fn ids(&self) -> &[u32] {
        &self.ids[..self.count]
    }
}

/// A block's pixels.
struct Block {
    middle: [f64; 2],
    q: Pixels<f32>,
}

/// A plane that some pixels of a block lie on, about the block's middle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Local {
    pub(super) id: u32,
    pub(super) a: f32,
    pub(super) b: f32,
    pub(super) c: f32,
    /// Square of the largest distance of its pixels.
    most: f32,
}

/// Memory for one block.
#[derive(Debug)]
struct Scratch {
    planes: [Local; MOST],
    /// For each plane the pixels' squared distances in units of `most`; infinite beyond.
    squares: [Pixels<f32>; MOST],
    /// How many other planes go before it.
    beaten: [Pixels<f32>; MOST],
    labels: Pixels<u16>,
}

impl Default for Scratch {
    fn default() -> Self {
        let nothing = [[0.0; PIXELS]; MOST];
        Scratch { planes: [Local::default(); MOST], squares: nothing, beaten: nothing, labels: [0; PIXELS] }
    }
}

/// Half of a block's columns, up to its middle.
const HALF: f64 = (BLOCK - 1) as f64 / 2.0;
/// Columns and rows of a block's pixels from its middle.
pub(super) const DU: Pixels<f32> = offsets(1);
pub(super) const DV: Pixels<f32> = offsets(BLOCK);

const fn offsets(step: usize) -> Pixels<f32> {
    let mut out = [0.0; PIXELS];
    let mut at = 0;
    while at < PIXELS {
        out[at] = (at / step % BLOCK) as f32 - (BLOCK - 1) as f32 / 2.0;
        at += 1;
    }
    out
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
                    Rule::between(one, other, &here[i], &here[j]).apply(
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
        let most = planes.reach(region, c) as f32;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Tiles in random rectangles of few regions and none, and the blocks with what their tiles agree on.
    fn grids(random: &mut Random) -> [Grid; 2] {
        let [mut tiles, mut blocks] = [Grid::new(SIDE), Grid::new(BLOCK)];
        (tiles.columns, tiles.rows, blocks.columns, blocks.rows) = (32, 12, 16, 6);
        tiles.region.resize(32 * 12, 0);
        let mut below = |most: usize| (random.uniform() * most as f64) as usize;
        for _ in 0..below(6) {
            let (id, first) = ([NONE, 1, 2, 3, 40][below(5)], [below(32), below(12)]);
            let size = [1 + below(20), 1 + below(8)];
            for row in first[1]..(first[1] + size[1]).min(12) {
                tiles.region[row * 32..][first[0]..(first[0] + size[0]).min(32)].fill(id);
            }
        }
        let agreed = |at: usize| {
            let first = at / 16 * 64 + at % 16 * 2;
            let ids = [0, 1, 32, 33].map(|step| tiles.region[first + step]);
            if ids == [ids[0]; 4] { ids[0] } else { NONE }
        };
        blocks.region = (0..16 * 6).map(agreed).collect();
        [tiles, blocks]
    }

    #[test]
    fn what_lies_around_a_block_is_what_a_search_of_the_tiles_finds() {
        let mut random = Random::new(3);
        for _ in 0..300 {
            let grids @ [tiles, blocks] = &grids(&mut random);
            for (row, column) in (0..blocks.rows).flat_map(|row| (0..blocks.columns).map(move |column| (row, column))) {
                let mut around = Vec::new();
                for y in (2 * row).saturating_sub(2)..(2 * row + 4).min(tiles.rows) {
                    let columns = (2 * column).saturating_sub(2)..(2 * column + 4).min(tiles.columns);
                    around.extend_from_slice(&tiles.region[y * tiles.columns..][columns]);
                }
                around.sort_unstable();
                around.dedup();
                let expected: Vec<u32> = around.iter().copied().filter(|&id| id != NONE).collect();
                assert_eq!(Near::new(tiles, column, row).ids(), expected);
                let inside = are_inside(blocks, column - column % STRETCH, row)[column % STRETCH];
                assert_eq!(inside, if around.len() == 1 { around[0] } else { NONE });
                let held = held_against([&grids[0], &grids[1]], [column * BLOCK + 3, row * BLOCK + 5]);
                assert_eq!((held.ids, held.factor), (expected, if inside == NONE { 1.0 } else { INSIDE }));
            }
        }
    }
}
