//! What a scene is made of: flat facets, discs, balls and cylinders; and the solids built of them.
//!
//! In: sizes and places in world metres (x right, y forward, z up). Out: a list of [`Surface`]s.
//! Solids that meet or cross need no care: a ray sees the first surface that it meets.

use super::exact::{Vec3, add, cross, scale, sin_cos_deg, sub, unit};

/// One smooth piece of the world. Both sides of it can be seen.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// A piece of one plane: convex polygons, at least three corners each, all in the plane of
    /// the first. A wall around a doorway has several parts and is still one plane.
    Facet {
        /// Corners of each part in order, world metres.
        parts: Vec<Vec<[f64; 3]>>,
    },
    /// A round piece of a plane.
    Disc {
        /// Its middle, world metres.
        centre: [f64; 3],
        /// Direction at right angles to it, of any length.
        normal: [f64; 3],
        /// Radius, metres.
        radius: f64,
    },
    /// A sphere.
    Ball {
        /// Its middle, world metres.
        centre: [f64; 3],
        /// Radius, metres.
        radius: f64,
    },
    /// The side of a round cylinder, or a strip of it.
    Cylinder {
        /// One end of the axis, world metres.
        from: [f64; 3],
        /// The other end, world metres.
        to: [f64; 3],
        /// Radius, metres.
        radius: f64,
        /// Only the strip around this direction (at right angles to the axis, length 1) whose
        /// points lie at least `cosine * radius` along it; the whole side for `None`.
        strip: Option<Strip>,
    },
}

/// A part of a cylinder's side; see [`Surface::Cylinder`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    /// Middle of the strip as seen from the axis, length 1.
    pub facing: [f64; 3],
    /// Cosine of half the angle that the strip takes up.
    pub cosine: f64,
}

/// Surfaces in world coordinates. The number of a surface is its place in the list, from 1.
///
/// ```
/// use depthplanes::scene::{Place, Scene};
/// let mut scene = Scene::default();
/// scene.facet(&[[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 6.0, 0.0], [-3.0, 6.0, 0.0]]);
/// scene.block(Place::at(0.0, 3.0).turned(30.0), [-0.3, -0.3, 0.0], [0.3, 0.3, 0.5]);
/// scene.ball([0.0, 3.0, 0.6], 0.1);
/// assert_eq!(scene.surfaces.len(), 1 + 6 + 1);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The surfaces; a degenerate one (no area, not a number) is never seen.
    pub surfaces: Vec<Surface>,
}

/// Where a solid stands: its own x, y, z axes, turned about the vertical and moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The solid's origin, world metres.
    pub origin_m: [f64; 3],
    /// Turn to the left (counterclockwise from above), degrees.
    pub yaw_deg: f64,
}

impl Place {
    /// On the floor.
    pub fn at(x_m: f64, y_m: f64) -> Self {
        Place { origin_m: [x_m, y_m, 0.0], yaw_deg: 0.0 }
    }

    /// The place, raised by so much.
    pub fn raised(mut self, z_m: f64) -> Self {
        self.origin_m[2] += z_m;
        self
    }

    /// The place, turned to the left.
    pub fn turned(mut self, yaw_deg: f64) -> Self {
        self.yaw_deg += yaw_deg;
        self
    }

    /// World coordinates of a point of the solid.
    pub fn point(&self, local_m: [f64; 3]) -> [f64; 3] {
        add(self.origin_m, self.direction(local_m))
    }

    /// World coordinates of a direction of the solid.
    pub fn direction(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (sine, cosine) = sin_cos_deg(self.yaw_deg);
        [cosine * x - sine * y, sine * x + cosine * y, z]
    }
}

impl Scene {
    /// A convex polygon.
    pub fn facet(&mut self, corners: &[[f64; 3]]) {
        self.surfaces.push(Surface::Facet { parts: vec![corners.to_vec()] });
    }

    /// A polygon in the coordinates of a place.
    pub fn facet_at(&mut self, place: Place, corners: &[[f64; 3]]) {
        self.facets_at(place, &[corners.to_vec()]);
    }

    /// Several polygons of one plane, in the coordinates of a place.
    pub fn facets_at(&mut self, place: Place, parts: &[Vec<[f64; 3]>]) {
        let parts = parts.iter().map(|part| part.iter().map(|&p| place.point(p)).collect()).collect();
        self.surfaces.push(Surface::Facet { parts });
    }

