//! A map as points in space with normals.
//!
//! In: a map in q and what is known of the sensor. Out: a point for each valid pixel, in metres where unit and camera are
//! known. Where they are not, one is assumed that sees 53 degrees along the longer side, and the unit is the median depth:
//! planes remain planes, though angles and distances are not the true ones.

use super::affine::{Affine, Around};
use crate::camera::{Intrinsics, Measure, Sensor};

/// A point or a direction.
pub(super) type Vec3 = [f64; 3];

pub(super) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector at length 1; none if it has no direction.
pub(super) fn unit(a: Vec3) -> Option<Vec3> {
    let length = dot(a, a).sqrt();
    (length > 0.0 && length.is_finite()).then(|| a.map(|x| x / length))
}

/// A plane in space, `normal . point = distance`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane3 {
    pub(super) normal: Vec3,
    pub(super) distance: f64,
}

impl Plane3 {
    /// Through three points; none if they lie on a line.
    pub(super) fn through([a, b, c]: [Vec3; 3]) -> Option<Plane3> {
        let normal = unit(cross(sub(b, a), sub(c, a)))?;
        Some(Plane3 { normal, distance: dot(normal, a) })
    }

    /// Signed distance of a point.
    #[inline(always)]
    pub(super) fn off(&self, point: Vec3) -> f64 {
        dot(self.normal, point) - self.distance
    }
}

/// Rays of the pixels, and inverse depth as an affine function of q.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays {
    camera: Intrinsics,
    slope: f64,
    offset: f64,
}

impl Rays {
    /// Of a sensor.
    pub(super) fn of(sensor: &Sensor, affine: &Affine) -> Self {
        let [w, h] = [affine.width, affine.height].map(|side| side as f64);
        let usual = Intrinsics { fx: w.max(h), fy: w.max(h), cx: w / 2.0, cy: h / 2.0 };
        let metres = match sensor.measure {
            Measure::Depth { .. } => Some((1.0, 0.0)), // q is in 1/m
            Measure::InverseDepth { slope, offset } => Some((slope, offset)),
            Measure::Disparity => None,
        };
        match (sensor.intrinsics, metres) {
            (Some(camera), Some((slope, offset))) => Rays { camera, slope, offset },
            (camera, _) => {
                let median = affine.range(0.5).map_or(1.0, |[low, _]| low);
                Rays { camera: camera.unwrap_or(usual), slope: 1.0 / median, offset: 0.0 }
            }
        }
    }

    /// The point of a pixel, none at infinity.
    pub(super) fn point(&self, [u, v]: [f64; 2], q: f64) -> Option<Vec3> {
        let Intrinsics { fx, fy, cx, cy } = self.camera;
        let depth = 1.0 / (self.slope * q + self.offset);
        (depth > 0.0 && depth.is_finite()).then_some([(u - cx) / fx * depth, (v - cy) / fy * depth, depth])
    }

    /// The plane in space where `q = a u + b v + c`, turned away from the camera; none if it passes through the camera.
    ///
    /// Inverse depth is affine in u and v too: `1 = normal . point` with the three coefficients of the rays as normal.
    pub(super) fn plane(&self, [a, b, c]: [f64; 3]) -> Option<Plane3> {
        let Intrinsics { fx, fy, cx, cy } = self.camera;
        let inverse = [self.slope * a * fx, self.slope * b * fy, self.slope * (c + a * cx + b * cy) + self.offset];
        let normal = unit(inverse)?;
        Some(Plane3 { normal, distance: 1.0 / dot(inverse, inverse).sqrt() })
    }

    /// The unit normal of the plane around a pixel, turned away from the camera.
    pub(super) fn normal(&self, [u, v]: [f64; 2], around: &Around) -> Option<Vec3> {
        let Intrinsics { fx, fy, cx, cy } = self.camera;
        let [a, b] = around.gradient;
        let at_middle = around.q + a * (cx - u) + b * (cy - v);
        unit([self.slope * a * fx, self.slope * b * fy, self.slope * at_middle + self.offset])
    }
}

/// Points with their normals.
#[derive(Debug)]
pub(super) struct Cloud {
    /// For each pixel its point; NaN where there is none.
    pub(super) points: Vec<Vec3>,
    /// For each pixel its unit normal; NaN where there is none.
    pub(super) normals: Vec<Vec3>,
    /// Pixels that have both, by their number in raster order.
    pub(super) known: Vec<u32>,
    /// From pixels to space.
    pub(super) rays: Rays,
}

impl Cloud {
    /// Of a map; normals are those of windows of `2 radius + 1` columns and rows.
    pub(super) fn of(affine: &Affine, sensor: &Sensor, radius: usize) -> Self {
        let rays = Rays::of(sensor, affine);
        let nowhere = [f64::NAN; 3];
        let place = |at: usize| affine.place(at);
        let point = |(at, &q): (usize, &f64)| rays.point(place(at), q).unwrap_or(nowhere);
        let points: Vec<Vec3> = affine.q.iter().enumerate().map(point).collect();
        let normal = |(at, around): (usize, &Option<Around>)| {
            around.as_ref().and_then(|around| rays.normal(place(at), around)).unwrap_or(nowhere)
        };
        let normals: Vec<Vec3> = affine.planes(radius).iter().enumerate().map(normal).collect();
        let is_known = |&at: &u32| points[at as usize][2].is_finite() && normals[at as usize][2].is_finite();
        let known = (0..points.len() as u32).filter(is_known).collect();
        Cloud { points, normals, known, rays }
    }

    /// Length of the diagonal of the box around all points but one in fifty on either side of each axis.
    pub(super) fn diagonal(&self) -> f64 {
        let side = |axis: usize| {
            let mut all: Vec<f64> = self.known.iter().map(|&at| self.points[at as usize][axis]).collect();
            let few = all.len() / 50;
            let Some(last) = all.len().checked_sub(few + 1) else { return 0.0 };
            let [low, high] = [few, last].map(|at| *all.select_nth_unstable_by(at, f64::total_cmp).1);
            high - low
        };
        [0, 1, 2].map(side).iter().map(|side| side * side).sum::<f64>().sqrt()
    }
}
