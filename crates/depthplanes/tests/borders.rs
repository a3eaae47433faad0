//! Borders that do not flicker: by hand-made frames of which the answer is known, and by a naive version of the rule.

use depthplanes::scene::{SceneFrame, Walk};
use depthplanes::track::{CameraPose, Tracker};
use depthplanes::{
    DepthView, Detection, Detector, Error, HessianNormalForm, Intrinsics, Sensor, ValueKind, describe_labels,
};

const SIZE: [usize; 2] = [160, 120];
const AREA: usize = SIZE[0] * SIZE[1];

fn sensor() -> Sensor {
    let camera = Intrinsics::new(145.0, 145.0, 79.5, 59.5).unwrap();
    Sensor::default().value_kind(ValueKind::depth(0.001).unwrap()).intrinsics(camera)
}

/// A map of two walls, in millimetres, that meet in column 80, with errors of a few millimetres.
fn corner() -> Vec<u16> {
    let depth = |u: usize| if u < 80 { 2000 + u as u16 } else { 2080 - (u - 80) as u16 };
    (0..AREA).map(|at| depth(at % SIZE[0]) + ((7 * at + 11 * (at / SIZE[0])) % 5) as u16).collect()
}

fn view(map: &[u16]) -> DepthView<'_, u16> {
    DepthView::new(map, SIZE[0], SIZE[1]).unwrap()
}

/// Each pixel's label by its column; 0 where the map has no value.
fn found(map: &[u16], sensor: &Sensor, label: impl Fn(usize) -> u16) -> Detection {
    let labels: Vec<u16> =
        map.iter().enumerate().map(|(at, &mm)| if mm == 0 { 0 } else { label(at % SIZE[0]) }).collect();
    describe_labels(view(map), &labels, sensor).unwrap().0
}

/// The labels that are shown after frames whose walls meet in these columns.
fn shown(sensor: &Sensor, seams: &[usize]) -> Vec<u16> {
    let (map, mut tracker, mut labels) = (corner(), Tracker::default(), Vec::new());
    for &seam in seams {
        let found = found(&map, sensor, |u| 1 + u16::from(u >= seam));
        labels.clone_from(&tracker.track_with_map(view(&map), &found, sensor, None).unwrap().labels);
    }
    labels
}

/// The columns of the first row whose left neighbour has another label.
fn seams(labels: &[u16]) -> Vec<usize> {
    assert!(labels.chunks(SIZE[0]).all(|row| row == &labels[..SIZE[0]]), "all rows are alike");
    (1..SIZE[0]).filter(|&u| labels[u] != labels[u - 1]).collect()
}

#[test]
fn a_border_stays_where_it_was_as_long_as_its_pixels_lie_on_both_planes() {
    // Of a camera and of a map in units of its own alike.
    for sensor in [sensor(), Sensor::default()] {
        assert_eq!(seams(&shown(&sensor, &[80])), [80]);
        assert_eq!(seams(&shown(&sensor, &[80, 79, 81, 78, 80])), [80]);
        // The left wall was wrong from 70 on, where it is 20 mm before the right one.
        let labels = shown(&sensor, &[70, 80]);
        let left = labels.iter().filter(|&&label| label == labels[0]).count() as f64 / SIZE[1] as f64;
        assert!((72.0..79.0).contains(&left), "{left} columns of the left wall");
    }
}

#[test]
fn what_is_before_a_plane_now_is_none_of_it() {
    let (map, sensor, mut tracker) = (corner(), sensor(), Tracker::default());
    let whole = found(&map, &sensor, |u| 1 + u16::from(u >= 80));
    tracker.track_with_map(view(&map), &whole, &sensor, None).unwrap();
    // A hand, and a shadow beside it; the detector took some columns around them for no plane.
    let mut later = map.clone();
    for row in later.chunks_mut(SIZE[0]) {
        row[30..40].fill(900);
        row[40..45].fill(0);
    }
    let part = found(&later, &sensor, |u| if (26..50).contains(&u) { 0 } else { 1 + u16::from(u >= 80) });
    let tracks = tracker.track_with_map(view(&later), &part, &sensor, None).unwrap();
    assert_eq!(
        seams(&tracks.labels),
        [30, 45, 80],
        "the wall has its columns back, but for the hand's and the shadow's"
    );
}

