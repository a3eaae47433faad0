//! How far off a map's pixels are, and how far means over larger and larger cells are, estimated from the map itself.
//!
//! In: the means of neighbouring cells of [`SIDES`] pixels. Out: the parts of a pixel's error ([`Errors`]). The
//! second difference of three neighbouring means is 0 on every plane, so its scatter is error. White error falls with
//! a cell's side, smooth error does not. Differences across the scene's edges do not fall either, but the median
//! ignores them as long as they are less than half of what is looked at.

use super::errors::Errors;
use super::median::{median, middle_of, pair_order};
use super::rounding::{Rounding, steady};
use super::space::Space;
use crate::util::memory::reserve_to;
use crate::util::simd::vectorised;

/// Sides of the cells, pixels.
pub(super) const SIDES: [usize; 4] = [4, 8, 16, 32];
/// Cells of so many sides are summed over pixels; a cell of the last side is put together from four.
pub(super) const SUMMED: usize = SIDES.len() - 1;
/// The first side whose cells are checked for an edge.
const EDGES: usize = 2;
/// Most cells that are looked at for each side, about: a median of 4,000 is known to 2 %.
pub(crate) const SAMPLE: usize = 4096;
/// Fewest second differences that give an estimate.
pub(super) const FEW: usize = 16;
/// Share of its usual number of pixels that a cell has to have.
const WHOLE: f32 = 0.75;
/// Stretches of q, with equal counts, that tell how the error grows over the range.
const STRETCHES: usize = 6;
/// Ratios of constant error to error that grows with q^2: how many are tried.
const SHAPES: usize = 17;
/// Median and lower quartile of the square of a standard normal number.
const MEDIAN_OF_SQUARE: f64 = 0.454_936;
const QUARTILE_OF_SQUARE: f64 = 0.101_531;
/// Median of chi-squared of the 13 degrees of freedom of a tile.
const MEDIAN_OF_TILE: f64 = 12.34;
/// Largest ratio of the scatter of cell means to that of means over cells of half the side: correlated error does not
/// grow with the side; what grows faster is the scene.
const GROWTH: f64 = 2.0;
/// Most steep tiles that the lateral error is estimated from.
const STEEP_ONES: usize = 512;
/// Largest squared residuals of a cell without an edge, as a multiple of their mean: 1.5 deviations.
const WITHOUT_EDGE: f64 = 2.25;
/// One cell in so many has to be without an edge for planes to be compared with what these cells show: where fewer
/// are, the map is clutter and what they show is chance.
const WHOLE_CELLS: usize = 3;
/// A lateral error is estimated if steep tiles scatter more than flat ones by this factor, in variance.
const STEEP: f64 = 1.25;
/// Smallest and largest lateral error of a pixel's direction, pixels: no camera is calibrated to better, and an error
/// of more is the next pixel's.
pub(crate) const RAY: [f64; 2] = [0.05, 0.5];

/// A second difference of the means of three neighbouring cells.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bend {
    /// q in the middle.
    pub(crate) q: f32,
    /// Squared slope there, a^2 + b^2.
    pub(crate) slope: f32,
    /// The square of `(m[-1] - 2 m[0] + m[1]) / sqrt 6`: its expected value is the variance of a cell's mean.
    pub(crate) square: f32,
    /// Squared residuals of a cell's pixels about its own plane, over their degrees of freedom: the largest of the
    /// three cells; for sides from [`EDGES`] on.
    pub(crate) residual: f32,
}

/// Cells of one side, row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    /// Which of [`SIDES`].
    pub(crate) level: usize,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Pixels that a tile usually has.
    pub(crate) usual: f32,
}

/// A cell: its pixels, its plane `q = a du + b dv + c` about its middle, and the squared residuals of the pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) n: f32,
    pub(crate) abc: [f32; 3],
    pub(crate) squares: f32,
}

