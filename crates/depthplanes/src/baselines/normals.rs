//! normals: local-normal grouping (Yoo, Kim, Kim, Park, *Real-time plane detection based on depth map from Kinect*,
//! ISR 2013), from its description.
//!
//! In: any map; lengths are in metres where unit and camera are known. Out: connected regions of points whose own normals
//! and places suit the region's plane. The paper's normals are cross products over the four neighbours; here the
//! neighbours may be further off, for those of a Kinect are lost in its noise. Fast and simple; where normals are noisy it
//! finds little.

use super::affine::Affine;
use super::baseline::{Baseline, Input, Segmented, Values};
use crate::limits::MAX_PLANES;
use crate::methods::extraction::{MIN_PIXELS, STAGES};
use crate::methods::method::Job;
use crate::methods::parameter::{Param, ParamKind};
use crate::methods::rays::{Plane3, Rays};
use crate::util::vec3::{Vec3, cross, dot, sub, unit};

pub(super) struct Normals {
    min_pixels: usize,
    /// Cosine of the largest angle between normals.
    cosine: f64,
    distance: f64,
    reach: usize,
}

impl Baseline for Normals {
    const NAME: &'static str = "normals";
    const ABOUT: &'static str =
        "Groups neighbours whose local normals agree and that lie on the group's plane (Yoo et al. 2013).";
    const STAGES: &'static [&'static str] = &["points", "grow", STAGES[0], STAGES[1], STAGES[2], STAGES[3]];
    const PARAMS: &'static [Param] = &[
        MIN_PIXELS,
        Param {
            name: "angle",
            alias: None,
            default: 25.0,
            min: 0.1,
            max: 90.0,
            kind: ParamKind::Real,
            unit: "degrees",
            meaning: "How far a point's normal may lie from that of the plane it joins.",
            source: Some("Yoo et al. 2013"),
        },
        Param {
            name: "distance",
            alias: None,
            default: 0.03,
            min: 1e-6,
            max: f64::MAX,
            kind: ParamKind::Real,
            unit: "m or median depths",
            meaning: "How far a point may lie from the plane it joins; in median depths where unit or camera is unknown.",
            source: Some("Yoo et al. 2013"),
        },
        Param {
            name: "reach",
            alias: None,
            default: 4.0,
            min: 1.0,
            max: 100.0,
            kind: ParamKind::Whole,
            unit: "pixels",
            meaning: "Distance to the four neighbours that a normal is computed from; 1 in the paper.",
            source: None,
        },
    ];

    fn new(values: &Values<'_>) -> Self {
        Normals {
            min_pixels: values.whole(MIN_PIXELS.name),
            cosine: values.of("angle").to_radians().cos(),
            distance: values.of("distance"),
            reach: values.whole("reach"),
        }
    }

    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented {
        let points = points(&map.affine, &map.affine.rays(&map.sensor));
        let normals = normals(&map.affine, &points, self.reach);
        job.done("points");
        let image = self.grow(&map.affine, &points, &normals);
        job.done("grow");
        Segmented { image, noise: None }
    }
}

impl Normals {
    /// The region of every pixel, 0 for none.
    fn grow(&self, affine: &Affine, points: &[Option<Vec3>], normals: &[Option<Vec3>]) -> Vec<u16> {
        let mut image = vec![0; points.len()];
        let mut is_taken = vec![false; points.len()];
        let mut planes = Vec::new();
        let mut members = Vec::new();
        for seed in 0..points.len() {
            let (Some(point), Some(normal)) = (points[seed], normals[seed]) else { continue };
            if is_taken[seed] {
                continue;
            }
            let mut region = Region { points: point, normals: normal, n: 1.0 };
            let mut plane = region.plane();
            members.clear();
            members.push(seed);
            is_taken[seed] = true;
            let mut next = 0;
            while let Some(&at) = members.get(next) {
                next += 1;
                for beside in affine.neighbours(at) {
                    let (Some(point), Some(normal)) = (points[beside], normals[beside]) else { continue };
                    let is_alike = dot(normal, plane.normal) >= self.cosine && plane.off(point).abs() <= self.distance;
                    if !is_taken[beside] && is_alike {
                        is_taken[beside] = true;
                        members.push(beside);
                        region.add(point, normal);
                        // The mean changes slowly once there are many.
                        if members.len().is_power_of_two() || members.len().is_multiple_of(256) {
                            plane = region.plane();
                        }
                    }
                }
            }
            if members.len() > self.min_pixels && planes.len() < MAX_PLANES {
                planes.push(region.plane());
                members.iter().for_each(|&at| image[at] = planes.len() as u16);
            }
        }
        // Whatever their normals: near an edge, a pixel's neighbours are on two surfaces, and its normal is that of neither.
        affine.spread(&mut image, |at, region| {
            let plane = planes[usize::from(region) - 1];
            points[at].is_some_and(|point| plane.off(point).abs() <= self.distance)
        });
        image
    }
}

/// Sums over the members of a region.
struct Region {
    points: Vec3,
    normals: Vec3,
    n: f64,
}

impl Region {
    fn add(&mut self, point: Vec3, normal: Vec3) {
        self.points = [0, 1, 2].map(|axis| self.points[axis] + point[axis]);
        self.normals = [0, 1, 2].map(|axis| self.normals[axis] + normal[axis]);
        self.n += 1.0;
    }

    /// Through the mean point, along the mean normal.
    fn plane(&self) -> Plane3 {
        let normal = unit(self.normals).unwrap_or(self.normals);
        Plane3 { normal, distance: dot(normal, self.points.map(|sum| sum / self.n)) }
    }
}

/// For each pixel its point.
fn points(affine: &Affine, rays: &Rays) -> Vec<Option<Vec3>> {
    affine.q.iter().enumerate().map(|(at, &q)| rays.point(affine.place(at), q)).collect()
}

/// For each pixel the normal of the points `reach` pixels to its four sides, turned away from the camera.
fn normals(affine: &Affine, points: &[Option<Vec3>], reach: usize) -> Vec<Option<Vec3>> {
    let (width, height) = (affine.width, affine.height);
    let normal = |at: usize| {
        let (u, v) = (at % width, at / width);
        if u < reach || v < reach || u + reach >= width || v + reach >= height {
            return None;
        }
        let across = sub(points[at + reach]?, points[at - reach]?);
        let down = sub(points[at + reach * width]?, points[at - reach * width]?);
        let normal = unit(cross(across, down))?;
        Some(if dot(normal, points[at]?) < 0.0 { normal.map(|x| -x) } else { normal })
    };
    (0..points.len()).map(normal).collect()
}
