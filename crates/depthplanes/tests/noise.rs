//! Noise models against their formulas, and estimates against the noise of synthetic scenes.

use depthplanes::methods::Planar;
use depthplanes::noise::{Estimate, Estimator, MAX_ROWS, NoiseModel, NoiseTable, Patch, SensorNoise};
use depthplanes::scene::{Random, SensorError, SensorModel, Spec};
use depthplanes::{DepthView, Detector, Error, ValueKind};

const METRES: ValueKind = ValueKind::Depth { metres: 1.0 };

/// The noise that so many seeds of a scene show together.
fn estimate(spec: &str, seeds: u64) -> Estimate {
    let mut estimator = Estimator::default();
    for seed in 1..=seeds {
        let frame = format!("{spec},seed={seed}").parse::<Spec>().unwrap().frame().unwrap();
        estimator.add(frame.view(), frame.sensor.value_kind).unwrap();
    }
    estimator.estimate().unwrap()
}

#[test]
fn estimates_are_within_a_quarter_of_the_generators_noise() {
    // kinect_white: 0.072 px of disparity, steps included; tof_white: 1 mm + 1.3 mm (z / 1 m)^2.
    let kinect = |z: f64| 0.0722 / (580.0 * 0.075) * z * z;
    let tof = |z: f64| 0.001 + 0.0013 * z * z;
    for scene in ["room", "random", "boxes", "planes3"] {
        for (sensor, truth) in [("kinect_white", &kinect as &dyn Fn(f64) -> f64), ("tof_white", &tof)] {
            for seeds in [1, 5] {
                let model = estimate(&format!("{scene}:sensor={sensor}"), seeds).model();
                // Few of the scenes' pixels are nearer than 2 m.
                let ratios = [2.0, 3.0, 4.0].map(|z| model.depth_sigma_m(z).unwrap() / truth(z));
                println!("{scene} {sensor}, {seeds} seeds: {ratios:.2?} of the truth at 2, 3, 4 m");
                for ratio in ratios {
                    assert!((ratio - 1.0).abs() < 0.25, "{scene} {sensor}, {seeds} seeds: {ratios:?}");
                }
            }
        }
        for sensor in ["clean", "clean_mm"] {
            let model = estimate(&format!("{scene}:sensor={sensor}"), 1).model();
            let sigma_mm = [1.0, 2.0, 3.0, 4.0].map(|z| 1e3 * model.depth_sigma_m(z).unwrap());
            println!("{scene} {sensor}: {sigma_mm:.3?} mm");
            assert!(sigma_mm.iter().all(|&sigma| sigma < 0.3), "{scene} {sensor}: {sigma_mm:?}");
        }
    }
}

#[test]
fn flat_and_slanted_maps_without_noise_have_none() {
    let (width, height) = (96, 72);
    let of = |pixels: Vec<f32>, value_kind| {
        let mut estimator = Estimator::default();
        estimator.add(DepthView::new(&pixels, width, height).unwrap(), value_kind).unwrap();
        let found = estimator.estimate().unwrap();
        assert!(found.wide_model().depth_sigma_m(2.0).is_none_or(f64::is_finite));
        found.noise
    };
    let depth = |noise| match noise {
        SensorNoise::Depth { base, growth } => base.max(growth),
        _ => panic!("depth has a noise of depth"),
    };
    assert!(depth(of(vec![2.0; width * height], METRES)) < 1e-12);
    let slanted = |at: usize| 1.0 / (0.2 + 0.001 * (at % width) as f32 + 0.002 * (at / width) as f32);
    let slanted = depth(of((0..width * height).map(slanted).collect(), METRES));
    assert!(slanted < 1e-6, "{slanted}");
    let SensorNoise::Value { sigma } = of(vec![20.0; width * height], ValueKind::Disparity) else {
        panic!("disparity has its own")
    };
    assert!(sigma < 1e-12, "{sigma}");
    let mut estimator = Estimator::default();
    let whole: Vec<u16> = (0..width * height).map(|at| (900 + at % width / 20 + at / width / 9) as u16).collect();
    estimator.add(DepthView::new(&whole, width, height).unwrap(), ValueKind::Disparity).unwrap();
    let SensorNoise::Value { sigma } = estimator.estimate().unwrap().noise else { panic!("disparity has its own") };
    assert!(sigma < 0.3, "rounding alone leaves {sigma} of a step");
}

