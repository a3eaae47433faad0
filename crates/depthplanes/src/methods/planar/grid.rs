//! Cells of one size, side by side, and what is known of each.
//!
//! A cell knows where its pixels lie, its least-squares plane and the squared residuals about it. These give the
//! residuals about any other plane without another look at the pixels.

use super::layout::AffineMap;
use super::thresholds::{FLAT, JOIN, limit};
use crate::statistics::least_squares::Moments;
use crate::util::parallel::Rows;
use std::ops::Range;

/// No region.
pub(super) use crate::util::runs::NONE;

/// What is known of each cell: numbers of the same kind side by side.
#[derive(Debug)]
pub(super) struct Sums<T> {
    /// Valid pixels.
    pub(super) n: T,
    /// Sums over them of du, dv, du^2, du dv, dv^2 about the cell's middle.
    pub(super) u: T,
    pub(super) v: T,
    pub(super) uu: T,
    pub(super) uv: T,
    pub(super) vv: T,
    /// Its least-squares plane about its middle: `q = a du + b dv + c`.
    pub(super) a: T,
    pub(super) b: T,
    pub(super) c: T,
    /// Squared residuals about it; infinite if it has none.
    pub(super) squares: T,
    /// What it adds to the squares of one of the cell's parts, at most.
    pub(super) child_misfit: T,
}

impl<T> Sums<T> {
    pub(super) fn of([n, u, v, uu, uv, vv, a, b, c, squares, child_misfit]: [T; 11]) -> Self {
        Sums { n, u, v, uu, uv, vv, a, b, c, squares, child_misfit }
    }

    pub(super) fn each(&mut self) -> [&mut T; 11] {
        let Sums { n, u, v, uu, uv, vv, a, b, c, squares, child_misfit } = self;
        [n, u, v, uu, uv, vv, a, b, c, squares, child_misfit]
    }
}

/// The cells of one size, row by row.
#[derive(Debug)]
pub(super) struct Grid {
    /// Pixels of a cell's side.
    pub(super) side: usize,
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) sums: Sums<Vec<f32>>,
    /// Variance of a pixel's q that the noise model expects here.
    pub(super) variance: Vec<f32>,
    /// Variance of the smooth part of its error, which all of the cell's pixels share.
    pub(super) smooth: Vec<f32>,
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
    pub(super) smooth: f64,
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
    #[inline(always)]
    pub(super) fn moments(&self, [u0, v0, q0]: [f64; 3]) -> Moments {
        let &Cell { middle: [mu, mv], n, u, v, uu, uv, vv, abc: [a, b, c], squares, .. } = self;
        let (uq, vq) = (a * uu + b * uv, a * uv + b * vv);
        let about_middle = Moments { n, u, v, q: a * u + b * v, uu, uv, vv, uq, vq, qq: squares + a * uq + b * vq };
        about_middle.moved([mu - u0, mv - v0, c - q0])
    }

    /// Largest sum of its squared residuals about a plane that its pixels lie on.
    #[inline(always)]
    pub(super) fn most_squares(&self, inlier_threshold: f64) -> f64 {
        f64::from(limit(self.n as f32, inlier_threshold as f32)) * self.variance + JOIN.smooth * self.n * self.smooth
    }

    /// Largest sum of its squared residuals about the plane of a region that a flat cell joins.
    #[inline(always)]
    pub(super) fn most_joining(&self) -> f64 {
        self.squares + JOIN.of(self.n, self.variance, self.smooth)
    }

    /// (u, v, q) of its own plane in its middle.
    #[inline(always)]
    pub(super) fn origin(&self) -> [f64; 3] {
        [self.middle[0], self.middle[1], self.abc[2]]
    }
}

impl Grid {
    pub(super) fn new(side: usize) -> Self {
        let none = || Vec::new();
        let sums = Sums::of(std::array::from_fn(|_| none()));
        Grid {
            side,
            columns: 0,
            rows: 0,
            sums,
            variance: none(),
            smooth: none(),
            roughness: none(),
            region: Vec::new(),
        }
    }

    pub(super) fn prepare(&mut self, affine: &AffineMap) {
        (self.columns, self.rows) = (affine.stride / self.side, affine.rows / self.side);
        let cells = self.columns * self.rows;
        for numbers in self.sums.each().into_iter().chain([&mut self.variance, &mut self.smooth, &mut self.roughness]) {
            numbers.resize(cells, 0.0);
        }
        self.region.clear();
        self.region.resize(cells, NONE);
    }

