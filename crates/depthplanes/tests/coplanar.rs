//! Joining coplanar planes, and the smallest plane in square metres.

use depthplanes::detection::MetricPlane;
use depthplanes::noise::SensorNoise;
use depthplanes::scene::{Camera, Place, Pose, Scene, SceneFrame, SensorModel, Spec, render};
use depthplanes::{Coplanar, Detection, Detector, Error, Ngaf, Planar, Sensor, ValueKind};

fn made(scene: &Scene, sensor: SensorModel) -> SceneFrame {
    let camera = Camera::kinect(320, 240, Pose::at_height(1.4, 12.0)).unwrap();
    render(scene, &camera, sensor, 7).unwrap()
}

fn wall(scene: &mut Scene, [left, right]: [f64; 2], y: f64) {
    scene.facet(&[[left, y, 0.0], [right, y, 0.0], [right, y, 3.0], [left, y, 3.0]]);
}

/// A wall seen on both sides of a column, and two table tops of one height before it, no floor.
fn hall() -> Scene {
    let mut scene = Scene::default();
    wall(&mut scene, [-3.0, 3.0], 3.5);
    scene.block(Place::at(0.1, 2.2), [-0.15, -0.15, -1.0], [0.15, 0.15, 3.0]);
    for x in [-0.8, 0.75] {
        scene.facet_at(
            Place::at(x, 2.2).raised(0.75),
            &[[-0.4, -0.3, 0.0], [0.4, -0.3, 0.0], [0.4, 0.3, 0.0], [-0.4, 0.3, 0.0]],
        );
    }
    scene
}

fn detector(frame: &SceneFrame) -> Detector {
    Detector::new(Planar::default()).unwrap().sensor(frame.sensor)
}

fn joined(frame: &SceneFrame, within: Coplanar) -> Detection {
    detector(frame).merge_coplanar(within).unwrap().detect(frame.view()).unwrap().clone()
}

fn degrees(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>().min(1.0).acos().to_degrees()
}

/// Labels of the joined for each label before; panics if the one is no coarsening of the other.
fn coarsening(before: &Detection, after: &Detection) -> Vec<u16> {
    let mut new = vec![None; before.planes.len() + 1];
    new[0] = Some(0);
    for (&old, &label) in before.labels.iter().zip(&after.labels) {
        assert_eq!(*new[usize::from(old)].get_or_insert(label), label, "label {old} was cut");
    }
    new.into_iter().map(|label| label.expect("every label has a pixel")).collect()
}

/// What holds for any detection that was joined.
fn check(before: &Detection, after: &Detection, within: Coplanar) {
    let new = coarsening(before, after);
    assert_eq!(after.labelled_pixels(), before.labelled_pixels());
    for (plane, label) in after.planes.iter().zip(1..) {
        assert_eq!(plane.label, label);
        assert_eq!(plane.pixel_count, after.labels.iter().filter(|&&l| l == label).count());
        let olds: Vec<u16> = (1..).zip(&new[1..]).filter(|&(_, &l)| l == label).map(|(old, _)| old).collect();
        let parts = after.parts_of(label);
        if olds.len() == 1 {
            assert!(parts.is_empty());
            let old = &before.planes[usize::from(olds[0]) - 1];
            let mut expected = old.clone();
            expected.label = label;
            assert_eq!(plane, &expected, "what is not joined is as it was");
            continue;
        }
        assert_eq!(parts.iter().map(|part| part.plane.label).collect::<Vec<_>>(), olds);
        for part in parts {
            assert_eq!((part.of, &part.plane), (label, &before.planes[usize::from(part.plane.label) - 1]));
            let mine = part.plane.metric.unwrap();
            assert!(parts.iter().all(|other| within.holds(&mine, &other.plane.metric.unwrap())), "complete linkage");
        }
    }
    let order = after.planes.windows(2).all(|pair| pair[0].pixel_count >= pair[1].pixel_count);
    assert!(order, "by decreasing pixel count");
    assert_eq!(after.parts_of(0), []);
}

