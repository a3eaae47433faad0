//! Where a camera is, and how it moved from one frame to the next.

use crate::camera::HessianNormalForm;
use crate::error::{Error, Result};
use crate::util::vec3::{cross, dot, unit};

/// Where a camera is: a point X of the camera is `rotation X + translation` in the world.
///
/// The world is any that stays the same from frame to frame; camera coordinates are x right, y down, z forward, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CameraPose {
    rotation: [[f64; 3]; 3],
    translation_m: [f64; 3],
}

/// How far the product of two rows of a rotation may be from that of a true one: poses are written with few digits.
const ORTHONORMAL: f64 = 0.02;

impl CameraPose {
    /// A checked pose, camera to world. The rotation is made exact, since files hold few digits of it.
    ///
    /// # Errors
    /// [`Error::Camera`] unless the rotation's rows have length 1 and are at right angles, within 0.02, in a right-handed
    /// order, and the translation is finite.
    pub fn new(rotation: [[f64; 3]; 3], translation_m: [f64; 3]) -> Result<Self> {
        let wrong = |name, given, accepted| Err(Error::Camera { name, given, accepted });
        for i in 0..3 {
            for j in 0..3 {
                let (product, right) = (dot(rotation[i], rotation[j]), f64::from(u8::from(i == j)));
                if product.is_nan() || (product - right).abs() > ORTHONORMAL {
                    return wrong("rotation", product, "rows of length 1 at right angles to each other");
                }
            }
        }
        if let Some(&given) = translation_m.iter().find(|x| !x.is_finite()) {
            return wrong("translation", given, "finite numbers of metres");
        }
        let [first, second, third] = rotation;
        if dot(cross(first, second), third) < 0.0 {
            return wrong("rotation", -1.0, "a rotation, whose determinant is 1; this one mirrors");
        }
        let first = unit(first).expect("its length was checked");
        let along = dot(first, second);
        let second = unit([0, 1, 2].map(|k| second[k] - along * first[k])).expect("it is across the first");
        Ok(CameraPose { rotation: [first, second, cross(first, second)], translation_m })
    }

    /// The rotation, row by row.
    pub fn rotation(&self) -> [[f64; 3]; 3] {
        self.rotation
    }

    /// Where the camera's centre is in the world, metres.
    pub fn translation_m(&self) -> [f64; 3] {
        self.translation_m
    }

    /// The rotation as a unit quaternion x, y, z, w (Shepperd 1978: the largest of the four is found first, and the others by
    /// it).
    pub fn quaternion(&self) -> [f64; 4] {
        let r = &self.rotation;
        let squares = [
            1.0 + r[0][0] - r[1][1] - r[2][2],
            1.0 - r[0][0] + r[1][1] - r[2][2],
            1.0 - r[0][0] - r[1][1] + r[2][2],
            1.0 + r[0][0] + r[1][1] + r[2][2],
        ];
        let largest = (0..4).max_by(|&a, &b| squares[a].total_cmp(&squares[b])).expect("there are four");
        let [xy, xz, yz] = [r[1][0] + r[0][1], r[0][2] + r[2][0], r[2][1] + r[1][2]];
        let [xw, yw, zw] = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
        let own = squares[largest];
        let q = match largest {
            0 => [own, xy, xz, xw],
            1 => [xy, own, yz, yw],
            2 => [xz, yz, own, zw],
            _ => [xw, yw, zw, own],
        };
        q.map(|part| 0.5 * part / own.sqrt())
    }

    /// A direction of the world in camera coordinates.
    pub fn to_camera(&self, direction: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| (0..3).map(|row| self.rotation[row][k] * direction[row]).sum())
    }

    /// The change of coordinates from this camera's to a later one's.
    pub(super) fn motion_to(&self, later: &CameraPose) -> Motion {
        let rotation = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| later.rotation[k][i] * self.rotation[k][j]).sum())
        });
        let between = [0, 1, 2].map(|k| self.translation_m[k] - later.translation_m[k]);
        Motion { rotation, translation_m: later.to_camera(between) }
    }
}

/// A change of camera coordinates: a point that does not move is `rotation X + translation` afterwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Motion {
    pub(super) rotation: [[f64; 3]; 3],
    pub(super) translation_m: [f64; 3],
}

impl Motion {
    pub(super) const NONE: Motion =
        Motion { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation_m: [0.0; 3] };

