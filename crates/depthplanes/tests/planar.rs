//! The method `planar` against the exact truth of synthetic scenes.

use depthplanes::explanation::Verdict;
use depthplanes::metrics::{Contingency, evops};
use depthplanes::noise::{Estimator, SensorNoise};
use depthplanes::scene::{Random, SceneFrame, ScenePixels, SensorModel, Spec, Truth};
use depthplanes::{DepthView, Detection, Detector, Intrinsics, Ngaf, Planar, Sensor, ValueKind};

fn scene(spec: &str) -> SceneFrame {
    spec.parse::<Spec>().unwrap().frame().unwrap()
}

fn detect(params: Planar, frame: &SceneFrame) -> Detection {
    Detector::new(params).unwrap().sensor(frame.sensor).detect(frame.view()).unwrap().clone()
}

/// Degrees between two unit normals.
fn degrees(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
    dot.min(1.0).acos().to_degrees()
}

/// Truth planes of at least 300 pixels where something was measured; pixels of smaller ones are left out on
/// both sides, and so are found planes that lie on them for the most part.
fn pairs(frame: &SceneFrame, found: &Detection) -> Contingency {
    let pieces = frame.truth.pieces(1);
    let is_small = |label: u16| label > 0 && pieces.planes[usize::from(label) - 1].pixel_count < 300;
    let measured = |(at, &label): (usize, &u16)| if frame.value(at) > 0.0 { label } else { 0 };
    let truth: Vec<u16> = pieces.labels.iter().enumerate().map(measured).collect();
    let mut on_small = vec![0; found.planes.len() + 1];
    for (&label, &found) in truth.iter().zip(&found.labels).filter(|(label, _)| is_small(**label)) {
        on_small[usize::from(found)] += usize::from(label > 0);
    }
    let is_left_out =
        |label: u16| label > 0 && 2 * on_small[usize::from(label)] > found.planes[usize::from(label) - 1].pixel_count;
    Contingency::of_pairs(
        truth
            .iter()
            .zip(&found.labels)
            .filter(|(label, _)| !is_small(**label))
            .map(|(&label, &found)| (label, if is_left_out(found) { 0 } else { found })),
    )
}

/// The curved pixels that some plane covers.
fn covered_of_curved(truth: &Truth, found: &Detection) -> usize {
    let is_curved = |surface: u32| surface > 0 && truth.curved[surface as usize - 1];
    let covered =
        truth.surfaces.iter().zip(&found.labels).filter(|(surface, label)| is_curved(**surface) && **label > 0);
    covered.count()
}

#[test]
fn the_three_planes_of_a_corner_are_found_with_their_equations() {
    for (sensor, angle) in [("clean", 0.01), ("clean_mm", 0.01), ("kinect_white", 0.2), ("tof_white", 0.2)] {
        let frame = scene(&format!("planes3:sensor={sensor}"));
        let found = detect(Planar::default(), &frame);
        assert_eq!(found.planes.len(), 3, "{sensor}");
        for (plane, truth) in found.planes.iter().zip(&frame.truth.planes) {
            let (metric, right) = (plane.metric.unwrap().plane, truth.plane);
            let off = degrees(metric.normal, right.normal);
            assert!(off < angle, "{sensor}: {off} degrees");
            assert!((metric.distance - right.distance).abs() < 0.02, "{sensor}: {metric:?} {right:?}");
        }
        let ngaf = Ngaf::default().theta(if sensor == "clean" { 0.02 } else { 20.0 });
        let joined =
            Detector::new(ngaf).unwrap().sensor(frame.sensor).detect(frame.view()).unwrap().planes[0].pixel_count;
        assert!(joined > frame.truth.planes[0].pixel_count * 11 / 10, "ngaf joins planes that meet");
    }
}

/// What is found of so many seeds of `random`.
struct Rooms {
    /// Mean of F over the rooms.
    f: f64,
    /// Share of the curved pixels that some plane covers.
    covered: f64,
    /// Degrees by which normals are off, sorted.
    off: Vec<f64>,
}

