//! Where one ray meets one surface, in the coordinates of the eye; and the box in the picture that
//! a surface stays within.

use super::exact::{Vec3, add, cross, dot, scale, sub, unit};
use super::surfaces::Strip;
use crate::camera::{HessianNormalForm, Intrinsics};

/// Depth along the optical axis at which boxes in the picture are cut, metres.
const NEAR_M: f64 = 1e-3;

/// A surface in the eye's coordinates. `inverse` is m of `1/z = m . r` (see [`crate::camera`]).
pub(super) enum Shape {
    /// A ray is inside if it is on the inner side of each edge's plane, the plane through the edge
    /// and the eye; so a facet that reaches behind the eye needs no clipping.
    Polygon { inverse: Vec3, edges: Vec<Vec3> },
    /// Flat and round.
    Disc { inverse: Vec3, centre: Vec3, radius: f64 },
    /// A sphere.
    Ball { centre: Vec3, radius: f64 },
    /// The side of a cylinder, or a strip of it.
    Cylinder(Cylinder),
}

/// See [`Shape::Cylinder`].
pub(super) struct Cylinder {
    pub(super) from: Vec3,
    pub(super) axis: Vec3,
    pub(super) length: f64,
    pub(super) radius: f64,
    pub(super) strip: Option<Strip>,
}

/// How far outside an edge a ray still counts as inside (sine of the angle), so that no ray slips
/// between two facets that share an edge.
const EDGE: f64 = -1e-12;

impl Shape {
    /// One part of a facet; `None` if it has no area.
    pub(super) fn polygon(plane: &HessianNormalForm, corners: &[Vec3]) -> Option<Self> {
        let area = unit(area_vector(corners))?;
        // Edges are turned so that the inside is positive whichever way the corners run.
        let side = if dot(area, plane.normal) < 0.0 { 1.0 } else { -1.0 };
        let edge = |i: usize| unit(cross(corners[i], corners[(i + 1) % corners.len()]));
        let edges = (0..corners.len()).filter_map(|i| Some(scale(edge(i)?, side))).collect();
        Some(Shape::Polygon { inverse: inverse(plane), edges })
    }

    pub(super) fn disc(plane: &HessianNormalForm, centre: Vec3, radius: f64) -> Self {
        Shape::Disc { inverse: inverse(plane), centre, radius }
    }

    /// Inverse depth of the first meeting with `ray` (z = 1), if it is above `least`.
    #[inline]
    pub(super) fn meet(&self, ray: Vec3, least: f64) -> Option<f64> {
        match self {
            Shape::Polygon { inverse, edges } => {
                let q = dot(*inverse, ray);
                (q > least && edges.iter().all(|edge| dot(*edge, ray) >= EDGE)).then_some(q)
            }
            Shape::Disc { inverse, centre, radius } => {
                let q = dot(*inverse, ray);
                if q <= least {
                    return None;
                }
                let off = sub(scale(ray, 1.0 / q), *centre);
                (dot(off, off) <= radius * radius).then_some(q)
            }
            Shape::Ball { centre, radius } => {
                let c = dot(*centre, *centre) - radius * radius;
                let roots = roots(dot(ray, ray), dot(ray, *centre), c)?;
                roots.into_iter().map(f64::recip).find(|&q| q > least)
            }
            Shape::Cylinder(cylinder) => cylinder.meet(ray, least),
        }
    }

    /// Cosine (0..=1) between the ray and the surface's normal where they meet.
    pub(super) fn cosine(&self, ray: Vec3, z: f64) -> f64 {
        let point = scale(ray, z);
        let normal = match self {
            Shape::Polygon { inverse, .. } | Shape::Disc { inverse, .. } => *inverse,
            Shape::Ball { centre, .. } => sub(point, *centre),
            Shape::Cylinder(cylinder) => cylinder.across(sub(point, cylinder.from)),
        };
        let lengths = (dot(normal, normal) * dot(ray, ray)).sqrt();
        if lengths > 0.0 { (dot(normal, ray).abs() / lengths).min(1.0) } else { 0.0 }
    }
}

