use super::*;
use crate::util::random::Random;

const WIDTH: usize = 320;
const HEIGHT: usize = 240;
const MILLIMETRES: Space = Space::InverseDepth { metres: 0.001 };
const METRES: Space = Space::InverseDepth { metres: 1.0 };
/// Pixels of disparity are inverse depth times focal length times baseline, as of a Kinect v1.
const RIG: f64 = 580.0 * 0.075;

/// Inverse depth of a room, 1/m: a wall 4 m away, a floor, a side and a box, seen by a camera that is turned about its axis.
fn room(roll: f64) -> Vec<f64> {
    let (sin, cos) = roll.sin_cos();
    let at = |u: usize, v: usize| {
        let [x, y] = [(u as f64 - 159.5) / 260.0, (v as f64 - 119.5) / 260.0];
        let [x, y] = [cos * x - sin * y, sin * x + cos * y];
        let wall = (0.98 - 0.199 * y) / 4.0;
        [(0.98 * y + 0.199) / 1.2, x / 1.5, (0.1 - x) / 2.5].into_iter().fold(wall, f64::max)
    };
    (0..WIDTH * HEIGHT).map(|place| at(place % WIDTH, place / WIDTH)).collect()
}

/// The values, each changed by what is drawn for it.
fn noisy(values: &[f64], change: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let mut random = Random::new(1);
    values.iter().map(|&value| change(value, random.gaussian())).collect()
}

fn found<T: Pixel>(pixels: &[T], space: Space) -> Rounding {
    RoundingFinder::default().find(&DepthView::new(pixels, WIDTH, HEIGHT).unwrap(), space)
}

fn u16s(values: &[f64], scale: f64) -> Vec<u16> {
    values.iter().map(|value| (value * scale).round() as u16).collect()
}

fn f32s(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&value| value as f32).collect()
}

/// Depths of the room where most of it lies.
const DEPTHS_M: [f64; 6] = [1.9, 2.3, 2.7, 3.1, 3.5, 3.9];

/// Checks the steps, metres, against those that a depth should have, to within a share of them.
#[track_caller]
fn check(rounding: &Rounding, within: f64, step_m: impl Fn(f64) -> f64) {
    for z in DEPTHS_M {
        let (found, right) = (rounding.step(1.0 / z) * z * z, step_m(z));
        assert!((found - right).abs() <= within * right, "{found} m at {z} m, not {right}");
    }
}

/// Depth, metres, from disparity in eighths of a pixel.
fn eighths(roll: f64, noise_px: f64) -> Vec<f64> {
    noisy(&room(roll), |q, normal| RIG / ((8.0 * (RIG * q + noise_px * normal)).round() / 8.0))
}

#[test]
fn eighths_of_a_pixel_are_found_in_depth_of_every_unit_and_type() {
    let step_m = |z: f64| z * z / (8.0 * RIG);
    for noise_px in [0.0, 0.06] {
        let depth_m = eighths(0.05, noise_px);
        check(&found(&u16s(&depth_m, 1e3), MILLIMETRES), 0.1, step_m);
        check(&found(&u16s(&depth_m, 5e3), Space::InverseDepth { metres: 2e-4 }), 0.1, step_m);
        check(&found(&f32s(&depth_m), METRES), 0.1, step_m);
    }
}

#[test]
fn eighths_of_a_pixel_are_found_where_lines_of_the_map_have_one_value_each() {
    check(&found(&u16s(&eighths(0.0, 0.0), 1e3), MILLIMETRES), 0.3, |z| z * z / (8.0 * RIG));
}

#[test]
fn whole_millimetres_are_found() {
    for roll in [0.0, 0.05] {
        for noise_m in [0.0, 0.005] {
            let depth_m = noisy(&room(roll), |q, normal| 1.0 / q + noise_m * normal);
            check(&found(&u16s(&depth_m, 1e3), MILLIMETRES), 0.3, |_| 0.001);
            check(&found(&u16s(&depth_m, 1e4), Space::InverseDepth { metres: 1e-4 }), 0.3, |_| 0.0001);
        }
    }
}