#[test]
fn planes_have_nothing_back_that_they_do_not_touch() {
    let (map, sensor, mut tracker) = (corner(), sensor(), Tracker::default());
    let mut whole = |label: &dyn Fn(usize) -> u16| {
        let found = found(&map, &sensor, label);
        tracker.track_with_map(view(&map), &found, &sensor, None).unwrap().labels.clone()
    };
    whole(&|u| 1 + u16::from(u >= 80));
    // A piece of the left wall becomes a plane of its own, from border to border.
    let labels = whole(&|u| if u < 20 { 3 } else { 1 + u16::from(u >= 80) });
    assert_eq!(seams(&labels), [80], "it was all of the wall, and is");
    let labels = whole(&|u| {
        if u < 20 {
            3
        } else if u < 80 {
            2
        } else {
            1
        }
    });
    assert_eq!(seams(&labels), [80], "{:?}", seams(&labels));
}

#[test]
fn only_the_frame_before_counts() {
    let (map, sensor, mut tracker) = (corner(), sensor(), Tracker::default());
    let [first, second] = [80, 78].map(|seam| found(&map, &sensor, |u| 1 + u16::from(u >= seam)));
    let seam = |labels: &[u16]| seams(labels);
    tracker.track_with_map(view(&map), &first, &sensor, None).unwrap();
    assert!(tracker.track(&second, &sensor, None).unwrap().labels.is_empty());
    assert_eq!(tracker.track(&second, &sensor, None).unwrap().labels_of(&second), second.labels);
    // The map of the frame before last is no frame before.
    assert_eq!(seam(&tracker.track_with_map(view(&map), &second, &sensor, None).unwrap().labels), [78]);
    tracker.forget();
    assert_eq!(seam(&tracker.track_with_map(view(&map), &first, &sensor, None).unwrap().labels), [80]);
    // A frame of another size.
    let small = vec![2000u16; 64 * 48];
    let small_view = DepthView::new(&small, 64, 48).unwrap();
    let mut detector = Detector::default().sensor(sensor);
    let found = detector.detect(small_view).unwrap();
    assert_eq!(tracker.track_with_map(small_view, found, &sensor, None).unwrap().labels, found.labels);
    let error = tracker.track_with_map(view(&map), found, &sensor, None).unwrap_err();
    assert!(matches!(error, Error::Labels { given: 3072, pixels: 19200 }), "{error}");
}

/// A frame of a walk as it was shown.
struct Frame {
    labels: Vec<u16>,
    ids: Vec<u32>,
    pose: CameraPose,
}

/// Where a pixel of a plane was in the frame before: by its point on the plane, in double precision.
fn place_before(
    at: usize,
    width: usize,
    plane: &HessianNormalForm,
    camera: &Intrinsics,
    [now, before]: [&CameraPose; 2],
) -> Option<[f64; 2]> {
    let point = plane.point_at([(at % width) as f64, (at / width) as f64], camera)?;
    let turned = |k: usize| (0..3).map(|j| now.rotation()[k][j] * point[j]).sum::<f64>();
    let offset = [0, 1, 2].map(|k| turned(k) + now.translation_m()[k] - before.translation_m()[k]);
    let there = before.to_camera(offset);
    (there[2] > 0.0).then(|| camera.project(there))
}

