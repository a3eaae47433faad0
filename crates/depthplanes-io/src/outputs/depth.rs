//! How far away a plane is along the view, for people.

use depthplanes::{Plane, ValueKind};

/// Depth of a plane at its middle, metres: the mean z of its points, or without a camera the depth that its fit has at the
/// mean of its pixels. `None` if the values have no unit or the plane has no fit.
///
/// It is what a person expects as the distance of a surface in the picture. The plane's `distance` is another: that of the
/// camera from the plane, perpendicular to it, wherever the plane goes on to.
pub fn depth_m(plane: &Plane, value_kind: ValueKind) -> Option<f64> {
    if let Some(metric) = plane.metric {
        return Some(metric.centroid_m[2]);
    }
    let (fit, [u, v]) = (plane.fit?, plane.centroid);
    value_kind.depth_m(fit.gradient[0] * u + fit.gradient[1] * v + fit.offset)
}