impl Rooms {
    /// From seeds that the method was not tuned on.
    fn of(sensor: &str, noise: Option<SensorNoise>, seeds: u64, params: Planar) -> Self {
        let (mut f, mut covered, mut curved, mut off) = (0.0, 0, 0, Vec::new());
        for seed in 201..=200 + seeds {
            let mut frame = scene(&format!("random:seed={seed},sensor={sensor}"));
            frame.sensor.noise = noise;
            let found = detect(params, &frame);
            let score = evops(&pairs(&frame, &found));
            f += score.f_score / seeds as f64;
            let truth = frame.truth.pieces(1).planes;
            off.extend(score.matched.iter().map(|pair| {
                let metric = found.planes[usize::from(pair.prediction) - 1].metric.unwrap();
                degrees(metric.plane.normal, truth[usize::from(pair.truth) - 1].plane.normal)
            }));
            covered += covered_of_curved(&frame.truth, &found);
            curved += frame.truth.curved_pixels();
        }
        off.sort_by(f64::total_cmp);
        Rooms { f, covered: covered as f64 / curved as f64, off }
    }

    fn print(&self, name: &str) {
        let (f, cover, normals, median) = (self.f, 100.0 * self.covered, self.off.len(), self.median());
        println!(
            "{name}: F {f:.3}, {cover:.1} % of the curved pixels covered, median error of {normals} normals {median:.3} degrees"
        );
    }

    fn median(&self) -> f64 {
        self.off[self.off.len() / 2]
    }
}

#[test]
fn rooms_of_boxes_balls_and_columns_are_found_as_they_are() {
    for (sensor, noise, least, most_cover) in [
        ("clean_mm", None, 0.96, 0.02),
        ("kinect_white", Some(SensorNoise::Depth { base: 0.0, growth: 1.425e-3 }), 0.89, 0.09),
        ("tof_white", None, 0.89, 0.045),
    ] {
        let rooms = Rooms::of(sensor, noise, 60, Planar::default());
        rooms.print(sensor);
        assert!(rooms.median() < 0.5, "{sensor}: {} degrees", rooms.median());
        assert!(rooms.f >= least, "{sensor}: F {}", rooms.f);
        assert!(rooms.covered < most_cover, "{sensor}: {} of the curved pixels covered", rooms.covered);
    }
}

/// The goal is 0.90 for each. With the smooth part stated as the generator has it, the second of each, it is no better: box and floor
/// differ by less than the error, and a ball bows by less.
#[test]
fn rooms_with_the_errors_of_real_cameras_are_found_for_the_most_part() {
    for (sensor, least) in [("kinect", 0.78), ("kinect2", 0.69), ("azure", 0.82), ("realsense", 0.65), ("stereo", 0.54)]
    {
        let rooms = Rooms::of(sensor, None, 20, Planar::default());
        rooms.print(sensor);
        let smooth = SensorModel::find(sensor).unwrap().error_at(2.0).smooth;
        let stated = match scene(&format!("random:seed=1,sensor={sensor}")).sensor.value_kind {
            ValueKind::InverseDepth { slope, .. } => Planar::default().smooth_noise(smooth / slope),
            _ => Planar::default().smooth_noise_growth(smooth),
        };
        Rooms::of(sensor, None, 20, stated).print(&format!("{sensor}, smooth part stated"));
        assert!(rooms.f >= least, "{sensor}: F {}", rooms.f);
    }
}

#[test]
fn a_flat_wall_without_noise_is_one_plane_on_every_type() {
    let (width, height) = (80, 60);
    let (byte, wide, single) = (vec![9u8; width * height], vec![900u16; width * height], vec![0.9f32; width * height]);
    let mut detector = Detector::new(Planar::default()).unwrap();
    let mut counts = Vec::new();
    for view in [
        DepthView::new(&byte, width, height).unwrap().into(),
        DepthView::new(&wide, width, height).unwrap().into(),
        depthplanes::AnyView::from(DepthView::new(&single, width, height).unwrap()),
    ] {
        let found = detector.detect(view).unwrap();
        counts.push((found.planes.len(), found.labelled_pixels()));
    }
    assert_eq!(counts, [(1, width * height); 3]);
}