    /// A box between two opposite corners, in the coordinates of its place: six facets.
    pub fn block(&mut self, place: Place, low: [f64; 3], high: [f64; 3]) {
        for axis in 0..3 {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            for end in [low[axis], high[axis]] {
                let corner = |along_b: f64, along_c: f64| {
                    let mut p = [0.0; 3];
                    (p[axis], p[b], p[c]) = (end, along_b, along_c);
                    p
                };
                let (b0, b1, c0, c1) = (low[b], high[b], low[c], high[c]);
                self.facet_at(place, &[corner(b0, c0), corner(b1, c0), corner(b1, c1), corner(b0, c1)]);
            }
        }
    }

    /// A wedge that rises from its origin's edge along local y: slope, back and two sides.
    /// `size` is width (across, centred), length and height.
    pub fn ramp(&mut self, place: Place, [width, length, height]: [f64; 3]) {
        let w = width / 2.0;
        let (foot, top, toe) = (|x| [x, 0.0, 0.0], |x| [x, length, height], |x| [x, length, 0.0]);
        self.facet_at(place, &[foot(-w), foot(w), top(w), top(-w)]);
        self.facet_at(place, &[toe(-w), toe(w), top(w), top(-w)]);
        for x in [-w, w] {
            self.facet_at(place, &[foot(x), toe(x), top(x)]);
        }
    }

    /// Steps that rise along local y: each tread and each riser is a plane of its own; each side
    /// is one plane of `steps` parts. `size` is the whole width (centred), length and height.
    pub fn stairs(&mut self, place: Place, [width, length, height]: [f64; 3], steps: usize) {
        let w = width / 2.0;
        let (run, rise) = (length / steps as f64, height / steps as f64);
        let mut sides = [Vec::new(), Vec::new()];
        for step in 0..steps {
            let (y, z) = (run * step as f64, rise * step as f64);
            let (back, top) = (y + run, z + rise);
            self.facet_at(place, &[[-w, y, z], [w, y, z], [w, y, top], [-w, y, top]]);
            self.facet_at(place, &[[-w, y, top], [w, y, top], [w, back, top], [-w, back, top]]);
            for (side, x) in sides.iter_mut().zip([-w, w]) {
                side.push(vec![[x, y, 0.0], [x, back, 0.0], [x, back, top], [x, y, top]]);
            }
        }
        sides.iter().for_each(|side| self.facets_at(place, side));
        self.facet_at(place, &[[-w, length, 0.0], [w, length, 0.0], [w, length, height], [-w, length, height]]);
    }

    /// A sphere.
    pub fn ball(&mut self, centre: [f64; 3], radius: f64) {
        self.surfaces.push(Surface::Ball { centre, radius });
    }

    /// A round column with flat ends, upright on its base's middle.
    pub fn column(&mut self, base: [f64; 3], radius: f64, height: f64) {
        self.roll(base, add(base, [0.0, 0.0, height]), radius);
    }

    /// A round bar with flat ends between the two ends of its axis.
    pub fn roll(&mut self, from: [f64; 3], to: [f64; 3], radius: f64) {
        self.surfaces.push(Surface::Cylinder { from, to, radius, strip: None });
        let normal = sub(to, from);
        self.surfaces.push(Surface::Disc { centre: from, normal, radius });
        self.surfaces.push(Surface::Disc { centre: to, normal, radius });
    }

    /// A curved sheet: a strip of a cylinder's side of the given radius, `size` = (length of the straight side, width
    /// across the curve, both metres), its middle at `middle`, straight along `along`, bulging along `facing`.
    pub fn sheet(&mut self, middle: [f64; 3], along: [f64; 3], facing: [f64; 3], size: [f64; 2], radius: f64) {
        let Some((axis, facing)) = frame(along, facing) else { return };
        let centre = sub(middle, scale(facing, radius));
        let half = scale(axis, size[0] / 2.0);
        // The chord `size[1]` of the circle.
        let sine = (size[1] / (2.0 * radius)).clamp(0.0, 1.0);
        let cosine = (1.0 - sine * sine).sqrt();
        let strip = Some(Strip { facing, cosine });
        self.surfaces.push(Surface::Cylinder { from: sub(centre, half), to: add(centre, half), radius, strip });
    }
}

/// `along` at length 1, and the part of `facing` at right angles to it at length 1.
fn frame(along: Vec3, facing: Vec3) -> Option<(Vec3, Vec3)> {
    let axis = unit(along)?;
    let across = unit(cross(axis, facing))?;
    Some((axis, cross(across, axis)))
}
