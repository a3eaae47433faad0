//! Synthetic scenes: is the truth true, and do the sensors err as they say?

use depthplanes::camera::ValueKind;
use depthplanes::scene::{
    Camera, Place, Pose, SCENES, SENSORS, Scene, SceneFrame, ScenePixels, SensorModel, Spec, Surface, render,
};
use proptest::prelude::*;

fn frame(spec: &str) -> SceneFrame {
    spec.parse::<Spec>().unwrap().frame().unwrap()
}

fn each_scene() -> impl Iterator<Item = (String, SceneFrame)> {
    SCENES.iter().flat_map(|scene| {
        (1..4).map(|seed| {
            let spec = format!("{}:seed={seed},sensor=clean,size=161x120", scene.name);
            (spec.clone(), frame(&spec))
        })
    })
}

fn point(frame: &SceneFrame, at: usize) -> [f64; 3] {
    let ray = frame.sensor.intrinsics.unwrap().ray((at % frame.width) as f64, (at / frame.width) as f64);
    ray.map(|r| r * frame.truth.depth_m[at])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A direction of the camera in the world, by rotation matrices and the platform's own sines.
fn to_world(pose: &Pose, direction: [f64; 3]) -> [f64; 3] {
    let [(sr, cr), (sp, cp), (sy, cy)] =
        [pose.roll_deg, pose.pitch_deg, pose.yaw_deg].map(|angle| angle.to_radians().sin_cos());
    let [x, y, z] = direction;
    let [right, down] = [cr * x - sr * y, sr * x + cr * y];
    let [forward, up] = [cp * z - sp * down, -sp * z - cp * down];
    [cy * right - sy * forward, sy * right + cy * forward, up]
}

#[test]
fn every_labelled_pixel_lies_on_its_plane() {
    for (name, frame) in each_scene() {
        for (at, &label) in frame.truth.labels.iter().enumerate().filter(|(_, label)| **label > 0) {
            let plane = frame.truth.planes[label as usize - 1].plane;
            let off = dot(plane.normal, point(&frame, at)) + plane.distance;
            assert!(off.abs() < 1e-9, "{name}: pixel {at} is {off} m off plane {label}");
        }
        for entry in &frame.truth.planes {
            assert!((dot(entry.plane.normal, entry.plane.normal) - 1.0).abs() < 1e-12);
            assert!(entry.plane.distance > 0.0);
        }
    }
}

#[test]
fn labels_follow_the_convention_of_detections() {
    for (name, frame) in each_scene() {
        for truth in [frame.truth.clone(), frame.truth.pieces(1)] {
            let first_and_count = |label: u16| {
                let mut pixels = (0..truth.labels.len()).filter(|&at| truth.labels[at] == label);
                let first = pixels.next().expect("each label is used");
                (first, 1 + pixels.count())
            };
            let mut before = (usize::MAX, 0);
            for (index, plane) in truth.planes.iter().enumerate() {
                assert_eq!(plane.label as usize, index + 1);
                let (first, count) = first_and_count(plane.label);
                assert_eq!(plane.pixel_count, count);
                assert!(count < before.0 || (count == before.0 && first > before.1), "{name}: plane {}", plane.label);
                before = (count, first);
            }
            assert!(truth.labels.iter().all(|&label| label as usize <= truth.planes.len()));
        }
    }
}

#[test]
fn curved_surfaces_have_no_label_and_are_where_they_are() {
    let mut curved = 0;
    for scene in SCENES {
        let staged = (scene.build)(5);
        let camera = Camera::kinect(160, 120, staged.pose).unwrap();
        let frame = render(&staged.scene, &camera, SensorModel::Clean, 0).unwrap();
        for (at, &number) in frame.truth.surfaces.iter().enumerate().filter(|(_, number)| **number > 0) {
            let [x, y, z] = to_world(&staged.pose, point(&frame, at));
            let [ox, oy, oz] = staged.pose.position_m;
            let seen = [x + ox, y + oy, z + oz];
            let (from, axis, radius) = match staged.scene.surfaces[number as usize - 1] {
                Surface::Ball { centre, radius } => (centre, [0.0; 3], radius),
                Surface::Cylinder { from, to, radius, .. } => {
                    let axis = sub(to, from);
                    let length = dot(axis, axis).sqrt();
                    (from, axis.map(|x| x / length), radius)
                }
                _ => continue,
            };
            let out = sub(seen, from);
            let along = dot(out, axis);
            let distance = (dot(out, out) - along * along).sqrt();
            assert!((distance - radius).abs() < 1e-9, "{}: pixel {at}", scene.name);
            assert_eq!(frame.truth.labels[at], 0);
            curved += 1;
        }
    }
    assert!(curved > 10_000);
}

/// Depth along one ray by Moeller and Trumbore's triangle test in world coordinates: nothing
/// shared with the library but the scene.
fn naive_depth(scene: &Scene, pose: &Pose, ray: [f64; 3]) -> f64 {
    let direction = to_world(pose, ray);
    let mut nearest = f64::INFINITY;
    for surface in &scene.surfaces {
        let Surface::Facet { parts } = surface else { panic!("only facets are compared") };
        for (part, i) in parts.iter().flat_map(|part| (2..part.len()).map(move |i| (part, i))) {
            let (ab, ac) = (sub(part[i - 1], part[0]), sub(part[i], part[0]));
            let p = cross(direction, ac);
            let determinant = dot(ab, p);
            let to_eye = sub(pose.position_m, part[0]);
            let q = cross(to_eye, ab);
            let (s, t) = (dot(to_eye, p) / determinant, dot(direction, q) / determinant);
            let z = dot(ac, q) / determinant;
            if s >= 0.0 && t >= 0.0 && s + t <= 1.0 && z > 0.0 {
                nearest = nearest.min(z);
            }
        }
    }
    if nearest.is_finite() { nearest } else { 0.0 }
}

#[test]
fn depth_matches_naive_triangles() {
    let mut differing = 0;
    for seed in 0..6 {
        for name in ["boxes", "planes3"] {
            let mut staged = (depthplanes::scene::find(name).unwrap().build)(seed);
            staged.pose.roll_deg += 11.0;
            staged.scene.stairs(Place::at(0.4, 1.6).turned(160.0), [0.5, 0.6, 0.5], 3);
            staged.scene.ramp(Place::at(-0.4, 1.3).turned(30.0), [0.5, 0.6, 0.5]);
            let camera = Camera::kinect(97, 73, staged.pose).unwrap();
            let truth = render(&staged.scene, &camera, SensorModel::Clean, 0).unwrap().truth;
            for at in 0..97 * 73 {
                let ray = camera.intrinsics.ray((at % 97) as f64, (at / 97) as f64);
                let naive = naive_depth(&staged.scene, &staged.pose, ray);
                differing += usize::from((truth.depth_m[at] - naive).abs() > 1e-9);
            }
        }
    }
    // Rays that graze an edge may fall to either side of it.
    assert!(differing <= 3, "{differing} pixels differ");
}

#[test]
fn a_facet_cut_in_two_is_one_plane_and_two_pieces() {
    let mut scene = Scene::default();
    scene.facet(&[[-9.0, 3.0, -9.0], [9.0, 3.0, -9.0], [9.0, 3.0, 9.0], [-9.0, 3.0, 9.0]]);
    scene.column([0.0, 2.0, -9.0], 0.1, 18.0);
    let camera = Camera::kinect(64, 48, Pose::at_height(1.0, 0.0)).unwrap();
    let truth = render(&scene, &camera, SensorModel::Clean, 0).unwrap().truth;
    assert_eq!(truth.planes.len(), 1);
    let pieces = truth.pieces(1);
    assert_eq!(pieces.planes.len(), 2);
    assert_eq!(pieces.planes[0].plane, truth.planes[0].plane);
    assert_eq!(pieces.planes.iter().map(|piece| piece.pixel_count).sum::<usize>(), truth.planes[0].pixel_count);
    assert_eq!(truth.curved_pixels() + truth.planes[0].pixel_count, 64 * 48);
    assert!(truth.pieces(64 * 48).planes.is_empty());
}

fn bytes(frame: &SceneFrame) -> Vec<u8> {
    let mut bytes: Vec<u8> = match &frame.pixels {
        ScenePixels::U8(pixels) => pixels.clone(),
        ScenePixels::U16(pixels) => pixels.iter().flat_map(|x| x.to_le_bytes()).collect(),
        ScenePixels::F32(pixels) => pixels.iter().flat_map(|x| x.to_le_bytes()).collect(),
    };
    bytes.extend(frame.truth.labels.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

#[test]
fn the_seed_alone_decides_every_byte() {
    for scene in SCENES {
        let of = |seed: u64| bytes(&frame(&format!("{}:seed={seed},sensor=kinect_white,size=80x60", scene.name)));
        assert_eq!(of(4), of(4), "{}", scene.name);
        assert_ne!(of(4), of(5), "{}", scene.name);
    }
}

/// The same bytes on every machine: FNV-1a over all scenes, for each sensor. A change of scene or
/// sensor changes it; a change of platform must not.
#[test]
fn all_frames_have_the_recorded_checksum() {
    let recorded = [
        ("clean", "13c45d3c8c528b30"),
        ("clean_mm", "dc16e53a281789b9"),
        ("kinect", "37be15833a6be8d4"),
        ("kinect2", "9d99fd08cd6a6dde"),
        ("azure", "1aaefc1dbb9b791f"),
        ("realsense", "355a37936106c1da"),
        ("stereo", "be34d079a388b685"),
        ("kinect_white", "96f069bd7b56b4bb"),
        ("tof_white", "59c152e7ad5cbd3d"),
        ("disparity", "58e017cbb7504819"),
    ];
    let found = SENSORS.iter().map(|sensor| {
        let mut hash = 0xCBF2_9CE4_8422_2325_u64;
        for scene in SCENES {
            let frame = frame(&format!("{}:seed=1,sensor={},size=128x96", scene.name, sensor.name));
            for byte in bytes(&frame) {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
            }
        }
        (sensor.name, format!("{hash:016x}"))
    });
    let recorded = recorded.map(|(sensor, hash)| (sensor, hash.to_string()));
    assert_eq!(found.collect::<Vec<_>>(), recorded);
}

/// Mean and standard deviation of `error(value, exact depth)` over the measured pixels of an
/// empty corner, a pixel away from its creases.
fn statistics(sensor: &str, error: impl Fn(f64, f64) -> f64) -> [f64; 2] {
    let frame = frame(&format!("planes3:sensor={sensor},size=640x480"));
    let labels = &frame.truth.labels;
    let inside = |at: &usize| {
        let (at, width) = (*at, frame.width);
        at > width && at + width + 1 < labels.len() && [1, width].iter().all(|d| labels[at - d] == labels[at + d])
    };
    let measured = (0..labels.len()).filter(inside).filter(|&at| frame.value(at) > 0.0);
    let errors: Vec<f64> = measured.map(|at| error(frame.value(at), frame.truth.depth_m[at])).collect();
    assert!(errors.len() > 250_000);
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let variance = errors.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / errors.len() as f64;
    [mean, variance.sqrt()]
}

#[test]
fn kinect_errs_by_a_sixteenth_of_a_pixel_and_rounds_to_an_eighth() {
    let f_b = 580.0 * 0.075;
    let [mean, sd] = statistics("kinect_white", |mm, z| f_b / (mm / 1000.0) - f_b / z);
    // Rounding to steps of 1/8 adds (1/8)^2 / 12 to the variance.
    let expected = (1.0f64 / 256.0 + 1.0 / 768.0).sqrt();
    assert!(mean.abs() < 0.002 && (sd / expected - 1.0).abs() < 0.03, "mean {mean}, sd {sd}, expected {expected}");
}

#[test]
fn tof_errs_as_its_formula_says() {
    let [mean, sd] = statistics("tof_white", |mm, z| (mm / 1000.0 - z) / (0.001 + 0.0013 * z * z));
    assert!(mean.abs() < 0.01 && (sd - 1.0).abs() < 0.02, "mean {mean}, sd {sd}");
}

/// A box before a wall, as wide as a hand, and the columns it spans in the middle row.
fn box_before_wall(sensor: SensorModel) -> (SceneFrame, Vec<usize>) {
    let mut scene = Scene::default();
    scene.facet(&[[-9.0, 3.0, -9.0], [9.0, 3.0, -9.0], [9.0, 3.0, 9.0], [-9.0, 3.0, 9.0]]);
    scene.block(Place::at(0.0, 1.0), [-0.15, 0.0, 0.0], [0.15, 0.02, 2.0]);
    let camera = Camera::kinect(640, 480, Pose::at_height(1.0, 0.0)).unwrap();
    let frame = render(&scene, &camera, sensor, 3).unwrap();
    let columns = (0..640).filter(|u| frame.truth.surfaces[240 * 640 + u] > 1).collect();
    (frame, columns)
}

#[test]
fn shadows_fall_to_the_left_of_near_things() {
    for (sensor, baseline_m) in [(SensorModel::KinectV1White, 0.075), (SensorModel::Disparity8, 0.1)] {
        let (frame, columns) = box_before_wall(sensor);
        let (left, right) = (columns[0], columns[columns.len() - 1]);
        let missing = |range: std::ops::Range<usize>| range.filter(|u| frame.value(240 * 640 + u) == 0.0).count();
        // The wall's points shift by f b (1/near - 1/far) less than the box's edge.
        let width = 580.0 * baseline_m * (1.0 - 1.0 / 3.0);
        let found = missing(left - 60..left) as f64;
        assert!((found - width).abs() < 4.0, "{sensor:?}: {found} missing, expected {width}");
        assert!(missing(right + 4..right + 80) == 0, "{sensor:?}");
    }
}

#[test]
fn disparities_round_to_half_a_unit() {
    for scene in SCENES {
        let frame = frame(&format!("{}:sensor=disparity,size=320x240", scene.name));
        let ValueKind::InverseDepth { slope, offset } = frame.sensor.value_kind else { panic!("disparity is affine") };
        assert_eq!(ValueKind::stereo(0.25, 290.0, 0.1, 0.0).unwrap(), ValueKind::InverseDepth { slope, offset });
        let mut measured = 0;
        for at in (0..320 * 240).filter(|&at| frame.value(at) > 0.0) {
            let exact = frame.sensor.value_kind.value(frame.truth.depth_m[at]).unwrap();
            assert!((frame.value(at) - exact).abs() <= 0.5 + 1e-9, "{}: pixel {at}", scene.name);
            measured += 1;
        }
        assert!(measured > 320 * 240 / 2, "{}: {measured}", scene.name);
    }
}

#[test]
fn clean_frames_are_exact() {
    let metres = frame("room:sensor=clean,size=200x150");
    let millimetres = frame("room:sensor=clean_mm,size=200x150");
    for (at, z) in metres.truth.depth_m.iter().enumerate() {
        assert_eq!(metres.value(at) as f32, *z as f32);
        assert!((millimetres.value(at) - 1000.0 * z).abs() <= 0.5 + 1e-9);
    }
    let measured = metres.measured_labels();
    assert_eq!(measured, metres.truth.labels, "a clean sensor misses nothing");
    let kinect = frame("room:size=200x150");
    assert!(kinect.measured_labels().iter().zip(&kinect.truth.labels).all(|(m, l)| m == l || *m == 0));
}

#[test]
fn degenerate_surfaces_are_never_seen() {
    let mut scene = Scene::default();
    scene.facet(&[]);
    scene.facet(&[[0.0, 2.0, 1.0]; 4]);
    scene.facet(&[[f64::NAN; 3], [1.0, 2.0, 0.0], [1.0, 2.0, 1.0]]);
    scene.facet(&[[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 5.0, 1.0]]); // seen edge on
    scene.ball([0.0, f64::NAN, 1.0], 1.0);
    scene.column([0.0, 2.0, 0.0], 0.2, 0.0);
    let camera = Camera::kinect(33, 25, Pose::at_height(1.0, 0.0)).unwrap();
    for sensor in SENSORS {
        let frame = render(&scene, &camera, sensor.model, 1).unwrap();
        assert!(frame.truth.surfaces.iter().all(|&surface| surface == 0), "{}", sensor.name);
        assert!((0..33 * 25).all(|at| frame.value(at) == 0.0));
        assert!(frame.truth.pieces(1).planes.is_empty());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_size_and_seed_makes_a_frame(
        scene in 0..SCENES.len(), sensor in 0..SENSORS.len(), seed: u64, width in 1usize..60, height in 1usize..60,
    ) {
        let (scene, sensor) = (SCENES[scene].name, SENSORS[sensor].name);
        let frame = frame(&format!("{scene}:seed={seed},sensor={sensor},size={width}x{height}"));
        prop_assert_eq!(frame.view().width() * frame.view().height(), frame.truth.labels.len());
        prop_assert_eq!(frame.truth.depth_m.len(), width * height);
    }

    #[test]
    fn any_text_is_a_spec_or_an_error(text in "[a-z]{0,8}:?[a-z0-9=x,:-]{0,30}") {
        if let Ok(spec) = text.parse::<Spec>() {
            prop_assert_eq!(spec.to_string().parse::<Spec>().unwrap(), spec);
        }
    }
}
