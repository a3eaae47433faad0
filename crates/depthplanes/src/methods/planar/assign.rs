//! Stage "assign": every pixel goes to the plane that it lies on.
//!
//! In: the map in q, the regions of its tiles. Out: a region image, 0 = none, else region + 1. Inside a
//! region nothing is to be decided. Along its border each pixel is held against the planes of the tiles
//! around it; where two planes meet at a crease, both explain the pixels near it, and the line
//! where they meet, which is known exactly, decides.

use super::grow::{Region, Regions};
use super::tiles::{Field, Layer, NONE, SIDE};
use crate::group::vectorised;
use crate::noise::NoiseModel;
use std::ops::Range;

/// How far around a tile planes are looked for, in tiles.
const REACH: usize = 2;
/// How much further from its plane a pixel may lie where no other plane is near, as a factor.
const INSIDE: f64 = 2.0;
/// A region goes if more than this share of its pixels lies on larger planes around it.
const EXPLAINED: f64 = 0.6;
/// Most planes that a tile's pixels are held against.
const MOST: usize = 12;

/// The regions of the tiles around one.
struct Around {
    ids: [u32; MOST],
    count: usize,
}

impl Around {
    fn new(layers: &[Layer], at: usize) -> Self {
        let (columns, rows) = (layers[0].columns, layers[0].rows);
        let (column, row) = (at % columns, at / columns);
        let mut around = Around { ids: [NONE; MOST], count: 0 };
        let (left, right) = (column.saturating_sub(REACH), (column + REACH + 1).min(columns));
        let mut last = NONE;
        for y in row.saturating_sub(REACH)..(row + REACH + 1).min(rows) {
            for layer in layers {
                for &id in &layer.region[y * columns + left..y * columns + right] {
                    if id != last {
                        around.include(id);
                        last = id;
                    }
                }
            }
        }
        around
    }

    fn include(&mut self, id: u32) {
        if id != NONE && self.count < MOST && !self.ids().contains(&id) {
            self.ids[self.count] = id;
            self.count += 1;
        }
    }

    fn ids(&self) -> &[u32] {
        &self.ids[..self.count]
    }
}

/// Calls `visit` for each valid pixel of a tile with its place and its (u, v, q).
fn each_pixel(field: &Field, columns: usize, at: usize, mut visit: impl FnMut(usize, [f64; 3])) {
    let (column, row) = (at % columns, at / columns);
    for v in row * SIDE..((row + 1) * SIDE).min(field.height) {
        for u in column * SIDE..((column + 1) * SIDE).min(field.width) {
            let place = v * field.width + u;
            let q = field.q[place];
            if !q.is_nan() {
                visit(place, [u as f64, v as f64, q.into()]);
            }
        }
    }
}

/// Leaves out regions whose pixels mostly lie on larger planes around them: tiles across a crease
/// make a strip that is flat to within the noise and no surface. `counts` is memory to work in.
pub(super) fn drop_explained(
    field: &Field,
    layers: &mut [Layer],
    regions: &Regions,
    reach: &Reach<'_>,
    counts: &mut Vec<Explained>,
) {
    counts.clear();
    counts.resize(regions.all.len(), Explained::default());
    for (at, tile, id) in layers.iter().flat_map(Layer::placed) {
        let (own, count) = (&regions.all[id as usize], &mut counts[id as usize]);
        let around = Around::new(layers, at);
        let is_larger = |other: &Region| other.sums.n > 2.0 * own.sums.n && !other.is_curved;
        let larger = around.ids().iter().map(|&other| &regions.all[other as usize]).filter(|other| is_larger(other));
        if own.is_curved || larger.clone().next().is_none() {
            count.pixels += tile.sums.n as u32;
            continue;
        }
        each_pixel(field, layers[0].columns, at, |_, point| {
            let most = reach.squared(point);
            if own.squared_distance(point) <= most {
                count.pixels += 1;
                count.by_others += u32::from(larger.clone().any(|other| other.squared_distance(point) <= most));
            }
        });
    }
    for region in layers.iter_mut().flat_map(|layer| &mut layer.region).filter(|region| **region != NONE) {
        let Explained { pixels, by_others } = counts[*region as usize];
        if f64::from(by_others) > EXPLAINED * f64::from(pixels) {
            *region = NONE;
        }
    }
}

/// A region's pixels, and how many of them larger planes explain.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Explained {
    pixels: u32,
    by_others: u32,
}

/// How far from a plane its pixels may lie.
pub(super) struct Reach<'a> {
    pub(super) noise: &'a NoiseModel,
    /// In standard deviations of the noise.
    pub(super) confidence: f64,
}

impl Reach<'_> {
    /// Square of the largest distance at a pixel, in q.
    fn squared(&self, [_, _, q]: [f64; 3]) -> f64 {
        self.confidence * self.confidence * self.noise.variance(q)
    }
}

