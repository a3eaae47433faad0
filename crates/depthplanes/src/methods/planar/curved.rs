//! Stage "curved": facets of curved surfaces are told from planes.
//!
//! In: regions of tiles. Out: which of them are curved. Growth cuts a ball or a column into facets, each
//! flat to within the noise. Two signs tell them. A region's own tile means bow: a quadratic explains more
//! of them than chance would. And across a joint of two facets one quadratic runs on smoothly, while the
//! crease of two planes leaves it far off: the best
//! parabola through a roof misses its ridge by 3/16 of the height.

use super::grow::{Region, Regions};
use super::tiles::{Layer, NONE, SIDE, Tile};
use crate::group::reserve_to;

/// Largest root mean square, in noise deviations of a pixel, of a plane's bow. Noise alone gives a region of
/// 15 tiles 0.11 (three terms of a quadratic, 240 pixels).
const BOW: f64 = 0.3;
/// Fewest tiles of a region whose bow means something.
const LEAST: usize = 15;
/// Fewest tiles that a quadratic, six numbers, is fitted to.
const ENOUGH: f64 = 12.0;
/// Largest mean square, in variances of a pixel, by which tile means may miss a quadratic that explains them.
const SMOOTH: f64 = 0.12;
/// The same for a small region beside one that is known to be curved.
const LOOSE: f64 = 0.4;
/// Variances by which the quadratic has to explain both better than their two planes do: three deviations.
const GAIN: f64 = 9.0;

/// A quadratic fitted to tile means by least squares: normal equations and their solution.
#[derive(Clone, Debug, Default)]
struct Quadratic {
    matrix: [[f64; 6]; 6],
    right: [f64; 6],
}

/// What a tile contributes: 1, x, y, x^2, x y, y^2 of its centre.
fn terms(x: f64, y: f64) -> [f64; 6] {
    [1.0, x, y, x * x, x * y, y * y]
}

impl Quadratic {
    fn add(&mut self, terms: [f64; 6], value: f64, weight: f64) {
        for i in 0..6 {
            self.right[i] += weight * terms[i] * value;
            for j in 0..6 {
                self.matrix[i][j] += weight * terms[i] * terms[j];
            }
        }
    }

    /// The coefficients; terms that the tiles do not determine are 0.
    fn solve(&self) -> [f64; 6] {
        let (mut m, mut r) = (self.matrix, self.right);
        let mut pivots = [false; 6];
        for i in 0..6 {
            pivots[i] = m[i][i] > 1e-9 * self.matrix[i][i];
            if pivots[i] {
                for k in i + 1..6 {
                    let factor = m[k][i] / m[i][i];
                    r[k] -= factor * r[i];
                    for j in i..6 {
                        m[k][j] -= factor * m[i][j];
                    }
                }
            }
        }
        let mut solution = [0.0; 6];
        for i in (0..6).rev().filter(|&i| pivots[i]) {
            let known: f64 = (i + 1..6).map(|j| m[i][j] * solution[j]).sum();
            solution[i] = (r[i] - known) / m[i][i];
        }
        solution
    }
}

/// Memory of this stage.
#[derive(Debug, Default)]
pub(super) struct Facets {
    fits: Vec<Quadratic>,
    boxes: Vec<TileBox>,
    curved: Vec<bool>,
}

impl Facets {
    /// Makes room for the worst of a map with so many tiles.
    pub(super) fn prepare(&mut self, tiles: usize) {
        reserve_to(&mut self.fits, 2 * tiles);
        reserve_to(&mut self.boxes, 2 * tiles);
        reserve_to(&mut self.curved, 2 * tiles);
    }