#[test]
fn the_same_numbers_have_the_same_steps_in_every_type() {
    let of_tof = noisy(&room(0.05), |q, normal| 1.0 / q + 0.005 * normal);
    for (depth_m, within) in [(eighths(0.05, 0.06), 0.002), (of_tof, 0.002)] {
        let mm = u16s(&depth_m, 1e3);
        let m: Vec<f32> = mm.iter().map(|&mm| (f64::from(mm) / 1e3) as f32).collect();
        let [by_mm, by_m] = [found(&mm, MILLIMETRES), found(&m, METRES)];
        for z in DEPTHS_M {
            let [mm, m] = [by_mm, by_m].map(|rounding| rounding.step(1.0 / z));
            assert!((mm - m).abs() <= within * m, "{mm} and {m} at {z} m");
        }
    }
}

#[test]
fn half_precision_doubles_its_step_at_powers_of_two() {
    let half = |z: f64| {
        let step = (z.log2().floor() - 10.0).exp2();
        (z / step).round() * step
    };
    let depth_m = noisy(&room(0.05), |q, normal| half(1.0 / q + 0.003 * normal));
    check(&found(&f32s(&depth_m), METRES), 0.3, |z| (z.log2().floor() - 10.0).exp2());
}

#[test]
fn true_floats_have_no_step() {
    for roll in [0.0, 0.05] {
        for noise_m in [0.0, 0.003] {
            let depth_m = noisy(&room(roll), |q, normal| 1.0 / q + noise_m * normal);
            assert_eq!(found(&f32s(&depth_m), METRES), Rounding::of_values(0.0, METRES), "{roll} {noise_m}");
        }
    }
}

#[test]
fn disparity_has_the_steps_that_it_was_scaled_to() {
    let q = room(0.05);
    let bytes = |scale: f64, times: f64| q.iter().map(|q| ((q * scale).round() * times) as u8).collect::<Vec<u8>>();
    for times in [1.0, 4.0] {
        let rounding = found(&bytes(200.0 / times, times), Space::Value);
        for q in [50.0, 60.0, 80.0, 120.0] {
            assert!((rounding.step(q) / times - 1.0).abs() < 0.3, "{} at {q}", rounding.step(q));
        }
    }
    let fine = noisy(&q, |q, normal| (256.0 * (RIG * q + 0.1 * normal)).round() / 256.0);
    let rounding = found(&f32s(&fine), Space::Value);
    assert!((rounding.step(11.0) * 256.0 - 1.0).abs() < 0.3, "{}", rounding.step(11.0));
}

#[test]
fn pixels_between_the_steps_do_not_shorten_them() {
    let mut random = Random::new(2);
    let mut mm = u16s(&eighths(0.05, 0.06), 1e3);
    for value in &mut mm {
        if random.uniform() < 0.02 {
            *value = (800.0 + 3200.0 * random.uniform()) as u16;
        }
    }
    check(&found(&mm, MILLIMETRES), 0.1, |z| z * z / (8.0 * RIG));
}

#[test]
fn few_values_have_the_usual_unit() {
    let mm: Vec<u16> = (0..WIDTH * HEIGHT).map(|at| if at % WIDTH < 20 { 1000 } else { 2000 }).collect();
    let m: Vec<f32> = mm.iter().map(|&mm| f32::from(mm) / 1e3).collect();
    check(&found(&mm, MILLIMETRES), 1e-6, |_| 0.001);
    check(&found(&m, METRES), 1e-6, |_| 0.001);
    check(&found(&[0u16; WIDTH * HEIGHT], MILLIMETRES), 1e-6, |_| 0.001);
    assert_eq!(found(&[f32::NAN; WIDTH * HEIGHT], METRES).step(1.0), 0.0);
}

#[test]
fn a_stated_step_is_taken_as_it_is() {
    assert_eq!(Rounding::of_values(5.0, MILLIMETRES).step(0.5), 0.005 * 0.25);
    assert_eq!(Rounding::of_values(0.125, Space::Value).variance(30.0), 0.125 * 0.125 / 12.0);
    assert_eq!(Rounding::NONE.step(3.0), 0.0);
}

#[test]
fn maps_of_every_shape_are_looked_at() {
    let random = &mut Random::new(3);
    for (width, height) in [(1, 1), (65_535, 1), (1, 65_535), (7, 3), (2000, 1500)] {
        let pixels: Vec<f32> = (0..width * height).map(|_| -0.5 - random.uniform() as f32).collect();
        let map = DepthView::new(&pixels, width, height).unwrap();
        assert_eq!(RoundingFinder::default().find(&map, Space::Value).step(-0.7), 0.0, "{width} x {height}");
    }
}
