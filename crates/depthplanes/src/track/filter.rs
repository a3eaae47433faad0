//! A plane's parameters over frames: a Kalman filter that forgets.
//!
//! State: the plane and the covariance of its white error. Prediction: the camera's motion, and a covariance that grows by
//! 1 / [`MEMORY`]. Measurement: the plane that was found, with the white share of its covariance. The smooth part repeats
//! from frame to frame, does not average out, and stays in the covariance that is reported.

use super::pose::Motion;
use crate::camera::HessianNormalForm;
use crate::detection::MetricPlane;
use crate::util::vec3::{cross, dot, inverse};

/// Share of the information that is kept from frame to frame: at rest the last ten frames count.
const MEMORY: f64 = 0.9;
/// Squared deviations, of 3 degrees of freedom, from where on the plane has really moved: one of 100,000 by chance, since a
/// new start throws away what is known.
const MOVED: f64 = 25.9;

/// A plane that is followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) plane: HessianNormalForm,
    /// Covariance of the white error of (nx, ny, nz, distance).
    white: [[f64; 4]; 4],
    /// Covariance of what repeats.
    lasting: [[f64; 4]; 4],
}

impl State {
    pub(super) fn new(seen: &MetricPlane) -> Self {
        let [white, lasting] = parts(seen);
        State { plane: seen.plane, white, lasting }
    }

    /// The part that differs from frame to frame.
    pub(super) fn white(&self) -> &[[f64; 4]; 4] {
        &self.white
    }

    /// Both parts together.
    pub(super) fn covariance(&self) -> [[f64; 4]; 4] {
        std::array::from_fn(|i| std::array::from_fn(|j| self.white[i][j] + self.lasting[i][j]))
    }

    /// The state in the coordinates of the camera after a motion, a frame later.
    pub(super) fn predict(&mut self, motion: &Motion) {
        if *motion != Motion::NONE {
            self.plane = motion.of_plane(&self.plane);
            self.white = motion.of_covariance(&self.white);
            self.lasting = motion.of_covariance(&self.lasting);
        }
        self.white.as_flattened_mut().iter_mut().for_each(|entry| *entry /= MEMORY);
    }

    /// Takes in what was found of the plane in this frame; what has moved starts anew.
    pub(super) fn update(&mut self, seen: &MetricPlane) {
        let [white, lasting] = parts(seen);
        let axes = Axes::of(self.plane.normal);
        let offset = axes.difference(&self.plane, &seen.plane);
        let (before, now) = (axes.within(&self.white), axes.within(&white));
        let sum = std::array::from_fn(|i| std::array::from_fn(|j| before[i][j] + now[i][j]));
        let Some(inverse) = inverse(&sum) else { return *self = State::new(seen) };
        let times = |a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]| -> [[f64; 3]; 3] {
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
        };
        let squares: f64 = (0..3).map(|i| offset[i] * dot(inverse[i], offset)).sum();
        if squares.is_nan() || squares > MOVED {
            return *self = State::new(seen);
        }
        let gain = times(&before, &inverse);
        let step = gain.map(|row| dot(row, offset));
        let taken = times(&gain, &before);
        let left = std::array::from_fn(|i| std::array::from_fn(|j| before[i][j] - taken[i][j]));
        self.plane = axes.moved(&self.plane, step);
        self.white = Axes::of(self.plane.normal).out(&left);
        self.lasting = lasting;
    }
}

/// The white part of a covariance and the rest.
fn parts(seen: &MetricPlane) -> [[[f64; 4]; 4]; 2] {
    [seen.white_share, 1.0 - seen.white_share].map(|share| seen.covariance.map(|row| row.map(|entry| entry * share)))
}

/// Two directions in which a unit normal can change, beside the distance.
struct Axes([[f64; 3]; 2]);

impl Axes {
    fn of(normal: [f64; 3]) -> Self {
        // The axis that the normal is farthest from.
        let nearest = |k: &usize, l: &usize| normal[*k].abs().total_cmp(&normal[*l].abs());
        let axis = (0..3).min_by(nearest).unwrap_or(0);
        let across = cross(normal, std::array::from_fn(|k| f64::from(u8::from(k == axis))));
        let length = dot(across, across).sqrt();
        let first = across.map(|x| x / length);
        Axes([first, cross(normal, first)])
    }