#[test]
fn too_little_to_estimate_from_is_an_error() {
    let mut estimator = Estimator::default();
    let too_few = |found| Err(Error::TooFewBlocks { found, least: 16 });
    assert_eq!(estimator.estimate(), too_few(0));
    estimator.add(DepthView::new(&[0u16; 9600], 120, 80).unwrap(), METRES).unwrap();
    assert_eq!(estimator.estimate(), too_few(0));
    // One row of blocks has none between others.
    estimator.add(DepthView::new(&[900u16; 4 * 800], 800, 4).unwrap(), METRES).unwrap();
    assert_eq!(estimator.estimate(), too_few(0));
    estimator.add(DepthView::new(&[900u16; 12 * 24], 12, 24).unwrap(), METRES).unwrap();
    assert_eq!(estimator.estimate(), too_few(13));
    let mixed = estimator.add(DepthView::new(&[9u8; 144], 12, 12).unwrap(), ValueKind::Disparity);
    assert_eq!(mixed, Err(Error::MixedValueKinds));
    for _ in 0..2 {
        estimator.add(DepthView::new(&[9.0f32; 144], 12, 12).unwrap(), ValueKind::Depth { metres: 0.001 }).unwrap();
    }
    assert_eq!(estimator.estimate().unwrap().blocks, 21);
}

#[test]
fn frames_in_which_a_third_is_missing_count_less_and_do_not_mislead() {
    let frame = "room:sensor=tof_white".parse::<Spec>().unwrap().frame().unwrap();
    let mut full = Estimator::default();
    full.add(frame.view(), frame.sensor.value_kind).unwrap();
    let depthplanes::scene::ScenePixels::U16(mut pixels) = frame.pixels.clone() else { panic!("16 bits") };
    (0..pixels.len()).filter(|at| at % 640 / 24 % 3 == 0).for_each(|at| pixels[at] = 0);
    let mut holed = Estimator::default();
    holed.add(DepthView::new(&pixels, frame.width, frame.height).unwrap(), frame.sensor.value_kind).unwrap();
    let (full, holed) = (full.estimate().unwrap(), holed.estimate().unwrap());
    assert!(holed.blocks < full.blocks * 3 / 4);
    let ratio = holed.model().depth_sigma_m(3.0).unwrap() / full.model().depth_sigma_m(3.0).unwrap();
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}

#[test]
fn the_four_kinds_of_noise_are_the_same_in_depth_and_in_disparity() {
    // 0.1 px of a rig of f T = 58 px m is 0.1 / 58 z^2 m, and 0.4 units of a quarter of a pixel.
    let rig = ValueKind::stereo(0.25, 580.0, 0.1, 7.0).unwrap();
    let (pixels, growth) = (SensorNoise::Value { sigma: 0.4 }, 0.1 / 58.0);
    let depth = SensorNoise::Depth { base: 0.0, growth };
    let rows: Vec<[f64; 2]> = (1..=16).map(|k| f64::from(k) * 0.5).map(|z| [z, growth * z * z]).collect();
    let table = SensorNoise::Table(NoiseTable::new(&rows).unwrap());
    for z in [0.5, 1.0, 2.5, 7.0, 8.0] {
        let sigma = growth * z * z;
        for (value_kind, noise) in [
            (rig, pixels),
            (rig, depth),
            (rig, table),
            (METRES, depth),
            (METRES, table),
            (ValueKind::Depth { metres: 0.001 }, table),
        ] {
            let model = NoiseModel::new(value_kind, noise, 0.0).unwrap();
            let given = model.depth_sigma_m(z).unwrap();
            assert!(
                (given / sigma - 1.0).abs() < 1e-9,
                "{value_kind:?} {noise:?} at {z} m: {given} instead of {sigma}"
            );
        }
        let q = rig.value(z).unwrap();
        let model = NoiseModel::new(rig, depth, 0.0).unwrap();
        assert!((model.sensor_sigma(q) / 0.4 - 1.0).abs() < 1e-9);
        assert!((model.variance(q) / 0.16 - 1.0).abs() < 1e-6);
    }
    let with_base = NoiseModel::new(METRES, SensorNoise::Depth { base: 0.001, growth: 0.002 }, 0.0).unwrap();
    assert!((with_base.depth_sigma_m(3.0).unwrap() - 0.019).abs() < 1e-12);
    assert_eq!(NoiseModel::new(METRES, pixels, 0.0), None);
    assert_eq!(NoiseModel::new(ValueKind::Disparity, depth, 0.0), None);
    assert_eq!(NoiseModel::new(ValueKind::Disparity, table, 0.0), None);
    let unknown = NoiseModel::new(ValueKind::Disparity, pixels, 1.0).unwrap();
    assert_eq!((unknown.sensor_sigma(9.0), unknown.depth_sigma_m(1.0)), (0.4, None));
}

