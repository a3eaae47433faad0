//! Stage "tiles": the map's small squares, each with its own plane, and larger squares made of them.
//!
//! In: the map in q. Out: a pyramid of grids: tiles of [`SIDE`] x [`SIDE`] pixels, cells of 2 x 2 tiles,
//! and cells of 4 x 4. A cell knows how its pixels lie, its least-squares plane and the squared residuals
//! about it, which give the residuals about any other plane without a look at a pixel. All cells of a row
//! are computed side by side, so the loops are plain arithmetic that the compiler turns into vectors.

use super::field::Field;
use crate::fit::Moments;
use crate::group::vectorised;
use crate::noise::NoiseModel;
use std::array::from_fn;

/// Columns and rows of a tile. The smallest plane has to hold a few; a tile's own plane should still
/// mean something under noise. Of 4, 5, 6 and 8, 4 was the best on ABW and on made-up rooms.
pub(super) const SIDE: usize = 4;
/// Grids of a pyramid. The sides of their cells double.
pub(super) const LEVELS: usize = 3;
/// Cells that are computed at a time.
pub(super) const LANES: usize = 16;

/// No region.
pub(super) const NONE: u32 = u32::MAX;

/// One number of each cell of a stretch of a row.
type Lanes = [f32; LANES];

/// What is known of each cell: numbers of the same kind side by side.
#[derive(Debug)]
pub(super) struct Sums<T> {
    /// Valid pixels.
    n: T,
    /// Sums over them of du, dv, du^2, du dv, dv^2 about the cell's middle.
    u: T,
    v: T,
    uu: T,
    uv: T,
    vv: T,
    /// Its least-squares plane about its middle: `q = a du + b dv + c`.
    a: T,
    b: T,
    c: T,
    /// Squared residuals about it; infinite if it has none.
    squares: T,
    /// What it adds to the squares of one of the cell's parts, at most, as a multiple of [`drift`].
    strain: T,
}

impl<T> Sums<T> {
    fn each(&mut self) -> [&mut T; 11] {
        let Sums { n, u, v, uu, uv, vv, a, b, c, squares, strain } = self;
        [n, u, v, uu, uv, vv, a, b, c, squares, strain]
    }
}

/// The cells of one size, row by row.
#[derive(Debug)]
pub(super) struct Grid {
    /// Pixels of a cell's side.
    pub(super) side: usize,
    pub(super) columns: usize,
    pub(super) rows: usize,
    sums: Sums<Vec<f32>>,
    /// Variance of a pixel's q that the noise model expects here.
    pub(super) variance: Vec<f32>,
    /// Mean squared residual in units of what noise may leave ([`limit`]): the largest of the cell's own, its
    /// parts' own, and its parts' about its plane. Flat cells have 1 and less.
    pub(super) roughness: Vec<f32>,
    /// For each cell its region, or [`NONE`].
    pub(super) region: Vec<u32>,
}

/// One cell, in double precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Its middle (u, v).
    pub(super) middle: [f64; 2],
    pub(super) n: f64,
    u: f64,
    v: f64,
    uu: f64,
    uv: f64,
    vv: f64,
    abc: [f64; 3],
    pub(super) squares: f64,
    pub(super) variance: f64,
}

impl Cell {
    /// Sum of its pixels' squared residuals about the plane `a (u - u0) + b (v - v0) + c + q0`.
    #[inline(always)]
    pub(super) fn squares_about(&self, [a, b, c]: [f64; 3], [u0, v0, q0]: [f64; 3]) -> f64 {
        let [u, v] = self.middle;
        let (da, db) = (self.abc[0] - a, self.abc[1] - b);
        let dc = self.abc[2] - (a * (u - u0) + b * (v - v0) + c + q0);
        let along = da * (da * self.uu + 2.0 * (db * self.uv + dc * self.u)) + db * (db * self.vv + 2.0 * dc * self.v);
        self.squares + along + dc * dc * self.n
    }

    /// Sum of its pixels' residuals about that plane.
    #[inline(always)]
    pub(super) fn residual_about(&self, [a, b, c]: [f64; 3], [u0, v0, q0]: [f64; 3]) -> f64 {
        let [u, v] = self.middle;
        let dc = self.abc[2] - (a * (u - u0) + b * (v - v0) + c + q0);
        (self.abc[0] - a) * self.u + (self.abc[1] - b) * self.v + dc * self.n
    }

