//! The camera of an organised cloud: its points say it.
//!
//! In: x, y and z of each pixel. Out: the pinhole camera that they came from, if one fits all of them.

use depthplanes::Intrinsics;

use super::format::Image;
use crate::frame::Pixels;

/// Furthest that a point may lie from where the camera sees it, pixels.
const EXACT_PX: f64 = 0.1;
/// Fewer points say nothing.
const FEW: usize = 64;

/// Sets the camera that the points' coordinates say.
pub(super) fn find_camera(image: &mut Image, [x, y, z]: [&Pixels; 3]) {
    let (Pixels::F32(x), Pixels::F32(y), Pixels::F32(z)) = (x, y, z) else { return };
    let seen = |at: usize| {
        let ray = [f64::from(x[at]) / f64::from(z[at]), f64::from(y[at]) / f64::from(z[at])];
        (z[at] > 0.0 && ray.iter().all(|part| part.is_finite())).then_some((at, ray))
    };
    let width = image.width;
    let axis = |axis: usize, place: &dyn Fn(usize) -> usize| {
        line((0..z.len()).filter_map(seen).map(|(at, ray)| [ray[axis], place(at) as f64]))
    };
    if let (Some([fx, cx]), Some([fy, cy])) = (axis(0, &|at| at % width), axis(1, &|at| at / width)) {
        image.intrinsics = Intrinsics::new(fx, fy, cx, cy).ok();
    }
}

/// Slope and offset of the line through all points; none if one is off.
fn line(mut points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<[f64; 2]> {
    let count = points.clone().count() as f64;
    let sums = points.clone().fold([0.0; 2], |sums, point| [sums[0] + point[0], sums[1] + point[1]]);
    let mean = sums.map(|sum| sum / count);
    let (squares, products) = points.clone().fold((0.0, 0.0), |(squares, products), [a, b]| {
        let off = a - mean[0];
        (squares + off * off, products + off * (b - mean[1]))
    });
    let slope = products / squares;
    let offset = mean[1] - slope * mean[0];
    // False as well where there is no slope, which is not a number.
    let is_exact = points.all(|[a, b]| (slope * a + offset - b).abs() <= EXACT_PX);
    (count >= FEW as f64 && is_exact).then_some([slope, offset])
}
