//! Planes keep their ids: by hand-made frames of which the answer is known, and by synthetic cameras that move.

use depthplanes::metrics::{Identity, IdentityFrame};
use depthplanes::scene::{Spec, Walk};
use depthplanes::track::{CameraPose, TrackState, Tracker, Tracks};
use depthplanes::{DepthView, Detection, Detector, Error, Intrinsics, Sensor, ValueKind, describe_labels};

const SIZE: [usize; 2] = [160, 120];

fn sensor() -> Sensor {
    let camera = Intrinsics::new(145.0, 145.0, 79.5, 59.5).unwrap();
    Sensor::default().value_kind(ValueKind::depth(0.001).unwrap()).intrinsics(camera)
}

/// Planes that face the camera: of each the columns and the depth in millimetres; the rest is missing.
fn frame(planes: &[([usize; 2], u16)]) -> Detection {
    let [width, height] = SIZE;
    let (mut depth, mut labels) = (vec![0u16; width * height], vec![0u16; width * height]);
    for (&([from, to], mm), label) in planes.iter().zip(1..) {
        for v in 10..height - 10 {
            for u in from..to {
                // Rounded values alone would have no noise at all.
                depth[v * width + u] = mm + ((7 * u + 11 * v) % 3) as u16;
                labels[v * width + u] = label;
            }
        }
    }
    describe_labels(DepthView::new(&depth, width, height).unwrap(), &labels, &sensor()).unwrap().0
}

fn track<'t>(tracker: &'t mut Tracker, planes: &[([usize; 2], u16)]) -> &'t Tracks {
    tracker.track(&frame(planes), &sensor(), None).unwrap()
}

#[test]
fn a_plane_that_was_hidden_gets_its_id_back_and_one_that_is_gone_does_not() {
    let (wall, door) = (([0, 70], 3000), ([80, 150], 2500));
    for (hidden, comes_back) in [(1, true), (10, true), (25, true), (31, false)] {
        let mut tracker = Tracker::default();
        for _ in 0..12 {
            assert_eq!(track(&mut tracker, &[wall, door]).ids, [1, 2]);
        }
        for unseen in 1..=hidden {
            let tracks = track(&mut tracker, &[wall]);
            assert_eq!(tracks.ids, [1]);
            if unseen <= 30 {
                let lost = tracks.plane(2).unwrap();
                assert_eq!((lost.state, lost.unseen, lost.label), (TrackState::Lost, unseen, None));
            } else {
                assert_eq!(tracks.plane(2), None);
            }
        }
        let ids = track(&mut tracker, &[wall, door]).ids.clone();
        assert_eq!(ids == [1, 2], comes_back, "{hidden} frames: {ids:?}");
        assert!(comes_back || ids == [1, 3], "an id is not given twice: {ids:?}");
    }
}

#[test]
fn what_is_seen_once_is_kept_for_ten_frames() {
    let (wall, speck) = (([0, 70], 3000), ([80, 150], 2500));
    for (hidden, id) in [(10, 2), (11, 3)] {
        let mut tracker = Tracker::default();
        track(&mut tracker, &[wall, speck]);
        (0..hidden).for_each(|_| drop(track(&mut tracker, &[wall]).clone()));
        assert_eq!(track(&mut tracker, &[wall, speck]).ids, [1, id]);
    }
}

#[test]
fn something_else_in_the_same_place_is_another_plane() {
    let wall = ([0, 70], 3000);
    let mut tracker = Tracker::default();
    (0..5).for_each(|_| drop(track(&mut tracker, &[wall, ([80, 150], 2500)]).clone()));
    track(&mut tracker, &[wall]);
    assert_eq!(track(&mut tracker, &[wall, ([80, 150], 1500)]).ids, [1, 3]);
}