    /// Its pixels' sums about (u, v, q) = `origin`.
    pub(super) fn moments(&self, [u0, v0, q0]: [f64; 3]) -> Moments {
        let &Cell { middle: [mu, mv], n, u, v, uu, uv, vv, abc: [a, b, c], squares, .. } = self;
        let (uq, vq) = (a * uu + b * uv, a * uv + b * vv);
        let about_middle = Moments { n, u, v, q: a * u + b * v, uu, uv, vv, uq, vq, qq: squares + a * uq + b * vq };
        about_middle.moved([mu - u0, mv - v0, c - q0])
    }

    /// (u, v, q) of its own plane in its middle.
    pub(super) fn origin(&self) -> [f64; 3] {
        [self.middle[0], self.middle[1], self.abc[2]]
    }
}

impl Grid {
    fn new(side: usize) -> Self {
        let none = || Vec::new();
        let sums = Sums {
            n: none(),
            u: none(),
            v: none(),
            uu: none(),
            uv: none(),
            vv: none(),
            a: none(),
            b: none(),
            c: none(),
            squares: none(),
            strain: none(),
        };
        Grid { side, columns: 0, rows: 0, sums, variance: none(), roughness: none(), region: Vec::new() }
    }

    fn prepare(&mut self, field: &Field) {
        (self.columns, self.rows) = (field.stride / self.side, field.rows / self.side);
        let (cells, room) = (self.columns * self.rows, self.columns * self.rows + 2 * LANES);
        for numbers in self.sums.each().into_iter().chain([&mut self.variance, &mut self.roughness]) {
            numbers.resize(room, 0.0);
        }
        self.region.clear();
        self.region.resize(cells, NONE);
    }

    /// How many cells there are.
    pub(super) fn len(&self) -> usize {
        self.region.len()
    }

    /// Valid pixels of a cell.
    #[inline(always)]
    pub(super) fn pixels(&self, at: usize) -> f32 {
        self.sums.n[at]
    }

    /// Squared residuals of a cell's pixels about its own plane.
    #[inline(always)]
    pub(super) fn squares(&self, at: usize) -> f32 {
        self.sums.squares[at]
    }

    /// q in the middle of a cell's own plane.
    pub(super) fn q(&self, at: usize) -> f64 {
        self.sums.c[at].into()
    }

    /// Mean squared residual about its own plane in variances.
    pub(super) fn scatter(&self, at: usize) -> f32 {
        self.sums.squares[at] / ((self.sums.n[at] - 3.0).max(1.0) * self.variance[at])
    }

    /// Where a cell's numbers stand.
    #[inline(always)]
    pub(super) fn at(&self, place: Place) -> usize {
        place.row as usize * self.columns + place.column as usize
    }

    /// A cell.
    #[inline(always)]
    pub(super) fn cell(&self, place: Place) -> Cell {
        let Sums { n, u, v, uu, uv, vv, a, b, c, squares, .. } = &self.sums;
        let at = self.at(place);
        let half = (self.side - 1) as f64 / 2.0;
        let middle = [place.column, place.row].map(|place| f64::from(place) * self.side as f64 + half);
        let number = |numbers: &[f32]| f64::from(numbers[at]);
        Cell {
            middle,
            n: number(n),
            u: number(u),
            v: number(v),
            uu: number(uu),
            uv: number(uv),
            vv: number(vv),
            abc: [number(a), number(b), number(c)],
            squares: number(squares),
            variance: number(&self.variance),
        }
    }

    /// The four neighbours of a cell.
    #[inline(always)]
    pub(super) fn neighbours(&self, Place { column, row }: Place) -> impl Iterator<Item = Place> + use<> {
        let beside = [
            (column > 0).then(|| Place { column: column - 1, row }),
            ((column as usize) + 1 < self.columns).then(|| Place { column: column + 1, row }),
            (row > 0).then(|| Place { column, row: row - 1 }),
            ((row as usize) + 1 < self.rows).then(|| Place { column, row: row + 1 }),
        ];
        beside.into_iter().flatten()
    }
}

/// Where a cell lies in its grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    pub(super) row: u32,
    pub(super) column: u32,
}

/// Largest sum of squared residuals of n pixels of one plane, in variances: the mean of chi-squared is n, its
/// standard deviation sqrt(2 n). The noise level itself is known to about a fifth.
#[inline(always)]
fn limit(n: f32, confidence: f32) -> f32 {
    1.4 * (n + confidence * (2.0 * n).sqrt())
}