#[test]
fn a_wall_behind_a_column_and_two_table_tops_become_one_plane_each() {
    let noise = SensorNoise::Depth { base: 0.0, growth: 1.425e-3 };
    for (sensor, noise) in
        [(SensorModel::CleanMm, None), (SensorModel::KinectV1White, Some(noise)), (SensorModel::TofWhite, None)]
    {
        let mut frame = made(&hall(), sensor);
        frame.sensor.noise = noise;
        let before = detector(&frame).detect(frame.view()).unwrap().clone();
        assert!(before.parts.is_empty(), "off unless it is asked for");
        let after = joined(&frame, Coplanar::default());
        check(&before, &after, Coplanar::default());
        let truth = |normal: [f64; 3]| {
            let of = |plane: &&depthplanes::scene::TruthPlane| degrees(plane.plane.normal, normal) < 1.0;
            frame.truth.planes.iter().find(of).unwrap().plane
        };
        let unions: Vec<_> = after.planes.iter().filter(|plane| !after.parts_of(plane.label).is_empty()).collect();
        assert_eq!(unions.len(), 2, "{sensor:?}: {:?}", after.parts);
        for union in unions {
            let (metric, parts) = (union.metric.unwrap(), after.parts_of(union.label));
            let right = truth(metric.plane.normal);
            let sigma = (0..4).map(|i| metric.covariance[i][i].sqrt()).fold(1e-4, f64::max);
            assert!((metric.plane.distance - right.distance).abs() < 4.0 * sigma, "{sensor:?}: {metric:?} {right:?}");
            for (found, right) in metric.plane.normal.iter().zip(right.normal) {
                assert!((found - right).abs() < 4.0 * sigma, "{sensor:?}: {metric:?} {right:?}");
            }
            let sum =
                |of: fn(&MetricPlane) -> f64| parts.iter().map(|part| of(part.plane.metric.as_ref().unwrap())).sum();
            let areas: f64 = sum(|metric| metric.area_m2.unwrap());
            assert!((metric.area_m2.unwrap() / areas - 1.0).abs() < 0.01, "{sensor:?}");
            assert_eq!(union.pixel_count, parts.iter().map(|part| part.plane.pixel_count).sum::<usize>());
            assert_eq!(union.bounding_box.u_min, parts.iter().map(|part| part.plane.bounding_box.u_min).min().unwrap());
            assert_eq!(union.bounding_box.u_max, parts.iter().map(|part| part.plane.bounding_box.u_max).max().unwrap());
            // Without noise the covariance is a bound of what rounding may do, and no sum of independent errors.
            let least = parts.iter().map(|part| part.plane.metric.unwrap().covariance[3][3]).fold(f64::MAX, f64::min);
            let is_better = metric.covariance[3][3] < least || sensor == SensorModel::CleanMm;
            assert!(is_better, "{sensor:?}: the union is known better than its parts");
        }
    }
}

#[test]
fn parallel_walls_ten_centimetres_apart_stay_two() {
    for sensor in [SensorModel::CleanMm, SensorModel::TofWhite] {
        let mut scene = Scene::default();
        wall(&mut scene, [-3.0, -0.2], 3.0);
        wall(&mut scene, [0.2, 3.0], 3.1);
        let frame = made(&scene, sensor);
        assert_eq!(joined(&frame, Coplanar::default()).planes.len(), 2, "{sensor:?}");
        let wide = joined(&frame, Coplanar::new(5.0, 0.3).unwrap());
        assert_eq!((wide.planes.len(), wide.parts.len()), (1, 2), "{sensor:?}");
    }
}