#[test]
fn shown_labels_are_those_of_the_rule() {
    for spec in
        ["room:sensor=kinect,size=320x240", "boxes:sensor=azure,size=320x240", "stairs:sensor=realsense,size=320x240"]
    {
        let walk = Walk::new(spec.parse().unwrap(), 1.0);
        let (mut detector, mut tracker) = (Detector::default(), Tracker::default());
        let (mut before, mut changed): (Option<Frame>, usize) = (None, 0);
        for index in 0..6 {
            let (frame, pose) = (walk.frame(index).unwrap(), walk.pose(index).unwrap());
            detector.set_sensor(frame.sensor);
            let found = detector.detect(frame.view()).unwrap();
            let tracks = tracker.track_with_map(frame.view(), found, &frame.sensor, Some(&pose)).unwrap();
            if let Some(before) = &before {
                let kept = |at: usize, label: u16| may_have(at, label, &tracks.ids, found, &frame, &pose, before);
                let neighbours = |at: usize| {
                    let (u, v, width) = (at % found.width, at / found.width, found.width);
                    let all = [(u > 0, 1), (v > 0, width)].map(|(is_there, step)| is_there.then(|| at - step));
                    let more = [(u + 1 < width, 1), (v + 1 < found.height, width)];
                    all.into_iter().chain(more.map(|(is_there, step)| is_there.then(|| at + step))).flatten()
                };
                for at in 0..found.labels.len() {
                    let (own, shown) = (found.labels[at], tracks.labels[at]);
                    if own != shown {
                        changed += 1;
                        assert!(shown > 0 && kept(at, shown) != Some(false), "{spec} {index} {at}: {own} {shown}");
                        assert!(
                            neighbours(at).any(|other| [tracks.labels[other], found.labels[other]].contains(&shown)),
                            "{spec} {index} {at}"
                        );
                    } else {
                        for label in neighbours(at).map(|other| tracks.labels[other]).filter(|&label| label != own) {
                            assert!(kept(at, label) != Some(true), "{spec} {index} {at}: {own} and not {label}");
                        }
                    }
                }
            }
            before = Some(Frame { labels: tracks.labels.clone(), ids: tracks.ids.clone(), pose });
        }
        assert!(changed > 100, "{spec}: {changed}");
    }
}

/// Whether a plane may have a pixel; `None` where rounding decides.
fn may_have(
    at: usize,
    label: u16,
    ids: &[u32],
    found: &Detection,
    frame: &SceneFrame,
    pose: &CameraPose,
    before: &Frame,
) -> Option<bool> {
    let Some(metric) = found.plane(label).and_then(|plane| plane.metric) else { return Some(false) };
    let camera = frame.sensor.intrinsics.unwrap();
    let Some(place) = place_before(at, found.width, &metric.plane, &camera, [pose, &before.pose]) else {
        return Some(false);
    };
    let id = ids[usize::from(label) - 1];
    let was = |[u, v]: [f64; 2]| {
        let is_inside = u >= -0.5 && v >= -0.5 && u < found.width as f64 - 0.5 && v < found.height as f64 - 0.5;
        let place = is_inside.then(|| (v + 0.5) as usize * found.width + (u + 0.5) as usize);
        place
            .and_then(|place| before.labels[place].checked_sub(1))
            .is_some_and(|label| before.ids[usize::from(label)] == id)
    };
    const ROUNDING_PX: f64 = 0.01;
    let were: Vec<bool> = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]]
        .map(|[a, b]| was([place[0] + a * ROUNDING_PX, place[1] + b * ROUNDING_PX]))
        .into();
    let value = frame.value(at);
    if value == 0.0 || !were.contains(&true) {
        return Some(false);
    }
    let depth = frame.sensor.value_kind.depth_m(value).unwrap();
    let ray = camera.ray((at % found.width) as f64, (at / found.width) as f64);
    let off = (0..3).map(|k| metric.plane.normal[k] * ray[k] * depth).sum::<f64>() + metric.plane.distance;
    let ratio = off.abs() / (3.0 * metric.rms_m);
    if (ratio - 1.0).abs() < 1e-3 || were.contains(&false) { None } else { Some(ratio < 1.0) }
}
