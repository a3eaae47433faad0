//! The method as a whole, where a test needs what the crate hides.

use super::Planar;
use crate::camera::{Measure, Sensor};
use crate::detection::Detection;
use crate::detector::Detector;
use crate::group::with_each_kernel;
use crate::map::DepthView;
use crate::scene::{Random, SceneFrame, Spec};

/// Depth and disparity, of one byte, two and four; one of several parts and strips.
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
        with_each_kernel(|kernel| {
            for threads in [1, 2, 4] {
                assert!(format!("{:?}", on(&frame, threads)) == expected, "{scene}, {kernel}, {threads} threads");
            }
            kernels += 1;
        });
        assert!(kernels >= 1);
    }
}

#[test]
fn an_estimated_ray_is_the_same_on_each_kernel_and_any_number_of_threads() {
    // A wall beside a floor and a ramp, along rays that are off by 0.3 pixels.
    let (width, height, mut random) = (400, 320, Random::new(11));
    let mut pixel = |at: usize| {
        let [u, v] = [at % width, at / width].map(|place| place as f64 + 0.3 * random.gaussian());
        (40.0 + 0.02 * random.gaussian() + (0.5 * (v - 160.0)).max(0.7 * (150.0 - u)).max(0.01 * u)) as f32
    };
    let map: Vec<f32> = (0..width * height).map(&mut pixel).collect();
    let on = |threads: usize, params: Planar| {
        let sensor = Sensor { measure: Measure::Disparity, ..Sensor::default() };
        let mut detector = Detector::new(params).unwrap().sensor(sensor).threads(threads);
        detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap().clone()
    };
    let expected = on(1, Planar::default());
    assert_eq!(expected.planes.len(), 3);
    // It is one: without, two of them fall to pieces.
    assert_ne!(expected, on(1, Planar { ray: 0.05, ..Planar::default() }));
    with_each_kernel(|kernel| {
        for threads in [1, 2, 4] {
            assert!(on(threads, Planar::default()) == expected, "{kernel}, {threads} threads");
        }
    });
}