/// Ten facets around a wide cylinder, two degrees from each to the next, with gaps between.
#[test]
fn planes_that_turn_slowly_do_not_join_hand_in_hand() {
    let mut scene = Scene::default();
    for step in -5..5 {
        let place = Place { origin_m: [0.0, -2.0, 0.0], yaw_deg: f64::from(step) * 2.0 + 1.0 };
        let half = 4.0 * 0.8f64.to_radians();
        scene.facet_at(place, &[[-half, 4.0, 0.0], [half, 4.0, 0.0], [half, 4.0, 3.0], [-half, 4.0, 3.0]]);
    }
    let frame = made(&scene, SensorModel::Clean);
    let within = Coplanar::new(3.0, 0.1).unwrap();
    let (before, after) = (detector(&frame).detect(frame.view()).unwrap().clone(), joined(&frame, within));
    check(&before, &after, within);
    assert_eq!((before.planes.len(), after.planes.len()), (10, 5), "pairs, and not one plane of twenty degrees");
}

#[test]
fn joining_coarsens_the_labels_and_nothing_is_joined_within_nothing() {
    for seed in 0..12 {
        let sensor = ["kinect_white", "tof_white", "clean_mm"][seed % 3];
        let frame =
            format!("random:seed={seed},sensor={sensor},size=320x240").parse::<Spec>().unwrap().frame().unwrap();
        let before = detector(&frame).detect(frame.view()).unwrap().clone();
        for within in [Coplanar::default(), Coplanar::new(10.0, 0.1).unwrap(), Coplanar::new(90.0, 1e9).unwrap()] {
            check(&before, &joined(&frame, within), within);
        }
        if sensor != "clean_mm" {
            assert_eq!(joined(&frame, Coplanar::new(0.0, 0.0).unwrap()), before, "{seed}");
        }
    }
}

#[test]
fn every_method_joins_and_threads_and_repetition_change_no_byte() {
    let frame = "room:seed=2,sensor=tof_white".parse::<Spec>().unwrap().frame().unwrap();
    let ngaf = || Ngaf::default().theta(30.0).min_pixels(200).window(3).min_fill(0.1);
    let detectors: [&dyn Fn() -> Detector; 2] =
        [&|| Detector::new(Planar::default()).unwrap(), &|| Detector::new(ngaf()).unwrap()];
    for make in detectors {
        let mut one = make().sensor(frame.sensor).merge_coplanar(Coplanar::default()).unwrap();
        let mut two = make().sensor(frame.sensor).merge_coplanar(Coplanar::default()).unwrap().threads(2);
        let first = one.detect(frame.view()).unwrap().clone();
        check(make().sensor(frame.sensor).detect(frame.view()).unwrap(), &first, Coplanar::default());
        assert!(!first.parts.is_empty());
        assert_eq!(format!("{first:?}"), format!("{:?}", one.detect(frame.view()).unwrap()));
        assert_eq!(format!("{first:?}"), format!("{:?}", two.detect(frame.view()).unwrap()));
    }
}

#[test]
fn planes_smaller_than_an_area_leave_no_label() {
    let frame = "room:seed=2,sensor=tof_white,size=320x240".parse::<Spec>().unwrap().frame().unwrap();
    let find = |min_area: f64, within: Option<Coplanar>| {
        let detector = Detector::new(Planar::default().min_area(min_area)).unwrap().sensor(frame.sensor);
        let mut detector =
            within.into_iter().fold(detector, |detector, within| detector.merge_coplanar(within).unwrap());
        detector.detect(frame.view()).unwrap().clone()
    };
    for within in [None, Some(Coplanar::default())] {
        let all = find(0.0, within);
        let large = find(0.2, within);
        let area = |plane: &depthplanes::Plane| plane.metric.unwrap().area_m2.unwrap();
        let kept: Vec<&depthplanes::Plane> = all.planes.iter().filter(|plane| area(plane) >= 0.2).collect();
        assert!(!kept.is_empty() && kept.len() < all.planes.len());
        assert_eq!(kept.len(), large.planes.len());
        for ((plane, old), label) in large.planes.iter().zip(&kept).zip(1..) {
            let mut expected = (*old).clone();
            expected.label = label;
            assert_eq!(plane, &expected);
            assert!((0..all.labels.len()).all(|at| (all.labels[at] == old.label) == (large.labels[at] == label)));
            let parts = |found: &Detection, label| {
                found.parts_of(label).iter().map(|part| part.plane.clone()).collect::<Vec<_>>()
            };
            assert_eq!(parts(&large, label), parts(&all, old.label));
        }
        assert!(large.parts.iter().all(|part| part.of > 0));
        let mut none = all.clone();
        none.labels.fill(0);
        (none.planes, none.parts) = (vec![], vec![]);
        assert_eq!(find(1e6, within), none);
    }
}

