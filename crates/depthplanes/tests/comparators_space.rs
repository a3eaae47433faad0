//! The methods `ransac`, `hough` and `mdl` against exact truth, and what they are known not to do.

use depthplanes::methods::find;
use depthplanes::scene::{SceneFrame, ScenePixels, Spec};
use depthplanes::{AnyView, DepthView, Detection, Detector, Sensor, ValueKind};

const NAMES: [&str; 3] = ["ransac", "hough", "mdl"];

fn scene(spec: &str) -> SceneFrame {
    spec.parse::<Spec>().unwrap().frame().unwrap()
}

fn detect<'m>(method: &str, given: &[(&str, f64)], sensor: Sensor, map: impl Into<AnyView<'m>>) -> Detection {
    let mut detector = Detector::new(find(method).unwrap().with(given).unwrap()).unwrap().sensor(sensor);
    detector.detect(map).unwrap().clone()
}

/// For each truth label, the found label that covers most of it, and their intersection over union.
fn best(truth: &[u16], found: &[u16]) -> Vec<(u16, f64)> {
    let count = |is: &dyn Fn(u16, u16) -> bool| truth.iter().zip(found).filter(|(t, f)| is(**t, **f)).count() as f64;
    let planes = |labels: &[u16]| 1..=labels.iter().copied().max().unwrap_or(0);
    let iou = |t: u16, f: u16| count(&|a, b| a == t && b == f) / count(&|a, b| a == t || b == f);
    let best = |t: u16| planes(found).map(|f| (f, iou(t, f))).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
    planes(truth).map(best).collect()
}

/// Pixels of each truth surface that a plane covers, and all of them, over the curved surfaces.
fn covered_of_curved(frame: &SceneFrame, found: &Detection) -> f64 {
    let truth = &frame.truth;
    let is_curved = |surface: u32| surface > 0 && truth.curved[surface as usize - 1];
    let on_curved = truth.surfaces.iter().zip(&found.labels).filter(|(surface, _)| is_curved(**surface));
    on_curved.filter(|(_, label)| **label > 0).count() as f64 / truth.curved_pixels() as f64
}

#[test]
fn the_three_planes_of_a_corner_are_found_with_a_camera_without_one_and_in_disparity() {
    for name in NAMES {
        for (sensor, camera) in
            [("clean", true), ("clean_mm", true), ("clean_mm", false), ("disparity", true), ("disparity", false)]
        {
            let frame = scene(&format!("planes3:sensor={sensor},size=320x240"));
            let known = match (camera, sensor) {
                (true, _) => frame.sensor,
                (false, "disparity") => Sensor::default().value_kind(ValueKind::Disparity),
                (false, _) => frame.sensor.intrinsics(None),
            };
            let found = detect(name, &[], known, frame.view());
            let matched = best(&frame.truth.pieces(1).labels, &found.labels);
            assert_eq!(matched.len(), 3);
            for (_, iou) in &matched {
                assert!(*iou >= 0.75, "{name}, {sensor}, camera {camera}: {matched:?}");
            }
            assert!(found.planes.len() <= 5, "{name}, {sensor}, camera {camera}: {} planes", found.planes.len());
        }
    }
}

#[test]
fn a_seed_decides_the_labels_and_threads_do_not() {
    let frame = scene("room:size=160x120");
    for name in NAMES {
        let labels = |seed: f64, threads: usize| {
            let method = find(name).unwrap().with(&[("seed", seed)]).unwrap();
            let mut detector = Detector::new(method).unwrap().sensor(frame.sensor).threads(threads);
            detector.detect(frame.view()).unwrap().labels.clone()
        };
        let first = labels(1.0, 1);
        assert_eq!(first, labels(1.0, 1), "{name}");
        assert_eq!(first, labels(1.0, 2), "{name}");
        assert!(labels(2.0, 1).iter().any(|&label| label > 0), "{name}");
    }
}

/// Flat surfaces one behind the other, 40 columns each, at depths in millimetres.
fn terrace(depths: &[u16]) -> (Vec<u16>, usize, usize) {
    let (width, height) = (40 * depths.len(), 120);
    ((0..width * height).map(|at| depths[at % width / 40]).collect(), width, height)
}

fn millimetres() -> Sensor {
    scene("planes3:size=32x24").sensor.value_kind(ValueKind::Depth { metres: 0.001 })
}

#[test]
fn ransac_with_a_coarse_epsilon_joins_low_steps() {
    let (map, width, height) = terrace(&[2000, 2040, 2080, 2120]);
    let map = DepthView::new(&map, width, height).unwrap();
    let count = |epsilon: f64| detect("ransac", &[("epsilon", epsilon)], millimetres(), map).planes.len();
    assert_eq!(count(0.01), 4);
    assert!(count(0.1) < 4, "{}", count(0.1));
    let stairs = scene("stairs:sensor=clean_mm,size=320x240");
    let found = |epsilon: f64| {
        let found = detect("ransac", &[("epsilon", epsilon)], stairs.sensor, stairs.view());
        best(&stairs.truth.pieces(1).labels, &found.labels).iter().filter(|(_, iou)| *iou >= 0.75).count()
    };
    let (fine, coarse) = (found(0.02), found(0.3));
    println!("steps of a stair: {fine} planes with an epsilon of 2 cm, {coarse} with 30 cm");
    assert!(coarse < fine, "{coarse} {fine}");
}

