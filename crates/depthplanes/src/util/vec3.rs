//! Vectors of three numbers, and small matrices.

/// A point or a direction.
pub(crate) type Vec3 = [f64; 3];

#[inline(always)]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector at length 1; none if it has no direction.
pub(crate) fn unit(a: Vec3) -> Option<Vec3> {
    let length = dot(a, a).sqrt();
    (length > 0.0 && length.is_finite()).then(|| a.map(|x| x / length))
}

/// The inverse of a matrix; `None` if it has none.
pub(crate) fn inverse(of: &[Vec3; 3]) -> Option<[Vec3; 3]> {
    // Its columns times the determinant are cross products of the rows.
    let columns = [cross(of[1], of[2]), cross(of[2], of[0]), cross(of[0], of[1])];
    let determinant = dot(of[0], columns[0]);
    let inverse: [Vec3; 3] = std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i] / determinant));
    inverse.as_flattened().iter().all(|entry| entry.is_finite()).then_some(inverse)
}

/// v M v, the variance of v . x where M is the covariance of x.
pub(crate) fn quadratic_form<const N: usize>(matrix: &[[f64; N]; N], v: [f64; N]) -> f64 {
    let row = |i: usize| (0..N).map(|j| v[i] * matrix[i][j] * v[j]).sum::<f64>();
    (0..N).map(row).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_one_and_a_flat_one_has_none() {
        let matrix = [[4.0, 1.0, 0.5], [-1.0, 9.0, 2.0], [0.0, 2.0, 16.0]];
        let inverse = inverse(&matrix).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| matrix[i][k] * inverse[k][j]).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-12);
            }
        }
        assert_eq!(super::inverse(&[[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 0.0, 1.0]]), None);
        assert_eq!(quadratic_form(&[[2.0, 1.0], [1.0, 3.0]], [1.0, 2.0]), 2.0 + 4.0 + 12.0);
    }
}
