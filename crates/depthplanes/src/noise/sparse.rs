//! Whether a map was measured at few of its pixels, and how far apart those are.
//!
//! In: a map. Out: [`Sparse`], bins of the map that mostly hold a measured pixel, and the one nearest to the middle of
//! each; `None` for maps of which most tiles are measured. Laser scans that were projected into a picture, sensors that
//! read every n-th row, and dots of a pattern look so: single pixels have no neighbours there, and bins have.

use crate::map::{DepthView, Pixel};
use crate::util::memory::reserve_to;

/// Columns and rows of a tile.
const TILE: usize = 4;
/// Measured pixels of a tile that is good for something: half of all.
const HALF: u32 = 8;
/// Share of the pixels that are in such tiles, from which on a map is worked on as it is. Every third row has half of its
/// pixels in them.
const DENSE: f64 = 0.6;
/// Rows of tiles that are looked at first, and the share from which on they tell: ordinary maps have more.
const FIRST: usize = 4;
const CERTAIN: f64 = 0.9;
/// Most columns and rows of a bin. Of one pixel in 144 nothing but the largest planes is seen.
const LARGEST: usize = 12;

/// The bins of a map and the pixel that stands for each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sparse<'a> {
    /// Columns and rows of the map that one of the bins has.
    pub side: [usize; 2],
    /// Columns and rows of bins.
    pub size: [usize; 2],
    /// For each bin, row by row, where its pixel stands in the map (row times width plus column), or [`Sparse::EMPTY`].
    pub pixels: &'a [u32],
    /// Mean of where the pixels lie in their bins, columns and rows from the first.
    pub centre: [f64; 2],
    /// Root mean square of their distance from there along an axis, bins.
    pub jitter: f64,
}

impl Sparse<'_> {
    /// No pixel of a bin was measured.
    pub const EMPTY: u32 = u32::MAX;
}

/// Finds out whether maps are sparse; reuses its memory.
#[derive(Debug, Default)]
pub struct SparseFinder {
    /// For each pixel how many are measured above and to the left of it: one row and one column more than the map.
    counts: Vec<u32>,
    pixels: Vec<u32>,
}