    /// A turn by a small vector (axis times angle, radians) and a shift.
    pub(super) fn small(turn: [f64; 3], translation_m: [f64; 3]) -> Motion {
        let angle = dot(turn, turn).sqrt();
        let axis = if angle > 0.0 { turn.map(|x| x / angle) } else { [0.0; 3] };
        let (sine, cosine) = angle.sin_cos();
        // Rodrigues' formula.
        let crossed = [[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]];
        let rotation = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let diagonal = if i == j { cosine } else { 0.0 };
                diagonal + sine * crossed[i][j] + (1.0 - cosine) * axis[i] * axis[j]
            })
        });
        Motion { rotation, translation_m }
    }

    /// The motion back.
    pub(super) fn inverse(&self) -> Motion {
        let rotation: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| self.rotation[j][i]));
        Motion { rotation, translation_m: rotation.map(|row| -dot(row, self.translation_m)) }
    }

    /// A direction after the motion.
    pub(super) fn turned(&self, direction: [f64; 3]) -> [f64; 3] {
        self.rotation.map(|row| dot(row, direction))
    }

    /// A plane after the motion.
    pub(super) fn of_plane(&self, plane: &HessianNormalForm) -> HessianNormalForm {
        let normal = self.turned(plane.normal);
        HessianNormalForm { normal, distance: plane.distance - dot(normal, self.translation_m) }
    }

    /// The covariance of (nx, ny, nz, distance) of a plane after the motion.
    pub(super) fn of_covariance(&self, covariance: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
        // (n', d') = A (n, d) with A = [R, 0; -t R, 1].
        let mut all = [[0.0; 4]; 4];
        for i in 0..3 {
            for j in 0..3 {
                all[i][j] = self.rotation[i][j];
                all[3][j] -= self.translation_m[i] * self.rotation[i][j];
            }
        }
        all[3][3] = 1.0;
        let times: [[f64; 4]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|l| (0..4).map(|k| all[i][k] * covariance[k][l]).sum()));
        std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|l| times[i][l] * all[j][l]).sum()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a metre to the right of the world's origin and a little turned.
    fn pose(turn: [f64; 3], translation_m: [f64; 3]) -> CameraPose {
        CameraPose::new(Motion::small(turn, [0.0; 3]).rotation, translation_m).unwrap()
    }

    #[test]
    fn points_on_a_plane_stay_on_it_when_the_camera_moves() {
        let (before, after) = (pose([0.1, -0.2, 0.05], [0.5, 0.0, 1.0]), pose([-0.3, 0.1, 0.2], [0.0, 0.4, 1.2]));
        let motion = before.motion_to(&after);
        let plane = HessianNormalForm { normal: [0.6, 0.0, -0.8], distance: 1.5 };
        let moved = motion.of_plane(&plane);
        for point in [[0.0, 2.0, 1.875], [-2.5, 0.0, 0.0], [1.5, -1.0, 3.0]] {
            assert!((dot(plane.normal, point) + plane.distance).abs() < 1e-12);
            let world = |pose: &CameraPose, point: [f64; 3]| {
                [0, 1, 2].map(|k| dot(pose.rotation()[k], point) + pose.translation_m()[k])
            };
            let turned = motion.turned(point);
            let seen = [0, 1, 2].map(|k| turned[k] + motion.translation_m[k]);
            for k in 0..3 {
                assert!((world(&before, point)[k] - world(&after, seen)[k]).abs() < 1e-12);
            }
            assert!((dot(moved.normal, seen) + moved.distance).abs() < 1e-12);
        }
    }

    #[test]
    fn quaternions_turn_as_their_matrices_do() {
        let half = 0.5f64.sqrt();
        for (matrix, expected) in [
            ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0, 0.0, 0.0, 1.0]),
            ([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]], [1.0, 0.0, 0.0, 0.0]),
            ([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [0.0, 0.0, half, half]),
            ([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]], [0.0, half, half, 0.0]),
            ([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]], [0.5, -0.5, 0.5, -0.5]),
        ] {
            let found = CameraPose::new(matrix, [0.0; 3]).unwrap().quaternion();
            let apart = |sign: f64| found.iter().zip(expected).map(|(a, b)| (a - sign * b).abs()).fold(0.0, f64::max);
            assert!(apart(1.0).min(apart(-1.0)) < 1e-12, "{matrix:?}: {found:?}");
        }
    }

    #[test]
    fn what_is_no_rotation_is_an_error_and_few_digits_are_made_exact() {
        let mirror = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(CameraPose::new(mirror, [0.0; 3]).is_err());
        assert!(CameraPose::new([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]], [0.0; 3]).is_err());
        assert!(CameraPose::new([[f64::NAN; 3]; 3], [0.0; 3]).is_err());
        assert!(CameraPose::new(Motion::NONE.rotation, [f64::INFINITY, 0.0, 0.0]).is_err());
        let rounded =
            Motion::small([0.3, 0.2, -0.1], [0.0; 3]).rotation.map(|row| row.map(|x| (x * 100.0).round() / 100.0));
        let exact = CameraPose::new(rounded, [0.0; 3]).unwrap().rotation();
        for i in 0..3 {
            assert!((dot(exact[i], exact[i]) - 1.0).abs() < 1e-12 && dot(exact[i], exact[(i + 1) % 3]).abs() < 1e-12);
        }
    }
}
