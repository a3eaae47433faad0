//! Depth, inverse depth and disparity that are taken for each other are noticed wherever the camera looks: the floor need
//! not be below.

mod common;
#[path = "common/room.rs"]
mod room;

use depthplanes::Intrinsics;
use depthplanes_io::{Frame, ReadOptions, decode};
use room::notes;

/// Columns, rows and a camera with square pixels.
const SIZES: [[usize; 2]; 2] = [[128, 96], [240, 320]];

fn camera([width, height]: [usize; 2]) -> Intrinsics {
    let focal = 0.9 * width.max(height) as f64;
    Intrinsics { fx: focal, fy: focal, cx: 0.5 * (width as f64 - 1.0), cy: 0.5 * (height as f64 - 1.0) }
}

/// A box that the camera is in: the distances of its sides in the directions -x, x, -y, y, -z, z, metres.
type Walls = [f64; 6];

const HALL: Walls = [2.5, 1.5, 1.6, 1.2, 1.0, 4.0];
const CORRIDOR: Walls = [0.9, 0.8, 1.4, 1.2, 1.0, 14.0];

/// Turns of the camera: pitch about x, yaw about y, roll about z, degrees.
const LOOKS: [(&str, Walls, [f64; 3]); 8] = [
    ("ahead and down", HALL, [-20.0, 15.0, 0.0]),
    ("up at the ceiling", HALL, [40.0, 20.0, 0.0]),
    ("down at the floor", HALL, [-50.0, 20.0, 10.0]),
    ("upside down", HALL, [-20.0, 15.0, 180.0]),
    ("on its side", HALL, [-20.0, 15.0, 90.0]),
    ("on its other side", HALL, [-15.0, 25.0, -90.0]),
    ("along a corridor", CORRIDOR, [0.0, 0.0, 0.0]),
    ("along a corridor, upside down", CORRIDOR, [5.0, 6.0, 180.0]),
];

/// Depth in metres of each pixel.
fn depths_m(size: [usize; 2], walls: &Walls, [pitch, yaw, roll]: [f64; 3]) -> Vec<f64> {
    let turn = |[a, b]: [f64; 2], degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        [cos * a - sin * b, sin * a + cos * b]
    };
    let depth = |at: usize| {
        let [x, y, z] = camera(size).ray((at % size[0]) as f64, (at / size[0]) as f64);
        let [x, y] = turn([x, y], roll);
        let [y, z] = turn([y, z], pitch);
        let [x, z] = turn([x, z], yaw);
        let sides = [x, y, z].into_iter().enumerate().map(|(axis, along)| {
            let wall = walls[2 * axis + usize::from(along > 0.0)];
            wall / along.abs()
        });
        sides.fold(f64::INFINITY, f64::min)
    };
    (0..size[0] * size[1]).map(depth).collect()
}

fn noise(at: usize) -> f64 {
    ((at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / (1u64 << 24) as f64 - 0.5
}

fn npy(kind: &str, [width, height]: [usize; 2], data: Vec<u8>) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({height}, {width}), }}");
    let padded = format!("{header:<117}\n");
    [b"\x93NUMPY\x01\x00".as_slice(), &(padded.len() as u16).to_le_bytes(), padded.as_bytes(), &data].concat()
}

/// A value of the depth and the pixel, as 16 bits where it is large and as floats where it is small.
fn read(size: [usize; 2], depths: &[f64], options: &ReadOptions, value: impl Fn(usize, f64) -> f64) -> Frame {
    let values: Vec<f64> = depths.iter().enumerate().map(|(at, &depth)| value(at, depth)).collect();
    let bytes = if values.iter().all(|value| *value < 300.0) {
        npy("<f4", size, values.iter().flat_map(|&value| (value as f32).to_le_bytes()).collect())
    } else {
        npy("<u2", size, values.iter().flat_map(|&value| (value.round() as u16).to_le_bytes()).collect())
    };
    decode(&bytes, "room", options).unwrap()
}

#[test]
fn inverse_depth_taken_for_depth_is_noticed_wherever_the_camera_looks() {
    for size in SIZES {
        let focal = camera(size).fx;
        for (look, walls, turns) in LOOKS {
            let depths = depths_m(size, &walls, turns);
            let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min);
            for (what, value) in [
                ("1/m", &(|_, depth| 1.0 / depth) as &dyn Fn(usize, f64) -> f64),
                ("pixels", &|at, depth| focal * 0.1 / depth + 0.1 * noise(at)),
                ("1/256 px", &|at, depth| 256.0 * (focal * 0.1 / depth + 0.2 * noise(at))),
                ("relative, 16 bits", &|_, depth| 60_000.0 * nearest * (1.0 / depth - 0.03)),
            ] {
                for options in
                    [ReadOptions::default(), ReadOptions { intrinsics: Some(camera(size)), ..Default::default() }]
                {
                    let notes = notes(&read(size, &depths, &options, value));
                    assert!(notes.contains("--encoding inverse-depth"), "{look}, {what}, {size:?}: {notes}");
                }
            }
        }
    }
}

#[test]
fn depth_is_taken_for_depth_wherever_the_camera_looks() {
    for size in SIZES {
        for (look, walls, turns) in LOOKS {
            let depths = depths_m(size, &walls, turns);
            for (what, value) in [
                ("millimetres", &(|_, depth| 1000.0 * depth) as &dyn Fn(usize, f64) -> f64),
                ("metres", &|_, depth| depth),
                ("noise", &|at, depth| 1000.0 * depth + 6.0 * noise(at) * depth * depth),
                ("much noise", &|at, depth| 1000.0 * depth + 40.0 * noise(at) * depth * depth),
            ] {
                for options in
                    [ReadOptions::default(), ReadOptions { intrinsics: Some(camera(size)), ..Default::default() }]
                {
                    let notes = notes(&read(size, &depths, &options, value));
                    assert_eq!(notes, "", "{look}, {what}, {size:?}");
                }
            }
        }
    }
}