/// Labels every pixel. `across` is memory to work in.
pub(super) fn assign(
    field: &Field,
    layers: &[Layer],
    regions: &Regions,
    reach: &Reach<'_>,
    across: &mut Vec<u32>,
    image: &mut [u16],
) {
    let (columns, rows) = (layers[0].columns, layers[0].rows);
    find_uniform(layers, across);
    for row in 0..rows {
        // The region of all tiles around a tile, where there is but one.
        let inside = |column: usize| {
            let mut ids =
                (row.saturating_sub(REACH)..(row + REACH + 1).min(rows)).map(|y| across[y * columns + column]);
            let first = ids.next().expect("the row itself");
            if ids.all(|id| id == first) { first } else { NONE }
        };
        let mut column = 0;
        while column < columns {
            let id = inside(column);
            let end = (column + 1..columns).find(|&next| id == NONE || inside(next) != id).unwrap_or(columns);
            if id == NONE {
                assign_tile(field, layers, regions, reach, row * columns + column, image);
            } else {
                vectorised(
                    #[inline(always)]
                    || assign_inside(field, &regions.all[id as usize], id as u16 + 1, reach, column..end, row, image),
                );
            }
            column = end;
        }
    }
}

/// For each tile the region of the tiles beside it and itself in all layers, if there is but one; else [`NONE`].
fn find_uniform(layers: &[Layer], across: &mut Vec<u32>) {
    across.clear();
    let columns = layers[0].columns;
    for first in (0..layers[0].region.len()).step_by(columns) {
        across.extend((0..columns).map(|column| {
            let beside = first + column.saturating_sub(REACH)..first + (column + REACH + 1).min(columns);
            let id = layers[0].region[first + column];
            let alike = layers[0].region[beside.clone()].iter().all(|&other| other == id);
            let alone = layers[1..].iter().all(|layer| layer.region[beside.clone()].iter().all(|&other| other == NONE));
            if alike && alone { id } else { NONE }
        }));
    }
}

/// Labels the pixels of a stretch of tiles in one row that have one region around them.
#[inline(always)]
fn assign_inside(
    field: &Field,
    region: &Region,
    label: u16,
    reach: &Reach<'_>,
    columns: Range<usize>,
    row: usize,
    image: &mut [u16],
) {
    let (first, end) = (columns.start * SIDE, (columns.end * SIDE).min(field.width));
    for v in row * SIDE..((row + 1) * SIDE).min(field.height) {
        let part = v * field.width + first..v * field.width + end;
        for ((u, &q), label_here) in (first as u32..).zip(&field.q[part.clone()]).zip(&mut image[part]) {
            let point = [f64::from(u), v as f64, f64::from(q)];
            let is_near = region.squared_distance(point) <= INSIDE * INSIDE * reach.squared(point); // not for NaN
            *label_here = if is_near { label } else { 0 };
        }
    }
}

/// Labels the pixels of a tile with several regions around it.
fn assign_tile(field: &Field, layers: &[Layer], regions: &Regions, reach: &Reach<'_>, at: usize, image: &mut [u16]) {
    let around = Around::new(layers, at);
    each_pixel(field, layers[0].columns, at, |place, point| {
        let best = nearest(around.ids(), regions, point, reach.squared(point));
        image[place] = best.map_or(0, |region| region as u16 + 1);
    });
}

/// The plane among `around` that a pixel lies on, if the square of its distance is at most `most`.
fn nearest(around: &[u32], regions: &Regions, point: [f64; 3], most: f64) -> Option<u32> {
    let mut best: Option<(f64, u32)> = None;
    for &id in around {
        let region = &regions.all[id as usize];
        let off = region.squared_distance(point);
        if off <= most
            && best.is_none_or(|(other_off, other)| region.wins(off, &regions.all[other as usize], other_off, point))
        {
            best = Some((off, id));
        }
    }
    best.map(|(_, id)| id)
}

impl Region {
    /// Square of a pixel's distance in q.
    #[inline(always)]
    fn squared_distance(&self, [u, v, q]: [f64; 3]) -> f64 {
        (q - self.at(u, v)).powi(2)
    }

    /// Whether a pixel that lies on two planes, so far off each, is this one's. A plane goes before a facet of a
    /// curved surface; the line where two planes meet goes before the distances.
    fn wins(&self, off: f64, other: &Region, other_off: f64, [u, v, _]: [f64; 3]) -> bool {
        if self.is_curved != other.is_curved {
            return other.is_curved;
        }
        let above = |[u, v]: [f64; 2]| self.at(u, v) - other.at(u, v);
        let (ours, theirs) = (above(self.middle), above(other.middle));
        if ours * theirs < 0.0 { above([u, v]) * ours > 0.0 } else { off < other_off }
    }
}