    /// Marks the regions that are facets of a curved surface.
    pub(super) fn mark(&mut self, layers: &[Layer], regions: &mut Regions) {
        regions.list_pairs(layers);
        let Facets { fits, boxes, curved } = self;
        mark_bowed(layers, regions, fits, curved);
        find_boxes(layers, regions, boxes);
        for &(a, b) in &regions.pairs {
            let is_larger = boxes[a as usize].area() < boxes[b as usize].area();
            let [small, large] = if is_larger { [a, b] } else { [b, a] };
            let joint = Joint::around(layers, regions, small, |id| id == large, &boxes[small as usize]);
            if let Some(seen) = joint.is_smooth() {
                curved[small as usize] = true;
                curved[large as usize] |= 2.0 * seen >= regions.all[large as usize].tiles as f64;
            }
        }
        while spread(layers, regions, boxes, curved) {}
        regions.all.iter_mut().zip(curved).for_each(|(region, curved)| region.is_curved |= *curved);
    }
}

/// Marks small regions that continue curved ones; whether there were any.
fn spread(layers: &[Layer], regions: &Regions, boxes: &[TileBox], curved: &mut [bool]) -> bool {
    let mut any = false;
    for &(a, b) in &regions.pairs {
        for (small, other) in [(a as usize, b as usize), (b as usize, a as usize)] {
            if curved[other] && !curved[small] && regions.all[small].tiles < LEAST {
                let joint = Joint::around(layers, regions, small as u32, |id| curved[id as usize], &boxes[small]);
                curved[small] = joint.continues();
                any |= curved[small];
            }
        }
    }
    any
}

/// Mean residual of a tile about a region's plane.
fn mean_residual(tile: &Tile, region: &Region) -> f64 {
    let [u, v] = tile.centre();
    tile.mean() - region.at(u, v)
}

/// Marks regions whose tile means follow a quadratic by more than [`BOW`].
fn mark_bowed(layers: &[Layer], regions: &Regions, fits: &mut Vec<Quadratic>, curved: &mut Vec<bool>) {
    fits.clear();
    fits.resize(regions.all.len(), Quadratic::default());
    for (_, tile, id) in layers.iter().flat_map(Layer::placed) {
        let region = &regions.all[id as usize];
        let scale = region.sums.n.sqrt();
        let [u, v] = tile.centre();
        let terms = terms((u - region.middle[0]) / scale, (v - region.middle[1]) / scale);
        fits[id as usize].add(terms, mean_residual(tile, region), tile.sums.n);
    }
    curved.clear();
    curved.extend(fits.iter().zip(&regions.all).map(|(fit, region)| {
        let explained: f64 = fit.solve().iter().zip(&fit.right).map(|(x, r)| x * r).sum();
        region.tiles >= LEAST && explained > BOW * BOW * region.variance
    }));
}

/// Columns and rows of tiles around a region.
#[derive(Clone, Copy, Debug)]
struct TileBox {
    first: [usize; 2],
    last: [usize; 2],
}

impl TileBox {
    fn area(&self) -> usize {
        (self.last[0] + 1).saturating_sub(self.first[0]) * (self.last[1] + 1).saturating_sub(self.first[1])
    }
}

impl TileBox {
    /// The box with its own size added on every side.
    fn widened(self, layer: &Layer) -> TileBox {
        let reach = [0, 1].map(|axis| self.last[axis].saturating_sub(self.first[axis]) + 2);
        let most = [layer.columns - 1, layer.rows - 1];
        TileBox {
            first: [0, 1].map(|axis| self.first[axis].saturating_sub(reach[axis])),
            last: [0, 1].map(|axis| (self.last[axis] + reach[axis]).min(most[axis])),
        }
    }
}

fn find_boxes(layers: &[Layer], regions: &Regions, boxes: &mut Vec<TileBox>) {
    boxes.clear();
    boxes.resize(regions.all.len(), TileBox { first: [usize::MAX; 2], last: [0; 2] });
    let columns = layers[0].columns;
    for (at, _, id) in layers.iter().flat_map(Layer::placed) {
        let around = &mut boxes[id as usize];
        for (axis, place) in [at % columns, at / columns].into_iter().enumerate() {
            around.first[axis] = around.first[axis].min(place);
            around.last[axis] = around.last[axis].max(place);
        }
    }
}

