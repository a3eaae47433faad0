//! The floor and what stands on it, in synthetic scenes where the truth is known.

use depthplanes::ground::{Floor, Ground, GroundFinder, PlaneClass, Up};
use depthplanes::scene::{Camera, Place, Pose, Random, Scene, SceneFrame, SensorModel, Spec, render};
use depthplanes::{DepthView, Detector, Error, Intrinsics, Sensor};

/// The sensors whose numbers are depth or disparity of a known rig, with real errors.
const SENSORS: [&str; 5] = ["kinect", "kinect2", "azure", "realsense", "stereo"];

fn ground_by(finder: GroundFinder, frame: &SceneFrame) -> Ground {
    let mut detector = Detector::default().sensor(frame.sensor);
    let found = detector.detect(frame.view()).unwrap();
    let mut finder = finder;
    finder.find(frame.view(), found, &frame.sensor).unwrap().clone()
}

fn ground_of(frame: &SceneFrame) -> Ground {
    ground_by(GroundFinder::default(), frame)
}

/// Up in the camera's coordinates, by its pose.
fn up_of(pose: Pose) -> [f64; 3] {
    let ([pitch_sin, pitch_cos], [roll_sin, roll_cos]) = (sin_cos(pose.pitch_deg), sin_cos(pose.roll_deg));
    [-pitch_cos * roll_sin, -pitch_cos * roll_cos, -pitch_sin]
}

fn sin_cos(degrees: f64) -> [f64; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    [sine, cosine]
}

/// An empty hall with a back wall, 4 m away.
fn hall() -> Scene {
    let mut scene = Scene::default();
    scene.facet(&[[-4.0, -1.0, 0.0], [4.0, -1.0, 0.0], [4.0, 4.0, 0.0], [-4.0, 4.0, 0.0]]);
    scene.facet(&[[-4.0, 4.0, 0.0], [4.0, 4.0, 0.0], [4.0, 4.0, 4.0], [-4.0, 4.0, 4.0]]);
    scene
}

fn seen_by(sensor: &str, scene: &Scene, pose: Pose, seed: u64) -> SceneFrame {
    let camera = Camera::kinect(640, 480, pose).unwrap();
    render(scene, &camera, SensorModel::find(sensor).unwrap(), seed).unwrap()
}

/// What is off: metres of height, degrees of tilt and of roll.
fn errors(floor: &Floor, pose: Pose) -> [f64; 3] {
    [floor.height_m - pose.position_m[2], floor.tilt_deg - pose.pitch_deg, floor.roll_deg - pose.roll_deg]
}

#[test]
fn height_tilt_and_roll_are_the_cameras_in_robot_scenes_of_every_sensor() {
    let mut random = Random::new(5);
    let (mut frames, mut squares) = (0.0, [0.0; 3]);
    for sensor in SENSORS {
        for seed in 0..6 {
            let pose = Pose {
                roll_deg: random.between(-5.0, 5.0),
                yaw_deg: random.between(-10.0, 10.0),
                ..Pose::at_height(random.between(0.25, 0.9), random.between(12.0, 40.0))
            };
            let mut scene = hall();
            scene.block(Place::at(random.between(-0.8, 0.8), 2.2).turned(20.0), [-0.2, -0.2, 0.0], [0.2, 0.2, 0.3]);
            let ground = ground_of(&seen_by(sensor, &scene, pose, seed));
            let floor = ground.floor.unwrap_or_else(|| panic!("{sensor} {pose:?}: no floor"));
            let [height, tilt, roll] = errors(&floor, pose);
            let told = format!("{sensor} {pose:?} {floor:?}");
            assert!(height.abs() < 0.01 && tilt.abs() < 0.5 && roll.abs() < 0.5, "{height} {tilt} {roll}: {told}");
            assert!(floor.confidence > 0.5, "{told}");
            frames += 1.0;
            let sds = [floor.height_sd_m, floor.tilt_sd_deg, floor.roll_sd_deg];
            for ((square, error), sd) in squares.iter_mut().zip([height, tilt, roll]).zip(sds) {
                assert!(error.abs() < 5.0 * sd, "{error} is more than {sd} allows: {told}");
                *square += (error / sd).powi(2);
            }
        }
    }
    for mean in squares.map(|square| square / frames) {
        assert!((0.02..2.0).contains(&mean), "errors in standard deviations have the mean square {mean}");
    }
}

