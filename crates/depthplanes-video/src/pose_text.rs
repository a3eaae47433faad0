//! Poses as data sets write them.

use crate::error::{Error, Result};
use depthplanes::track::CameraPose;
use std::path::Path;

/// A pose of four rows of four numbers, camera to world, as 7-Scenes writes it.
pub(crate) fn matrix(text: &str, path: &Path) -> Result<CameraPose> {
    let accepted = "four rows of four numbers, camera to world: a rotation and a translation in metres";
    let wrong = |wrong: String| Error::source(path.display(), wrong, accepted);
    let numbers: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
    if numbers.len() != 16 || text.split_whitespace().count() != 16 {
        return Err(wrong(format!("{} numbers", numbers.len())));
    }
    let at = |row: usize, column: usize| numbers[4 * row + column];
    let rotation = std::array::from_fn(|row| std::array::from_fn(|column| at(row, column)));
    let translation_m = std::array::from_fn(|row| at(row, 3));
    CameraPose::new(rotation, translation_m).map_err(|error| wrong(error.to_string()))
}

/// A pose of `tx ty tz qx qy qz qw`, camera to world, as TUM RGB-D writes it.
pub(crate) fn quaternion(numbers: [f64; 7]) -> depthplanes::Result<CameraPose> {
    let [x, y, z, qx, qy, qz, qw] = numbers;
    let length = (qx * qx + qy * qy + qz * qz + qw * qw).sqrt();
    let [i, j, k, w] = [qx, qy, qz, qw].map(|q| q / length);
    let rotation = [
        [1.0 - 2.0 * (j * j + k * k), 2.0 * (i * j - k * w), 2.0 * (i * k + j * w)],
        [2.0 * (i * j + k * w), 1.0 - 2.0 * (i * i + k * k), 2.0 * (j * k - i * w)],
        [2.0 * (i * k - j * w), 2.0 * (j * k + i * w), 1.0 - 2.0 * (i * i + j * j)],
    ];
    CameraPose::new(rotation, [x, y, z])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_is_the_same_as_matrix_and_as_quaternion() {
        let text = "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n";
        let of_matrix = matrix(text, Path::new("pose.txt")).unwrap();
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let of_quaternion = quaternion([1.0, 2.0, 3.0, 0.0, 0.0, 2.0 * half, 2.0 * half]).unwrap();
        for row in 0..3 {
            for column in 0..3 {
                assert!((of_matrix.rotation()[row][column] - of_quaternion.rotation()[row][column]).abs() < 1e-12);
            }
        }
        assert_eq!(of_matrix.translation_m(), of_quaternion.translation_m());
    }

    #[test]
    fn what_is_no_pose_is_an_error() {
        for text in ["", "1 2 3", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 x", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1"] {
            assert!(matrix(text, Path::new("pose.txt")).is_err(), "{text}");
        }
        assert!(quaternion([0.0; 7]).is_err());
    }
}