#[test]
fn parts_that_join_go_on_as_the_older_one_and_get_their_ids_back_when_they_part() {
    let (left, right) = (([0, 60], 3000), ([60, 150], 3000));
    let mut tracker = Tracker::default();
    (0..4).for_each(|_| drop(track(&mut tracker, &[left]).clone()));
    for _ in 0..4 {
        let ids = track(&mut tracker, &[right, left]).ids.clone();
        assert_eq!(ids, [2, 1], "the larger one is the younger");
    }
    for _ in 0..3 {
        let tracks = track(&mut tracker, &[([0, 150], 3000)]);
        assert_eq!(tracks.ids, [1]);
        let part = tracks.plane(2).unwrap();
        assert_eq!((part.state, part.subsumed_by), (TrackState::Subsumed, Some(1)));
    }
    let tracks = track(&mut tracker, &[right, left]);
    assert_eq!(tracks.ids, [2, 1]);
    assert_eq!(tracks.plane(2).unwrap().subsumed_by, None);
}

#[test]
fn the_larger_part_of_what_splits_keeps_the_id_and_the_other_says_where_it_is_from() {
    let mut tracker = Tracker::default();
    (0..4).for_each(|_| drop(track(&mut tracker, &[([0, 150], 3000)]).clone()));
    let tracks = track(&mut tracker, &[([0, 90], 3000), ([94, 150], 3000)]);
    assert_eq!(tracks.ids, [1, 2]);
    let [whole, part] = [1, 2].map(|id| *tracks.plane(id).unwrap());
    assert_eq!((whole.state, whole.split_from), (TrackState::Tracked, None));
    assert_eq!((part.state, part.split_from), (TrackState::New, Some(1)));
    assert_eq!((whole.age, whole.seen, part.age, part.seen), (5, 5, 1, 1));
}

#[test]
fn a_frame_of_another_size_begins_anew_and_labels_that_are_not_a_frames_are_refused() {
    let mut tracker = Tracker::default();
    track(&mut tracker, &[([0, 150], 3000)]);
    let depth = vec![3000u16; 64 * 48];
    let mut detector = Detector::default().sensor(sensor());
    let found = detector.detect(DepthView::new(&depth, 64, 48).unwrap()).unwrap();
    assert_eq!(tracker.track(found, &sensor(), None).unwrap().ids, [2]);
    let mut wrong = found.clone();
    wrong.labels.pop();
    let error = tracker.track(&wrong, &sensor(), None).unwrap_err();
    assert!(matches!(error, Error::Labels { given: 3071, pixels: 3072 }), "{error}");
}

#[test]
fn planes_that_are_not_metric_are_followed_by_their_pixels() {
    let depth: Vec<u16> = (0..64 * 48).map(|at| if at % 64 < 30 { 1000 } else { 2000 }).collect();
    let (mut detector, mut tracker) = (Detector::default(), Tracker::default());
    for _ in 0..3 {
        let found = detector.detect(DepthView::new(&depth, 64, 48).unwrap()).unwrap();
        let tracks = tracker.track(found, &Sensor::default(), None).unwrap();
        assert_eq!(tracks.ids, [1, 2]);
        assert_eq!(tracks.planes[0].plane, None);
    }
}

/// How well a walk's planes keep their ids, with the poses or without.
fn identity(spec: &str, speed: f64, frames: u64, with_pose: bool) -> (Identity, Vec<Tracks>) {
    let walk = Walk::new(spec.parse::<Spec>().unwrap(), speed);
    let (mut detector, mut tracker, mut identity) = (Detector::default(), Tracker::default(), Identity::default());
    let (mut before, mut all) = (None, Vec::new());
    for index in 0..frames {
        let frame = walk.frame(index).unwrap();
        let pose: Option<CameraPose> = with_pose.then(|| walk.pose(index).unwrap());
        detector = detector.sensor(frame.sensor);
        let found = detector.detect(frame.view()).unwrap();
        let tracks = tracker.track_with_map(frame.view(), found, &frame.sensor, pose.as_ref()).unwrap();
        let spots =
            walk.same_spots((index, &frame), before.as_ref().map_or((index, &frame), |frame| (index - 1, frame)));
        let (surfaces, labels) = (&frame.truth.surfaces, &tracks.labels);
        identity.add(&IdentityFrame { surfaces, before: &spots.unwrap(), labels, ids: &tracks.ids }).unwrap();
        all.push(tracks.clone());
        before = Some(frame);
    }
    (identity, all)
}

