//! A smooth random field over a picture: the patches in which neighbouring pixels err alike.
//!
//! In: a length and random draws. Out: a value for each pixel, mean 0, standard deviation 1, the same on every
//! platform. Gaussian draws on a lattice are blended by cubic B-splines. These are polynomials alone, and unlike
//! linear blends as strong between the nodes as on them (within a tenth of the variance).

use crate::util::random::Random;

/// The inverse of the mean of the sum of a cubic B-spline's four squared weights, 151/315: along
/// two axes it brings the blend of nodes back to a standard deviation of 1.
const NORM: f64 = 315.0 / 151.0;

/// A field that is evaluated row by row.
pub(super) struct Field {
    nodes: Vec<f64>,
    /// Nodes in a row of the lattice.
    across: usize,
    spacing: f64,
    /// For each column of the picture its first node and the weights of four.
    columns: Vec<(usize, [f64; 4])>,
}

/// Where a pixel lies between the nodes: the first of four, and their weights.
fn place(pixel: usize, spacing: f64) -> (usize, [f64; 4]) {
    let x = pixel as f64 / spacing;
    let (first, t) = (x.floor(), x - x.floor());
    let (s, tt) = (1.0 - t, t * t);
    let weights = [s * s * s, 3.0 * tt * t - 6.0 * tt + 4.0, -3.0 * tt * t + 3.0 * tt + 3.0 * t + 1.0, tt * t];
    (first as usize, weights.map(|weight| weight / 6.0))
}

impl Field {
    /// A field for a picture of that size (1 x 1 and up) with a node every `spacing` pixels. Two
    /// pixels are correlated about as by a Gaussian of standard deviation 0.8 `spacing`. Nodes are at
    /// least a pixel apart: there are never more of them than pixels and a rim.
    pub(super) fn drawn([width, height]: [usize; 2], spacing: f64, random: &mut Random) -> Self {
        let spacing = spacing.max(1.0);
        let nodes_along = |side: usize| place(side - 1, spacing).0 + 4;
        let (across, down) = (nodes_along(width), nodes_along(height));
        let nodes = (0..across * down).map(|_| random.gaussian() * NORM).collect();
        Field { nodes, across, spacing, columns: (0..width).map(|u| place(u, spacing)).collect() }
    }

    /// Writes the values of picture row `v`, one for each column.
    pub(super) fn row(&self, v: usize, values: &mut Vec<f64>) {
        let (first, weights) = place(v, self.spacing);
        let node = |column: usize, k: usize| self.nodes[(first + k) * self.across + column];
        let blend = |column| (0..4).map(|k| weights[k] * node(column, k)).sum::<f64>();
        let line: Vec<f64> = (0..self.across).map(blend).collect();
        values.clear();
        values.extend(self.columns.iter().map(|(first, weights)| {
            let near = &line[*first..first + 4];
            near.iter().zip(weights).map(|(node, weight)| node * weight).sum::<f64>()
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_has_deviation_1_and_the_stated_length() {
        let (size, spacing) = (600, 6.0);
        let field = Field::drawn([size, size], spacing, &mut Random::new(5));
        let (mut row, mut pixels) = (Vec::new(), Vec::new());
        for v in 0..size {
            field.row(v, &mut row);
            pixels.extend_from_slice(&row);
        }
        let variance = pixels.iter().map(|x| x * x).sum::<f64>() / pixels.len() as f64;
        assert!((variance - 1.0).abs() < 0.05, "{variance}");
        // exp(-d^2 / (2 L^2)) with L = 0.8 x 6 px.
        for (apart, expected) in [(1, 0.978), (5, 0.581), (10, 0.114), (30, 0.0)] {
            let pairs = pixels.chunks(size).flat_map(|row| row.iter().zip(&row[apart..]));
            let correlation = pairs.map(|(a, b)| a * b).sum::<f64>() / ((size - apart) * size) as f64 / variance;
            assert!((correlation - expected).abs() < 0.04, "{correlation} at {apart} px, expected {expected}");
        }
    }

    #[test]
    fn a_field_is_never_finer_than_its_pixels() {
        for spacing in [0.0, 1e-300, f64::INFINITY] {
            let field = Field::drawn([3, 2], spacing, &mut Random::new(1));
            assert!(field.nodes.len() <= 6 * 5);
            let mut row = Vec::new();
            field.row(1, &mut row);
            assert!(row.len() == 3 && row.iter().all(|value| value.is_finite()));
        }
    }
}
