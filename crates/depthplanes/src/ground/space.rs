//! Vectors of camera coordinates, and heights above a plane.

use crate::camera::HessianNormalForm;
use crate::detection::MetricPlane;
use crate::util::vec3::{dot, quadratic_form};

/// Angle between two unit vectors, degrees, 0 to 180.
pub(super) fn angle_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    dot(a, b).clamp(-1.0, 1.0).acos().to_degrees()
}

/// How far a point is on the side that the plane's normal points to, metres.
pub(super) fn height_m(floor: &HessianNormalForm, point_m: [f64; 3]) -> f64 {
    dot(floor.normal, point_m) + floor.distance
}

/// Variance of the height of a point above a plane, by the plane's covariance alone, square metres.
pub(super) fn height_variance(covariance: &[[f64; 4]; 4], [x, y, z]: [f64; 3]) -> f64 {
    quadratic_form(covariance, [x, y, z, 1.0]).max(0.0)
}

/// Standard deviation of the height of a plane's middle above another plane, by the covariance of both, metres.
pub(super) fn height_sd_m(floor: &[[f64; 4]; 4], plane: &MetricPlane) -> f64 {
    let middle = plane.centroid_m;
    (height_variance(floor, middle) + height_variance(&plane.covariance, middle)).sqrt()
}