/// Largest sum of squares that another plane may add to a cell's own, in variances.
#[inline(always)]
pub(super) fn drift(n: f32) -> f32 {
    10.0 + DRIFT * n
}
const DRIFT: f32 = 0.1;

/// The same for one cell.
#[inline(always)]
pub(super) fn most_squares(cell: &Cell, confidence: f64) -> f64 {
    1.4 * (cell.n + confidence * (2.0 * cell.n).sqrt()) * cell.variance
}

/// The grids of a map, the finest first.
#[derive(Debug)]
pub(super) struct Pyramid {
    pub(super) grids: [Grid; LEVELS],
}

impl Default for Pyramid {
    fn default() -> Self {
        Pyramid { grids: from_fn(|level| Grid::new(SIDE << level)) }
    }
}

impl Pyramid {
    /// Sums a map's pixels, tile by tile, and the tiles, cell by cell.
    pub(super) fn sum(&mut self, field: &Field) {
        self.grids.iter_mut().for_each(|grid| grid.prepare(field));
        vectorised(
            #[inline(always)]
            || {
                sum_tiles(field, &mut self.grids[0]);
                for level in 1..LEVELS {
                    let (finer, coarser) = self.grids.split_at_mut(level);
                    sum_cells(&finer[level - 1], &mut coarser[0]);
                }
            },
        );
    }

    /// Holds the cells against a noise model.
    pub(super) fn expect(&mut self, noise: &NoiseModel, confidence: f64) {
        vectorised(
            #[inline(always)]
            || {
                for level in 0..LEVELS {
                    let (finer, coarser) = self.grids.split_at_mut(level);
                    let grid = &mut coarser[0];
                    noise.variances(&grid.sums.c, &mut grid.variance);
                    grid.hold_against_noise(finer.last(), confidence as f32);
                }
            },
        );
    }

    /// Gives the regions of a grid's cells to the cells' parts that have none.
    pub(super) fn hand_down(&mut self, level: usize) {
        let (finer, coarser) = self.grids.split_at_mut(level);
        let (parts, grid) = (&mut finer[level - 1], &coarser[0]);
        for row in 0..parts.rows {
            let above = &grid.region[row / 2 * grid.columns..][..grid.columns];
            let here = row * parts.columns..(row + 1) * parts.columns;
            let pixels = parts.sums.n[here.clone()].as_chunks::<2>().0;
            for ((part, pixels), &region) in parts.region[here].as_chunks_mut::<2>().0.iter_mut().zip(pixels).zip(above)
            {
                *part = pixels.map(|pixels| if pixels > 0.0 { region } else { NONE });
            }
        }
    }
}

impl Pyramid {
    /// Gives each coarse cell the region that its four parts agree on.
    pub(super) fn hand_up(&mut self) {
        for level in 1..LEVELS {
            let (finer, coarser) = self.grids.split_at_mut(level);
            let (parts, grid) = (&finer[level - 1], &mut coarser[0]);
            for (row, cells) in grid.region.chunks_exact_mut(grid.columns).enumerate() {
                let above = parts.region[2 * row * parts.columns..].as_chunks::<2>().0;
                let below = parts.region[(2 * row + 1) * parts.columns..].as_chunks::<2>().0;
                for (cell, (above, below)) in cells.iter_mut().zip(above.iter().zip(below)) {
                    let id = above[0];
                    *cell = if [above[1], below[0], below[1]] == [id; 3] { id } else { NONE };
                }
            }
        }
    }
}

/// The middle of a tile's columns and rows from its own.
const OFF: [f32; SIDE] = [-1.5, -0.5, 0.5, 1.5];

#[inline(always)]
fn sum_tiles(field: &Field, grid: &mut Grid) {
    for (row, rows) in field.q.chunks_exact(field.stride * SIDE).enumerate() {
        let mut rows = rows.chunks_exact(field.stride);
        let rows: [_; SIDE] = from_fn(|_| rows.next().expect("so many rows").as_chunks::<{ LANES * SIDE }>().0);
        for block in 0..rows[0].len() {
            grid.put(row, block * LANES, tiles(from_fn(|row| &rows[row][block])));
        }
    }
}

#[inline(always)]
fn sum_cells(parts: &Grid, grid: &mut Grid) {
    let half = parts.side as f32 / 2.0;
    for row in 0..grid.rows {
        for column in (0..grid.columns).step_by(LANES) {
            let first = 2 * row * parts.columns + 2 * column;
            grid.put(row, column, cells(&parts.sums, [first, first + parts.columns], half));
        }
    }
}