    /// All rows, to be written.
    pub(super) fn whole(&mut self) -> GridRows<'_> {
        let Grid { columns, rows, sums, variance, smooth, roughness, .. } = self;
        let sums = Sums::of(sums.each().map(|numbers| &mut numbers[..]));
        GridRows { columns: *columns, rows: *rows, sums, variance, smooth, roughness }
    }

    /// How many cells there are.
    pub(super) fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Valid pixels of a cell.
    #[inline(always)]
    pub(super) fn pixels(&self, at: usize) -> f32 {
        self.sums.n[at]
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

    /// Which cell's numbers stand there.
    #[inline(always)]
    pub(super) fn place(&self, at: usize) -> Place {
        Place::new(at % self.columns, at / self.columns)
    }

    /// (u, v) of a cell's middle.
    #[inline(always)]
    pub(super) fn middle(&self, place: Place) -> [f64; 2] {
        let half = (self.side - 1) as f64 / 2.0;
        [place.column, place.row].map(|place| f64::from(place) * self.side as f64 + half)
    }

    /// A cell.
    #[inline(always)]
    pub(super) fn cell(&self, place: Place) -> Cell {
        let Sums { n, u, v, uu, uv, vv, a, b, c, squares, .. } = &self.sums;
        let at = self.at(place);
        let middle = self.middle(place);
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
            smooth: number(&self.smooth),
        }
    }

    /// For each cell of a row, one of 2 x 2 of these, the region that its parts agree on.
    pub(super) fn agreed(&self, row: usize, to: &mut [u32]) {
        let above = self.region[2 * row * self.columns..].as_chunks::<2>().0;
        let below = self.region[(2 * row + 1) * self.columns..].as_chunks::<2>().0;
        for (to, (above, below)) in to.iter_mut().zip(above.iter().zip(below)) {
            let id = above[0];
            *to = if [above[1], below[0], below[1]] == [id; 3] { id } else { NONE };
        }
    }

    /// The four neighbours of a cell; at the map's edge itself in place of those that are missing.
    #[inline(always)]
    pub(super) fn neighbours(&self, place: Place) -> [Place; 4] {
        self.neighbours_within(place, &(0..self.rows))
    }

    /// The same, as if there were some rows only.
    #[inline(always)]
    pub(super) fn neighbours_within(&self, Place { column, row }: Place, rows: &Range<usize>) -> [Place; 4] {
        let [last_column, first, last] = [self.columns - 1, rows.start, rows.end - 1].map(|place| place as u32);
        [
            Place { column: column.saturating_sub(1), row },
            Place { column: (column + 1).min(last_column), row },
            Place { column, row: row.saturating_sub(1).max(first) },
            Place { column, row: (row + 1).min(last) },
        ]
    }
}

/// Where a cell lies in its grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    pub(super) row: u32,
    pub(super) column: u32,
}

impl Place {
    pub(super) fn new(column: usize, row: usize) -> Self {
        Place { row: row as u32, column: column as u32 }
    }
}

/// What is known of the cells of some rows, to be written.
#[derive(Debug)]
pub(super) struct GridRows<'a> {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) sums: Sums<&'a mut [f32]>,
    pub(super) variance: &'a mut [f32],
    pub(super) smooth: &'a mut [f32],
    pub(super) roughness: &'a mut [f32],
}

impl<'a> Rows for GridRows<'a> {
    fn rows(&self) -> usize {
        self.rows
    }

    fn split_rows(mut self, rows: usize) -> (Self, Self) {
        let columns = self.columns;
        let take = |numbers: &mut &'a mut [f32]| -> &'a mut [f32] {
            numbers.split_off_mut(..rows * columns).expect("so many rows")
        };
        let first = GridRows {
            columns,
            rows,
            sums: Sums::of(self.sums.each().map(take)),
            variance: take(&mut self.variance),
            smooth: take(&mut self.smooth),
            roughness: take(&mut self.roughness),
        };
        self.rows -= rows;
        (first, self)
    }
}

impl<const N: usize> Sums<[f32; N]> {
    /// Sets a cell's numbers; one without a plane has no pixels.
    #[inline(always)]
    pub(super) fn put(&mut self, t: usize, numbers: [f32; 11], is_determined: bool) {
        for (i, (place, number)) in self.each().into_iter().zip(numbers).enumerate() {
            let nothing = if i == 9 { f32::INFINITY } else { 0.0 };
            place[t] = if is_determined { number } else { nothing };
        }
    }
}

