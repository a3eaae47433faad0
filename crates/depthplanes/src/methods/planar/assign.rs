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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::layout::SIDE;
    use crate::methods::planar::region::CURVED_LABEL;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, THRESHOLD, noise, planes};
    use crate::util::random::Random;

    /// The label of every pixel, without what is beyond the map.
    fn image_of(made: &Made, stages: &mut Stages, curved: bool, threads: usize) -> Vec<u16> {
        let run = &mut stages.run;
        // What another map has left.
        let mut image = vec![77; run.affine.q.len()];
        run.pyramid.propagate_up(1);
        let [tiles, blocks, ..] = &run.pyramid.grids;
        let planes = Planes { curved, ..planes(&run.regions.all, &stages.noise) };
        assign(&run.affine, [tiles, blocks], &planes, threads, &mut image);
        image.chunks(run.affine.stride).take(made.height).flat_map(|row| row[..made.width].to_vec()).collect()
    }

    #[test]
    fn pixels_on_a_plane_get_it_and_outliers_and_missing_ones_do_not() {
        let mut random = Random::new(3);
        // Off by so many deviations, or missing.
        let kinds = [0.0, 3.0, -3.5, 7.0, 9.0, -12.0, 1000.0, f64::NAN];
        let offs: Vec<f64> = (0..130 * 70).map(|_| kinds[random.whole(0, 63).min(7)]).collect();
        let plane = |u: usize, v: usize| 40.0 + 0.05 * u as f64 - 0.03 * v as f64;
        let clean = Made::exact([130, 70], plane);
        let made = Made::exact([130, 70], |u, v| plane(u, v) + SIGMA * offs[v * 130 + u]);
        let mut stages = Stages::tiles(&clean, noise(0.0));
        // To the right of column 64 no tile has a region.
        stages.divide(|column, _| if column < 16 { 0 } else { NONE });
        let other = Stages::tiles(&made, noise(0.0));
        stages.run.affine = other.run.affine;
        for threads in [1, 2] {
            let image = image_of(&made, &mut stages, false, threads);
            for (at, &label) in image.iter().enumerate() {
                let (u, off) = (at % 130, offs[at].abs());
                // Twice as far where all blocks around are of the plane: not beside those that have no tile, and the
                // last row of blocks has none below it. Out of reach is what lies more than two tiles off.
                let most = if u < 56 && at / 130 < 64 { 2.0 * THRESHOLD } else { THRESHOLD };
                let is_near = u < 72;
                assert_eq!(label, u16::from(is_near && off <= most), "{off} deviations off, column {u}");
            }
        }
    }

    #[test]
    fn each_pixel_gets_the_nearest_of_the_planes_around_its_block_that_it_lies_on() {
        // Parallel planes, that no line parts: the nearest decides, and of an even number of deviations none.
        let mut random = Random::new(8);
        let level = |id: u32| 40.0 + 5.0 * SIGMA * f64::from(id);
        for round in 0..20 {
            let clean = Made::exact([128, 64], |u, _| level((u / 4 % 4) as u32));
            let made = Made::exact([128, 64], |_, _| {
                if random.uniform() < 0.05 { f64::NAN } else { 40.0 + SIGMA * random.between(-6.0, 21.0) }
            });
            let mut stages = Stages::tiles(&clean, noise(0.0));
            stages.divide(|column, _| (column % 4) as u32);
            // Their tiles lie elsewhere, in rectangles, now and then alone.
            let grid = &mut stages.run.pyramid.grids[0];
            let ids: Vec<u32> = (0..16 * 8).map(|_| [NONE, 0, 1, 2, 3][random.whole(0, 4)]).collect();
            let size = [2, 4, 8][round % 3];
            for at in 0..grid.len() {
                grid.region[at] = ids[at / 32 / size * 16 + at % 32 / size];
            }
            stages.run.affine = Stages::tiles(&made, noise(0.0)).run.affine;
            let image = image_of(&made, &mut stages, false, 1);
            let region = |column: usize, row: usize| stages.grid().region[row * 32 + column];
            let mut seen = [0; 5];
            for (at, &label) in image.iter().enumerate() {
                let [u, v] = [at % 128, at / 128];
                let [column, row] = [u / BLOCK * 2, v / BLOCK * 2];
                let around = |by: usize| {
                    let rows = row.saturating_sub(by)..(row + 2 + by).min(16);
                    let columns = column.saturating_sub(by)..(column + 2 + by).min(32);
                    rows.flat_map(move |row| columns.clone().map(move |column| (column, row)))
                };
                let mut ids: Vec<u32> = around(2).map(|(column, row)| region(column, row)).collect();
                ids.sort_unstable();
                ids.dedup();
                let most = if ids.len() == 1 { 2.0 * THRESHOLD } else { THRESHOLD };
                let q = f64::from(made.q[at]);
                let off = |id: u32| (q - level(id)).abs() / SIGMA;
                let mut held: Vec<u32> = ids.into_iter().filter(|&id| id != NONE && off(id) <= most).collect();
                held.sort_by(|&a, &b| off(a).total_cmp(&off(b)));
                let expected = held.first().map_or(0, |id| id + 1);
                // What is as good as undecided depends on the rounding.
                let is_close = |a: f64, b: f64| (a - b).abs() < 0.01;
                let undecided =
                    (0..4).any(|id| is_close(off(id), most)) || held.len() > 1 && is_close(off(held[0]), off(held[1]));
                assert!(undecided || u32::from(label) == expected, "{label}, not {expected}, at {u}, {v}: {held:?}");
                seen[expected as usize] += 1;
            }
            assert!(seen.iter().all(|&count| count > 0) || round % 3 > 0, "{seen:?}");
        }
    }

    #[test]
    fn at_a_crease_the_line_where_the_planes_meet_decides() {
        // Up to a dozen columns to each side a pixel lies on both planes. The line runs aslant through the blocks.
        let line = |u: f64, v: f64| u - 70.0 - 0.3 * v;
        for seed in 0..5 {
            let mut random = Random::new(seed);
            let q = |u: f64, v: f64| 40.0 + 0.02 * v - 0.02 * line(u, v).abs();
            // Little noise, so that no block has reason to doubt the line.
            let made = Made::exact([128, 64], |u, v| q(u as f64, v as f64) + 0.1 * SIGMA * random.gaussian());
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, row| {
                let [u, v] = [column, row].map(|place| (SIDE * place) as f64 + 1.5);
                u32::from(line(u, v) > 0.0)
            });
            // The planes as they are, without the tiles that lie on both sides.
            let clean = Made::exact([128, 64], |u, v| {
                let off = line(u as f64, v as f64);
                if off.abs() > 6.0 { q(u as f64, v as f64) } else { f64::NAN }
            });
            let mut right = Stages::tiles(&clean, noise(0.0));
            right.divide(|column, row| u32::from(line((SIDE * column) as f64 + 1.5, (SIDE * row) as f64 + 1.5) > 0.0));
            stages.run.regions.all = right.run.regions.all;
            let image = image_of(&made, &mut stages, false, 1);
            for (at, &label) in image.iter().enumerate() {
                let off = line((at % 128) as f64, (at / 128) as f64);
                if off.abs() > 0.05 {
                    assert_eq!(label, 1 + u16::from(off > 0.0), "{off} columns off the line, seed {seed}");
                }
            }
        }
    }

    #[test]
    fn a_plane_goes_before_a_facet_of_a_curved_surface_and_either_has_the_labels_that_are_sought() {
        let made = Made::noisy([128, 64], 3, |u, v| 40.0 + 0.05 * u - 0.03 * v);
        for (curved, expected) in [(false, [1, CURVED_LABEL, 1]), (true, [0, 2, 0])] {
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, _| u32::from(column >= 16));
            stages.run.regions.all[1].is_curved = true;
            let image = image_of(&made, &mut stages, curved, 1);
            // Both explain the pixels of the blocks on the border, whose tiles are of either.
            for (at, &label) in image.iter().enumerate() {
                let u = at % 128;
                let off = f64::from(made.q[at]) - stages.all()[0].at(u as f64, (at / 128) as f64);
                if off.abs() < 3.0 * SIGMA {
                    let which =
                        [(0..56, 0), (56..72, 2), (72..128, 1)].into_iter().find(|(columns, _)| columns.contains(&u));
                    assert_eq!(label, expected[which.unwrap().1], "column {u}");
                }
            }
        }
    }
}
