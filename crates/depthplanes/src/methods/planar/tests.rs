//! The method as a whole, where a test needs what the crate hides.

use crate::detection::Detection;
use crate::detector::Detector;
use crate::group::with_each_kernel;
use crate::scene::{SceneFrame, Spec};

/// Depth and disparity, of one byte, two and four; one of several parts and strips.
const SCENES: [&str; 6] = [
    "room:sensor=kinect,size=320x240",
    "curved:sensor=tof,size=320x240",
    "random:sensor=disparity,size=321x203",
    "random:sensor=clean,size=320x240",
    "stairs:sensor=clean_mm,size=320x240",
    "random:sensor=kinect,size=1024x768",
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