impl Cylinder {
    /// The part of a vector at right angles to the axis.
    fn across(&self, vector: Vec3) -> Vec3 {
        sub(vector, scale(self.axis, dot(vector, self.axis)))
    }

    fn meet(&self, ray: Vec3, least: f64) -> Option<f64> {
        let (ray_across, from_across) = (self.across(ray), self.across(self.from));
        let c = dot(from_across, from_across) - self.radius * self.radius;
        let roots = roots(dot(ray_across, ray_across), dot(ray_across, from_across), c)?;
        let on_it = |z: f64| {
            let point = sub(scale(ray, z), self.from);
            let along = dot(point, self.axis);
            let strip = self.strip.is_none_or(|strip| dot(point, strip.facing) >= strip.cosine * self.radius);
            (0.0..=self.length).contains(&along) && strip
        };
        roots.into_iter().find(|&z| z > 0.0 && on_it(z)).map(f64::recip).filter(|&q| q > least)
    }
}

/// Both solutions of `a z^2 - 2 b z + c = 0`, the smaller first (a > 0).
fn roots(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let square = b * b - a * c;
    if !(square >= 0.0 && a > 0.0) {
        return None;
    }
    let root = square.sqrt();
    Some([(b - root) / a, (b + root) / a])
}

/// Twice the area of a polygon, along its normal.
pub(super) fn area_vector(corners: &[Vec3]) -> Vec3 {
    let Some(&origin) = corners.first() else { return [0.0; 3] };
    corners.windows(2).fold([0.0; 3], |sum, pair| add(sum, cross(sub(pair[0], origin), sub(pair[1], origin))))
}

fn inverse(plane: &HessianNormalForm) -> Vec3 {
    plane.normal.map(|x| -x / plane.distance)
}

/// A box in the picture outside which a surface is not seen.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Bounds {
    const NOWHERE: Bounds = Bounds { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
    const EVERYWHERE: Bounds = Bounds { low: [f64::NEG_INFINITY; 2], high: [f64::INFINITY; 2] };

    fn include(&mut self, pixel: [f64; 2]) {
        for axis in 0..2 {
            self.low[axis] = self.low[axis].min(pixel[axis]);
            self.high[axis] = self.high[axis].max(pixel[axis]);
        }
    }

    /// Around the part of a polygon that lies before the eye.
    pub(super) fn of_polygon(corners: &[Vec3], camera: &Intrinsics) -> Self {
        let mut bounds = Bounds::NOWHERE;
        for i in 0..corners.len() {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            if a[2] >= NEAR_M {
                bounds.include(camera.project(a));
            }
            if (a[2] < NEAR_M) != (b[2] < NEAR_M) {
                let cut = add(a, scale(sub(b, a), (NEAR_M - a[2]) / (b[2] - a[2])));
                bounds.include(camera.project([cut[0], cut[1], NEAR_M]));
            }
        }
        bounds.widened()
    }

    /// Around all that is within `radius` of the segment between two points.
    pub(super) fn of_round(ends: [Vec3; 2], radius: f64, camera: &Intrinsics) -> Self {
        let mut bounds = Bounds::NOWHERE;
        for end in ends {
            for corner in 0..8 {
                let step = |bit: usize| if corner >> bit & 1 == 0 { -radius } else { radius };
                let point = add(end, [step(0), step(1), step(2)]);
                if point[2] < NEAR_M {
                    return Bounds::EVERYWHERE;
                }
                bounds.include(camera.project(point));
            }
        }
        bounds.widened()
    }

    /// A thousandth of a pixel more on each side, for rounding.
    fn widened(self) -> Self {
        Bounds { low: self.low.map(|x| x - 1e-3), high: self.high.map(|x| x + 1e-3) }
    }

    #[inline]
    pub(super) fn column(&self, u: f64) -> bool {
        self.low[0] <= u && u <= self.high[0]
    }

    #[inline]
    pub(super) fn row(&self, v: f64) -> bool {
        self.low[1] <= v && v <= self.high[1]
    }
}