impl SparseFinder {
    /// The bins of a sparse map; `None` for others: those of which tiles of 4 x 4 pixels that are at least half measured
    /// hold most of the pixels.
    ///
    /// ```
    /// use depthplanes::DepthView;
    /// use depthplanes::noise::SparseFinder;
    /// // Every third row was measured.
    /// let depth_mm: Vec<u16> = (0..60 * 60).map(|at| if at / 60 % 3 == 1 { 1000 } else { 0 }).collect();
    /// let mut finder = SparseFinder::default();
    /// let found = finder.find(&DepthView::new(&depth_mm, 60, 60)?).unwrap();
    /// assert_eq!((found.side, found.centre, found.jitter), ([1, 3], [0.0, 1.0], 0.0));
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn find<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> Option<Sparse<'_>> {
        // Room for maps that are sparse, whichever comes first.
        reserve_to(&mut self.counts, (map.width() + 1) * (map.height() + 1));
        reserve_to(&mut self.pixels, map.area());
        if is_dense(map) {
            return None;
        }
        self.count(map);
        let size = [map.width(), map.height()];
        let Filled { pixels, in_halves, .. } = self.fill(size, [1, 1])?;
        if in_halves < DENSE * pixels {
            let side = self.best_side(size)?;
            return (side != [1, 1]).then(|| self.choose(map, side));
        }
        // Of every second row a tile has two, through which a plane goes whatever they are.
        let is_full = |filled: Filled| filled.pixels == (TILE * TILE) as f64 * filled.tiles;
        let side = [[1, 2], [2, 1]].into_iter().find(|&side| self.fill(size, side).is_some_and(is_full))?;
        Some(self.choose(map, side)).filter(|sparse| sparse.jitter == 0.0)
    }

    fn count<T: Pixel>(&mut self, map: &DepthView<'_, T>) {
        let SparseFinder { counts, .. } = self;
        let (validity, stride) = (map.validity(), map.width() + 1);
        counts.resize(stride, 0);
        for row in map.rows() {
            let above = counts.len() - stride;
            let mut own = 0;
            counts.push(0);
            for (u, &value) in row.iter().enumerate() {
                own += u32::from(validity.holds(value));
                counts.push(counts[above + u + 1] + own);
            }
        }
    }

    /// Measured pixels between some columns and rows.
    #[inline(always)]
    fn between(&self, stride: usize, first: [usize; 2], end: [usize; 2]) -> u32 {
        let at = |u: usize, v: usize| self.counts[v * stride + u];
        at(end[0], end[1]) + at(first[0], first[1]) - at(first[0], end[1]) - at(end[0], first[1])
    }

    /// How tiles of 4 x 4 bins are filled; `None` if no bin is.
    fn fill(&self, size: [usize; 2], side: [usize; 2]) -> Option<Filled> {
        let bins = [0, 1].map(|axis| size[axis] / side[axis]);
        let mut filled = Filled::default();
        for tile_row in 0..bins[1] / TILE {
            for tile_column in 0..bins[0] / TILE {
                let mut own = 0;
                for (row, column) in (0..TILE).flat_map(|row| (0..TILE).map(move |column| (row, column))) {
                    let first = [(tile_column * TILE + column) * side[0], (tile_row * TILE + row) * side[1]];
                    let end = [0, 1].map(|axis| first[axis] + side[axis]);
                    own += u32::from(self.between(size[0] + 1, first, end) > 0);
                }
                filled.add(own);
            }
        }
        (filled.tiles > 0.0).then_some(filled)
    }

    /// The sides for which bins are small and full: one that is `n` times as large has to be fuller by the fourth root of
    /// that, so that bins of random pixels are nine tenths full, and those of a pattern as large as its period. One that
    /// is longer than wide counts as larger by the fourth root of that.
    fn best_side(&self, size: [usize; 2]) -> Option<[usize; 2]> {
        let sides = (1..=LARGEST).flat_map(|columns| (1..=LARGEST).map(move |rows| [columns, rows]));
        let cost = |side: [usize; 2]| {
            let filled = self.fill(size, side)?;
            let full = filled.pixels / filled.tiles / (TILE * TILE) as f64;
            let [columns, rows] = side.map(|side| side as f64);
            let long = (columns / rows).max(rows / columns).sqrt().sqrt();
            let squared = full * full;
            (full >= 0.5).then(|| columns * rows * long / (squared * squared))
        };
        let costs = sides.filter_map(|side| Some((cost(side)?, side)));
        costs.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, side)| side)
    }

    /// Chooses the pixel of each bin that is nearest to its middle, the first of several.
    fn choose<T: Pixel>(&mut self, map: &DepthView<'_, T>, side: [usize; 2]) -> Sparse<'_> {
        let validity = map.validity();
        let size = [map.width().div_ceil(side[0]), map.height().div_ceil(side[1])];
        let middle = side.map(|side| (side - 1) as f64 / 2.0);
        reserve_to(&mut self.pixels, map.area());
        let mut places = Places::default();
        for (row, column) in (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (row, column))) {
            let mut best = (f64::INFINITY, Sparse::EMPTY, [0.0; 2]);
            for v in row * side[1]..((row + 1) * side[1]).min(map.height()) {
                for u in column * side[0]..((column + 1) * side[0]).min(map.width()) {
                    let place = [(u - column * side[0]) as f64, (v - row * side[1]) as f64];
                    let off = (place[0] - middle[0]).powi(2) + (place[1] - middle[1]).powi(2);
                    if off < best.0 && validity.holds(map.row(v)[u]) {
                        best = (off, (v * map.width() + u) as u32, place);
                    }
                }
            }
            let (_, pixel, place) = best;
            self.pixels.push(pixel);
            if pixel != Sparse::EMPTY {
                places.add(place);
            }
        }
        let centre = places.mean();
        Sparse { side, size, pixels: &self.pixels, centre, jitter: places.jitter(side) }
    }
}

