//! Stage "tiles": the map in the space where planes are affine, and the sums of its small squares.
//!
//! In: a map and its noise model. Out: q for every pixel, and for every tile of [`SIDE`] x [`SIDE`]
//! pixels the nine sums of its valid pixels and the scatter about its own plane. From here on whole
//! tiles are added and tested by their sums alone; pixels are looked at again only by `assign`.

use crate::fit::Moments;
use crate::map::{DepthView, Pixel};
use crate::noise::{NoiseModel, Space};

/// Columns and rows of a tile. The smallest plane has to hold a few; a tile's own plane should still
/// mean something under noise. Of 4, 5, 6 and 8, 4 was the best on ABW and on made-up rooms.
pub(super) const SIDE: usize = 4;

/// A map in q, row by row; NaN where nothing was measured.
#[derive(Debug, Default)]
pub(super) struct Field {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) q: Vec<f32>,
    pub(super) valid_pixels: usize,
    /// Steps that the map's values come in, map units; 0 for values that are not rounded.
    pub(super) step: f64,
    seen: Vec<bool>,
}

impl Field {
    /// Turns every value into q.
    pub(super) fn fill<T: Pixel>(&mut self, map: &DepthView<'_, T>, space: Space) {
        (self.width, self.height) = (map.width(), map.height());
        let validity = map.validity();
        self.q.clear();
        for row in map.rows() {
            self.q.extend(row.iter().map(|&value| {
                let q = space.q(value.into()) as f32;
                if validity.holds(value) { q } else { f32::NAN }
            }));
        }
        self.valid_pixels = self.q.iter().filter(|q| !q.is_nan()).count();
        self.step = if T::IS_INTEGER { self.value_step(map) } else { 0.0 };
    }

    /// The lower quartile of the distances of neighbouring values that occur: scaled maps leave out many.
    fn value_step<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> f64 {
        self.seen.clear();
        self.seen.resize(1 << 16, false);
        let validity = map.validity();
        for &value in map.rows().flatten().filter(|value| validity.holds(**value)) {
            self.seen[value.into() as usize] = true;
        }
        let occur = || (1..self.seen.len()).filter(|&value| self.seen[value]);
        let steps = || occur().zip(occur().skip(1)).map(|(a, b)| b - a);
        let count = steps().count();
        let most = |step: usize| 4 * steps().filter(|&other| other <= step).count() >= count;
        (1..self.seen.len()).find(|&step| most(step)).unwrap_or(1) as f64
    }
}

/// A tile: sums over its valid pixels about its first pixel and `q`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tile {
    /// About (`u`, `v`, `q`).
    pub(super) sums: Moments,
    /// First column.
    pub(super) u: f64,
    /// First row.
    pub(super) v: f64,
    /// Reference value, near its pixels'.
    pub(super) q: f64,
    /// Squared residuals about its own plane; infinite if it has none.
    pub(super) squares: f64,
    /// Variance of a pixel's q that the noise model expects here.
    pub(super) variance: f64,
}

impl Tile {
    /// Sum of squared residuals about a plane that stands about (u, v, q) = `origin`.
    #[inline]
    pub(super) fn squares_about(&self, [a, b, c]: [f64; 3], [u, v, q]: [f64; 3]) -> f64 {
        self.sums.squares_about([a, b, c + a * (self.u - u) + b * (self.v - v) + q - self.q])
    }

    /// Mean squared residual about its own plane in units of the variance expected.
    pub(super) fn scatter(&self) -> f64 {
        self.squares / ((self.sums.n - 3.0).max(1.0) * self.variance)
    }

    /// Mean (u, v) of its pixels.
    pub(super) fn centre(&self) -> [f64; 2] {
        [self.u + self.sums.u / self.sums.n, self.v + self.sums.v / self.sums.n]
    }

    /// Mean q.
    pub(super) fn mean(&self) -> f64 {
        self.q + self.sums.q / self.sums.n
    }
}

/// No region.
pub(super) const NONE: u32 = u32::MAX;

/// All tiles of a map, row by row, over the pixels that are still free.
#[derive(Debug, Default)]
pub(super) struct Layer {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) tiles: Vec<Tile>,
    /// For each tile its region, or [`NONE`].
    pub(super) region: Vec<u32>,
}

impl Layer {
    /// Sums the pixels that `taken` says 0 of, tile by tile.
    pub(super) fn sum(&mut self, field: &Field, taken: &[u16]) {
        (self.columns, self.rows) = (field.width.div_ceil(SIDE), field.height.div_ceil(SIDE));
        self.tiles.clear();
        for row in 0..self.rows {
            self.tiles.extend((0..self.columns).map(|column| tile(field, taken, column * SIDE, row * SIDE)));
        }
        self.region.clear();
        self.region.resize(self.tiles.len(), NONE);
    }

    /// Sets the variances that a noise model expects.
    pub(super) fn expect(&mut self, noise: &NoiseModel) {
        for tile in self.tiles.iter_mut().filter(|tile| tile.sums.n > 0.0) {
            tile.variance = noise.variance(tile.mean());
        }
    }

    /// The four neighbours of a tile.
    pub(super) fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let (columns, column, count) = (self.columns, at % self.columns, self.tiles.len());
        let beside = [
            (column > 0).then(|| at - 1),
            (column + 1 < columns).then(|| at + 1),
            at.checked_sub(columns),
            Some(at + columns).filter(|&below| below < count),
        ];
        beside.into_iter().flatten()
    }

    /// The tiles that belong to a region: place, tile, region.
    pub(super) fn placed(&self) -> impl Iterator<Item = (usize, &Tile, u32)> {
        let all = self.tiles.iter().zip(&self.region).enumerate();
        all.filter(|(_, (_, id))| **id != NONE).map(|(at, (tile, &id))| (at, tile, id))
    }
}

fn tile(field: &Field, taken: &[u16], u: usize, v: usize) -> Tile {
    let columns = u..(u + SIDE).min(field.width);
    let rows = v..(v + SIDE).min(field.height);
    let mut tile = Tile { u: u as f64, v: v as f64, squares: f64::INFINITY, ..Tile::default() };
    for (dv, v) in rows.enumerate() {
        let row = v * field.width;
        for (du, at) in (row + columns.start..row + columns.end).enumerate() {
            let q = f64::from(field.q[at]);
            if !q.is_nan() && taken[at] == 0 {
                if tile.sums.n == 0.0 {
                    tile.q = q;
                }
                tile.sums.add(du as f64, dv as f64, q - tile.q);
            }
        }
    }
    if let Some(fit) = tile.sums.fit() {
        tile.squares = fit.rms * fit.rms * fit.n;
    }
    tile
}
