//! How the camera moved between two frames, from planes that are in both.
//!
//! In: planes before and after with what they may err. Out: the most probable motion, if hand-held cameras and robots
//! turn and move between frames by [`TURN_SD`] and [`SHIFT_SD_M`]. Two planes that are not parallel show the turn, three
//! the whole motion; what the planes do not show stays at rest.

use super::pose::Motion;
use crate::camera::HessianNormalForm;
use crate::util::vec3::{cross, dot};

/// Standard deviation of the turn between two frames about each axis, radians: 90 degrees a second at 30 frames.
const TURN_SD: f64 = 0.05;
/// Standard deviation of the shift between two frames along each axis, metres: 1.5 m a second at 30 frames.
const SHIFT_SD_M: f64 = 0.05;
/// Steps of Gauss and Newton, each with new weights.
const STEPS: usize = 4;
/// Squared deviations, of 3 degrees of freedom, at which a plane counts half: it has moved itself, or is another.
const HALF: f64 = 11.3;

/// A plane of both frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) before: HessianNormalForm,
    pub(super) after: HessianNormalForm,
    /// Variance of each component of the normal's difference.
    pub(super) normal_variance: f64,
    /// Where the planes' distance is compared, and its variance, square metres: where the plane was seen.
    pub(super) at: [f64; 3],
    pub(super) variance: f64,
}

/// The motion; [`Motion::NONE`] without pairs.
pub(super) fn motion(pairs: &[Pair]) -> Motion {
    let (mut turn, mut shift) = ([0.0; 3], [0.0; 3]);
    for _ in 0..STEPS {
        let now = Motion::small(turn, shift);
        let mut system = System::with_prior(turn, shift);
        for pair in pairs {
            let rows = rows(pair, &now);
            let trust = 1.0 / (1.0 + sum(&rows) / HALF);
            rows.iter().for_each(|row| system.add(row, trust));
        }
        let step = system.solve();
        (turn, shift) = ([0, 1, 2].map(|k| turn[k] + step[k]), [0, 1, 2].map(|k| shift[k] + step[3 + k]));
    }
    Motion::small(turn, shift)
}

/// Squared deviations of a plane from where a motion brings it, of 3 degrees of freedom.
pub(super) fn squares(pair: &Pair, motion: &Motion) -> f64 {
    sum(&rows(pair, motion))
}

fn sum(rows: &[Row]) -> f64 {
    rows.iter().map(|row| row.residual * row.residual * row.weight).sum()
}

/// A measurement: derivatives by turn and shift, what is left, and the inverse of its variance.
struct Row {
    by: [f64; 6],
    residual: f64,
    weight: f64,
}

/// The normal in three components, and the distance at the point where the plane was seen.
fn rows(pair: &Pair, now: &Motion) -> [Row; 4] {
    let moved = now.of_plane(&pair.before);
    let normal = |k: usize| {
        // The normal turns by w x n.
        let axis: [f64; 3] = std::array::from_fn(|l| f64::from(u8::from(k == l)));
        let [a, b, c] = cross(moved.normal, axis);
        Row {
            by: [a, b, c, 0.0, 0.0, 0.0],
            residual: pair.after.normal[k] - moved.normal[k],
            weight: 1.0 / pair.normal_variance,
        }
    };
    let height = |plane: &HessianNormalForm| dot(plane.normal, pair.at) + plane.distance;
    let [a, b, c] = cross(moved.normal, pair.at);
    let [x, y, z] = moved.normal;
    let distance =
        Row { by: [a, b, c, -x, -y, -z], residual: height(&pair.after) - height(&moved), weight: 1.0 / pair.variance };
    [normal(0), normal(1), normal(2), distance]
}

/// Normal equations of six unknowns.
struct System {
    left: [[f64; 6]; 6],
    right: [f64; 6],
}

impl System {
    fn with_prior(turn: [f64; 3], shift: [f64; 3]) -> Self {
        let mut system = System { left: [[0.0; 6]; 6], right: [0.0; 6] };
        for k in 0..3 {
            for (at, value, sd) in [(k, turn[k], TURN_SD), (3 + k, shift[k], SHIFT_SD_M)] {
                system.left[at][at] = 1.0 / (sd * sd);
                system.right[at] = -value / (sd * sd);
            }
        }
        system
    }

    fn add(&mut self, row: &Row, trust: f64) {
        for i in 0..6 {
            let weighted = trust * row.weight * row.by[i];
            (0..6).for_each(|j| self.left[i][j] += weighted * row.by[j]);
            self.right[i] += weighted * row.residual;
        }
    }

    /// By Gauss without pivots, since the prior makes the matrix positive definite.
    fn solve(mut self) -> [f64; 6] {
        for i in 0..6 {
            for below in i + 1..6 {
                let times = self.left[below][i] / self.left[i][i];
                (i..6).for_each(|j| self.left[below][j] -= times * self.left[i][j]);
                self.right[below] -= times * self.right[i];
            }
        }
        let mut solution = [0.0; 6];
        for i in (0..6).rev() {
            let known: f64 = (i + 1..6).map(|j| self.left[i][j] * solution[j]).sum();
            solution[i] = (self.right[i] - known) / self.left[i][i];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(before: HessianNormalForm, motion: &Motion, at: [f64; 3]) -> Pair {
        Pair { before, after: motion.of_plane(&before), normal_variance: 1e-6, at, variance: 1e-6 }
    }

    const FLOOR: HessianNormalForm = HessianNormalForm { normal: [0.0, -1.0, 0.0], distance: 1.2 };
    const WALL: HessianNormalForm = HessianNormalForm { normal: [0.0, 0.0, -1.0], distance: 3.0 };
    const SIDE: HessianNormalForm = HessianNormalForm { normal: [1.0, 0.0, 0.0], distance: 1.0 };

    #[test]
    fn three_planes_show_the_motion() {
        let truth = Motion::small([0.03, -0.05, 0.02], [0.02, -0.01, 0.04]);
        let mut pairs = vec![
            pair(FLOOR, &truth, [0.2, 1.2, 2.0]),
            pair(WALL, &truth, [0.0, 0.0, 3.0]),
            pair(SIDE, &truth, [-1.0, 0.0, 2.0]),
        ];
        let check = |pairs: &[Pair]| {
            let found = motion(pairs);
            for k in 0..3 {
                assert!((found.translation_m[k] - truth.translation_m[k]).abs() < 5e-4, "{found:?}");
                assert!((found.rotation[k][(k + 1) % 3] - truth.rotation[k][(k + 1) % 3]).abs() < 5e-4);
            }
        };
        check(&pairs);
        // A door that swings by itself.
        let swung = Motion::small([0.0, 0.3, 0.0], [0.1, 0.0, 0.0]);
        pairs.push(pair(WALL, &swung, [0.0, 0.0, 3.0]));
        check(&pairs);
    }

    #[test]
    fn what_one_plane_does_not_show_is_taken_to_be_at_rest() {
        let truth = Motion::small([0.0, 0.0, 0.0], [0.05, 0.0, -0.04]);
        let found = motion(&[pair(WALL, &truth, [0.0, 0.0, 3.0])]);
        assert!((found.translation_m[2] + 0.04).abs() < 2e-3 && found.translation_m[0].abs() < 1e-6, "{found:?}");
        assert_eq!(motion(&[]), Motion::NONE);
    }
}