    fn rows(&self) -> [[f64; 4]; 3] {
        let [[a, b, c], [d, e, f]] = self.0;
        [[a, b, c, 0.0], [d, e, f, 0.0], [0.0, 0.0, 0.0, 1.0]]
    }

    fn difference(&self, from: &HessianNormalForm, to: &HessianNormalForm) -> [f64; 3] {
        let between = [0, 1, 2].map(|k| to.normal[k] - from.normal[k]);
        [dot(self.0[0], between), dot(self.0[1], between), to.distance - from.distance]
    }

    fn within(&self, covariance: &[[f64; 4]; 4]) -> [[f64; 3]; 3] {
        let rows = self.rows();
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                (0..4).map(|k| (0..4).map(|l| rows[i][k] * covariance[k][l] * rows[j][l]).sum::<f64>()).sum()
            })
        })
    }

    fn out(&self, covariance: &[[f64; 3]; 3]) -> [[f64; 4]; 4] {
        let rows = self.rows();
        std::array::from_fn(|k| {
            std::array::from_fn(|l| {
                (0..3).map(|i| (0..3).map(|j| rows[i][k] * covariance[i][j] * rows[j][l]).sum::<f64>()).sum()
            })
        })
    }

    fn moved(&self, plane: &HessianNormalForm, [a, b, distance]: [f64; 3]) -> HessianNormalForm {
        let normal = [0, 1, 2].map(|k| plane.normal[k] + a * self.0[0][k] + b * self.0[1][k]);
        let length = dot(normal, normal).sqrt();
        HessianNormalForm { normal: normal.map(|x| x / length), distance: plane.distance + distance }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

    /// A wall 2 m ahead, seen with errors of 0.01 of the normal and 1 cm, of which that share is white.
    fn seen(random: &mut Random, white_share: f64) -> MetricPlane {
        let [a, b, d] = std::array::from_fn(|_| 0.01 * white_share.sqrt() * random.gaussian());
        let length = (1.0 + a * a + b * b).sqrt();
        let plane = HessianNormalForm { normal: [a / length, b / length, -1.0 / length], distance: 2.0 + d };
        let covariance = std::array::from_fn(|i| std::array::from_fn(|j| if i == j && i != 2 { 1e-4 } else { 0.0 }));
        MetricPlane { covariance, white_share, ..MetricPlane::new(plane, [0.0, 0.0, 2.0]) }
    }

    #[test]
    fn a_plane_at_rest_is_known_better_with_every_frame_and_as_well_as_it_says() {
        let mut random = Random::new(5);
        let (mut squares, mut said, runs) = (0.0, 0.0, 400);
        for _ in 0..runs {
            let mut state = State::new(&seen(&mut random, 1.0));
            for _ in 0..40 {
                state.predict(&Motion::NONE);
                state.update(&seen(&mut random, 1.0));
            }
            squares += (state.plane.distance - 2.0).powi(2);
            said = state.covariance()[3][3];
        }
        // Of white frames the share 1 - MEMORY remains, and the mean of weights MEMORY^k has the variance (1 - m) / (1 + m).
        let expected = 1e-4 * (1.0 - MEMORY) / (1.0 + MEMORY);
        assert!((squares / f64::from(runs) / expected - 1.0).abs() < 0.25, "{}", squares / f64::from(runs) / expected);
        assert!((said / 1e-5 - 1.0).abs() < 0.05, "{said}");
    }

    #[test]
    fn what_repeats_does_not_average_out() {
        let mut random = Random::new(6);
        let mut state = State::new(&seen(&mut random, 0.25));
        for _ in 0..100 {
            state.predict(&Motion::NONE);
            state.update(&seen(&mut random, 0.25));
        }
        let said = state.covariance()[3][3];
        assert!((0.75e-4..0.8e-4).contains(&said), "{said}");
    }

    #[test]
    fn what_moves_is_believed_at_once() {
        let mut random = Random::new(7);
        let mut state = State::new(&seen(&mut random, 1.0));
        let mut moved = seen(&mut random, 1.0);
        moved.plane.distance = 2.3;
        state.predict(&Motion::NONE);
        state.update(&moved);
        assert_eq!(state.plane.distance, 2.3);
    }
}
