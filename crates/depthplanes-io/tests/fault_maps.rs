//! Maps that once broke an answer: every method has to keep the label contract on them.

mod common;

use depthplanes::methods::METHODS;
use depthplanes::{Detector, Intrinsics, Planar, Sensor};
use depthplanes_io::{Frame, ReadOptions, read};

fn frames() -> Vec<Frame> {
    let Some(data) = common::data() else { return Vec::new() };
    let options = ReadOptions { encoding: Some("millimetre".into()), ..Default::default() };
    let paths = ["b-103367.npy", "b-4727.npy"].map(|name| data.join("reports/faults").join(name));
    paths.iter().filter(|path| path.exists()).map(|path| read(path, &options).unwrap()).collect()
}

fn sensors(frame: &Frame) -> [Sensor; 2] {
    [frame.sensor, frame.sensor.intrinsics(Intrinsics::new(60.0, 60.0, 30.0, 30.0).unwrap())]
}

#[test]
fn no_pixel_of_them_is_both_curved_and_in_a_plane() {
    for frame in frames() {
        for sensor in sensors(&frame) {
            for (scale, threshold) in [(1.0, 3.0), (0.0237, 0.582), (0.01, 0.5), (0.1, 10.0), (100.0, 100.0)] {
                let planar =
                    Planar::default().min_pixels(3).noise_scale(scale).inlier_threshold(threshold).lateral_noise(1.0);
                let mut detector = Detector::new(planar).unwrap().sensor(sensor).curved(true);
                let found = detector.detect(frame.view().unwrap()).unwrap();
                let curved = &found.curved.as_ref().unwrap().labels;
                assert!(!curved.iter().zip(&found.labels).any(|(curved, plane)| *curved > 0 && *plane > 0));
            }
        }
    }
}

#[test]
fn every_method_counts_its_labels_on_them() {
    for frame in frames() {
        for (sensor, method) in
            sensors(&frame).into_iter().flat_map(|sensor| METHODS.iter().map(move |row| (sensor, row)))
        {
            for least in [0.0, 30.0] {
                let method = method.with(&[("min-pixels", least)]).unwrap();
                let mut detector = Detector::new(method).unwrap().sensor(sensor);
                let found = detector.detect(frame.view().unwrap()).unwrap();
                let mut counts = vec![0; found.planes.len() + 1];
                found.labels.iter().for_each(|&label| counts[usize::from(label)] += 1);
                assert!(found.planes.iter().zip(&counts[1..]).all(|(plane, &count)| plane.pixel_count == count));
            }
        }
    }
}