#[test]
fn the_floor_is_found_in_random_rooms_and_what_is_stated_of_up_changes_nothing() {
    let (mut shown, mut right_ones) = (0, 0);
    for seed in 0..30 {
        let spec: Spec = format!("random:seed={seed},sensor=kinect,size=320x240").parse().unwrap();
        let (frame, pose) = (spec.frame().unwrap(), (spec.scene.build)(seed).pose);
        let up = up_of(pose);
        let is_floor = |normal: [f64; 3]| normal.iter().zip(up).map(|(a, b)| a * b).sum::<f64>() > 0.9999;
        let height = |distance: f64| (distance - pose.position_m[2]).abs() < 1e-6;
        let true_floor =
            frame.truth.planes.iter().find(|of| is_floor(of.plane.normal) && height(of.plane.distance)).unwrap();
        if true_floor.pixel_count < 320 * 240 / 20 {
            continue;
        }
        shown += 1;
        let estimated = ground_of(&frame);
        let known = ground_by(GroundFinder::default().up(Up::known(up).unwrap()), &frame);
        let label = |ground: &Ground| ground.floor.as_ref().map(|floor| floor.label);
        assert_eq!(label(&estimated), label(&known), "seed {seed}");
        let floor = known.floor.unwrap();
        let found = Detector::default().sensor(frame.sensor).detect(frame.view()).unwrap().clone();
        // Of the pixels of the floor's pieces, those that are floor.
        let called = found.labels.iter().zip(&frame.truth.labels).filter(|(label, _)| floor.labels.contains(label));
        let right = called.filter(|&(_, &label)| label == true_floor.label).count();
        right_ones += usize::from(right as f64 > 0.9 * floor.pixel_count as f64);
        let [height, tilt, _] = errors(&floor, pose);
        let told = format!("seed {seed} {pose:?} {floor:?}");
        assert!(height.abs() < 5.0 * floor.height_sd_m && tilt.abs() < 5.0 * floor.tilt_sd_deg, "{told}");
    }
    assert!(shown > 15 && right_ones >= shown - 1, "{right_ones} of {shown}");
}

#[test]
fn a_floor_in_pieces_is_one_floor_and_a_larger_wall_is_none() {
    // A beam across the floor hides the middle of it; the wall fills most of the picture.
    let mut scene = hall();
    scene.block(Place::at(0.0, 2.0), [-4.0, 0.0, 0.0], [4.0, 0.1, 0.25]);
    let pose = Pose::at_height(0.6, 2.0);
    let ground = ground_of(&seen_by("kinect", &scene, pose, 1));
    let floor = ground.floor.unwrap();
    assert!(floor.labels.len() >= 2, "{floor:?}");
    assert_eq!(ground.planes[0].class, PlaneClass::Wall);
    assert!(!floor.labels.contains(&1));
    let [height, tilt, _] = errors(&floor, pose);
    assert!(height.abs() < 0.01 && tilt.abs() < 0.5, "{floor:?}");
}

#[test]
fn every_class_is_told() {
    let mut scene = hall();
    scene.facet(&[[-4.0, -1.0, 2.4], [4.0, -1.0, 2.4], [4.0, 4.0, 2.4], [-4.0, 4.0, 2.4]]);
    scene.block(Place::at(-0.9, 2.4), [-0.4, -0.3, 0.7], [0.4, 0.3, 0.74]); // a table
    scene.block(Place::at(0.0, 3.0), [-0.3, -0.2, 0.0], [0.3, 0.2, 0.17]); // a step
    scene.ramp(Place::at(1.0, 2.5), [0.8, 1.2, 0.3]);
    let ground = ground_of(&seen_by("clean", &scene, Pose::at_height(1.3, 0.0), 1));
    let is_there = |class: PlaneClass, height: f64| {
        let near = |of: f64| (of - height).abs() < 0.02;
        ground.planes.iter().any(|plane| plane.class == class && plane.height_m.is_some_and(near))
    };
    assert!(is_there(PlaneClass::Floor, 0.0), "{:?}", ground.planes);
    assert!(is_there(PlaneClass::Ceiling, 2.4), "{:?}", ground.planes);
    assert!(is_there(PlaneClass::Table, 0.74), "{:?}", ground.planes);
    assert!(is_there(PlaneClass::Step, 0.17), "{:?}", ground.planes);
    for class in [PlaneClass::Wall, PlaneClass::Ramp] {
        assert!(ground.planes.iter().any(|plane| plane.class == class), "{class:?}: {:?}", ground.planes);
    }
}