/// Squared residuals of a tile's pixels about its own plane, over its degrees of freedom.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Scatter {
    pub(crate) q: f32,
    pub(crate) slope: f32,
    pub(crate) square: f32,
}

/// A second difference of means on a slope, and the variance that it would have without the slope.
#[derive(Clone, Copy, Debug)]
struct Steep {
    square: f64,
    slope: f64,
    flat: f64,
}

/// What was measured of a map or of several; reuses its memory.
#[derive(Debug, Default)]
pub(crate) struct Scales {
    /// For each of [`SIDES`].
    pub(crate) bends: [Vec<Bend>; SIDES.len()],
    pub(crate) tiles: Vec<Scatter>,
    /// Cells of the last of the sides.
    fours: Vec<Cell>,
    numbers: Vec<f32>,
    steep: Vec<Steep>,
}

impl Scales {
    /// Forgets everything and makes room for a map.
    pub(crate) fn prepare(&mut self) {
        for bends in &mut self.bends {
            bends.clear();
            reserve_to(bends, 4 * SAMPLE);
        }
        self.tiles.clear();
        reserve_to(&mut self.tiles, 2 * SAMPLE);
        reserve_to(&mut self.numbers, 4 * SAMPLE);
        reserve_to(&mut self.steep, STEEP_ONES);
    }

    /// Looks at cells of the first [`SUMMED`] of [`SIDES`], and at each four of the last of these as a cell of twice
    /// the side.
    #[inline(always)]
    pub(crate) fn look_at(&mut self, cells: Cells, cell: impl Fn(usize) -> Cell) {
        self.look_at_each(cells, &cell);
        let Cells { level, columns: every, .. } = cells;
        if level + 1 == SUMMED {
            let (columns, rows) = (every / 2, cells.rows / 2);
            let mut fours = std::mem::take(&mut self.fours);
            fours.clear();
            fours.extend((0..columns * rows).map(|at| {
                let first = 2 * (at / columns * every + at % columns);
                Cell::of_quarters([first, first + 1, first + every, first + every + 1].map(&cell), SIDES[level] as f32)
            }));
            self.look_at_each(Cells { level: level + 1, columns, rows, ..cells }, |at| fours[at]);
            self.fours = fours;
        }
    }

    /// Looks at cells that have most of their usual pixels, as have their neighbours on either side.
    #[inline(always)]
    fn look_at_each(&mut self, cells: Cells, cell: impl Fn(usize) -> Cell) {
        let (stride, before) = ((cells.columns * cells.rows).div_ceil(SAMPLE).max(1), self.tiles.len());
        self.look_at_some(cells, stride, &cell);
        // A sample may fall between tiles that lie like the white squares of a chequer.
        if cells.level == 0 && stride > 1 && self.tiles.len() == before {
            self.look_at_some(cells, 1, &cell);
        }
    }

    /// Looks at one cell of `stride`.
    #[inline(always)]
    fn look_at_some(&mut self, cells: Cells, stride: usize, cell: impl Fn(usize) -> Cell) {
        let Cells { level, columns, rows, usual } = cells;
        // A map without a valid pixel has no usual tile.
        let least = (WHOLE * usual * (1 << (2 * level)) as f32).max(1.0);
        // Successive rows begin at different columns, so that no column is left out.
        for row in 1..rows.saturating_sub(1) {
            for column in (1 + row * 7 % stride..columns.saturating_sub(1)).step_by(stride) {
                let at = row * columns + column;
                let own = cell(at);
                let Cell { n, abc: [a, b, q], .. } = own;
                if n < least {
                    continue;
                }
                let slope = a * a + b * b;
                if level == 0 {
                    self.tiles.push(Scatter { q, slope, square: own.scatter() });
                }
                for step in [1, columns] {
                    let [before, behind] = [at - step, at + step].map(&cell);
                    if before.n.min(behind.n) >= least {
                        let off = before.abc[2] - 2.0 * q + behind.abc[2];
                        let residual =
                            if level < EDGES { 0.0 } else { own.scatter().max(before.scatter()).max(behind.scatter()) };
                        self.bends[level].push(Bend { q, slope, square: off * off * (1.0 / 6.0), residual });
                    }
                }
            }
        }
    }