#[test]
fn tables_hold_at_their_ends_and_refuse_what_is_none() {
    let table = NoiseTable::new(&[[1.0, 0.002], [2.0, 0.004], [4.0, 0.020]]).unwrap();
    let given = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 90.0, f64::INFINITY].map(|z| table.sigma_m(z));
    assert_eq!(given, [0.002, 0.002, 0.003, 0.004, 0.012, 0.020, 0.020, 0.020]);
    assert_eq!(NoiseTable::new(&[[2.0, 0.5]]).unwrap().sigma_m(7.0), 0.5);
    assert_eq!(table.rows().len(), 3);
    let row_of = |rows: &[[f64; 2]]| match NoiseTable::new(rows) {
        Err(Error::NoiseTable { row, .. }) => row,
        other => panic!("{other:?}"),
    };
    assert_eq!(row_of(&[]), 0);
    assert_eq!(row_of(&[[1.0, 0.1]; MAX_ROWS + 1]), 0);
    assert_eq!(row_of(&[[0.0, 0.1]]), 1);
    assert_eq!(row_of(&[[1.0, 0.1], [1.0, 0.2]]), 2);
    assert_eq!(row_of(&[[1.0, 0.1], [f64::NAN, 0.2]]), 2);
    assert_eq!(row_of(&[[1.0, 0.1], [2.0, -0.2]]), 2);
    assert_eq!(row_of(&[[1.0, f64::INFINITY]]), 1);
}

#[test]
fn rounding_counts_by_how_many_pixels_share_it() {
    let model = |sigma: f64| NoiseModel::new(ValueKind::Disparity, SensorNoise::Value { sigma }, 1.0).unwrap();
    let patch = |gradient| Patch { gradient, extent: [200.0, 100.0], pixels: 15_000.0 };
    let twelfth = 1.0 / 12.0;
    // A flat patch is off by one and the same error, whatever its size.
    assert_eq!(model(0.0).variance_in(&patch([0.0, 0.0]), 9.0), twelfth * 15_000.0);
    // A ramp along the rows, ten columns a level: all rows sum alike, each to a sawtooth's (10 / pi)^2.
    let ramp = (10.0 / std::f64::consts::PI).powi(2) * 100.0 / 200.0;
    assert!((model(0.0).variance_in(&patch([0.1, 0.0]), 9.0) - twelfth * ramp).abs() < 1e-9);
    // A steep ramp along the columns alone leaves the columns alike.
    assert!((model(0.0).variance_in(&patch([0.0, 3.0]), 9.0) - twelfth * 200.0).abs() < 1e-9);
    // A steep ramp along both, or noise of half a step, leaves nothing to share.
    assert_eq!(model(0.0).variance_in(&patch([3.0, -2.0]), 9.0), twelfth);
    let dithered = model(0.5).variance_in(&patch([0.1, 0.1]), 9.0);
    assert!((dithered / (0.25 + twelfth) - 1.0).abs() < 0.01, "{dithered}");
}

/// Columns and rows of the maps that rays are estimated from.
const RAY_MAP: [usize; 2] = [360, 240];

/// The ray that a map of inverse depth along rays off by `ray` pixels shows, its depth having a noise.
fn ray_of(inverse_depth: impl Fn(f64, f64) -> f64, ray: f64, sigma_m: impl Fn(f64) -> f64, seed: u64) -> Option<f64> {
    let ([width, height], mut random) = (RAY_MAP, Random::new(seed));
    let mut depth = |at: usize| {
        let [u, v] = [at % width, at / width].map(|place| place as f64 + ray * random.gaussian());
        let z = inverse_depth(u, v).recip();
        (z + sigma_m(z) * random.gaussian()) as f32
    };
    let pixels: Vec<f32> = (0..width * height).map(&mut depth).collect();
    let mut estimator = Estimator::default();
    estimator.add(DepthView::new(&pixels, width, height).unwrap(), METRES).unwrap();
    estimator.estimate().unwrap().lateral_noise_px
}

/// A wall, a floor that comes near, and a side that recedes steeply: the near surfaces are the slanted ones.
fn room(u: f64, v: f64) -> f64 {
    (0.25 + 0.0002 * u).max(0.25 + 0.004 * (v - 140.0)).max(0.25 + 0.006 * (80.0 - u))
}