#[test]
fn small_boxes_are_obstacles_where_they_stand_and_a_free_floor_has_none() {
    let (mut boxes, mut found, mut free, mut blocked) = (0, 0, 0, 0);
    for sensor in SENSORS {
        for seed in 0..4 {
            let mut random = Random::new(seed);
            let pose = Pose::at_height(random.between(0.4, 0.8), random.between(18.0, 28.0));
            let [x, y] = [random.between(-0.4, 0.4), random.between(1.6, 2.0)];
            let mut scene = hall();
            scene.block(Place::at(x, y), [-0.05, -0.05, 0.0], [0.05, 0.05, 0.05]);
            let ground = ground_of(&seen_by(sensor, &scene, pose, seed));
            boxes += 1;
            let bearing = x.atan2(y - 0.05).to_degrees();
            let is_it = |of: &&depthplanes::ground::Obstacle| {
                (of.distance_m - x.hypot(y - 0.05)).abs() < 0.1
                    && (of.bearing_deg - bearing).abs() < 5.0
                    && of.height_m < 0.1
            };
            found += usize::from(ground.obstacles.iter().any(|of| is_it(&of)));
            // Without the box nothing is in the way before the wall.
            let ground = ground_of(&seen_by(sensor, &hall(), pose, seed));
            for sector in &ground.sectors {
                free += 1;
                blocked += usize::from(sector.is_blocked && sector.free_m < 2.5);
            }
        }
    }
    assert!(found as f64 >= 0.95 * boxes as f64, "{found} of {boxes} boxes");
    assert!(blocked as f64 <= 0.01 * free as f64, "{blocked} of {free} sectors");
}

#[test]
fn a_hole_is_a_drop_at_its_near_edge() {
    let mut scene = Scene::default();
    // Floor on all sides of a hole of 1 m, 0.5 m deep.
    for [x0, x1, y0, y1] in
        [[-4.0, -0.5, -1.0, 9.0], [0.5, 4.0, -1.0, 9.0], [-0.5, 0.5, -1.0, 1.6], [-0.5, 0.5, 2.6, 9.0]]
    {
        scene.facet(&[[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]]);
    }
    scene.block(Place::at(0.0, 2.1), [-0.5, -0.5, -0.5], [0.5, 0.5, -0.5]);
    scene.facet(&[[-0.5, 2.6, -0.5], [0.5, 2.6, -0.5], [0.5, 2.6, 0.0], [-0.5, 2.6, 0.0]]);
    let finder = GroundFinder::default().camera_height_m(1.0).unwrap();
    let ground = ground_by(finder, &seen_by("kinect2", &scene, Pose::at_height(1.0, 28.0), 1));
    let drop = ground.obstacles.iter().find(|of| of.is_drop).unwrap();
    assert!((drop.distance_m - 1.6).abs() < 0.08 && drop.bearing_deg.abs() < 20.0, "{drop:?}");
    assert!((drop.width_m - 1.0).abs() < 0.15 && drop.height_m < -0.25, "{drop:?}");
    let ahead = ground.sectors.iter().find(|sector| sector.to_deg > 0.0).unwrap();
    assert!(ahead.is_blocked && (ahead.free_m - 1.6).abs() < 0.1, "{ahead:?}");
}

#[test]
fn steps_have_the_rise_and_run_of_the_stair() {
    let mut scene = hall();
    scene.stairs(Place::at(0.0, 1.0), [1.0, 1.2, 0.68], 4); // 30 cm run, 17 cm rise
    for sensor in ["clean_mm", "kinect2", "azure"] {
        let ground = ground_of(&seen_by(sensor, &scene, Pose::at_height(1.2, 32.0), 1));
        assert!(ground.steps.len() >= 4, "{sensor}: {:?}", ground.steps);
        for (order, step) in (1..).zip(&ground.steps[..4]) {
            assert_eq!(step.order, order);
            let within = if sensor == "clean_mm" { 0.003 } else { 0.02 };
            assert!((step.rise_m - 0.17).abs() < within, "{sensor}: {step:?}");
            assert!(step.run_m.is_none_or(|run| (run - 0.3).abs() < 0.03), "{sensor}: {step:?}");
        }
    }
}

