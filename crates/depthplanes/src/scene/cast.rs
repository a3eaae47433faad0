//! Which surface each ray meets first: exact ray casting in camera coordinates.
//!
//! In: a scene and an eye (the camera, a projector or a second camera). Out: the depth, surface
//! number and angle of incidence of each pixel, and whether a given ray is blocked. A list of the
//! surfaces in each row, and a box around each in the picture, keep most tests from being made; a
//! tree would buy nothing for the tens of surfaces of a room.

use super::exact::{Vec3, dot, scale, sub, unit};
use super::pose::{Camera, Extrinsics};
use super::shape::{Bounds, Cylinder, Shape, area_vector};
use super::surfaces::{Scene, Strip, Surface};
use crate::camera::{HessianNormalForm, Intrinsics};

/// What the camera sees, without any sensor: one entry for each pixel.
#[derive(Clone, Debug, Default)]
pub(super) struct Cast {
    /// Depth along the optical axis, metres; 0 where nothing is.
    pub(super) depth_m: Vec<f64>,
    /// Number of the surface, from 1; 0 where nothing is.
    pub(super) surfaces: Vec<u32>,
    /// Cosine of the angle between the ray and the surface's normal, 0..=1.
    pub(super) cosines: Vec<f32>,
}

/// A scene prepared for one eye.
pub(super) struct Caster {
    intrinsics: Intrinsics,
    targets: Vec<Target>,
}

/// One thing that a ray can meet.
pub(super) struct Target {
    surface: u32,
    shape: Shape,
    bounds: Bounds,
}

/// The plane of a flat surface in the eye's coordinates; `None` for curved surfaces, and for planes
/// without an area or seen exactly edge on.
pub(super) fn plane_of(surface: &Surface, eye: &Extrinsics) -> Option<HessianNormalForm> {
    let (point, normal) = match surface {
        Surface::Facet { parts } => {
            let corners = seen_from(eye, parts.first()?);
            (*corners.first()?, unit(area_vector(&corners))?)
        }
        Surface::Disc { centre, normal, .. } => (eye.point(*centre), unit(eye.direction(*normal))?),
        _ => return None,
    };
    let distance = -dot(normal, point);
    let toward = if distance < 0.0 { -1.0 } else { 1.0 };
    (distance.abs() > 1e-9).then(|| HessianNormalForm { normal: scale(normal, toward), distance: distance * toward })
}

fn seen_from(eye: &Extrinsics, points: &[Vec3]) -> Vec<Vec3> {
    points.iter().map(|&point| eye.point(point)).collect()
}

impl Caster {
    pub(super) fn new(scene: &Scene, intrinsics: Intrinsics, eye: &Extrinsics) -> Self {
        let mut targets = Vec::new();
        for (number, surface) in (1..).zip(&scene.surfaces) {
            let shapes = shapes_of(surface, &intrinsics, eye);
            targets.extend(shapes.into_iter().map(|(shape, bounds)| Target { surface: number, shape, bounds }));
        }
        Caster { intrinsics, targets }
    }

    /// What rays of row `v` can meet.
    pub(super) fn row(&self, v: f64) -> Vec<&Target> {
        self.targets.iter().filter(|target| target.bounds.row(v)).collect()
    }

    /// What the ray through column `u` meets first, and its inverse depth there. Of surfaces at
    /// the same depth the first in the scene counts.
    #[inline]
    fn first<'t>(&self, ray: Vec3, u: f64, row: &[&'t Target]) -> Option<(f64, &'t Target)> {
        let mut best = None;
        let mut nearest = 0.0;
        for &target in row.iter().filter(|target| target.bounds.column(u)) {
            if let Some(q) = target.shape.meet(ray, nearest) {
                nearest = q;
                best = Some((q, target));
            }
        }
        best
    }

    /// Whether anything stands nearer than inverse depth `q` on the ray through (u, v); `row` is
    /// [`Caster::row`] of the same v.
    #[inline]
    pub(super) fn blocked(&self, [u, v]: [f64; 2], q: f64, row: &[&Target]) -> bool {
        let ray = self.intrinsics.ray(u, v);
        // Nearer by a millionth of the depth, so that a point does not shade itself.
        let before = q * (1.0 + 1e-6);
        row.iter().any(|target| target.bounds.column(u) && target.shape.meet(ray, before).is_some())
    }
}

/// One surface as the eye has it; none if it is degenerate.
fn shapes_of(surface: &Surface, camera: &Intrinsics, eye: &Extrinsics) -> Vec<(Shape, Bounds)> {
    let plane = plane_of(surface, eye);
    match surface {
        Surface::Facet { parts } => {
            let Some(plane) = plane else { return Vec::new() };
            let corners = parts.iter().map(|part| seen_from(eye, part));
            corners.filter_map(|c| Some((Shape::polygon(&plane, &c)?, Bounds::of_polygon(&c, camera)))).collect()
        }
        Surface::Disc { centre, radius, .. } => {
            let Some(plane) = plane else { return Vec::new() };
            let centre = eye.point(*centre);
            vec![(Shape::disc(&plane, centre, *radius), Bounds::of_round([centre; 2], *radius, camera))]
        }
        Surface::Ball { centre, radius } => {
            let (centre, radius) = (eye.point(*centre), *radius);
            vec![(Shape::Ball { centre, radius }, Bounds::of_round([centre; 2], radius, camera))]
        }
        Surface::Cylinder { from, to, radius, strip } => {
            let (from, to, radius) = (eye.point(*from), eye.point(*to), *radius);
            let Some(axis) = unit(sub(to, from)) else { return Vec::new() };
            let length = dot(sub(to, from), axis);
            let strip = strip.map(|strip| Strip { facing: eye.direction(strip.facing), ..strip });
            let cylinder = Cylinder { from, axis, length, radius, strip };
            vec![(Shape::Cylinder(cylinder), Bounds::of_round([from, to], radius, camera))]
        }
    }
}

/// Casts one ray through the centre of each pixel.
pub(super) fn cast(scene: &Scene, camera: &Camera) -> Cast {
    let caster = Caster::new(scene, camera.intrinsics, &camera.extrinsics());
    let mut seen = Cast::default();
    for v in 0..camera.height {
        let row = caster.row(v as f64);
        for u in 0..camera.width {
            let ray = camera.intrinsics.ray(u as f64, v as f64);
            let (z, surface, cosine) = match caster.first(ray, u as f64, &row) {
                Some((q, target)) => (1.0 / q, target.surface, target.shape.cosine(ray, 1.0 / q)),
                None => (0.0, 0, 0.0),
            };
            seen.depth_m.push(z);
            seen.surfaces.push(surface);
            seen.cosines.push(cosine as f32);
        }
    }
    seen
}