#[test]
fn the_ray_of_slanted_planes_is_found_beside_the_noise() {
    for ray in [0.15, 0.3, 0.45] {
        for seed in 1..=5 {
            let none = ray_of(room, ray, |_| 0.0, seed).unwrap_or(0.0);
            let noisy = ray_of(room, ray, |z| 0.0004 * z * z, seed).unwrap_or(0.0);
            println!("{ray} px: {none:.3} without noise, {noisy:.3} with it");
            // Half of the tiles are steep, and the noise of the others hides some of it.
            assert!((none / ray - 1.0).abs() < 0.25, "{none} instead of {ray}");
            assert!((0.4..1.1).contains(&(noisy / ray)), "{noisy} instead of {ray} beside noise");
        }
    }
}

/// Ratios of the estimate to what the generator states, at 2 and 3 m: the white part, and the smooth part or, where the
/// generator has none, what is taken for it to the white part.
fn ratios(scene: &str, sensor: SensorModel) -> [[f64; 2]; 2] {
    let estimate = estimate(&format!("{scene}:sensor={}", sensor.info().name), 3);
    let [white, smooth] = [estimate.model(), estimate.wide_model()];
    let of = |model: &NoiseModel, stated: fn(&SensorError) -> f64| {
        [2.0, 3.0].map(|z| model.depth_sigma_m(z).unwrap() / (z * z) / stated(&sensor.error_at(z)))
    };
    [of(&white, SensorError::pixel), of(&smooth, |error| if error.smooth > 0.0 { error.smooth } else { error.pixel() })]
}

#[test]
fn the_parts_of_synthetic_cameras_are_told_apart() {
    use SensorModel::{AzureKinect, KinectV1, KinectV1White, KinectV2, RealSense, Stereo, TofWhite};
    for sensor in [KinectV1, KinectV2, AzureKinect, RealSense, Stereo, KinectV1White, TofWhite] {
        for scene in ["room", "boxes"] {
            let [white, smooth] = ratios(scene, sensor);
            let name = sensor.info().name;
            println!("{scene} {name}: white {white:.2?}, smooth {smooth:.2?}");
            let within_a_quarter = |ratios: [f64; 2]| ratios.iter().all(|ratio| (ratio - 1.0).abs() <= 0.25);
            // Most of a matched pair's error are patches of a few pixels, which are neither.
            assert!(sensor == Stereo || within_a_quarter(white), "{scene} {name}: white {white:?}");
            let least = match (sensor, scene) {
                (KinectV1White | TofWhite, _) => {
                    assert!(smooth.iter().all(|&share| share < 0.1), "{scene} {name}: smooth {smooth:?}");
                    continue;
                }
                // Their waves are as long as the planes, or of a few pixels.
                (AzureKinect, "room") | (Stereo, "boxes") => 0.65,
                _ => 0.75,
            };
            assert!(smooth.iter().all(|ratio| (least..1.25).contains(ratio)), "{scene} {name}: smooth {smooth:?}");
        }
    }
}

#[test]
fn each_part_is_the_parameters_or_else_the_sensors_and_a_larger_scale_joins_more() {
    let frame = "room:sensor=kinect,size=320x240".parse::<Spec>().unwrap().frame().unwrap();
    let labels = |params: Planar, noise: [Option<SensorNoise>; 2]| {
        let [noise, smooth_noise] = noise;
        let sensor = frame.sensor.noise(noise).smooth_noise(smooth_noise);
        Detector::new(params).unwrap().sensor(sensor).detect(frame.view()).unwrap().labels.clone()
    };
    let growing = |growth: f64| Some(SensorNoise::Depth { base: 0.0, growth });
    let plain = labels(Planar::default(), [None; 2]);
    let white = Planar::default().noise_growth(0.002);
    let smooth = Planar::default().smooth_noise_growth(0.004);
    for (params, of_sensor, another) in [
        (white, [growing(0.002), None], [growing(0.005), None]),
        (smooth, [None, growing(0.004)], [None, growing(0.0001)]),
    ] {
        let by_parameter = labels(params, [None; 2]);
        assert_ne!(by_parameter, plain);
        assert_eq!(labels(Planar::default(), of_sensor), by_parameter);
        assert_eq!(labels(params, another), by_parameter);
    }
    let planes = |noise_scale: f64| {
        let labels = labels(Planar::default().noise_scale(noise_scale), [None; 2]);
        labels.into_iter().max().unwrap()
    };
    let [half, one, three] = [0.5, 1.0, 3.0].map(planes);
    println!("{half}, {one} and {three} planes with half, all and three times the noise");
    assert!(half > one && one > three);
}