    /// The errors that explain what was seen; none if too little was.
    pub(crate) fn errors(&mut self, space: Space, rounding: &Rounding) -> Option<Errors> {
        vectorised(
            #[inline(always)]
            || self.errors_of(space, rounding),
        )
    }

    #[inline(always)]
    fn errors_of(&mut self, space: Space, rounding: &Rounding) -> Option<Errors> {
        let Scales { bends: [fine, larger @ ..], tiles, numbers, steep: memory, .. } = self;
        if fine.len() < FEW {
            // Tiles that lie apart show how their own pixels scatter, and nothing else.
            let of_mean = 13.0 / MEDIAN_OF_TILE * MEDIAN_OF_SQUARE / 16.0;
            fine.extend(tiles.iter().map(|&Scatter { q, slope, square }| Bend {
                q,
                slope,
                square: of_mean as f32 * square,
                residual: 0.0,
            }));
        }
        if fine.len() < FEW {
            return None;
        }
        let ([constant, square], q) = shape(fine, numbers, space);
        let facing = |q: f32| (constant + square * f64::from(q) * f64::from(q)).powi(2) + floor(q.into(), rounding);
        let pixels = tiles.iter().map(|tile| (f64::from(tile.square) / facing(tile.q)) as f32);
        let at_most = if tiles.len() < FEW { 16.0 } else { median(numbers, pixels) * 13.0 / MEDIAN_OF_TILE };
        let shared = |bend: &Bend, side: f64| shared(bend, side, rounding, at_most * facing(bend.q));
        // The lateral error: what the steeper half shows beyond the flatter one.
        let half = fine.len() / 2;
        fine.select_nth_unstable_by(half, |a, b| a.slope.total_cmp(&b.slope));
        let (flat, steep) = fine.split_at(half);
        let of = |bends: &[Bend], numbers: &mut Vec<f32>| {
            median(numbers, bends.iter().map(|bend| (f64::from(bend.square) / facing(bend.q)) as f32))
                / MEDIAN_OF_SQUARE
        };
        let (of_flat, of_steep) = (of(flat, numbers), of(steep, numbers));
        let excess = of_steep - STEEP * of_flat;
        let ray =
            if excess > 0.0 { ray_of(steep, memory, |bend| of_flat * facing(bend.q) + shared(bend, 4.0)) } else { 0.0 };
        let level = if ray > 0.0 { of_flat.sqrt() } else { 1.0 };
        let found = Errors { constant: constant * level, square: square * level, ray, q, ..Errors::NONE };
        let variance = |q: f32, slope: f32| found.variance(q.into(), slope.into()) + floor(q.into(), rounding);
        let pixels = tiles.iter().map(|tile| (f64::from(tile.square) / variance(tile.q, tile.slope)) as f32);
        let white = if tiles.len() < FEW { 4.0 } else { (median(numbers, pixels) * 13.0 / MEDIAN_OF_TILE).sqrt() };
        let mut ratio = |bends: &[Bend], side: f64, least: f64, most: f64| {
            if bends.len() < FEW {
                return least;
            }
            let squares = bends.iter().map(|bend| {
                let expected = variance(bend.q, bend.slope) + shared(bend, side);
                (f64::from(bend.square) / expected) as f32
            });
            (median(numbers, squares) / MEDIAN_OF_SQUARE).sqrt().clamp(least, most)
        };
        let of_middle = ratio(&larger[0], 8.0, 0.5, GROWTH);
        let smooth = ratio(&larger[1], 16.0, 0.5 * of_middle.min(0.5), GROWTH * of_middle);
        // The part of the scatter of tiles that is not white: W^2 / 16 is known to a tenth.
        let of_tiles = (1.0 - 1.1 * white * white / 16.0).max(0.0).sqrt();
        let smooth = (smooth * of_tiles).max(white / 16.0);
        let expected = |bend: &Bend, side: f64| {
            let mean = variance(bend.q, bend.slope);
            [mean, mean + shared(bend, side), rounding.variance(bend.q.into())]
        };
        let [wide, whole] = long_waves(&larger[EDGES - 1..], white, of_middle.max(1.0), numbers, expected);
        Some(Errors { white, smooth, wide, whole, ..found })
    }
}

