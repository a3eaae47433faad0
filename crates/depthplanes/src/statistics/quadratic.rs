//! A quadratic through the means of cells, by least squares.
//!
//! In: cells with their residuals about a plane. Out: how much of the residuals a quadratic explains, and how much a
//! plane does.

/// Sums over cells of `weight x^i y^j` up to the fourth power, and with a value r up to the second: the normal equations
/// of a quadratic in (x, y), and how well it or anything else explains r.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct QuadraticSums {
    /// Sums of weight x^i y^j, i + j <= 4, by j and i.
    powers: [[f64; 5]; 5],
    /// Sums of weight r x^i y^j, i + j <= 2.
    right: [[f64; 3]; 3],
    /// Sum of weight r r.
    pub(crate) squares: f64,
    /// Cells.
    pub(crate) cells: f64,
    /// Pixels.
    pub(crate) pixels: f64,
    /// Sum of the smooth part's variances, in variances of a pixel.
    pub(crate) smooth: f64,
    /// Sum of the weighted squared residuals about the cell's own region.
    pub(crate) by_planes: f64,
}

/// (j, i) of the terms 1, x, y, x^2, x y, y^2.
const TERMS: [[usize; 2]; 6] = [[0, 0], [0, 1], [1, 0], [0, 2], [1, 1], [2, 0]];

/// Normal equations in echelon form.
struct Eliminated {
    matrix: [[f64; 6]; 6],
    right: [f64; 6],
    /// Which terms the cells determine beyond those before.
    pivots: [bool; 6],
}

impl QuadraticSums {
    /// Adds cells of one row, summed along it: `powers[i]` of `w x^i`, `right[i]` of `w r x^i`.
    pub(crate) fn add_row(&mut self, y: f64, powers: [f64; 5], right: [f64; 3]) {
        let mut yj = 1.0;
        for j in 0..5 {
            for i in 0..5 - j {
                self.powers[j][i] += yj * powers[i];
            }
            for i in 0..3usize.saturating_sub(j) {
                self.right[j][i] += yj * right[i];
            }
            yj *= y;
        }
    }

    pub(crate) fn merge(&self, other: &QuadraticSums) -> QuadraticSums {
        let mut both = *self;
        for j in 0..5 {
            for i in 0..5 - j {
                both.powers[j][i] += other.powers[j][i];
            }
        }
        for [j, i] in TERMS {
            both.right[j][i] += other.right[j][i];
        }
        both.squares += other.squares;
        both.cells += other.cells;
        both.pixels += other.pixels;
        both.smooth += other.smooth;
        both.by_planes += other.by_planes;
        both
    }

    #[inline(always)]
    fn matrix(&self) -> [[f64; 6]; 6] {
        let mut matrix = [[0.0; 6]; 6];
        for (row, [j, i]) in matrix.iter_mut().zip(TERMS) {
            row.iter_mut().zip(TERMS).for_each(|(sum, [l, k])| *sum = self.powers[j + l][i + k]);
        }
        matrix
    }

    #[inline(always)]
    fn right(&self) -> [f64; 6] {
        let mut right = [0.0; 6];
        right.iter_mut().zip(TERMS).for_each(|(sum, [j, i])| *sum = self.right[j][i]);
        right
    }

    /// The normal equations of the first N terms, each with the terms before it eliminated: what a term explains
    /// beyond them is its right side squared over its pivot.
    #[inline(always)]
    fn eliminate<const N: usize>(&self) -> Eliminated {
        let (mut m, mut r) = (self.matrix(), self.right());
        let diagonal: [f64; 6] = std::array::from_fn(|i| m[i][i]);
        let mut pivots = [false; 6];
        for i in 0..N {
            pivots[i] = m[i][i] > 1e-9 * diagonal[i];
            if pivots[i] {
                let per_pivot = 1.0 / m[i][i];
                for k in i + 1..N {
                    let factor = m[k][i] * per_pivot;
                    r[k] -= factor * r[i];
                    for j in i..N {
                        m[k][j] -= factor * m[i][j];
                    }
                }
            }
        }
        Eliminated { matrix: m, right: r, pivots }
    }

    /// The least-squares coefficients of the first N terms; those that the cells do not determine are 0.
    pub(crate) fn solve<const N: usize>(&self) -> [f64; 6] {
        let Eliminated { matrix: m, right: r, pivots } = self.eliminate::<N>();
        let mut solution = [0.0; 6];
        for i in (0..6).rev().filter(|&i| pivots[i]) {
            let known: f64 = (i + 1..N).map(|j| m[i][j] * solution[j]).sum();
            solution[i] = (r[i] - known) / m[i][i];
        }
        solution
    }

    /// Sum of squares that a quadratic explains beyond a plane.
    pub(crate) fn bow(&self) -> f64 {
        let Eliminated { matrix, right, pivots } = self.eliminate::<6>();
        (3..6).filter(|&i| pivots[i]).map(|i| right[i] * right[i] / matrix[i][i]).sum()
    }

    /// Sum of the weighted squares that these coefficients leave.
    pub(crate) fn left_by(&self, coefficients: &[f64; 6]) -> f64 {
        let (matrix, right) = (self.matrix(), self.right());
        let explained: f64 = (0..6)
            .map(|i| {
                let product: f64 = (0..6).map(|j| matrix[i][j] * coefficients[j]).sum();
                coefficients[i] * (2.0 * right[i] - product)
            })
            .sum();
        self.squares - explained
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

    #[test]
    fn a_bow_is_what_a_quadratic_leaves_less_than_a_plane() {
        let mut random = Random::new(11);
        for round in 0..200 {
            // Now and then too few rows, so that some terms are not determined.
            let (columns, rows) = (2 + round % 9, 1 + round % 7);
            let mut sums = QuadraticSums::default();
            for row in 0..rows {
                let (mut powers, mut right) = ([0.0; 5], [0.0; 3]);
                for column in 0..columns {
                    let [x, r] = [column as f64 - 3.0, random.uniform() - 0.5];
                    (0..5).for_each(|i| powers[i] += x.powi(i as i32));
                    (0..3).for_each(|i| right[i] += r * x.powi(i as i32));
                    sums.squares += r * r;
                }
                sums.add_row(row as f64 - 2.0, powers, right);
            }
            let by_coefficients = sums.left_by(&sums.solve::<3>()) - sums.left_by(&sums.solve::<6>());
            assert!((sums.bow() - by_coefficients).abs() < 1e-9, "{} by {by_coefficients}", sums.bow());
        }
    }
}