#[test]
fn a_wall_alone_is_no_floor() {
    let mut scene = Scene::default();
    scene.facet(&[[-9.0, 2.0, -9.0], [9.0, 2.0, -9.0], [9.0, 2.0, 9.0], [-9.0, 2.0, 9.0]]);
    for pitch in [0.0, 20.0] {
        let ground = ground_of(&seen_by("kinect", &scene, Pose::at_height(1.0, pitch), 1));
        assert_eq!(ground, Ground::default());
    }
}

#[test]
fn a_camera_that_looks_straight_down_needs_to_be_told_what_is_up() {
    let pose = Pose::at_height(1.2, 88.0);
    let frame = seen_by("kinect", &hall(), pose, 1);
    assert_eq!(ground_of(&frame).floor, None);
    let known = ground_by(GroundFinder::default().up(Up::known(up_of(pose)).unwrap()), &frame);
    let floor = known.floor.unwrap();
    assert!((floor.height_m - 1.2).abs() < 0.01 && (floor.tilt_deg - 88.0).abs() < 0.5, "{floor:?}");
}

#[test]
fn of_two_levels_the_lower_is_the_floor_unless_the_cameras_height_says_otherwise() {
    // A landing, and a floor half a metre below it.
    let mut scene = Scene::default();
    scene.facet(&[[-2.0, -1.0, 0.0], [2.0, -1.0, 0.0], [2.0, 1.8, 0.0], [-2.0, 1.8, 0.0]]);
    scene.facet(&[[-2.0, 1.8, -0.5], [2.0, 1.8, -0.5], [2.0, 5.0, -0.5], [-2.0, 5.0, -0.5]]);
    let frame = seen_by("kinect", &scene, Pose::at_height(1.0, 30.0), 1);
    let height = |finder: GroundFinder| ground_by(finder, &frame).floor.unwrap().height_m;
    assert!((height(GroundFinder::default()) - 1.5).abs() < 0.05);
    assert!((height(GroundFinder::default().camera_height_m(0.95).unwrap()) - 1.0).abs() < 0.02);
}

#[test]
fn a_picture_whose_y_axis_points_up_has_the_same_floor() {
    let frame = seen_by("clean", &hall(), Pose { roll_deg: 4.0, ..Pose::at_height(1.0, 25.0) }, 1);
    let camera = frame.sensor.intrinsics.unwrap();
    let mut flipped = frame.clone();
    flipped.sensor = frame.sensor.intrinsics(Intrinsics::new(camera.fx, -camera.fy, camera.cx, camera.cy).unwrap());
    let [a, b] = [&frame, &flipped].map(|frame| ground_of(frame).floor.unwrap());
    for (a, b) in [(a.height_m, b.height_m), (a.tilt_deg, b.tilt_deg), (a.roll_deg, b.roll_deg)] {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
    for (a, b) in [(a.tilt_sd_deg, b.tilt_sd_deg), (a.roll_sd_deg, b.roll_sd_deg)] {
        assert!((a - b).abs() < 1e-3 * a, "{a} {b}");
    }
}

#[test]
fn what_is_no_direction_no_height_and_no_camera_is_refused() {
    for wrong in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
        let message = Up::known(wrong).unwrap_err().to_string();
        assert!(message.starts_with("`up` is `") && message.contains("0,-1,0 of a level camera"), "{message}");
    }
    assert_eq!(Up::known([0.0, -9.81, 0.0]).unwrap(), Up::Known([0.0, -1.0, 0.0]));
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(GroundFinder::default().camera_height_m(wrong).is_err(), "{wrong}");
    }
    let found = depthplanes::Detection::default();
    let map = DepthView::new(&[1000u16; 12], 4, 3).unwrap();
    let error = GroundFinder::default().find(map, &found, &Sensor::default()).unwrap_err();
    assert_eq!(error, Error::Labels { given: 0, pixels: 12 });
    let found = Detector::default().detect(map).unwrap().clone();
    let error = GroundFinder::default().find(map, &found, &Sensor::default()).unwrap_err();
    assert_eq!(error, Error::NotMetric { wants: "floor", is_disparity: false });
}