/// How tiles are filled.
#[derive(Debug, Default)]
struct Filled {
    /// Measured pixels, those of them in tiles that are half measured, and tiles with any.
    pixels: f64,
    in_halves: f64,
    tiles: f64,
}

impl Filled {
    #[inline(always)]
    fn add(&mut self, pixels: u32) {
        self.pixels += f64::from(pixels);
        self.in_halves += if pixels >= HALF { f64::from(pixels) } else { 0.0 };
        self.tiles += if pixels > 0 { 1.0 } else { 0.0 };
    }
}

/// Where pixels lie in their bins.
#[derive(Default)]
struct Places {
    count: f64,
    sums: [f64; 2],
    squares: [f64; 2],
}

impl Places {
    fn add(&mut self, place: [f64; 2]) {
        self.count += 1.0;
        for axis in 0..2 {
            self.sums[axis] += place[axis];
            self.squares[axis] += place[axis] * place[axis];
        }
    }

    fn mean(&self) -> [f64; 2] {
        self.sums.map(|sum| sum / self.count.max(1.0))
    }

    /// Root mean square of the distance from the mean along an axis, in sides.
    fn jitter(&self, side: [usize; 2]) -> f64 {
        let (count, mean) = (self.count.max(1.0), self.mean());
        let of_axis =
            |axis: usize| (self.squares[axis] / count - mean[axis].powi(2)).max(0.0) / (side[axis] as f64).powi(2);
        ((of_axis(0) + of_axis(1)) / 2.0).sqrt()
    }
}

