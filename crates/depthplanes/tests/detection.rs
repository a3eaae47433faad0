//! What a detection promises, recomputed naively from its label image: over random maps and synthetic scenes.

mod naive;

use depthplanes::noise::SensorNoise;
use depthplanes::scene::{Camera, Pose, SCENES, Scene, SceneFrame, SensorModel, Spec, render};
use depthplanes::{AnyView, DepthView, Detection, Detector, Intrinsics, Ngaf, Plane, Sensor, ValueKind, with_view};
use naive::{Fit, Random, Record};

fn values(view: &AnyView<'_>) -> Vec<f64> {
    with_view!(view, view => view.rows().flatten().map(|&value| value.into()).collect())
}

fn is_valid(view: &AnyView<'_>) -> impl Fn(f64) -> bool + Copy + use<> {
    let [sentinel, low, high]: [f64; 3] =
        with_view!(view, view => [view.validity().sentinel, view.validity().low, view.validity().high].map(Into::into));
    move |value| naive::valid(value, sentinel, low, high)
}

fn is_whole(view: &AnyView<'_>) -> bool {
    !matches!(view, AnyView::F32(_))
}

/// The map after section 3b, and how many pixels were filled.
fn enhanced(view: &AnyView<'_>, params: &Ngaf) -> (Vec<f64>, usize) {
    let mean = if is_whole(view) { naive::whole_mean } else { naive::single_mean };
    let (mut map, mut filled) = (values(view), 0);
    for _ in 0..if params.window > 0 { params.passes } else { 0 } {
        let (next, count) = naive::enhance(&map, view.width(), is_valid(view), params.window as usize, mean);
        (map, filled) = (next, filled + count);
    }
    (map, filled)
}

fn detect(params: Ngaf, sensor: Sensor, view: AnyView<'_>) -> Detection {
    Detector::new(params).unwrap().sensor(sensor).detect(view).unwrap().clone()
}

#[track_caller]
fn assert_near(given: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((given - expected).abs() <= tolerance, "{what}: {given} instead of {expected}, more than {tolerance} off");
}

/// All that can be said of a detection without our own conditions.
fn check(found: &Detection, view: AnyView<'_>, params: &Ngaf, sensor: Sensor, what: &str) {
    let (width, height) = (view.width(), view.height());
    assert_eq!((found.width, found.height, found.labels.len()), (width, height, width * height), "{what}");
    let ok = is_valid(&view);
    let (map, filled) = enhanced(&view, params);
    assert_eq!(found.filled_pixels, filled, "{what}");
    assert_eq!(found.valid_pixels, values(&view).into_iter().filter(|&value| ok(value)).count(), "{what}");
    assert!((0..map.len()).all(|at| ok(map[at]) || found.labels[at] == 0), "{what}: a missing pixel has a label");

    let records = naive::records(&found.labels, &map, width); // fails if a label is not used
    assert_eq!(records.len(), found.planes.len(), "{what}");
    let whole = (found.valid_pixels + found.filled_pixels) as f64;
    for ((plane, record), label) in found.planes.iter().zip(&records).zip(1..) {
        let what = format!("{what}, plane {label}");
        assert_eq!((plane.label, plane.pixel_count), (label, record.pixel_count), "{what}");
        let found_box = plane.bounding_box;
        let sides = [found_box.u_min, found_box.v_min, found_box.u_max, found_box.v_max];
        assert_eq!(sides.map(|side| side as usize), record.bounding_box, "{what}");
        (0..2).for_each(|k| assert_near(plane.centroid[k], record.centroid[k], 1e-9, &what));
        assert_near(plane.share_of_valid, record.pixel_count as f64 / whole, 1e-15, &what);
        check_fit(plane, record, &what);
        check_metric(plane, found, &map, sensor, &what);
    }
    for pair in records.windows(2) {
        let key = |record: &Record| (usize::MAX - record.pixel_count, record.first);
        assert!(key(&pair[0]) < key(&pair[1]), "{what}: planes out of order");
    }
    let labelled: usize = records.iter().map(|record| record.pixel_count).sum();
    assert_eq!(found.labelled_pixels(), labelled, "{what}");
    assert_near(found.labelled_share(), found.planes.iter().map(|plane| plane.share_of_valid).sum(), 1e-12, what);
    assert!(found.labelled_share() <= 1.0, "{what}");
}