/// The sums of tiles that lie side by side.
#[inline(always)]
fn tiles(rows: [&[f32; LANES * SIDE]; SIDE]) -> Sums<Lanes> {
    let mut out = no_sums();
    for t in 0..LANES {
        let mut q = [[0.0; SIDE]; SIDE];
        let mut w = [[0.0; SIDE]; SIDE];
        let [mut n, mut u, mut v, mut uu, mut uv, mut vv, mut sum] = [0.0; 7];
        for row in 0..SIDE {
            for column in 0..SIDE {
                let value = rows[row][t * SIDE + column];
                let holds = value.is_finite();
                w[row][column] = if holds { 1.0 } else { 0.0 };
                q[row][column] = if holds { value } else { 0.0 };
                let (w, du, dv) = (w[row][column], OFF[column], OFF[row]);
                n += w;
                u += w * du;
                v += w * dv;
                uu += w * (du * du);
                uv += w * (du * dv);
                vv += w * (dv * dv);
                sum += q[row][column];
            }
        }
        let mean = sum / if n > 0.0 { n } else { 1.0 };
        let [mut rest, mut uq, mut vq] = [0.0; 3];
        for row in 0..SIDE {
            for column in 0..SIDE {
                let off = w[row][column] * (q[row][column] - mean);
                rest += off;
                uq += OFF[column] * off;
                vq += OFF[row] * off;
            }
        }
        let fit = plane([n, u, v, uu, uv, vv], [rest, uq, vq]);
        let [a, b, c] = fit.abc;
        let mut squares = 0.0;
        for row in 0..SIDE {
            for column in 0..SIDE {
                let off = q[row][column] - mean - (a * OFF[column] + b * OFF[row] + c);
                squares += w[row][column] * (off * off);
            }
        }
        out.put(t, [n, u, v, uu, uv, vv, a, b, mean + c, squares, 0.0], fit.is_determined);
    }
    out
}

/// The sums of cells that lie side by side, from their parts in two rows.
#[inline(always)]
fn cells(parts: &Sums<Vec<f32>>, rows: [usize; 2], half: f32) -> Sums<Lanes> {
    let part = |numbers: &'_ [f32]| -> [[f32; 2 * LANES]; 2] {
        rows.map(|first| numbers[first..first + 2 * LANES].try_into().expect("so many"))
    };
    let (pn, pu, pv, puu, puv, pvv) =
        (part(&parts.n), part(&parts.u), part(&parts.v), part(&parts.uu), part(&parts.uv), part(&parts.vv));
    let (pa, pb, pc, psquares) = (part(&parts.a), part(&parts.b), part(&parts.c), part(&parts.squares));
    let mut out = no_sums();
    for t in 0..LANES {
        let [mut n, mut u, mut v, mut uu, mut uv, mut vv, mut sum] = [0.0; 7];
        for row in 0..2 {
            for column in 0..2 {
                let i = 2 * t + column;
                let (du, dv) = (half * (2 * column) as f32 - half, half * (2 * row) as f32 - half);
                let (m, mu, mv) = (pn[row][i], pu[row][i], pv[row][i]);
                n += m;
                u += mu + m * du;
                v += mv + m * dv;
                uu += puu[row][i] + du * (2.0 * mu + m * du);
                uv += puv[row][i] + du * mv + dv * mu + m * (du * dv);
                vv += pvv[row][i] + dv * (2.0 * mv + m * dv);
                sum += m * pc[row][i];
            }
        }
        let mean = sum / if n > 0.0 { n } else { 1.0 };
        let [mut q, mut uq, mut vq] = [0.0; 3];
        for row in 0..2 {
            for column in 0..2 {
                let i = 2 * t + column;
                let (du, dv) = (half * (2 * column) as f32 - half, half * (2 * row) as f32 - half);
                let (a, b, c) = (pa[row][i], pb[row][i], pc[row][i] - mean);
                let sum = pn[row][i] * c + pu[row][i] * a + pv[row][i] * b;
                q += sum;
                uq += c * pu[row][i] + a * puu[row][i] + b * puv[row][i] + du * sum;
                vq += c * pv[row][i] + a * puv[row][i] + b * pvv[row][i] + dv * sum;
            }
        }
        let fit = plane([n, u, v, uu, uv, vv], [q, uq, vq]);
        let [a, b, c] = fit.abc;
        let [mut squares, mut strain] = [0.0; 2];
        for row in 0..2 {
            for column in 0..2 {
                let i = 2 * t + column;
                let (du, dv) = (half * (2 * column) as f32 - half, half * (2 * row) as f32 - half);
                let (da, db) = (pa[row][i] - a, pb[row][i] - b);
                let dc = pc[row][i] - mean - (a * du + b * dv + c);
                let added = da * (da * puu[row][i] + 2.0 * (db * puv[row][i] + dc * pu[row][i]))
                    + db * (db * pvv[row][i] + 2.0 * dc * pv[row][i])
                    + dc * dc * pn[row][i];
                squares += own(psquares[row][i]) + added;
                strain = larger(strain, added / drift(pn[row][i]));
            }
        }
        out.put(t, [n, u, v, uu, uv, vv, a, b, mean + c, squares, strain], fit.is_determined);
    }
    out
}