/// Scenes, sensors, and the least share of planes and of points that keep their ids: a hundredth below what was measured.
const WALKS: [(&str, f64, f64); 8] = [
    ("room:sensor=kinect", 0.97, 0.965),
    ("stairs:sensor=kinect", 0.985, 0.99),
    ("boxes:sensor=kinect", 0.99, 0.99),
    ("corridor:sensor=kinect", 0.99, 0.99),
    ("room:sensor=kinect2", 0.94, 0.95),
    ("room:sensor=azure", 0.965, 0.94),
    ("room:sensor=realsense", 0.91, 0.955),
    ("room:sensor=stereo", 0.98, 0.985),
];

#[test]
fn ids_are_kept_while_the_camera_moves_with_its_pose_or_without() {
    let (mut misses, mut means, mut all_switches) = (Vec::new(), [0.0; 2], [0; 2]);
    for (spec, planes, points) in WALKS {
        for with_pose in [true, false] {
            let (found, _) = identity(spec, 1.0, 12, with_pose);
            let kept = [found.matched_planes().unwrap(), found.matched_points().unwrap()];
            let Identity { switches, plane_frames, .. } = found;
            println!(
                "{spec}, pose {with_pose}: planes {:.3}, points {:.3}, {switches} of {plane_frames}",
                kept[0], kept[1]
            );
            if kept[0] < planes || kept[1] < points || found.expected_planes < 100 {
                misses.push((spec, with_pose, kept));
            }
            means = [0, 1].map(|at| means[at] + kept[at] / (2 * WALKS.len()) as f64);
            all_switches = [all_switches[0] + switches, all_switches[1] + plane_frames];
        }
    }
    println!("mean: planes {:.3}, points {:.3}, {} of {}", means[0], means[1], all_switches[0], all_switches[1]);
    assert!(misses.is_empty(), "{misses:?}");
    assert!(means[0] >= 0.97 && means[1] >= 0.98, "{means:?}");
    // The aim is one of 200; this holds what there is.
    assert!(120 * all_switches[0] <= all_switches[1], "{all_switches:?}");
}

#[test]
fn the_same_frames_give_the_same_tracks() {
    let (_, first) = identity("room:sensor=kinect,size=160x120", 2.0, 8, false);
    let (_, again) = identity("room:sensor=kinect,size=160x120", 2.0, 8, false);
    assert!(first == again && first.len() == 8);
}

#[test]
fn at_rest_filtered_planes_tremble_less_than_those_of_single_frames() {
    let walk = Walk::new("planes3:sensor=kinect_white,size=320x240".parse().unwrap(), 0.0);
    let (mut detector, mut tracker) = (Detector::default(), Tracker::default());
    let (mut single, mut filtered, mut variance) = (Vec::new(), Vec::new(), [0.0; 2]);
    for index in 0..40 {
        let frame = walk.frame(index).unwrap();
        detector = detector.sensor(frame.sensor);
        let found = detector.detect(frame.view()).unwrap();
        let tracks = tracker.track(found, &frame.sensor, None).unwrap();
        if index >= 10 {
            let (metric, track) = (found.planes[0].metric.unwrap(), tracks.plane(tracks.ids[0]).unwrap());
            single.push(metric.plane.distance);
            filtered.push(track.plane.unwrap().distance);
            variance = [metric.covariance[3][3], track.covariance[3][3]];
        }
    }
    let steps = |values: &[f64]| values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>();
    let [single, filtered] = [single, filtered].map(|values| steps(&values));
    assert!(filtered < 0.1 * single, "squared steps: {filtered} filtered, {single} of single frames");
    assert!(variance[1] < 0.5 * variance[0], "{variance:?}");
}
