//! Where the points of a plane are in the picture after the camera has moved.

use super::pose::Motion;
use crate::camera::{HessianNormalForm, Intrinsics};

/// K (R - t n^T / d) K^-1 of the plane n . X + d = 0 (Hartley and Zisserman, *Multiple View Geometry*, result 13.1).
#[derive(Clone, Copy, Debug)]
pub(super) struct Homography {
    /// Of the pixel (u, v, 1) to the ray (x, y, z).
    rows: [[f32; 3]; 3],
    /// fx, fy, cx, cy.
    camera: [f32; 4],
}

impl Homography {
    /// That of a camera at rest.
    pub(super) const NONE: Homography =
        Homography { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], camera: [1.0, 1.0, 0.0, 0.0] };

    /// Of a plane before the motion.
    pub(super) fn new(motion: &Motion, plane: &HessianNormalForm, camera: &Intrinsics) -> Self {
        let Motion { rotation, translation_m } = motion;
        let rows = std::array::from_fn(|i| {
            let [a, b, c] = [0, 1, 2].map(|j| rotation[i][j] - translation_m[i] * plane.normal[j] / plane.distance);
            // Of the pixel (u, v, 1) instead of the ray ((u - cx) / fx, (v - cy) / fy, 1).
            let [a, b] = [a / camera.fx, b / camera.fy];
            [a, b, c - a * camera.cx - b * camera.cy].map(|entry| entry as f32)
        });
        Homography { rows, camera: [camera.fx, camera.fy, camera.cx, camera.cy].map(|number| number as f32) }
    }

    /// Where a pixel is afterwards; not a number behind the camera.
    #[inline]
    pub(super) fn of(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let [x, y, z] = self.rows.map(|[a, b, c]| a * u + b * v + c);
        let [fx, fy, cx, cy] = self.camera;
        if z > 0.0 { [fx * (x / z) + cx, fy * (y / z) + cy] } else { [f32::NAN; 2] }
    }
}