/// The squares of a part, nothing for one without a plane, which has no pixels either.
#[inline(always)]
fn own(squares: f32) -> f32 {
    if squares.is_finite() { squares } else { 0.0 }
}

impl Sums<Lanes> {
    /// Sets a cell's numbers; one without a plane has no pixels.
    #[inline(always)]
    fn put(&mut self, t: usize, numbers: [f32; 11], is_determined: bool) {
        for (i, (place, number)) in self.each().into_iter().zip(numbers).enumerate() {
            let nothing = if i == 9 { f32::INFINITY } else { 0.0 };
            place[t] = if is_determined { number } else { nothing };
        }
    }
}

impl Grid {
    /// Writes the numbers of cells that lie side by side, as many as the row has.
    #[inline(always)]
    fn put(&mut self, row: usize, column: usize, mut sums: Sums<Lanes>) {
        let (at, count) = (row * self.columns + column, (self.columns - column).min(LANES));
        for (numbers, lanes) in self.sums.each().into_iter().zip(sums.each()) {
            numbers[at..at + count].copy_from_slice(&lanes[..count]);
        }
    }

    /// Roughness from each cell's own residuals, and from those of its parts.
    #[inline(always)]
    fn hold_against_noise(&mut self, parts: Option<&Grid>, confidence: f32) {
        let Grid { sums: Sums { n, squares, strain, .. }, variance, roughness, columns, .. } = self;
        for at in 0..n.len() {
            let free = larger(n[at] - 3.0, 1.0);
            let own = squares[at] * n[at] / (free * limit(n[at], confidence));
            roughness[at] = larger(own, strain[at]) / variance[at];
        }
        if let Some(parts) = parts {
            for (row, roughness) in roughness.chunks_exact_mut(*columns).take(self.rows).enumerate() {
                let above = parts.roughness[2 * row * parts.columns..].as_chunks::<2>().0;
                let below = parts.roughness[(2 * row + 1) * parts.columns..].as_chunks::<2>().0;
                for ((roughness, above), below) in roughness.iter_mut().zip(above).zip(below) {
                    *roughness = larger(*roughness, larger(larger(above[0], above[1]), larger(below[0], below[1])));
                }
            }
        }
    }
}

/// The larger; `b` if `a` is not a number.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn no_sums() -> Sums<Lanes> {
    let none = [0.0; LANES];
    Sums {
        n: none,
        u: none,
        v: none,
        uu: none,
        uv: none,
        vv: none,
        a: none,
        b: none,
        c: none,
        squares: none,
        strain: none,
    }
}

/// A least-squares plane about a cell's middle.
struct Fit {
    abc: [f32; 3],
    /// Whether the points determine it.
    is_determined: bool,
}

/// Least squares of `q = a u + b v + c` from sums.
#[inline(always)]
fn plane([n, u, v, uu, uv, vv]: [f32; 6], [q, uq, vq]: [f32; 3]) -> Fit {
    let per_n = 1.0 / n;
    let (mu, mv) = (u * per_n, v * per_n);
    let (uu, uv, vv) = (uu - u * mu, uv - u * mv, vv - v * mv);
    let (uq, vq) = (uq - q * mu, vq - q * mv);
    let det = uu * vv - uv * uv;
    let per_det = 1.0 / det;
    let (a, b) = ((vv * uq - uv * vq) * per_det, (uu * vq - uv * uq) * per_det);
    // Three pixels that are not on a line span a determinant of 1/3 and more.
    Fit { abc: [a, b, q * per_n - a * mu - b * mv], is_determined: det > 0.1 }
}
