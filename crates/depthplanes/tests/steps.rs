//! Maps whose values come in steps, and `planar`.

mod room;

use room::{FOCAL, check, detect, detector, normal, places, seen};

/// Depth in metres with white noise of that many metres at 1 m, growing with the square of the range.
fn depths(noise: f64) -> Vec<f64> {
    places()
        .map(|[u, v]| (seen(u, v).1, normal(u, v)))
        .map(|(depth, draw)| depth + noise * depth * depth * draw)
        .collect()
}

#[test]
fn disparity_in_steps_stored_as_millimetres_leaves_the_planes_of_the_room() {
    for baseline in [0.075, 0.12, 0.3] {
        for step in [0.25, 0.125, 0.0625] {
            for noise in [0.0, 0.2] {
                let mm = |[u, v]: [usize; 2]| {
                    let disparity = FOCAL * baseline / seen(u, v).1 + noise * step * normal(u, v);
                    (1e3 * FOCAL * baseline / ((disparity / step).round() * step)).round() as u16
                };
                let found = detect(&mut detector(), &places().map(mm).collect::<Vec<u16>>());
                check(&format!("steps of {step} pixels, baseline {baseline}, noise {noise}"), &found, 0.9);
            }
        }
    }
}

#[test]
fn depth_in_steps_of_millimetres_to_centimetres_leaves_the_planes_of_the_room() {
    for step_mm in [1.0, 5.0, 10.0, 20.0] {
        for noise in [0.0, 0.0004, 0.0014] {
            let rounded = |depth: f64| ((1e3 * depth / step_mm).round() * step_mm) as u16;
            let mm: Vec<u16> = depths(noise).into_iter().map(rounded).collect();
            check(&format!("steps of {step_mm} mm, noise {noise}"), &detect(&mut detector(), &mm), 0.9);
        }
    }
}

#[test]
fn depth_in_floats_of_few_bits_leaves_the_planes_of_the_room() {
    // Half precision has 10 bits behind the first; some formats have 8, or keep the logarithm.
    let of_bits = |bits: i32| {
        move |depth: f64| {
            let unit = 2f64.powi(depth.log2().floor() as i32 - bits);
            ((depth / unit).round() * unit * 1e3) as f32
        }
    };
    for noise in [0.0, 0.0008] {
        for bits in [8, 9, 10, 11] {
            let mm: Vec<f32> = depths(noise).into_iter().map(of_bits(bits)).collect();
            check(&format!("{bits} bits, noise {noise}"), &detect(&mut detector(), &mm), 0.9);
        }
        let logarithm: Vec<f32> = depths(noise)
            .into_iter()
            .map(|depth| (1e3 * ((depth.ln() * 400.0).round() / 400.0).exp()) as f32)
            .collect();
        check(&format!("logarithms, noise {noise}"), &detect(&mut detector(), &logarithm), 0.9);
    }
}