impl GridRows<'_> {
    /// Writes the numbers of cells that lie side by side.
    #[inline(always)]
    pub(super) fn put<const N: usize>(&mut self, row: usize, column: usize, mut sums: Sums<[f32; N]>) {
        let at = row * self.columns + column;
        for (numbers, lanes) in self.sums.each().into_iter().zip(sums.each()) {
            numbers[at..at + N].copy_from_slice(lanes);
        }
    }

    /// Roughness from each cell's own residuals, and from those of its parts.
    #[inline(always)]
    pub(super) fn hold_against_noise(&mut self, parts: Option<&GridRows<'_>>, inlier_threshold: f32) {
        let GridRows { sums: Sums { n, squares, child_misfit, .. }, variance, smooth, roughness, columns, .. } = self;
        let numbers = n.iter().zip(&**squares).zip(&**child_misfit).zip(&**variance).zip(&**smooth);
        for (((((&n, &squares), &child_misfit), &variance), &smooth), roughness) in numbers.zip(&mut **roughness) {
            let free = larger(n - 3.0, 1.0);
            let smooth_part = if parts.is_some() { FLAT.smooth as f32 * n * smooth } else { 0.0 };
            let own = squares * n / (free * (limit(n, inlier_threshold) * variance + smooth_part));
            let most = FLAT.variances as f32 * variance + FLAT.smooth as f32 * n / 4.0 * smooth;
            *roughness = larger(own, child_misfit / most);
        }
        if let Some(parts) = parts {
            for (row, roughness) in roughness.chunks_exact_mut(*columns).enumerate() {
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
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::testing::{Stages, noise, patchy, pixels_that_count, squares_about};
    use crate::util::random::Random;

    #[test]
    fn squares_and_residuals_about_any_plane_and_moments_of_a_cell_are_those_of_its_pixels() {
        let (made, mut random) = (patchy(7), Random::new(8));
        let stages = Stages::tiles(&made, noise(0.0));
        for grid in &stages.run.pyramid.grids {
            for at in (0..grid.len()).step_by(3) {
                let place = grid.place(at);
                let pixels = pixels_that_count(&made, grid.side, [place.column as usize, place.row as usize]);
                if pixels.is_empty() {
                    continue;
                }
                let cell = grid.cell(place);
                let [a, b] = [0; 2].map(|_| random.between(-0.3, 0.3));
                let [u0, v0, q0] = [random.between(0.0, 150.0), random.between(0.0, 90.0), random.between(20.0, 60.0)];
                let c = random.between(-5.0, 5.0);
                let count = pixels.len() as f64;
                let squares = squares_about(&pixels, [a, b, c + q0], [u0, v0]);
                let found = cell.squares_about([a, b, c], [u0, v0, q0]);
                assert!((found - squares).abs() <= 1e-4 * squares + 1e-5 * count, "{found} squares, not {squares}");
                let residual: f64 = pixels.iter().map(|[u, v, q]| q - (a * (u - u0) + b * (v - v0) + c + q0)).sum();
                let found = cell.residual_about([a, b, c], [u0, v0, q0]);
                assert!((found - residual).abs() <= 1e-4 * count, "{found}, not {residual}");
                let (found, mut sums) = (cell.moments([u0, v0, q0]), Moments::default());
                pixels.iter().for_each(|[u, v, q]| sums.add(u - u0, v - v0, q - q0));
                assert_eq!(found.n, sums.n);
                let root = |x: f64, y: f64| (x * y).sqrt();
                for (what, found, expected, scale) in [
                    ("u", found.u, sums.u, root(sums.n, sums.uu)),
                    ("v", found.v, sums.v, root(sums.n, sums.vv)),
                    ("q", found.q, sums.q, root(sums.n, sums.qq)),
                    ("uu", found.uu, sums.uu, sums.uu),
                    ("uv", found.uv, sums.uv, root(sums.uu, sums.vv)),
                    ("vv", found.vv, sums.vv, sums.vv),
                    ("uq", found.uq, sums.uq, root(sums.uu, sums.qq)),
                    ("vq", found.vq, sums.vq, root(sums.vv, sums.qq)),
                    ("qq", found.qq, sums.qq, sums.qq),
                ] {
                    assert!((found - expected).abs() <= 1e-4 * scale, "{what}: {found}, not {expected}");
                }
            }
        }
    }

    #[test]
    fn the_neighbours_of_a_cell_are_the_four_beside_it_and_at_an_edge_it_takes_the_place_of_those_missing() {
        let grid = Grid { columns: 5, rows: 7, ..Grid::new(4) };
        for rows in [0..7, 2..5, 3..4] {
            for (row, column) in rows.clone().flat_map(|row| (0..5).map(move |column| (row, column))) {
                let place = Place::new(column, row);
                assert_eq!(grid.place(grid.at(place)), place);
                let mut expected = [place; 4];
                let steps = [(-1, 0), (1, 0), (0, -1), (0, 1)];
                for (expected, (right, down)) in expected.iter_mut().zip(steps) {
                    let (u, v) = (column as isize + right, row as isize + down);
                    if (0..5).contains(&u) && v >= 0 && rows.contains(&(v as usize)) {
                        *expected = Place::new(u as usize, v as usize);
                    }
                }
                assert_eq!(grid.neighbours_within(place, &rows), expected);
            }
        }
    }
}