#[test]
fn what_is_in_metres_needs_a_camera() {
    let map = [1000u16; 64];
    let view = depthplanes::DepthView::new(&map, 8, 8).unwrap();
    let rigless = Sensor::default().value_kind(ValueKind::Disparity);
    for (sensor, is_disparity) in [(Sensor::default(), false), (rigless, true)] {
        let mut join =
            Detector::new(Ngaf::default()).unwrap().sensor(sensor).merge_coplanar(Coplanar::default()).unwrap();
        assert_eq!(join.detect(view).unwrap_err(), Error::NotMetric { wants: "merge-coplanar", is_disparity });
        let mut large = Detector::new(Planar::default().min_area(0.1)).unwrap().sensor(sensor);
        assert_eq!(large.detect(view).unwrap_err(), Error::NotMetric { wants: "min-area", is_disparity });
    }
    for (angle, distance) in [(-1.0, 0.0), (91.0, 0.0), (f64::NAN, 0.0), (1.0, -0.1), (1.0, f64::INFINITY)] {
        assert!(matches!(Coplanar::new(angle, distance), Err(Error::Parameter { .. })));
    }
}

/// The truth plane that most of each found plane's pixels lie on, if that is more than half of them.
fn truths(frame: &SceneFrame, found: &Detection) -> Vec<Option<u16>> {
    let most = |plane: &depthplanes::Plane| {
        let mut counts = vec![0; frame.truth.planes.len() + 1];
        for (&truth, _) in frame.truth.labels.iter().zip(&found.labels).filter(|(_, label)| **label == plane.label) {
            counts[usize::from(truth)] += 1;
        }
        (1..=frame.truth.planes.len()).find(|&at| 2 * counts[at] > plane.pixel_count).map(|at| at as u16)
    };
    found.planes.iter().map(most).collect()
}

#[test]
fn pieces_of_one_plane_of_a_room_are_joined_and_others_are_nearly_coplanar() {
    let (mut together, mut same, mut apart, mut wrong) = (0, 0, 0, 0);
    for seed in 101..=110 {
        let frame = format!("room:seed={seed},sensor=tof_white").parse::<Spec>().unwrap().frame().unwrap();
        let detector = || Detector::new(Planar::default().min_pixels(300)).unwrap().sensor(frame.sensor);
        let before = detector().detect(frame.view()).unwrap().clone();
        let mut joining = detector().merge_coplanar(Coplanar::default()).unwrap();
        let new = coarsening(&before, joining.detect(frame.view()).unwrap());
        let truths = truths(&frame, &before);
        for a in 0..truths.len() {
            for b in 0..a {
                let (Some(of_a), Some(of_b)) = (truths[a], truths[b]) else { continue };
                let is_joined = new[a + 1] == new[b + 1];
                same += usize::from(of_a == of_b);
                together += usize::from(of_a == of_b && is_joined);
                apart += usize::from(of_a != of_b && is_joined);
                let [p, q] = [of_a, of_b].map(|label| frame.truth.planes[usize::from(label) - 1].plane);
                let middle = before.planes[b].metric.unwrap().centroid_m;
                let at = p.normal.iter().zip(middle).map(|(n, x)| n * x).sum::<f64>() + p.distance;
                wrong += usize::from(is_joined && (degrees(p.normal, q.normal) > 6.0 || at.abs() > 0.06));
            }
        }
    }
    println!("{together} of {same} pairs of one plane joined, {apart} of two planes, {wrong} of them wrong");
    assert!(100 * together >= 65 * same);
    // Two narrow planes that noise hides the crease of are one before, and look like a third.
    // It has been one; pieces that meet at up to 8 degrees without a step may be one that bows.
    assert!(wrong <= 2, "{wrong}");
}