fn check_fit(plane: &Plane, record: &Record, what: &str) {
    assert_eq!(plane.fit.is_some(), record.fit.is_some(), "{what}");
    let (Some(given), Some(Fit { abc, rms, spread })) = (plane.fit, record.fit) else { return };
    let scale = 1e-9 * spread + 1e-12;
    (0..2).for_each(|k| assert_near(given.gradient[k], abc[k], scale, what));
    let at = |[a, b]: [f64; 2], c: f64| a * record.centroid[0] + b * record.centroid[1] + c;
    assert_near(at(given.gradient, given.offset), at([abc[0], abc[1]], abc[2]), 1e-9 * (1.0 + abc[2].abs()), what);
    assert_near(given.rms * given.rms, rms * rms, 1e-13 * spread * spread + 1e-9 * rms * rms, what);
}

/// The plane in metres: least squares in inverse depth, then distances point by point.
fn check_metric(plane: &Plane, found: &Detection, map: &[f64], sensor: Sensor, what: &str) {
    let camera = sensor.intrinsics.filter(|_| sensor.value_kind != ValueKind::Disparity);
    assert_eq!(plane.metric.is_some(), camera.is_some() && plane.fit.is_some(), "{what}");
    let (Some(metric), Some(camera)) = (plane.metric, camera) else { return };
    let inverse_depth = |value: f64| match sensor.value_kind {
        ValueKind::Depth { metres } => 1.0 / (metres * value),
        ValueKind::InverseDepth { slope, offset } => slope * value + offset,
        ValueKind::Disparity => unreachable!("no metric planes"),
    };
    let pixels = (0..map.len()).filter(|&at| found.labels[at] == plane.label);
    let points: Vec<[f64; 3]> =
        pixels.map(|at| [(at % found.width) as f64, (at / found.width) as f64, inverse_depth(map[at])]).collect();
    let [a, b, c] = naive::fit(&points).expect("the metric plane has a fit").abc;
    let m = [a * camera.fx, b * camera.fy, c + a * camera.cx + b * camera.cy];
    let length = (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]).sqrt();
    let (normal, distance) = (m.map(|x| -x / length), 1.0 / length);
    let (mut squares, mut sum) = (0.0, [0.0; 3]);
    for [u, v, q] in &points {
        let point = [(u - camera.cx) / camera.fx / q, (v - camera.cy) / camera.fy / q, 1.0 / q];
        let off: f64 = (0..3).map(|k| normal[k] * point[k]).sum::<f64>() + distance;
        squares += off * off;
        (0..3).for_each(|k| sum[k] += point[k]);
    }
    let n = points.len() as f64;
    let size = sum[2] / n;
    for k in 0..3 {
        assert_near(metric.plane.normal[k], normal[k], 1e-7, what);
        assert_near(metric.centroid_m[k], sum[k] / n, 1e-9 * size, what);
    }
    assert_near(metric.plane.distance, distance, 1e-7 * distance, what);
    assert_near(metric.rms_m, (squares / n).sqrt(), 1e-7 * size, what);
    assert!(metric.covariance.iter().flatten().all(|x| x.is_finite()), "{what}");
}

fn sensors() -> [Sensor; 4] {
    let intrinsics = Intrinsics::new(90.0, -95.0, 40.0, 21.0).ok();
    let stereo = ValueKind::stereo(0.5, 90.0, 0.2, 3.0).unwrap();
    [
        Sensor::default(),
        Sensor::default().value_kind(ValueKind::Depth { metres: 0.02 }).intrinsics(intrinsics),
        Sensor::default().value_kind(stereo).intrinsics(intrinsics),
        Sensor::default().value_kind(ValueKind::Disparity).intrinsics(intrinsics),
    ]
}

fn random_params(random: &mut Random) -> Ngaf {
    let window = [0, 0, 3, 5, 9][random.below(5) as usize];
    let passes = 1 + random.below(3) as u32;
    Ngaf::default().theta(random.below(5) as f64).min_pixels(random.below(12) as u32).window(window).passes(passes)
}