/// How well one quadratic explains a small region and its neighbours around it. First of each pair the
/// neighbours, then the region.
struct Joint {
    tiles: [f64; 2],
    pixels: [f64; 2],
    /// Squares of tile means about the quadratic, in variances of a tile's mean, beyond what noise leaves.
    missed: [f64; 2],
    /// The same about the regions' own planes.
    missed_by_planes: [f64; 2],
}

impl Joint {
    /// Looks at a region and at those that `neighbours` names, within its box and as much again on each side.
    fn around(
        layers: &[Layer],
        regions: &Regions,
        small: u32,
        neighbours: impl Fn(u32) -> bool,
        region_box: &TileBox,
    ) -> Self {
        let around = region_box.widened(&layers[0]);
        let plane = &regions.all[small as usize];
        let mut joint = Joint { tiles: [0.0; 2], pixels: [0.0; 2], missed: [0.0; 2], missed_by_planes: [0.0; 2] };
        let ours = |id: u32| id == small || (id != NONE && neighbours(id));
        let mut fit = Quadratic::default();
        around.each_tile(layers, ours, |tile, terms, id| {
            fit.add(terms, mean_residual(tile, plane), tile.sums.n);
            joint.tiles[usize::from(id == small)] += 1.0;
        });
        let coefficients = fit.solve();
        around.each_tile(layers, ours, |tile, terms, id| {
            let bow: f64 = terms.iter().zip(coefficients).map(|(x, c)| x * c).sum();
            let off = [mean_residual(tile, plane) - bow, mean_residual(tile, &regions.all[id as usize])];
            let [by_quadratic, by_plane] = off.map(|off| off * off * tile.sums.n / tile.variance - 1.0);
            let which = usize::from(id == small);
            joint.missed[which] += by_quadratic;
            joint.missed_by_planes[which] += by_plane;
            joint.pixels[which] += tile.sums.n;
        });
        joint
    }

    /// Whether it misses neither by more than `most` variances of a pixel.
    fn is_close(&self, most: f64) -> bool {
        (0..2).all(|which| self.missed[which] <= most * self.pixels[which])
    }

    /// Whether the quadratic explains both regions, and better than their planes; if so, how many tiles of
    /// the neighbour were seen.
    fn is_smooth(&self) -> Option<f64> {
        let enough = self.tiles.iter().all(|&tiles| tiles >= 4.0) && self.tiles.iter().sum::<f64>() >= ENOUGH;
        let better = self.missed.iter().sum::<f64>() + GAIN <= self.missed_by_planes.iter().sum();
        (enough && better && self.is_close(SMOOTH)).then_some(self.tiles[0])
    }

    /// Whether a small region lies on the quadratic of curved neighbours.
    fn continues(&self) -> bool {
        self.tiles[0] >= 4.0 && self.tiles.iter().sum::<f64>() >= ENOUGH && self.is_close(LOOSE)
    }
}

impl TileBox {
    /// Calls `visit` for each tile of the box whose region `ours` names.
    fn each_tile(&self, layers: &[Layer], ours: impl Fn(u32) -> bool, mut visit: impl FnMut(&Tile, [f64; 6], u32)) {
        let [u, v] = self.first.map(|first| (first * SIDE) as f64);
        let sides = self.last[0] + self.last[1] + 2 - self.first[0] - self.first[1];
        let scale = 1.0 / (SIDE * sides) as f64;
        for row in self.first[1]..=self.last[1] {
            for Layer { columns, tiles, region, .. } in layers {
                let part = row * columns + self.first[0]..row * columns + self.last[0] + 1;
                for (tile, &id) in tiles[part.clone()].iter().zip(&region[part]).filter(|(_, id)| ours(**id)) {
                    let [x, y] = tile.centre();
                    visit(tile, terms((x - u) * scale, (y - v) * scale), id);
                }
            }
        }
    }
}
