//! What is too much: searches that would not end, and numbers that cannot be given.

use depthplanes::methods::{METHODS, find};
use depthplanes::noise::{NoiseTable, SensorNoise};
use depthplanes::scene::Random;
use depthplanes::{DepthView, Detector, Error, Intrinsics, Sensor, ValueKind};
use std::time::{Duration, Instant};

/// A slanted wall with a box in front of it, noisy, millimetres.
fn noisy(seed: u64, [width, height]: [usize; 2]) -> Vec<u16> {
    let mut random = Random::new(seed);
    let value = |(u, v): (usize, usize)| {
        let is_box = (width / 4..width / 2).contains(&u) && (height / 4..height / 2).contains(&v);
        let depth = if is_box { 1000 } else { 1500 + 3 * u + 2 * v };
        (depth + random.whole(0, 39)) as u16
    };
    (0..width * height).map(|at| (at % width, at / width)).map(value).collect()
}

#[test]
fn searches_with_tolerances_of_nothing_end() {
    let size = [70, 64];
    let map = noisy(1, size);
    let view = DepthView::new(&map, size[0], size[1]).unwrap();
    let cases: [(&str, &[(&str, f64)]); 8] = [
        ("ransac", &[("min-pixels", 0.0), ("epsilon", 1e-9), ("angle", 90.0)]),
        ("ransac", &[("min-pixels", 0.0), ("epsilon", 1e-3), ("angle", 90.0), ("overlooked", 0.001)]),
        ("ransac", &[("min-pixels", 3.0), ("overlooked", 0.001), ("reach", 100.0)]),
        ("hough", &[("min-pixels", 0.0), ("epsilon", 1e-4), ("misses", 10_000.0), ("votes", 1.0)]),
        ("hough", &[("min-pixels", 0.0), ("angle", 1.0), ("misses", 10_000.0), ("votes", 10_000.0)]),
        ("ppdfdm", &[("min-pixels", 0.0), ("spacing", 1.0), ("radius", 100.0), ("draws", 1000.0), ("delta", 1e6)]),
        ("ppdfdm", &[("min-pixels", 0.0), ("spacing", 1.0), ("delta", 0.1), ("eps", 1e300)]),
        ("fpdidm", &[("min-pixels", 0.0), ("radius", 1.0), ("delta", 0.1), ("eps", 1e300)]),
    ];
    for (name, parameters) in cases {
        for metres in [0.001, 1e-12, 1e12] {
            let started = Instant::now();
            let sensor = Sensor::default().value_kind(ValueKind::depth(metres).unwrap());
            let sensor = sensor.intrinsics(Intrinsics::new(60.0, 60.0, 35.0, 32.0).unwrap());
            let mut detector = Detector::new(find(name).unwrap().with(parameters).unwrap()).unwrap().sensor(sensor);
            detector.detect(view).unwrap();
            assert!(started.elapsed() < Duration::from_secs(5), "{name} {parameters:?}: {:?}", started.elapsed());
        }
    }
}

#[test]
fn too_many_planes_name_parameters_that_the_method_has() {
    let map: Vec<u8> = (0..400 * 400).map(|at| 1 + ((at % 400 + at / 400) % 2 * 100) as u8).collect();
    let view = DepthView::new(&map, 400, 400).unwrap();
    let mut detector = Detector::new(find("ngaf").unwrap().with(&[("min-pixels", 0.0)]).unwrap()).unwrap();
    let error = detector.detect(view).unwrap_err();
    assert_eq!(
        error,
        Error::TooManyPlanes { found: 160_000, raise: "`min-pixels` or `theta` or `window`".to_string() }
    );
    assert!(error.to_string().ends_with("raise `min-pixels` or `theta` or `window`"), "{error}");
}

/// Values, units and cameras at the ends of what is accepted; no number may be infinite or none.
#[test]
fn numbers_that_cannot_be_given_are_left_out() {
    let size = [24, 16];
    let surfaces: [fn(f32, f32) -> f32; 4] =
        [|_, _| f32::MAX, |_, _| 1e-45, |u, v| 1e30 / (1.0 + u + v), |u, v| 1e-30 * (1.0 + u - 0.5 * v)];
    let mut metric = 0;
    for surface in surfaces {
        let map: Vec<f32> = (0..24 * 16).map(|at| surface((at % 24) as f32, (at / 24) as f32)).collect();
        let view = DepthView::new(&map, size[0], size[1]).unwrap();
        for value_kind in [
            ValueKind::Depth { metres: 1e-12 },
            ValueKind::Depth { metres: 1e12 },
            ValueKind::InverseDepth { slope: 1e-15, offset: 1e15 },
            ValueKind::InverseDepth { slope: 1e15, offset: 0.0 },
        ] {
            for [focal, middle] in [[1e-3, 1e9], [1e9, -1e9], [20.0, 8.0]] {
                for noise in [None, Some(1e12), Some(1e-12)] {
                    let noise = noise.map(|base| SensorNoise::Depth { base, growth: base });
                    let camera = Intrinsics::new(focal, -focal, middle, middle).unwrap();
                    let sensor = Sensor::default().value_kind(value_kind).intrinsics(camera).noise(noise);
                    for method in METHODS {
                        let method = method.with(&[("min-pixels", 8.0)]).unwrap();
                        let mut detector = Detector::new(method).unwrap().sensor(sensor);
                        for plane in &detector.detect(view).unwrap().planes {
                            let Some(plane) = plane.metric else { continue };
                            metric += 1;
                            let numbers = plane.covariance.iter().flatten().chain(&plane.centroid_m);
                            let others = [plane.plane.distance, plane.rms_m, plane.area_m2.unwrap_or(0.0)];
                            assert!(numbers.chain(&others).all(|x| x.is_finite()), "{plane:?} of {sensor:?}");
                        }
                    }
                }
            }
        }
    }
    assert!(metric > 100, "{metric} planes in metres");
    assert!(NoiseTable::new(&[[1.0, 1e13]]).is_err() && NoiseTable::new(&[[1e13, 1.0]]).is_err());
}