#[test]
fn planes_of_a_disparity_map_need_no_calibration() {
    let (width, height) = (120, 90);
    // Two slanted planes that meet in column 60: 20 + u / 4 and 50 - u / 4.
    let disparity = |u: usize, v: usize| (200 + 4 * v + if u < 60 { 5 * u } else { 600 - 5 * u }) as u16;
    let map: Vec<u16> = (0..width * height).map(|at| disparity(at % width, at / width)).collect();
    let sensor = Sensor::default().value_kind(ValueKind::Disparity);
    let mut detector = Detector::new(Planar::default()).unwrap().sensor(sensor);
    let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
    assert_eq!(found.planes.len(), 2);
    for (at, &label) in found.labels.iter().enumerate() {
        let of_corner = found.labels[if at % width < 60 { 0 } else { width - 1 }];
        // In the last columns before the crease both planes are within rounding.
        assert!(label == of_corner || (58..63).contains(&(at % width)), "pixel {} {}", at % width, at / width);
    }
    let gradient = found.planes[0].fit.unwrap().gradient;
    assert!((gradient[0].abs() - 5.0).abs() < 0.05 && (gradient[1] - 4.0).abs() < 0.05, "{gradient:?}");
}

#[test]
fn holes_and_a_negative_focal_length_change_no_plane() {
    let frame = scene("planes3:sensor=clean_mm");
    let ScenePixels::U16(mut pixels) = frame.pixels.clone() else { panic!("millimetres are 16 bits") };
    let mut random = Random::new(5);
    for pixel in &mut pixels {
        *pixel *= u16::from(random.uniform() > 0.3);
    }
    let Intrinsics { fx, fy, cx, cy } = frame.sensor.intrinsics.unwrap();
    let flipped = Intrinsics::new(fx, -fy, cx, cy).unwrap();
    let sensor = frame.sensor.intrinsics(Some(flipped));
    let mut detector = Detector::new(Planar::default()).unwrap().sensor(sensor);
    let found = detector.detect(DepthView::new(&pixels, frame.width, frame.height).unwrap()).unwrap();
    assert_eq!(found.planes.len(), 3);
    for (plane, truth) in found.planes.iter().zip(&frame.truth.planes) {
        let [x, y, z] = truth.plane.normal;
        let off = degrees(plane.metric.unwrap().plane.normal, [x, -y, z]);
        assert!(off < 0.05, "{off} degrees");
    }
}

#[test]
fn planes_of_which_nearly_every_second_pixel_is_missing_stay_whole() {
    let frame = scene("planes3:sensor=clean_mm");
    let ScenePixels::U16(mut pixels) = frame.pixels.clone() else { panic!("millimetres are 16 bits") };
    let mut random = Random::new(7);
    // By their four next pixels alone planes fall apart where fewer than 59 % are there.
    for pixel in &mut pixels {
        *pixel *= u16::from(random.uniform() > 0.45);
    }
    let mut detector = Detector::new(Planar::default()).unwrap().sensor(frame.sensor);
    let found = detector.detect(DepthView::new(&pixels, frame.width, frame.height).unwrap()).unwrap();
    assert_eq!(found.planes.len(), 3);
    assert!(100 * found.labelled_pixels() >= 98 * found.valid_pixels);
}

#[test]
fn noise_of_which_no_plane_is_made_has_none() {
    let mut random = Random::new(6);
    let map: Vec<u16> = (0..320 * 240).map(|_| (500.0 + 5000.0 * random.uniform()) as u16).collect();
    let stated = Planar::default().noise(0.002);
    let found = Detector::new(stated).unwrap().detect(DepthView::new(&map, 320, 240).unwrap()).unwrap().clone();
    assert_eq!(found.planes.len(), 0);
}

