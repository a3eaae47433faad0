//! Where points are as seen from the camera's foot on the floor.

use super::floor::Floor;
use super::space::height_m;
use crate::camera::HessianNormalForm;
use crate::util::vec3::dot;

/// Axes on the floor under the camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    floor: HessianNormalForm,
    right: [f64; 3],
    ahead: [f64; 3],
}

/// A point by its place on the floor, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    /// To the right of the direction of view.
    pub(super) right_m: f64,
    /// Along the direction of view.
    pub(super) ahead_m: f64,
    /// Above the floor.
    pub(super) height_m: f64,
}

impl Spot {
    /// Distance along the floor from the camera's foot.
    pub(super) fn distance_m(&self) -> f64 {
        (self.right_m * self.right_m + self.ahead_m * self.ahead_m).sqrt()
    }

    /// Degrees to the right of the direction of view.
    pub(super) fn bearing_deg(&self) -> f64 {
        self.right_m.atan2(self.ahead_m).to_degrees()
    }
}

impl Standing {
    pub(super) fn new(floor: &Floor) -> Self {
        Standing { floor: floor.plane, right: floor.right, ahead: floor.ahead }
    }

    /// Where a point in camera coordinates is.
    pub(super) fn spot(&self, point_m: [f64; 3]) -> Spot {
        let [right_m, ahead_m] = [dot(self.right, point_m), dot(self.ahead, point_m)];
        Spot { right_m, ahead_m, height_m: height_m(&self.floor, point_m) }
    }

    /// To the right and ahead, of a direction.
    pub(super) fn direction(&self, ray: [f64; 3]) -> [f64; 2] {
        [dot(self.right, ray), dot(self.ahead, ray)]
    }

    /// Where a ray meets the floor; `None` of one that does not.
    pub(super) fn on_floor(&self, ray: [f64; 3]) -> Option<Spot> {
        self.floor.point_along(ray).map(|point| self.spot(point))
    }
}