/// [`Errors::wide`] and [`Errors::whole`], from cells of the sides from [`EDGES`] on. The pixels of a cell without an
/// edge scatter about its plane by the white part and by what smaller cells showed to be smooth; `before` is the
/// latter for the first side. `expected` gives variances: of a tile's mean, of the cell's mean if its error is as
/// smooth, and of rounding.
#[inline(always)]
fn long_waves(
    bends: &[Vec<Bend>],
    white: f64,
    mut before: f64,
    numbers: &mut Vec<f32>,
    expected: impl Fn(&Bend, f64) -> [f64; 3],
) -> [f64; 2] {
    let least = white / 16.0;
    let (mut seen, mut wide) = ([None; 2], least);
    for ((bends, &side), seen) in bends.iter().zip(&SIDES[EDGES..]).zip(&mut seen) {
        let side = side as f64;
        numbers.clear();
        numbers.extend(bends.iter().filter_map(|bend| {
            let [tile, mean, rounding] = expected(bend, side);
            let own = (white * white + before * before) * tile + rounding;
            let is_whole = f64::from(bend.residual) <= WITHOUT_EDGE * own;
            is_whole.then_some((f64::from(bend.square) / mean) as f32)
        }));
        if numbers.len() < FEW {
            break;
        }
        let squared = middle_of(numbers) / MEDIAN_OF_SQUARE;
        let smooth = (squared - 1.1 * (white / side).powi(2)).max(0.0).sqrt().max(least);
        if numbers.len() >= bends.len() / WHOLE_CELLS {
            wide = wide.max(smooth);
        }
        *seen = Some(smooth);
        before = before.max(squared.sqrt());
    }
    let growth = match seen {
        [Some(of_half), Some(of_whole)] => (of_whole / of_half.max(f64::MIN_POSITIVE)).clamp(1.0, GROWTH),
        _ => 1.0,
    };
    [wide, growth.sqrt() * seen.into_iter().flatten().fold(least, f64::max)]
}

impl Cell {
    /// Squared residuals over their degrees of freedom.
    #[inline(always)]
    fn scatter(&self) -> f32 {
        self.squares / (self.n - 3.0).max(1.0)
    }

    /// The cell whose quarters, row by row, are four cells of `side` pixels; each counts as much as the others.
    #[inline(always)]
    fn of_quarters(quarters: [Cell; 4], side: f32) -> Cell {
        let [mut n, mut a, mut b, mut c] = [0.0; 4];
        for quarter in &quarters {
            n += quarter.n;
            a += quarter.abc[0] / 4.0;
            b += quarter.abc[1] / 4.0;
            c += quarter.abc[2] / 4.0;
        }
        let [q0, q1, q2, q3] = quarters.map(|cell| cell.abc[2]);
        // Of the sum of squared places along a line, a quarter is within its halves and the rest between them.
        let slope = |within: f32, between: f32| 0.25 * within + 0.75 * between / (2.0 * side);
        let (a, b) = (slope(a, q1 + q3 - q0 - q2), slope(b, q2 + q3 - q0 - q1));
        let mut squares = 0.0;
        for (at, quarter) in quarters.iter().enumerate() {
            let [u, v] = [at % 2, at / 2].map(|half| side * (half as f32 - 0.5));
            let [da, db, off] = [quarter.abc[0] - a, quarter.abc[1] - b, quarter.abc[2] - (c + a * u + b * v)];
            squares += quarter.squares + quarter.n * (off * off + (da * da + db * db) * side * side / 12.0);
        }
        Cell { n, abc: [a, b, c], squares }
    }
}