/// Whether some rows of tiles show that most of the map was measured.
fn is_dense<T: Pixel>(map: &DepthView<'_, T>) -> bool {
    let (validity, rows) = (map.validity(), map.height() / TILE);
    let mut filled = Filled::default();
    let mut counts = [0u8; 64];
    for row in (0..rows).step_by(rows.div_ceil(FIRST).max(1)) {
        for first in (0..map.width() / TILE).step_by(counts.len()) {
            let columns = (map.width() / TILE - first).min(counts.len());
            counts.fill(0);
            for v in row * TILE..(row + 1) * TILE {
                let part = &map.row(v)[first * TILE..][..columns * TILE];
                for (count, values) in counts.iter_mut().zip(part.as_chunks::<TILE>().0) {
                    *count += values.iter().map(|&value| u8::from(validity.holds(value))).sum::<u8>();
                }
            }
            counts.iter().for_each(|&count| filled.add(count.into()));
        }
    }
    // Of every second row tiles have half, and are no fuller.
    filled.pixels > (f64::from(HALF) + 1.0) * filled.tiles && filled.in_halves >= CERTAIN * filled.pixels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

    /// A map of ones where a rule says so.
    fn map_of([width, height]: [usize; 2], mut holds: impl FnMut(usize, usize) -> bool) -> Vec<u16> {
        (0..width * height).map(|at| u16::from(holds(at % width, at / width))).collect()
    }

    const SIZE: [usize; 2] = [163, 121];

    #[test]
    fn bins_are_as_large_as_the_period_of_a_pattern_and_the_pixel_is_where_it_was_measured() {
        let mut finder = SparseFinder::default();
        for [x, y] in [[1, 3], [3, 1], [1, 4], [4, 1], [2, 2], [3, 3], [4, 2], [1, 8], [5, 5], [1, 2], [2, 1]] {
            for [u0, v0] in [[0, 0], [x - 1, y / 2]] {
                let pixels = map_of(SIZE, |u, v| u % x == u0 && v % y == v0);
                let found = finder.find(&DepthView::new(&pixels, SIZE[0], SIZE[1]).unwrap()).unwrap();
                assert_eq!((found.side, found.jitter), ([x, y], 0.0), "at {u0}, {v0}");
                assert_eq!(found.centre, [u0 as f64, v0 as f64]);
                assert_eq!(found.size, [SIZE[0].div_ceil(x), SIZE[1].div_ceil(y)]);
                for (at, &pixel) in found.pixels.iter().enumerate() {
                    let [u, v] = [at % found.size[0] * x + u0, at / found.size[0] * y + v0];
                    let expected = if u < SIZE[0] && v < SIZE[1] { (v * SIZE[0] + u) as u32 } else { Sparse::EMPTY };
                    assert_eq!(pixel, expected);
                }
            }
        }
    }

    #[test]
    fn the_pixel_of_a_bin_is_the_nearest_to_its_middle_and_the_jitter_is_theirs() {
        let (mut finder, mut random) = (SparseFinder::default(), Random::new(3));
        for share in [0.3, 0.2, 0.1, 0.05] {
            let pixels = map_of(SIZE, |_, _| random.uniform() < share);
            let view = DepthView::new(&pixels, SIZE[0], SIZE[1]).unwrap();
            let found = finder.find(&view).unwrap();
            let full =
                found.pixels.iter().filter(|&&pixel| pixel != Sparse::EMPTY).count() as f64 / found.pixels.len() as f64;
            assert!(full > 0.7 && found.jitter > 0.1 && found.jitter < 0.3, "{share}: {full} {}", found.jitter);
            for (at, &chosen) in found.pixels.iter().enumerate() {
                let first = [at % found.size[0] * found.side[0], at / found.size[0] * found.side[1]];
                let off = |pixel: usize| {
                    let place = [pixel % SIZE[0], pixel / SIZE[0]];
                    let away = |axis: usize| (place[axis] - first[axis]) as f64 - (found.side[axis] - 1) as f64 / 2.0;
                    away(0).powi(2) + away(1).powi(2)
                };
                let own = (0..pixels.len()).filter(|&pixel| {
                    let place = [pixel % SIZE[0], pixel / SIZE[0]];
                    pixels[pixel] > 0
                        && (0..2).all(|axis| place[axis] / found.side[axis] == first[axis] / found.side[axis])
                });
                let nearest = own.min_by(|&a, &b| off(a).total_cmp(&off(b)));
                assert_eq!(nearest.map_or(Sparse::EMPTY, |pixel| pixel as u32), chosen);
            }
        }
    }

    #[test]
    fn maps_that_are_measured_in_most_tiles_are_not_sparse() {
        let (mut finder, mut random) = (SparseFinder::default(), Random::new(4));
        let mut ordinary = |what: &str, pixels: Vec<u16>| {
            assert_eq!(finder.find(&DepthView::new(&pixels, SIZE[0], SIZE[1]).unwrap()), None, "{what}");
        };
        ordinary("whole", map_of(SIZE, |_, _| true));
        ordinary("nothing", map_of(SIZE, |_, _| false));
        ordinary("a hole", map_of(SIZE, |u, v| u < 20 || v > 90));
        ordinary("a strip", map_of(SIZE, |_, v| v / 7 == 3));
        ordinary("two thirds at random", map_of(SIZE, |_, _| random.uniform() < 0.66));
        ordinary("a chequer", map_of(SIZE, |u, v| (u + v) % 2 == 0));
        ordinary("two rows of four", map_of(SIZE, |_, v| v % 4 < 2));
        ordinary("squares", map_of(SIZE, |u, v| (u / 4 + v / 4) % 2 == 0));
        for size in [[1, 1], [3, 3], [1, 50], [5, 4]] {
            let pixels = map_of(size, |u, v| (u + v) % 3 == 0);
            let _ = finder.find(&DepthView::new(&pixels, size[0], size[1]).unwrap());
        }
    }
}
