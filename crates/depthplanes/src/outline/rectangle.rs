//! The rectangle of least area around a convex hull, on the picture or on the plane.
//!
//! In: the hull. Out: a [`Rectangle`]. One side of it lies along an edge of the hull (Freeman and
//! Shapira 1975), so that four calipers that turn with the edges (Toussaint 1983) find it in one
//! round.

use super::corner::{Corner, point};
use crate::camera::HessianNormalForm;
use crate::sensor::Sensor;
use crate::util::vec3::cross;

/// A rectangle in N dimensions: pixels on the picture, metres in camera coordinates on the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle<const N: usize> {
    /// Its middle.
    pub centre: [f64; N],
    /// Unit vectors along its sides, that of the longer side first. The first points to growing u or
    /// x; the second is a quarter turn counter-clockwise from it, on the picture or around the normal.
    pub axes: [[f64; N]; 2],
    /// Lengths of its sides, the longer first.
    pub sides: [f64; 2],
}

impl<const N: usize> Rectangle<N> {
    /// Its area, in square pixels or square metres.
    pub fn area(&self) -> f64 {
        self.sides[0] * self.sides[1]
    }

    /// Its corners, counter-clockwise as the second axis is from the first.
    pub fn corners(&self) -> [[f64; N]; 4] {
        let half = self.sides.map(|side| side / 2.0);
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|signs| {
            let along = |i: usize| (0..2).map(|k| signs[k] * half[k] * self.axes[k][i]).sum::<f64>();
            std::array::from_fn(|i| self.centre[i] + along(i))
        })
    }
}

/// Fits rectangles; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Fitter {
    points: Vec<[f64; 2]>,
}

impl Fitter {
    /// The rectangle around a hull on the picture.
    pub(super) fn on_picture(&mut self, hull: &[Corner]) -> Rectangle<2> {
        // With v turned up the picture is right-handed.
        self.points.clear();
        self.points.extend(hull.iter().map(|&corner| point(corner)).map(|[u, v]| [u, -v]));
        let Placed { centre, axis, sides } = self.fit();
        let upright = |[x, y]: [f64; 2]| [x + 0.0, 0.0 - y];
        let axis = pointing(axis);
        Rectangle { centre: upright(centre), axes: [axis, [-axis[1], axis[0]]].map(upright), sides }
    }

    /// The rectangle around a hull on the plane that a camera sees.
    pub(super) fn on_plane(&mut self, hull: &[Corner], (plane, camera): &(HessianNormalForm, Sensor)) -> Rectangle<3> {
        let on_plane = |&corner: &Corner| plane.point_seen_by(point(corner), camera).unwrap_or([0.0; 3]);
        let origin = hull.first().map_or([0.0; 3], on_plane);
        let basis = basis(plane.normal);
        self.points.clear();
        self.points.extend(hull.iter().map(on_plane).map(|point| {
            let from_origin = [0, 1, 2].map(|i| point[i] - origin[i]);
            basis.map(|axis| dot(axis, from_origin))
        }));
        let Placed { centre, axis, sides } = self.fit();
        let in_space = |[x, y]: [f64; 2]| [0, 1, 2].map(|i| x * basis[0][i] + y * basis[1][i] + 0.0);
        let from_origin = in_space(centre);
        let first = pointing(in_space(axis));
        let second = cross(plane.normal, first).map(|x| x + 0.0);
        Rectangle { centre: [0, 1, 2].map(|i| origin[i] + from_origin[i]), axes: [first, second], sides }
    }

    /// The rectangle of least area around the points, which go round convexly, either way.
    fn fit(&self) -> Placed {
        let n = self.points.len();
        let at = |k: usize| self.points[k % n];
        let way = |k: usize| [0, 1].map(|axis| at(k + 1)[axis] - at(k)[axis]);
        let inwards = doubled_area(&self.points).signum();
        let mut best = Placed { centre: at(0), axis: [1.0, 0.0], sides: [f64::INFINITY; 2] };
        let [mut right, mut top, mut left] = [0; 3];
        for i in 0..n {
            let [x, y] = way(i);
            let length = x.hypot(y);
            if !(length > 0.0 && length.is_finite()) {
                continue;
            }
            let along = [x / length, y / length];
            let up = [-along[1] * inwards, along[0] * inwards];
            // Each caliper moves on while the hull still goes its way.
            let moved = |caliper: usize, direction: [f64; 2]| {
                (caliper..i + n).find(|&k| dot(direction, way(k)) <= 0.0).unwrap_or(i + n)
            };
            right = moved(right.max(i + 1), along);
            top = moved(top.max(right), up);
            left = moved(left.max(top), along.map(|x| -x));
            let found = Placed::between([along, up], [[at(left), at(right)], [at(i), at(top)]]);
            if found.area() < best.area() {
                best = found;
            }
        }
        best
    }
}

/// Twice the area of a ring of points, above 0 if it goes round from the first axis to the second.
fn doubled_area(points: &[[f64; 2]]) -> f64 {
    let from = |point: [f64; 2]| [point[0] - points[0][0], point[1] - points[0][1]];
    let cross = |pair: &[[f64; 2]]| {
        let (a, b) = (from(pair[0]), from(pair[1]));
        a[0] * b[1] - b[0] * a[1]
    };
    points.windows(2).map(cross).sum()
}

/// A rectangle in two coordinates.
struct Placed {
    centre: [f64; 2],
    axis: [f64; 2],
    sides: [f64; 2],
}

impl Placed {
    /// The rectangle whose sides along each of two axes go through a first and a last point.
    fn between(axes: [[f64; 2]; 2], ends: [[[f64; 2]; 2]; 2]) -> Self {
        let reach = [0, 1].map(|k| ends[k].map(|point| dot(axes[k], point)));
        let [width, height] = reach.map(|[low, high]| high - low);
        let middle = reach.map(|[low, high]| (low + high) / 2.0);
        let centre = [0, 1].map(|i| middle[0] * axes[0][i] + middle[1] * axes[1][i]);
        let (axis, sides) = if width >= height { (axes[0], [width, height]) } else { (axes[1], [height, width]) };
        Placed { centre, axis, sides }
    }

    fn area(&self) -> f64 {
        self.sides[0] * self.sides[1]
    }
}

fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}

/// The vector or its opposite, so that its first component that is not 0 is positive.
fn pointing<const N: usize>(vector: [f64; N]) -> [f64; N] {
    let backwards = vector.iter().find(|&&x| x != 0.0).is_some_and(|&x| x < 0.0);
    if backwards { vector.map(|x| 0.0 - x) } else { vector }
}

/// Two unit vectors at right angles to a normal and to each other, the three right-handed.
fn basis(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let [x, y, z] = normal.map(f64::abs);
    let least = if x <= y && x <= z {
        0
    } else if y <= z {
        1
    } else {
        2
    };
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let first = cross(normal, axis);
    let length = dot(first, first).sqrt();
    let first = first.map(|x| x / length);
    [first, cross(normal, first)]
}
