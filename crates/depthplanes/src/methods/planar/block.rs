//! A block of 8 x 8 pixels, and which regions lie around it.
//!
//! In: the regions of tiles, and of blocks. Out: the candidate regions whose planes a block's pixels are compared with.

use super::grid::{Grid, NONE};
use super::layout::{COLUMNS, SIDE};

/// Columns and rows of a block.
pub(super) const BLOCK: usize = 2 * SIDE;
/// Pixels of a block.
pub(super) const PIXELS: usize = BLOCK * BLOCK;
/// A block's pixels, row by row.
pub(super) type Pixels<T> = [T; PIXELS];
/// Half of a block's columns, up to its middle.
pub(super) const HALF: f64 = (BLOCK - 1) as f64 / 2.0;
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

/// How much further from its plane a pixel may lie where no other plane is near, as a factor.
pub(super) const INSIDE: f64 = 2.0;

/// A plane that some pixels of a block lie on, about the block's middle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Local {
    pub(super) id: u32,
    pub(super) a: f32,
    pub(super) b: f32,
    pub(super) c: f32,
    /// Square of the largest distance of its pixels.
    pub(super) most: f32,
}

/// Most planes that a block's pixels are held against.
pub(super) const MOST_CANDIDATES: usize = 12;
/// Blocks of a row that are looked at together, a multiple of which it has; the noise is taken to be the same in all that
/// are labelled at a time.
pub(super) const STRETCH: usize = 8;
const _: () = assert!(COLUMNS.is_multiple_of(STRETCH * BLOCK));

/// For each block from `first` on its region, if all tiles of it and of the blocks around it are of that one.
#[inline(always)]
pub(super) fn are_inside(blocks: &Grid, first: usize, row: usize) -> [u32; STRETCH] {
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

/// Tiles of a row that are looked at for a block: its own two, two on either side, and two that do not count.
const AROUND: usize = 8;

/// The regions of the tiles of a block and of those up to two tiles around it, the smallest number first.
pub(super) struct Candidates {
    ids: [u32; MOST_CANDIDATES],
    pub(super) count: usize,
}

impl Candidates {
    #[inline(always)]
    pub(super) fn new(tiles: &Grid, column: usize, row: usize) -> Self {
        let mut near = Candidates { ids: [NONE; MOST_CANDIDATES], count: 0 };
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
        while near.count < MOST_CANDIDATES {
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

    pub(super) fn ids(&self) -> &[u32] {
        &self.ids[..self.count]
    }
}

/// The planes that a pixel is held against: the regions' numbers, and the middle of its block, which decides on the
/// noise.
pub(super) struct PixelCandidates {
    pub(super) ids: Vec<u32>,
    pub(super) middle: [f64; 2],
    /// How much further off than elsewhere it may lie.
    pub(super) factor: f64,
}

/// Which planes stage "assign" holds the pixel in column `u`, row `v` against.
pub(super) fn candidates_of_pixel(grids: [&Grid; 2], [u, v]: [usize; 2]) -> PixelCandidates {
    let [column, row] = [u / BLOCK, v / BLOCK];
    let near = Candidates::new(grids[0], column, row);
    let middle = [column, row].map(|place| (place * BLOCK) as f64 + HALF);
    let is_inside = are_inside(grids[1], column - column % STRETCH, row)[column % STRETCH] != NONE;
    PixelCandidates { ids: near.ids().to_vec(), middle, factor: if is_inside { INSIDE } else { 1.0 } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

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
                assert_eq!(Candidates::new(tiles, column, row).ids(), expected);
                let inside = are_inside(blocks, column - column % STRETCH, row)[column % STRETCH];
                assert_eq!(inside, if around.len() == 1 { around[0] } else { NONE });
                let held = candidates_of_pixel([&grids[0], &grids[1]], [column * BLOCK + 3, row * BLOCK + 5]);
                assert_eq!((held.ids, held.factor), (expected, if inside == NONE { 1.0 } else { INSIDE }));
            }
        }
    }
}
