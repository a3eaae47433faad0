//! Points, planes and the rays of pixels in space.
//!
//! In: what is known of the sensor, and q at places of the image. Out: points and planes. Where the camera is not
//! known, [`Intrinsics::assumed`] stands in for it.

use crate::camera::{Intrinsics, ValueKind};
use crate::sensor::Sensor;
use crate::util::vec3::{Vec3, cross, dot, sub, unit};

/// A plane in space, `normal . point = distance`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane3 {
    pub(crate) normal: Vec3,
    pub(crate) distance: f64,
}

impl Plane3 {
    /// Through three points; none if they lie on a line.
    pub(crate) fn through([a, b, c]: [Vec3; 3]) -> Option<Plane3> {
        let normal = unit(cross(sub(b, a), sub(c, a)))?;
        Some(Plane3 { normal, distance: dot(normal, a) })
    }

    /// Signed distance of a point.
    #[inline(always)]
    pub(crate) fn off(&self, point: Vec3) -> f64 {
        dot(self.normal, point) - self.distance
    }
}

/// Rays of the pixels, and inverse depth as an affine function of q.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rays {
    camera: Intrinsics,
    /// Inverse depth is `slope q + offset`.
    slope: f64,
    offset: f64,
}

impl Rays {
    /// The rays of a sensor. For disparity, inverse depth is known up to a factor only, on which angles do not depend.
    pub(crate) fn of(sensor: &Sensor, width: usize, height: usize) -> Self {
        let (slope, offset) = match sensor.value_kind {
            ValueKind::InverseDepth { slope, offset } => (slope, offset),
            ValueKind::Depth { .. } | ValueKind::Disparity => (1.0, 0.0), // q of depth is in 1/m
        };
        let camera = sensor.intrinsics.unwrap_or_else(|| Intrinsics::assumed(width, height));
        Rays { camera, slope, offset }
    }

    /// As [`Rays::of`], with lengths in metres where unit and camera are known, and in median depths of the map where
    /// they are not; `median` finds the median of q.
    pub(crate) fn scaled(sensor: &Sensor, [width, height]: [usize; 2], median: impl FnOnce() -> f64) -> Self {
        let rays = Rays::of(sensor, width, height);
        if sensor.is_metric() {
            return rays;
        }
        Rays { slope: 1.0 / median(), offset: 0.0, ..rays }
    }

    /// Where the ray of a place meets q; it may be behind the camera or at infinity.
    pub(crate) fn at(&self, [u, v]: [f64; 2], q: f64) -> Vec3 {
        let Intrinsics { fx, fy, cx, cy } = self.camera;
        let depth = 1.0 / (self.slope * q + self.offset);
        [(u - cx) / fx * depth, (v - cy) / fy * depth, depth]
    }

    /// The point of a pixel; none at or behind infinity.
    pub(crate) fn point(&self, place: [f64; 2], q: f64) -> Option<Vec3> {
        Some(self.at(place, q)).filter(|[_, _, depth]| *depth > 0.0 && depth.is_finite())
    }

    /// The vector n of the plane `n . point = 1` whose q has that gradient along columns and rows and is `q_at` a
    /// place: inverse depth is affine in u and v too.
    pub(crate) fn inverse(&self, [a, b]: [f64; 2], q_at: impl Fn(f64, f64) -> f64) -> Vec3 {
        let Intrinsics { fx, fy, cx, cy } = self.camera;
        [self.slope * a * fx, self.slope * b * fy, self.slope * q_at(cx, cy) + self.offset]
    }

    /// The plane in space where `q = a u + b v + c`, turned away from the camera; none if it passes through the camera.
    pub(crate) fn plane(&self, [a, b, c]: [f64; 3]) -> Option<Plane3> {
        let inverse = self.inverse([a, b], |u, v| c + a * u + b * v);
        Some(Plane3 { normal: unit(inverse)?, distance: 1.0 / dot(inverse, inverse).sqrt() })
    }

    /// The unit normal of the plane whose q is `q` at a pixel and changes by that gradient, turned away from the camera.
    pub(crate) fn normal(&self, [u, v]: [f64; 2], [a, b]: [f64; 2], q: f64) -> Option<Vec3> {
        unit(self.inverse([a, b], |x, y| q + a * (x - u) + b * (y - v)))
    }
}
