//! With the feature `serde`: what is written is read back the same.
#![cfg(feature = "serde")]

use depthplanes::noise::{NoiseTable, SensorNoise};
use depthplanes::scene::Spec;
use depthplanes::{Coplanar, Detection, Detector, Intrinsics, Ngaf, Planar, Sensor, ValueKind};
use serde::Serialize;
use serde::de::DeserializeOwned;

fn same<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(value: &T) {
    let text = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<T>(&text).unwrap(), value, "{text}");
}

#[test]
fn a_detection_is_read_back_as_it_was() {
    let frame = "room:sensor=kinect,size=160x120".parse::<Spec>().unwrap().frame().unwrap();
    let mut detector =
        Detector::default().sensor(frame.sensor).curved(true).merge_coplanar(Coplanar::default()).unwrap();
    let found: Detection = detector.detect(frame.view()).unwrap().clone();
    assert!(found.planes.len() > 3 && found.curved.is_some());
    same(&found);
}

#[test]
fn sensors_and_parameters_are_read_back_as_they_were() {
    let table = NoiseTable::new(&[[0.5, 0.001], [2.0, 0.004]]).unwrap();
    let camera = Intrinsics::new(525.0, 520.0, 319.5, 239.5).unwrap();
    let sensor = Sensor::default().value_kind(ValueKind::stereo(1.0, 500.0, 0.1, 0.0).unwrap()).intrinsics(camera);
    same(&sensor.noise(SensorNoise::Table(table)));
    same(&Planar::default().min_pixels(7).inlier_threshold(2.5));
    same(&Ngaf::default().window(5));
}

#[test]
fn what_is_left_out_of_parameters_is_the_default() {
    assert_eq!(serde_json::from_str::<Planar>(r#"{"min_pixels": 500}"#).unwrap(), Planar::default().min_pixels(500));
}

#[test]
fn the_papers_word_for_a_parameter_is_read_and_its_name_is_written() {
    assert_eq!(serde_json::from_str::<Planar>(r#"{"min": 500}"#).unwrap(), Planar::default().min_pixels(500));
    let ngaf: Ngaf = serde_json::from_str(r#"{"min": 64}"#).unwrap();
    assert_eq!(ngaf, Ngaf::default().min_pixels(64));
    assert_eq!(serde_json::to_value(ngaf).unwrap()["min_pixels"], 64);
}

#[test]
fn a_table_that_is_none_is_refused() {
    let error = serde_json::from_str::<NoiseTable>("[[2.0, 0.1], [1.0, 0.1]]").unwrap_err().to_string();
    assert!(error.contains("each above the one before"), "{error}");
}

#[test]
fn a_misspelt_parameter_is_refused() {
    let error = serde_json::from_str::<Planar>(r#"{"inlier_treshold": 9.0}"#).unwrap_err().to_string();
    assert!(error.contains("inlier_treshold") && error.contains("inlier_threshold"), "{error}");
}