#[test]
fn a_slant_seen_along_rays_of_whole_pixels_is_one_plane_if_that_is_said() {
    let mut random = Random::new(7);
    let slant = |at: usize, off: f64| 300.0 + 2.0 * ((at % 160) as f64 + off) + 0.5 * (at / 160) as f64;
    let map: Vec<f32> = (0..160 * 120).map(|at| slant(at, random.between(-0.5, 0.5)) as f32).collect();
    let found = |ray: f64| {
        let stated = Planar::default().noise(0.05).lateral_noise(ray);
        let sensor = Sensor::default().value_kind(ValueKind::Disparity);
        let mut detector = Detector::new(stated).unwrap().sensor(sensor);
        let found = detector.detect(DepthView::new(&map, 160, 120).unwrap()).unwrap();
        found.planes.iter().map(|plane| plane.pixel_count).collect::<Vec<_>>()
    };
    assert_eq!(found(0.3), [160 * 120]);
    assert_eq!(found(0.05), [0; 0]);
}

#[test]
fn a_slant_seen_along_rays_of_whole_pixels_is_one_plane_beside_a_wall_if_nothing_is_said() {
    let mut random = Random::new(7);
    let mut value = |at: usize| match at % 160 {
        u @ 80.. => 300.0 + 2.0 * (u as f64 + random.between(-0.5, 0.5)) + 0.5 * (at / 160) as f64,
        _ => 200.0 + random.between(-0.08, 0.08),
    };
    let map: Vec<f32> = (0..160 * 120).map(|at| value(at) as f32).collect();
    let found = |noise: f64, ray: f64| {
        let stated = Planar::default().noise(noise).lateral_noise(ray);
        let sensor = Sensor::default().value_kind(ValueKind::Disparity);
        let mut detector = Detector::new(stated).unwrap().sensor(sensor);
        let found = detector.detect(DepthView::new(&map, 160, 120).unwrap()).unwrap();
        found.planes.iter().map(|plane| plane.pixel_count).collect::<Vec<_>>()
    };
    assert_eq!(found(0.05, 0.05), [80 * 120]);
    assert_eq!(found(0.05, 0.0), [80 * 120; 2]);
    assert_eq!(found(0.0, 0.0), [80 * 120; 2]);
}

#[test]
fn flat_surfaces_of_one_value_each_are_planes_of_their_own() {
    let (width, height) = (64, 48);
    // Their distance in depth is no step of the sensor's.
    let map: Vec<u16> = (0..width * height).map(|at| if at % width < 32 { 1003 } else { 1503 }).collect();
    let mut detector = Detector::default();
    let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
    let counts: Vec<usize> = found.planes.iter().map(|plane| plane.pixel_count).collect();
    assert_eq!(counts, [32 * 48; 2]);
}

#[test]
fn planes_that_are_grown_over_in_bands_are_whole() {
    // Two walls that meet in a corner, over five bands of half a million pixels, on one thread and on several.
    let (width, height, sigma, mut random) = (1600, 1600, 0.25, Random::new(9));
    let disparity = |at: usize| (100.0 + 0.02 * (at / width) as f64).min(60.0 + 0.04 * (at % width) as f64);
    let map: Vec<f32> = (0..width * height).map(|at| (disparity(at) + sigma * random.gaussian()) as f32).collect();
    for threads in [1, 3] {
        let sensor = Sensor::default().value_kind(ValueKind::Disparity);
        let mut detector = Detector::default().sensor(sensor).threads(threads);
        let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
        assert_eq!(found.planes.len(), 2, "{threads} threads");
        let on_planes: f64 = found.planes.iter().map(|plane| plane.share_of_valid).sum();
        assert!(on_planes > 0.99, "{on_planes} of the pixels, {threads} threads");
    }
}