/// Runs `test` on the same map as `u8`, `u16` times 50 and `f32` divided by 8.
fn as_each_type(bytes: &[u8], width: usize, height: usize, mut test: impl FnMut(AnyView<'_>, f64)) {
    let stride = bytes.len() / height;
    let wide: Vec<u16> = bytes.iter().map(|&value| u16::from(value) * 50).collect();
    let single: Vec<f32> =
        bytes.iter().map(|&value| if value == 0 { f32::NAN } else { f32::from(value) / 8.0 }).collect();
    test(DepthView::with_stride(bytes, width, height, stride).unwrap().missing_value(45).into(), 1.0);
    test(DepthView::with_stride(&wide, width, height, stride).unwrap().missing_value(2250).into(), 50.0);
    test(DepthView::with_stride(&single, width, height, stride).unwrap().valid_range(5.0, 29.0).unwrap().into(), 0.125);
}

#[test]
fn detections_on_random_maps_are_what_they_say() {
    let mut random = Random(71);
    for case in 0..1500 {
        let (width, height) = (1 + random.below(90) as usize, 1 + random.below(50) as usize);
        let bytes = naive::awkward_map(&mut random, width + case % 3, height);
        let params = random_params(&mut random);
        let sensor = sensors()[case % 4];
        as_each_type(&bytes, width, height, |view, unit| {
            let params = params.theta(params.theta * unit);
            let found = detect(params, sensor, view);
            check(&found, view, &params, sensor, &format!("case {case}, {width}x{height}, {params:?}"));
            let (map, _) = enhanced(&view, &params);
            let groups = naive::flood(&map, width, is_valid(&view), params.theta, !is_whole(&view));
            assert!(found.labels == naive::select(&groups, params.min_pixels as usize), "case {case}, {params:?}");
        });
    }
}

#[test]
fn detections_on_scenes_are_what_they_say() {
    for scene in SCENES {
        for sensor in ["clean", "clean_mm", "kinect_white", "tof_white", "disparity"] {
            let name = format!("{}:sensor={sensor},size=160x120", scene.name);
            let frame = name.parse::<Spec>().unwrap().frame().unwrap();
            let metres = if sensor == "clean" { 0.001 } else { 1.0 };
            for (theta, window) in [(2.0, 0), (30.0, 5)] {
                let params = Ngaf::default().theta(theta * metres).window(window).passes(2);
                let found = detect(params, frame.sensor, frame.view());
                check(&found, frame.view(), &params, frame.sensor, &name);
            }
        }
    }
}

/// Equal to the last bit, which == would not see in a 0 and a -0.
#[track_caller]
fn assert_same(given: &Detection, expected: &Detection, what: &str) {
    assert!(given.labels == expected.labels, "{what}: labels differ");
    assert_eq!(format!("{:?}", given.planes), format!("{:?}", expected.planes), "{what}");
    assert!(given == expected, "{what}");
}

#[test]
fn any_number_of_threads_gives_the_same_detection() {
    let mut random = Random(72);
    let mut maps = Vec::new();
    for _ in 0..150 {
        let (width, height) = (1 + random.below(200) as usize, 1 + random.below(200) as usize);
        maps.push((width, height, naive::awkward_map(&mut random, width, height)));
    }
    // Large enough to be cut into strips.
    for (width, height) in [(1300, 1000), (2000, 700), (30_000, 40), (3, 60_000), (1024, 2048)] {
        maps.push((width, height, naive::awkward_map(&mut random, width, height)));
        let slope = |at: usize| 20 + ((at % width + at / width) / 16 % 200) as u8;
        maps.push((width, height, (0..width * height).map(|at| slope(at) + (random.below(9) / 7) as u8).collect()));
    }
    for (width, height, map) in &maps {
        as_each_type(map, *width, *height, |view, unit| {
            let params = Ngaf::default().theta(unit).min_pixels(200).window(3).max_rms(90.0 * unit);
            let on = |threads: usize| {
                let mut detector = Detector::new(params).unwrap().sensor(sensors()[1]).threads(threads);
                detector.detect(view).unwrap().clone()
            };
            let expected = on(1);
            for threads in [0, 2, 4, 7] {
                assert_same(&on(threads), &expected, &format!("{threads} threads on {width}x{height}"));
            }
        });
    }
}

#[test]
fn a_used_detector_answers_like_a_fresh_one() {
    let mut random = Random(73);
    for sensor in sensors() {
        let params = Ngaf::default().theta(2.0).min_pixels(3).window(5).passes(2).min_fill(0.3);
        let mut used = Detector::new(params).unwrap().sensor(sensor).threads(2);
        for case in 0..300 {
            let (width, height) = match case % 60 {
                30 => (1100, 1000),
                _ => (1 + random.below(120) as usize, 1 + random.below(80) as usize),
            };
            let map = naive::awkward_map(&mut random, width, height);
            let kind = random.below(3);
            let mut types = 0..;
            as_each_type(&map, width, height, |view, _| {
                if types.next() == Some(kind) {
                    let expected = detect(params, sensor, view);
                    assert_same(used.detect(view).unwrap(), &expected, &format!("frame {case}, {width}x{height}"));
                }
            });
        }
    }
}

#[test]
fn a_detector_recovers_from_a_map_with_too_many_planes() {
    let params = Ngaf::default().min_pixels(0);
    let board: Vec<u8> = (0..400 * 400).map(|at| 1 + ((at % 400 + at / 400) % 2 * 100) as u8).collect();
    let mut detector = Detector::new(params).unwrap();
    let flat = [7u8; 30];
    let flat = DepthView::new(&flat, 6, 5).unwrap();
    for _ in 0..2 {
        assert!(detector.detect(DepthView::new(&board, 400, 400).unwrap()).is_err());
        assert_same(detector.detect(flat).unwrap(), &detect(params, Sensor::default(), flat.into()), "after the error");
    }
}

/// The labels that are left when some planes are dropped: the others move up.
fn without(labels: &[u16], keep: &[bool]) -> Vec<u16> {
    let mut kept = 0;
    let new: Vec<u16> = keep
        .iter()
        .map(|&keep| {
            kept += u16::from(keep);
            if keep { kept } else { 0 }
        })
        .collect();
    labels.iter().map(|&label| if label == 0 { 0 } else { new[usize::from(label) - 1] }).collect()
}

#[test]
fn own_conditions_drop_the_planes_that_the_table_says() {
    let mut random = Random(74);
    let (mut kept, mut dropped) = (0, 0);
    for case in 0..1500 {
        let (width, height) = (1 + random.below(60) as usize, 1 + random.below(40) as usize);
        let map = naive::awkward_map(&mut random, width, height);
        let view = DepthView::new(&map, width, height).unwrap();
        let plain = Ngaf::default().theta(random.below(6) as f64).min_pixels(random.below(9) as u32);
        let pick = |random: &mut Random, choices: [f64; 4]| choices[random.below(4) as usize];
        let params = plain
            .max_rms(pick(&mut random, [0.0, 0.05, 0.7, 2.0]) * (1.0 + 1e-6))
            .min_fill(pick(&mut random, [0.0, 0.25, 0.5, 1.0]))
            .margin(pick(&mut random, [0.0, 1.0, 3.0, 65_535.0]) as u32);
        let all = detect(plain, Sensor::default(), view.into());
        let values: Vec<f64> = map.iter().map(|&value| value.into()).collect();
        let margin = params.margin as usize;
        let is_inner = |at: usize| {
            let (u, v) = (at % width, at / width);
            u >= margin && v >= margin && u + margin < width && v + margin < height
        };
        let accepts = |(record, label): (&Record, u16)| {
            let [u_min, v_min, u_max, v_max] = record.bounding_box;
            let area = (u_max - u_min + 1) * (v_max - v_min + 1);
            let inner = (0..map.len()).filter(|&at| all.labels[at] == label && is_inner(at)).count();
            let flat = params.max_rms == 0.0 || record.fit.is_some_and(|fit| fit.rms <= params.max_rms);
            flat && record.pixel_count as f64 / area as f64 >= params.min_fill && inner > params.min_pixels as usize
        };
        let records = naive::records(&all.labels, &values, width);
        let keep: Vec<bool> = records.iter().zip(1..).map(accepts).collect();
        let found = detect(params, Sensor::default(), view.into());
        assert!(found.labels == without(&all.labels, &keep), "case {case}: {params:?}");
        check(&found, view.into(), &params, Sensor::default(), &format!("case {case}: {params:?}"));
        kept += found.planes.len();
        dropped += all.planes.len() - found.planes.len();
    }
    assert!(kept > 1000 && dropped > 1000, "{kept} kept, {dropped} dropped");
}

#[test]
fn conditions_off_are_no_conditions() {
    // A line has no fit; max-rms drops it, off does not. A ring fills little of its box.
    let line = [9u8; 40];
    let line = DepthView::new(&line, 40, 1).unwrap();
    let planes = |params: Ngaf, view: DepthView<'_, u8>| detect(params, Sensor::default(), view.into()).planes.len();
    assert_eq!(planes(Ngaf::default(), line), 1);
    assert_eq!(planes(Ngaf::default().max_rms(1e9), line), 0);
    assert_eq!(planes(Ngaf::default().min_fill(1.0), line), 1);
    let ring: Vec<u8> =
        (0..400).map(|at| u8::from([0, 19].contains(&(at % 20)) || [0, 19].contains(&(at / 20)))).collect();
    let ring = DepthView::new(&ring, 20, 20).unwrap();
    assert_eq!(planes(Ngaf::default().min_fill(76.0 / 400.0), ring), 1);
    assert_eq!(planes(Ngaf::default().min_fill(0.2), ring), 0);
    // All of the ring lies at the edge.
    assert_eq!(planes(Ngaf::default().margin(1).min_pixels(0), ring), 0);
}

/// Compares planes whose pixels all show one true plane with it; returns how many there were.
fn compare_with_truth(frame: &SceneFrame, found: &Detection, least_pixels: usize, what: &str) -> usize {
    let mut compared = 0;
    for plane in found.planes.iter().filter(|plane| plane.pixel_count >= least_pixels) {
        let side = plane.bounding_box;
        if side.u_max - side.u_min < 16 || side.v_max - side.v_min < 16 {
            continue;
        }
        let mut shown =
            (0..found.labels.len()).filter(|&at| found.labels[at] == plane.label).map(|at| frame.truth.labels[at]);
        let first = shown.next().expect("each label is used");
        if first == 0 || shown.any(|label| label != first) {
            continue;
        }
        let truth = frame.truth.planes[usize::from(first) - 1].plane;
        let metric = plane.metric.expect("the camera is known");
        let what = format!("{what}, plane {} of {} pixels", plane.label, plane.pixel_count);
        (0..3).for_each(|k| assert_near(metric.plane.normal[k], truth.normal[k], 1e-6, &what));
        assert_near(metric.plane.distance, truth.distance, 1e-6, &what);
        assert!(metric.rms_m < 1e-6, "{what}: {} m", metric.rms_m);
        compared += 1;
    }
    compared
}

#[test]
fn isolated_planes_of_clean_scenes_are_where_the_truth_says() {
    let mut compared = 0;
    for scene in ["planes3", "room", "boxes", "corridor"] {
        for seed in 1..10 {
            let name = format!("{scene}:seed={seed},sensor=clean,size=320x240");
            let frame = name.parse::<Spec>().unwrap().frame().unwrap();
            for theta in [0.002, 0.004, 0.008, 0.015, 0.03] {
                let found = detect(Ngaf::default().theta(theta), frame.sensor, frame.view());
                compared += compare_with_truth(&frame, &found, 300, &format!("{name}, theta {theta}"));
            }
        }
    }
    assert!(compared > 20, "{compared} planes");
}

#[test]
fn walls_facing_the_camera_are_found_at_their_distance() {
    let mut scene = Scene::default();
    for (k, y) in [1.5, 2.25, 3.0].into_iter().enumerate() {
        let x = k as f64 - 1.5;
        scene.facet(&[[x, y, 0.0], [x + 1.0, y, 0.0], [x + 1.0, y, 2.0], [x, y, 2.0]]);
    }
    let camera = Camera::kinect(320, 240, Pose::at_height(1.0, 0.0)).unwrap();
    let frame = render(&scene, &camera, SensorModel::Clean, 0).unwrap();
    let found = detect(Ngaf::default().theta(0.01), frame.sensor, frame.view());
    assert_eq!(found.planes.len(), 3);
    assert_eq!(compare_with_truth(&frame, &found, 1000, "walls"), 3);
    let mut distances: Vec<f64> = found.planes.iter().map(|plane| plane.metric.unwrap().plane.distance).collect();
    distances.sort_by(f64::total_cmp);
    distances.iter().zip([1.5, 2.25, 3.0]).for_each(|(&given, expected)| assert_near(given, expected, 1e-6, "walls"));
}

/// In disparity a plane has one slope throughout, so that theta isolates it however it is slanted.
#[test]
fn slanted_planes_are_exact_in_disparity() {
    let mut random = Random(75);
    let (width, height) = (200, 150);
    for case in 0..100 {
        let camera = Intrinsics::new(random.between(150.0, 300.0), random.between(150.0, 300.0), 100.0, 75.0).unwrap();
        let value_kind = ValueKind::stereo(1.0, camera.fx, 0.1, random.between(0.0, 5.0)).unwrap();
        let ValueKind::InverseDepth { slope, offset } = value_kind else { unreachable!("stereo is affine") };
        // Left and right half, well apart in disparity.
        let planes = [20.0, 60.0].map(|d| [random.between(-0.1, 0.1), random.between(-0.1, 0.1), d]);
        let disparity = |u: usize, v: usize| {
            let [a, b, c] = planes[usize::from(u >= 100)];
            a * (u as f64 - 100.0) + b * (v as f64 - 75.0) + c
        };
        let map: Vec<f32> = (0..width * height).map(|at| disparity(at % width, at / width) as f32).collect();
        let sensor = Sensor::default().value_kind(value_kind).intrinsics(Some(camera));
        let view = DepthView::new(&map, width, height).unwrap();
        let found = detect(Ngaf::default().theta(0.11), sensor, view.into());
        assert_eq!(found.planes.len(), 2, "case {case}");
        for (plane, [a, b, c]) in found.planes.iter().zip(planes) {
            let m = [slope * a * camera.fx, slope * b * camera.fy, slope * c + offset];
            let length = m.iter().map(|x| x * x).sum::<f64>().sqrt();
            let metric = plane.metric.unwrap();
            let what = format!("case {case}, plane {}", plane.label);
            (0..3).for_each(|k| assert_near(metric.plane.normal[k], -m[k] / length, 1e-6, &what));
            assert_near(metric.plane.distance, 1.0 / length, 1e-6, &what);
            assert_near(plane.fit.unwrap().gradient[0], a, 1e-6, &what);
            assert_near(plane.fit.unwrap().gradient[1], b, 1e-6, &what);
        }
    }
}

#[test]
fn values_behind_infinity_leave_a_plane_without_metric_values() {
    let map: Vec<f32> = (0..600).map(|at| 1.0 + (at % 30) as f32).collect();
    let view = DepthView::new(&map, 30, 20).unwrap();
    let intrinsics = Intrinsics::new(100.0, 100.0, 15.0, 10.0).ok();
    let at = |offset: f64| {
        let sensor =
            Sensor::default().value_kind(ValueKind::InverseDepth { slope: 0.1, offset }).intrinsics(intrinsics);
        detect(Ngaf::default(), sensor, view.into()).planes[0].metric.is_some()
    };
    assert!(at(-0.09) && !at(-0.1) && !at(-5.0));
}

#[test]
fn a_sensor_whose_numbers_mean_nothing_is_refused_however_it_was_made() {
    let map = [1000u16; 64];
    let view = DepthView::new(&map, 8, 8).unwrap();
    let camera = Intrinsics { fx: 0.0, fy: 50.0, cx: 4.0, cy: 4.0 };
    let wrong = [
        Sensor::default().value_kind(ValueKind::Depth { metres: -1.0 }),
        Sensor::default().value_kind(ValueKind::Depth { metres: f64::NAN }),
        Sensor::default().value_kind(ValueKind::InverseDepth { slope: 0.0, offset: 0.0 }),
        Sensor::default().value_kind(ValueKind::InverseDepth { slope: 1.0, offset: f64::INFINITY }),
        Sensor::default().intrinsics(camera),
        Sensor::default().intrinsics(Intrinsics { fx: 50.0, cx: f64::NAN, ..camera }),
        Sensor::default().intrinsics(Intrinsics { fx: 1e-9, ..camera }),
        Sensor::default().noise(SensorNoise::Depth { base: f64::NAN, growth: 0.0 }),
        Sensor::default().smooth_noise(SensorNoise::Depth { base: 0.0, growth: 1e30 }),
        Sensor::default().noise(SensorNoise::Value { sigma: -1.0 }),
    ];
    for sensor in wrong {
        let mut detector = Detector::default().sensor(sensor);
        let errors = [
            detector.detect(view).unwrap_err(),
            detector.explain(view, [1, 1]).unwrap_err(),
            depthplanes::describe_labels(view, &[1; 64], &sensor).unwrap_err(),
        ];
        assert!(
            errors.iter().all(|error| matches!(error, depthplanes::Error::Camera { .. })),
            "{sensor:?}: {errors:?}"
        );
    }
}