#[test]
fn ransac_leaves_planes_that_meet_their_points_near_edges() {
    let mut count = [0, 0];
    for seed in 1..=3 {
        let frame = scene(&format!("room:seed={seed},sensor=kinect_white"));
        let found = detect("ransac", &[], frame.sensor, frame.view());
        let matched = best(&frame.truth.pieces(500).labels, &found.labels);
        count[0] += matched.iter().filter(|(_, iou)| *iou >= 0.75).count();
        count[1] += matched.len();
    }
    println!("ransac: {} of {} planes of Kinect rooms", count[0], count[1]);
    assert!(count[0] >= 62, "{count:?}");
}

#[test]
fn hough_joins_planes_that_fall_into_one_cell() {
    // A roof whose halves are bent by 4 degrees.
    let (width, height, slope) = (160, 120, 2f64.to_radians().tan());
    let depth = |u: f64| 2.0 / (1.0 - slope * (u - 80.0).abs() / 160.0);
    let map: Vec<f32> = (0..width * height).map(|at| depth((at % width) as f64) as f32).collect();
    let sensor = Sensor::default()
        .value_kind(ValueKind::Depth { metres: 1.0 })
        .intrinsics(depthplanes::Intrinsics::new(160.0, 160.0, 80.0, 60.0).ok());
    let map = DepthView::new(&map, width, height).unwrap();
    let count = |angle: f64| {
        let given = [("angle", angle), ("epsilon", 0.05), ("distance", 0.2)];
        detect("hough", &given, sensor, map).planes.len()
    };
    assert_eq!(count(20.0), 1);
    assert_eq!(detect("mdl", &[], sensor, map).planes.len(), 2);
}

#[test]
fn mdl_describes_curved_surfaces_by_many_planes() {
    let frame = scene("curved");
    let found = detect("mdl", &[], frame.sensor, frame.view());
    let planar = detect("planar", &[], frame.sensor, frame.view());
    let (covered, by_planar) = (covered_of_curved(&frame, &found), covered_of_curved(&frame, &planar));
    println!("curved pixels on planes: mdl {covered:.2}, planar {by_planar:.2}");
    assert!(covered > 0.5 && covered > 2.0 * by_planar, "{covered} {by_planar}");
}

#[test]
fn mdl_splits_a_wall_that_bows_by_more_than_the_noise() {
    let wall = |bow: f64| {
        let mut random = depthplanes::scene::Random::new(4);
        let map: Vec<f32> = (0..320 * 240)
            .map(|at| {
                let x = (at % 320) as f64 / 160.0 - 1.0;
                (2.0 + bow * x * x + 0.002 * random.gaussian()) as f32
            })
            .collect();
        let sensor = Sensor::default().value_kind(ValueKind::Depth { metres: 1.0 });
        detect("mdl", &[("noise", 0.002)], sensor, DepthView::new(&map, 320, 240).unwrap()).planes.len()
    };
    let (flat, bowed) = (wall(0.0), wall(0.02));
    println!("a wall: {flat} planes, one with a bow of 2 cm: {bowed}");
    assert_eq!(flat, 1);
    assert!(bowed > 1);
}

#[test]
fn mdl_needs_no_tolerance_and_joins_levels_of_a_ramp() {
    // A slant that rounding makes into levels 50 columns wide.
    let map: Vec<u8> = (0..320 * 240).map(|at| (40.0 + 0.02 * (at % 320) as f64).round() as u8).collect();
    let sensor = Sensor::default().value_kind(ValueKind::Disparity);
    let found = detect("mdl", &[], sensor, DepthView::new(&map, 320, 240).unwrap());
    assert_eq!(found.planes.iter().map(|plane| plane.pixel_count).collect::<Vec<_>>(), [320 * 240]);
}

#[test]
fn maps_of_nothing_give_no_plane_and_maps_of_noise_few() {
    let mut random = depthplanes::scene::Random::new(5);
    let noise: Vec<f32> = (0..64 * 48).map(|_| random.between(0.5, 8.0) as f32).collect();
    let mut holes = vec![f32::NAN; 64 * 48];
    holes[1000] = 1.0;
    holes[1001] = f32::INFINITY;
    for name in NAMES {
        let known = scene("planes3:size=64x48").sensor;
        let metres = known.value_kind(ValueKind::Depth { metres: 1.0 });
        for sensor in [metres, Sensor::default(), Sensor::default().value_kind(ValueKind::Disparity)] {
            for map in [&vec![0.0; 64 * 48], &vec![f32::NAN; 64 * 48], &holes] {
                let found = detect(name, &[], sensor, DepthView::new(map, 64, 48).unwrap());
                assert_eq!(found.planes.len(), 0, "{name}");
            }
            for (width, height) in [(1, 1), (64, 1), (1, 64), (2, 2)] {
                let found =
                    detect(name, &[], sensor, DepthView::new(&vec![2.0f32; width * height], width, height).unwrap());
                assert_eq!(found.planes.len(), 0, "{name}");
            }
            let found = detect(name, &[], sensor, DepthView::new(&noise, 64, 48).unwrap());
            // hough asks no more of a plane than that enough pixels on it touch.
            let most = if name == "hough" { 16 } else { 3 };
            assert!(found.planes.len() <= most, "{name}: {} planes of noise", found.planes.len());
        }
    }
}

#[test]
fn rooms_are_found_by_each() {
    let mut frame = scene("room");
    assert!(matches!(frame.pixels, ScenePixels::U16(_)));
    frame.sensor.noise = None;
    for (name, least) in [("ransac", 10), ("hough", 3), ("mdl", 5)] {
        let found = detect(name, &[], frame.sensor, frame.view());
        let matched = best(&frame.truth.pieces(100).labels, &found.labels);
        let count = matched.iter().filter(|(_, iou)| *iou >= 0.75).count();
        println!("{name}: {count} of {} planes of a room", matched.len());
        assert!(count >= least, "{name}: {count}");
    }
}
