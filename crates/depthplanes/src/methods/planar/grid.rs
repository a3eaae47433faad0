//! Cells of one size, side by side, and what is known of each.
//!
//! A cell knows how its pixels lie, its least-squares plane and the squared residuals about it, which give the
//! residuals about any other plane without a look at a pixel.

use super::field::Field;
use super::thresholds::JOIN;
use crate::fit::Moments;
use crate::parallel::Rows;
use std::ops::Range;

/// No region.
pub(super) const NONE: u32 = u32::MAX;

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
    pub(super) strain: T,
}

impl<T> Sums<T> {
    pub(super) fn of([n, u, v, uu, uv, vv, a, b, c, squares, strain]: [T; 11]) -> Self {
        Sums { n, u, v, uu, uv, vv, a, b, c, squares, strain }
    }

    pub(super) fn each(&mut self) -> [&mut T; 11] {
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

    pub(super) fn prepare(&mut self, field: &Field) {
        (self.columns, self.rows) = (field.stride / self.side, field.rows / self.side);
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

/// Cells whose regions are compared together.
const ABREAST: usize = 16;

/// Calls `visit` for each run of a row's cells that have one region: the region, the columns.
#[inline(always)]
pub(super) fn each_run(row: &[u32], first: usize, mut visit: impl FnMut(u32, Range<usize>)) {
    let mut start = 0;
    let mut end_at = |end: usize| {
        if row[start] != NONE {
            visit(row[start], first + start..first + end);
        }
        start = end;
    };
    let Some(last) = row.len().checked_sub(1) else { return };
    let (own, next) = (row[..last].as_chunks::<ABREAST>(), row[1..].as_chunks::<ABREAST>());
    for (at, (own, next)) in (1..).step_by(ABREAST).zip(own.0.iter().zip(next.0)) {
        let mut rest = u128::from_le_bytes(std::array::from_fn(|i| u8::from(own[i] != next[i])));
        while rest != 0 {
            end_at(at + rest.trailing_zeros() as usize / 8);
            rest &= rest - 1;
        }
    }
    for (at, (own, next)) in (last - own.1.len() + 1..).zip(own.1.iter().zip(next.1)) {
        if own != next {
            end_at(at);
        }
    }
    end_at(row.len());
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

/// Largest sum of squared residuals of n pixels of one plane, in variances: the mean of chi-squared is n, its
/// standard deviation sqrt(2 n). The noise level itself is known to about a fifth.
#[inline(always)]
pub(super) fn limit(n: f32, inlier_threshold: f32) -> f32 {
    1.4 * (n + inlier_threshold * (2.0 * n).sqrt())
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

    fn cut(mut self, rows: usize) -> (Self, Self) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn runs_of_a_row_are_what_a_look_at_each_cell_finds() {
        let mut random = Random::new(7);
        for length in 0..80 {
            let share = random.uniform();
            let mut id = 0;
            let mut next = |_| {
                if random.uniform() < share {
                    id = [NONE, 1, 2, 3][(random.uniform() * 4.0) as usize];
                }
                id
            };
            let row: Vec<u32> = (0..length).map(&mut next).collect();
            let (mut cells, mut runs) = (vec![NONE; length], 0);
            each_run(&row, 5, |id, columns| {
                runs += 1;
                columns.for_each(|column| cells[column - 5] = id);
            });
            let begins = (0..length).filter(|&at| row[at] != NONE && (at == 0 || row[at - 1] != row[at]));
            assert_eq!((cells, runs), (row.clone(), begins.count()), "{row:?}");
        }
    }
}