#[test]
fn a_surface_seen_edge_on_is_no_plane_and_explain_says_so() {
    // A wall at 8 m, and beside it a surface that comes nearer by a share of its inverse depth in each of 4 columns.
    let (width, height, seam) = (324usize, 64usize, 320usize);
    let map = |per_pixel: f64| -> Vec<f32> {
        let q = |u: usize| 1.0 / 8.0 * (1.0 + per_pixel * (u + 1).saturating_sub(seam) as f64);
        (0..width * height).map(|at| (1.0 / q(at % width)) as f32).collect()
    };
    // In the middle, 2.5 columns on, a change of s at the seam is one of s / (1 + 2.5 s) of what is there.
    for (per_pixel, is_plane) in [(0.05, true), (0.08, true), (0.2, false), (2.0, false)] {
        let map = map(per_pixel);
        let sensor = Sensor::default().value_kind(ValueKind::Depth { metres: 1.0 });
        let mut detector = Detector::new(Planar::default()).unwrap().sensor(sensor);
        let view = DepthView::new(&map, width, height).unwrap();
        let label = detector.detect(view).unwrap().labels[32 * width + 322];
        assert_eq!(label > 0, is_plane, "{per_pixel}");
        let verdict = detector.explain(view, [322, 32]).unwrap().verdict;
        assert_eq!(matches!(verdict, Verdict::EdgeOn), !is_plane, "{per_pixel}: {verdict:?}");
    }
}

#[test]
fn a_wall_behind_a_large_ball_stays_whole_without_any_noise() {
    // A ball of 0.7 m at 2 m, before a wall at 4 m, in millimetres: each half of the map.
    let (width, height, f) = (640usize, 480usize, 580.0);
    let depth = |at: usize| {
        let [x, y] = [(at % width) as f64 - 319.5, (at / width) as f64 - 239.5].map(|px| px / f);
        let a = x * x + y * y + 1.0;
        let root = 16.0 - 4.0 * a * (4.0 - 0.7 * 0.7);
        if root > 0.0 { (4.0 - root.sqrt()) / (2.0 * a) } else { 4.0 }
    };
    let map: Vec<u16> = (0..width * height).map(|at| (1000.0 * depth(at)).round() as u16).collect();
    let sensor = Sensor::default()
        .value_kind(ValueKind::Depth { metres: 0.001 })
        .intrinsics(Some(Intrinsics::new(f, f, 319.5, 239.5).unwrap()));
    let mut detector = Detector::new(Planar::default()).unwrap().sensor(sensor);
    let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
    let wall = map.iter().filter(|&&value| value == 4000).count();
    let kept = map.iter().zip(&found.labels).filter(|(value, label)| **value == 4000 && **label == found.labels[0]);
    assert!(found.labels[0] > 0 && kept.count() > wall * 99 / 100);
}

#[test]
fn the_floor_below_a_low_camera_is_a_plane_however_coarse_the_picture() {
    for (width, height, f, near) in [(80usize, 60usize, 72.5, 0.1), (320, 240, 290.0, 0.5), (640, 480, 580.0, 1.0)] {
        let depth = |at: usize| {
            let y = ((at / width) as f64 - (height as f64 - 1.0) / 2.0) / f;
            let z = 0.05 / y;
            if y > 0.0 && (near..8.0).contains(&z) { z as f32 } else { 0.0 }
        };
        let map: Vec<f32> = (0..width * height).map(depth).collect();
        let sensor = Sensor::default().value_kind(ValueKind::Depth { metres: 1.0 });
        let mut detector = Detector::new(Planar::default()).unwrap().sensor(sensor);
        let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
        assert_eq!(found.planes.len(), 1, "{width} x {height}");
        assert!(found.labelled_share() > 0.95, "{width} x {height}: {}", found.labelled_share());
    }
}

#[test]
fn values_too_small_for_a_depth_count_as_not_measured() {
    let (width, height, mut random) = (320usize, 240usize, Random::new(5));
    for share in [0.001, 0.01, 1.0] {
        let pixel = |at: usize| if random.uniform() < share { 1.2e-38 } else { 2.0 + 0.001 * (at % width) as f32 };
        let map: Vec<f32> = (0..width * height).map(pixel).collect();
        let view = DepthView::new(&map, width, height).unwrap();
        let mut detector = Detector::new(Planar::default()).unwrap();
        assert_eq!(detector.detect(view).unwrap().planes.len(), usize::from(share < 1.0), "{share}");
        detector.explain(view, [100, 100]).unwrap();
        let mut estimator = Estimator::default();
        estimator.add(view, ValueKind::Depth { metres: 1.0 }).unwrap();
        assert_eq!(estimator.estimate().is_ok(), share < 1.0);
    }
}