/// The least variance of a tile's mean, by rounding and single precision.
#[inline(always)]
fn floor(q: f64, rounding: &Rounding) -> f64 {
    let single = 2e-7 * q;
    rounding.variance(q) / 16.0 + single * single
}

/// Variance that rounding gives to the mean over a cell of `side` pixels, where a slope crosses few steps in it.
#[inline(always)]
fn shared(bend: &Bend, side: f64, rounding: &Rounding, scatter: f64) -> f64 {
    let square = rounding.step(bend.q.into()).powi(2);
    let level = square / (square + side * side * f64::from(bend.slope) + f64::MIN_POSITIVE);
    steady(square, scatter) * square / 12.0 * level
}

/// Constant and square of the error, from its scatter in stretches of q: the ratio of the two that leaves the
/// smallest residual in the logarithm of the variance. Also returns a q in the middle.
#[inline(always)]
fn shape(bends: &mut [Bend], numbers: &mut Vec<f32>, space: Space) -> ([f64; 2], f64) {
    let size = bends.len().div_ceil(STRETCHES);
    let mut points = [(0.0, 0.0); STRETCHES];
    let (mut rest, mut count) = (bends, 0);
    for point in &mut points {
        if rest.is_empty() {
            break;
        }
        let take = size.min(rest.len());
        if take < rest.len() {
            rest.select_nth_unstable_by_key(take, |bend| pair_order(bend.q, bend.square));
        }
        let (stretch, others) = rest.split_at_mut(take);
        let q = median(numbers, stretch.iter().map(|bend| bend.q));
        let variance = median(numbers, stretch.iter().map(|bend| bend.square)) / MEDIAN_OF_SQUARE;
        *point = (q, variance);
        rest = others;
        count += 1;
    }
    let points = &points[..count];
    let middle = points[count / 2].0;
    let per_square = if middle == 0.0 { 0.0 } else { 1.0 / (middle * middle) };
    let tried = if space == Space::Value { 1 } else { SHAPES };
    let mut best = (f64::INFINITY, [0.0; 2]);
    for step in 0..tried {
        let share = step as f64 / (SHAPES - 1) as f64;
        let level = |q: f64| 2.0 * ((1.0 - share) + share * q * q * per_square).ln();
        let points = points.iter().map(|&(q, variance)| (q, variance.max(f64::MIN_POSITIVE).ln()));
        let mean = points.clone().map(|(q, variance)| variance - level(q)).sum::<f64>() / count as f64;
        let left: f64 = points.map(|(q, variance)| (variance - level(q) - mean).powi(2)).sum();
        if left < best.0 {
            let sigma = (mean / 2.0).exp();
            best = (left, [sigma * (1.0 - share), sigma * share * per_square]);
        }
    }
    (best.1, middle)
}

/// The lateral error, pixels, that explains the scatter of steep tiles beyond the error of flat ones; by bisection.
#[inline(always)]
fn ray_of(steep: &[Bend], memory: &mut Vec<Steep>, flat: impl Fn(&Bend) -> f64) -> f64 {
    let every = steep.len().div_ceil(STEEP_ONES);
    memory.clear();
    memory.extend(steep.iter().step_by(every).map(|bend| Steep {
        square: bend.square.into(),
        slope: bend.slope.into(),
        flat: flat(bend),
    }));
    let quarter = memory.len() / 4;
    let (mut low, mut high) = (0.0, RAY[1]);
    for _ in 0..8 {
        let ray: f64 = (low + high) / 2.0;
        let ratio = |tile: &Steep| (tile.square / (tile.flat + ray * ray * tile.slope)) as f32;
        let smaller = memory.iter().filter(|tile| f64::from(ratio(tile)) < QUARTILE_OF_SQUARE).count();
        (low, high) = if smaller > quarter { (low, ray) } else { (ray, high) };
    }
    low
}
