//! A room of a wall, a floor and a side, as a camera of 320 x 240 pixels sees it.
#![allow(dead_code, unreachable_pub)] // Each test binary uses its part.

use depthplanes::{DepthView, Detection, Detector, Intrinsics, Pixel, Planar, Sensor};

pub const SIZE: [usize; 2] = [320, 240];
pub const FOCAL: f64 = 288.0;
/// Normal and distance, metres, of the wall, the floor and the side.
pub const PLANES: [([f64; 3], f64); 3] =
    [([0.0, 0.199, -0.98], 4.0), ([0.0, -0.98, -0.199], 1.2), ([1.0, 0.0, 0.0], 1.5)];

/// Which of [`PLANES`] a pixel sees, and at what depth, metres.
pub fn seen(u: usize, v: usize) -> (usize, f64) {
    let ray = [(u as f64 - 159.5) / FOCAL, (v as f64 - 119.5) / FOCAL, 1.0];
    let inverse = PLANES.map(|(normal, distance)| -(0..3).map(|i| normal[i] * ray[i]).sum::<f64>() / distance);
    let nearest = (0..3).max_by(|&a, &b| inverse[a].total_cmp(&inverse[b])).unwrap();
    (nearest, 1.0 / inverse[nearest])
}

/// A number from 0 to 1 for each place and use.
pub fn chance(u: usize, v: usize, of: usize) -> f64 {
    let mut bits = (u as u64) << 40 ^ (v as u64) << 20 ^ of as u64 ^ 0x9e37_79b9;
    for _ in 0..3 {
        bits = (bits ^ bits >> 31).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// A number of mean 0 and deviation 1 for each place.
pub fn normal(u: usize, v: usize) -> f64 {
    (0..12).map(|of| chance(u, v, of)).sum::<f64>() - 6.0
}

/// The room in millimetres with the noise of a Kinect, 0 where a pattern has no pixel.
pub fn room(holds: impl Fn(usize, usize) -> bool) -> Vec<u16> {
    let noisy = |u: usize, v: usize| {
        let depth = seen(u, v).1;
        (1e3 * (depth + 0.0014 * depth * depth * normal(u, v))).round() as u16
    };
    places().map(|[u, v]| if holds(u, v) { noisy(u, v) } else { 0 }).collect()
}

/// Every column and row.
pub fn places() -> impl Iterator<Item = [usize; 2]> {
    (0..SIZE[0] * SIZE[1]).map(|at| [at % SIZE[0], at / SIZE[0]])
}

pub fn detect<T: Pixel>(detector: &mut Detector, pixels: &[T]) -> Detection {
    detector.detect(DepthView::new(pixels, SIZE[0], SIZE[1]).unwrap()).unwrap().clone()
}

pub fn detector() -> Detector {
    Detector::new(Planar::default()).unwrap().sensor(sensor())
}

pub fn sensor() -> Sensor {
    Sensor::default().intrinsics(Intrinsics::new(FOCAL, FOCAL, 159.5, 119.5).ok())
}

/// Fails unless the planes are those of the room, no other, on nearly all measured pixels.
pub fn check(what: &str, found: &Detection, share: f64) {
    assert_eq!(found.planes.len(), 3, "{what}");
    let mut on = 0;
    for plane in &found.planes {
        let metric = plane.metric.as_ref().unwrap();
        let own = |(normal, distance): &([f64; 3], f64)| {
            let same = (0..3).all(|i| (normal[i] - metric.plane.normal[i]).abs() < 0.03);
            same && (metric.plane.distance / distance - 1.0).abs() < 0.02
        };
        let which = PLANES.iter().position(own);
        assert!(which.is_some(), "{what}: {:?}", metric.plane);
        let right = |at: usize| found.labels[at] == plane.label && Some(seen(at % SIZE[0], at / SIZE[0]).0) == which;
        on += (0..found.labels.len()).filter(|&at| right(at)).count();
    }
    assert!(on as f64 >= share * found.valid_pixels as f64, "{what}: {on} of {}", found.valid_pixels);
}
