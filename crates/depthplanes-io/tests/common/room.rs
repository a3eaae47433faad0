//! The room of the reported inputs: its depth, and whether planes found in it are its planes.
#![allow(dead_code, unreachable_pub)] // Each test binary uses its part.

use depthplanes::{Detector, Intrinsics, Plane};
use depthplanes_io::outputs::Report;
use depthplanes_io::{Frame, doubts};

/// Columns and rows, and the camera.
pub const SIZE: [usize; 2] = [128, 96];
pub const CAMERA: Intrinsics = Intrinsics { fx: 115.2, fy: 115.2, cx: 63.5, cy: 47.5 };

/// Distance and normal of each plane: wall, floor, side wall, the front of a box.
pub const WALL: (f64, [f64; 3]) = (4.0, [0.0, 0.199, -0.980]);
pub const FLOOR: (f64, [f64; 3]) = (1.2, [0.0, -0.980, -0.199]);
pub const SIDE: (f64, [f64; 3]) = (1.5, [1.0, 0.0, 0.0]);
pub const FRONT: (f64, [f64; 3]) = (2.6, [0.0, 0.199, -0.980]);
pub const ROOM: [(f64, [f64; 3]); 4] = [WALL, FLOOR, SIDE, FRONT];

/// Depth in metres of each pixel; the box stands in front.
pub fn depths_m() -> Vec<f64> {
    let [width, height] = SIZE;
    let depth = |(distance, normal): (f64, [f64; 3]), ray: [f64; 3]| {
        let along: f64 = normal.iter().zip(ray).map(|(n, r)| n * r).sum();
        Some(-distance / along).filter(|depth| *depth > 0.0)
    };
    let pixel = |at: usize| {
        let (u, v) = (at % width, at / width);
        let ray = CAMERA.ray(u as f64, v as f64);
        if (68..=102).contains(&u) && (43..=74).contains(&v) {
            return depth(FRONT, ray).unwrap();
        }
        [WALL, FLOOR, SIDE].into_iter().filter_map(|plane| depth(plane, ray)).fold(f64::INFINITY, f64::min)
    };
    (0..width * height).map(pixel).collect()
}

/// What `planar` finds with its defaults, and every note on frame and result.
pub fn planes(frame: &Frame) -> (Vec<Plane>, f64, Vec<String>) {
    let method = depthplanes::methods::default();
    let mut detector = Detector::default().sensor(frame.sensor);
    let detection = detector.detect(frame.view().unwrap()).unwrap();
    let defaults = method.defaults();
    let report = Report::new("room", frame, method, &defaults, detection);
    let notes = frame.warnings.iter().cloned().chain(doubts(&report)).collect();
    (detection.planes.clone(), detection.labelled_share(), notes)
}

/// Asserts that the planes of a frame are these, to within a share of the distance and a length of the normal, on a share of
/// the valid pixels.
pub fn check(name: &str, frame: &Frame, expected: &[(f64, [f64; 3])], [distance, normal, share]: [f64; 3]) {
    let (planes, on_planes, notes) = planes(frame);
    assert!(on_planes >= share, "{name}: {on_planes} on planes; {notes:?}");
    let is = |plane: &Plane, (d, n): &(f64, [f64; 3])| {
        let found = plane.metric.unwrap_or_else(|| panic!("{name}: not metric; {notes:?}")).plane;
        let off = found.normal.iter().zip(n).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        (found.distance - d).abs() <= distance * d && off <= normal
    };
    for plane in &planes {
        assert!(
            expected.iter().any(|expected| is(plane, expected)),
            "{name}: {plane:?} is none of the room; {notes:?}"
        );
    }
    for expected in expected {
        let found = planes.iter().filter(|plane| is(plane, expected)).count();
        assert_eq!(found, 1, "{name}: {expected:?}, of {} planes; {notes:?}", planes.len());
    }
}

/// Whether a note says that.
pub fn notes(frame: &Frame) -> String {
    planes(frame).2.join("\n")
}
