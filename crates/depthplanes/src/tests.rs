//! `planar` as a whole on each instruction set: a test that needs what the crate hides.

use crate::camera::ValueKind;
use crate::detection::Detection;
use crate::detector::Detector;
use crate::map::DepthView;
use crate::methods::Planar;
use crate::scene::{Random, SceneFrame, Spec};
use crate::sensor::Sensor;
use crate::util::simd::with_each_level;

/// Depth and disparity, of one, two and four bytes; one map of several parts and strips.
const SCENES: [&str; 6] = [
    "room:sensor=kinect_white,size=320x240",
    "curved:sensor=tof_white,size=320x240",
    "random:sensor=disparity,size=321x203",
    "random:sensor=clean,size=320x240",
    "stairs:sensor=clean_mm,size=320x240",
    "random:sensor=kinect_white,size=1024x768",
];

fn on(frame: &SceneFrame, threads: usize) -> Detection {
    let mut detector = Detector::default().sensor(frame.sensor).threads(threads).curved(true);
    detector.detect(frame.view()).unwrap();
    detector.detect(frame.view()).unwrap().clone()
}

#[test]
fn kernels_threads_and_repetition_change_no_byte() {
    for scene in SCENES {
        let frame = scene.parse::<Spec>().unwrap().frame().unwrap();
        let expected = on(&frame, 1);
        assert!(!expected.planes.is_empty(), "{scene}");
        // Written out, numbers differ if they differ in a bit.
        let expected = format!("{expected:?}");
        let mut kernels = 0;
        with_each_level(|kernel| {
            for threads in [1, 2, 4] {
                assert!(format!("{:?}", on(&frame, threads)) == expected, "{scene}, {kernel}, {threads} threads");
            }
            kernels += 1;
        });
        assert!(kernels >= 1);
    }
}

#[test]
fn an_estimated_lateral_noise_is_the_same_on_each_kernel_and_any_number_of_threads() {
    // A wall beside a floor and a ramp, with a lateral error of 0.3 pixels in the pixels' directions.
    let (width, height, mut random) = (400, 320, Random::new(11));
    let mut pixel = |at: usize| {
        let [u, v] = [at % width, at / width].map(|place| place as f64 + 0.3 * random.gaussian());
        (40.0 + 0.02 * random.gaussian() + (0.5 * (v - 160.0)).max(0.7 * (150.0 - u)).max(0.01 * u)) as f32
    };
    let map: Vec<f32> = (0..width * height).map(&mut pixel).collect();
    let on = |threads: usize, params: Planar| {
        let sensor = Sensor { value_kind: ValueKind::Disparity, ..Sensor::default() };
        let mut detector = Detector::new(params).unwrap().sensor(sensor).threads(threads);
        detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap().clone()
    };
    let expected = on(1, Planar::default());
    assert_eq!(expected.planes.len(), 3);
    // The lateral error matters: without it, two of them fall to pieces.
    assert_ne!(expected, on(1, Planar { lateral_noise: 0.05, ..Planar::default() }));
    with_each_level(|kernel| {
        for threads in [1, 2, 4] {
            assert!(on(threads, Planar::default()) == expected, "{kernel}, {threads} threads");
        }
    });
}

#[test]
fn the_same_numbers_give_the_same_labels_as_whole_millimetres_and_as_metres() {
    for scene in ["room:sensor=kinect_white,size=320x240", "random:sensor=azure,size=321x203"] {
        let frame = scene.parse::<Spec>().unwrap().frame().unwrap();
        let crate::AnyView::U16(counts) = frame.view() else { panic!("{scene} is in millimetres") };
        for units_per_metre in [1000.0, 5000.0] {
            let of = |metres: f64| Sensor { value_kind: ValueKind::Depth { metres }, ..frame.sensor };
            let metres: Vec<f32> =
                counts.rows().flatten().map(|&count| (f64::from(count) / units_per_metre) as f32).collect();
            let map = DepthView::new(&metres, counts.width(), counts.height()).unwrap();
            let (mut as_counts, mut as_metres) = (Detector::default(), Detector::default());
            as_counts = as_counts.sensor(of(1.0 / units_per_metre)).curved(true);
            as_metres = as_metres.sensor(of(1.0)).curved(true);
            let (expected, found) = (as_counts.detect(counts).unwrap(), as_metres.detect(map).unwrap());
            assert!(found.planes.len() > 3 && found.labels == expected.labels, "{scene}, {units_per_metre}");
            assert_eq!(found.curved.as_ref().map(|it| &it.labels), expected.curved.as_ref().map(|it| &it.labels));
            for (found, expected) in found.planes.iter().zip(&expected.planes) {
                assert_eq!(found.metric, expected.metric);
                let [fit, of_counts] = [found, expected].map(|plane| plane.fit.unwrap());
                assert!((fit.offset * units_per_metre - of_counts.offset).abs() < 1e-6 * of_counts.offset.abs());
            }
        }
        // With one value that is no whole number of units, the map is one of floats.
        let mut floats: Vec<f32> = counts.rows().flatten().map(|&count| f32::from(count) / 1000.0).collect();
        floats.iter_mut().filter(|value| **value > 0.0).take(1).for_each(|value| *value += 1e-5 * *value);
        let sensor = Sensor { value_kind: ValueKind::Depth { metres: 1.0 }, ..frame.sensor };
        let mut detector = Detector::default().sensor(sensor);
        assert!(
            !detector
                .detect(DepthView::new(&floats, counts.width(), counts.height()).unwrap())
                .unwrap()
                .planes
                .is_empty()
        );
    }
}
