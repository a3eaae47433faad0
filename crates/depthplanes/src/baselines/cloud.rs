//! A map as points in space with normals.
//!
//! In: a map in q and what is known of the sensor. Out: a point and a normal for each valid pixel, in the lengths of
//! [`Affine::rays`].

use super::affine::{Affine, Around};
use crate::methods::rays::Rays;
use crate::sensor::Sensor;
use crate::util::vec3::Vec3;

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
    /// The points of a map; normals are those of windows of `2 radius + 1` columns and rows.
    pub(super) fn of(affine: &Affine, sensor: &Sensor, radius: usize) -> Self {
        let rays = affine.rays(sensor);
        let nowhere = [f64::NAN; 3];
        let place = |at: usize| affine.place(at);
        let point = |(at, &q): (usize, &f64)| rays.point(place(at), q).unwrap_or(nowhere);
        let points: Vec<Vec3> = affine.q.iter().enumerate().map(point).collect();
        let normal = |(at, around): (usize, &Option<Around>)| {
            around.as_ref().and_then(|around| rays.normal(place(at), around.gradient, around.q)).unwrap_or(nowhere)
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
