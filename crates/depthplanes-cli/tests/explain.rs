//! `depthplanes explain` and `detect --curved`.

mod support;

use depthplanes_io::{Pixels, ReadOptions};
use serde_json::Value;
use support::Bench;

#[test]
fn the_document_has_the_verdict_and_what_was_tried() {
    let bench = Bench::with_map("explain_json");
    let out = bench.run(&["explain", "map.pgm", "--at", "3,4", "--min-pixels", "500", "--json"]).ok();
    let record: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&record["schema"], &record["at"]), (&"depthplanes.explain/1".into(), &serde_json::json!([3, 4])));
    assert_eq!(record["verdict"]["kind"], "small");
    let flag = record["suggestions"][0]["parameters"]["min-pixels"].as_f64().unwrap().to_string();
    let after = bench.run(&["explain", "map.pgm", "--at", "3,4", "--min-pixels", &flag]).ok();
    assert!(after.contains("It belongs to plane"), "{after}");
}

#[test]
fn wrong_pixels_and_several_maps_are_refused() {
    let bench = Bench::with_map("explain_wrong");
    let outside = bench.run(&["explain", "map.pgm", "--at", "32,0"]).fails(2);
    assert!(outside.contains("pixel 32,0 is outside of the map; accepted: columns 0 to 31, rows 0 to 23"), "{outside}");
    assert!(bench.run(&["explain", "map.pgm", "--at", "3"]).fails(2).contains("column and row"));
    assert!(bench.run(&["explain", "map.pgm", "--at=-1,3"]).fails(2).contains("column and row"));
    assert!(bench.run(&["explain", "map.pgm"]).fails(2).contains("--at"));
    bench.run(&["detect", "map.pgm", "--labels", "other.png"]).ok();
    assert!(bench.run(&["explain", "*.p*", "--at", "1,1"]).fails(2).contains("one map; 2 were given"));
}

#[test]
fn curved_surfaces_are_counted_recorded_and_written() {
    let bench = Bench::new("curved");
    let scene = "scene:curved:sensor=tof_white,size=160x120";
    let out = bench.run(&["detect", scene, "--curved", "--out-dir", "d"]).ok();
    assert!(out.contains("curved surfaces on"), "{out}");
    let of_scene = |end: &str| format!("d/scene_curved_sensor_tof_white_size_160x120.{end}");
    let record: Value = serde_json::from_slice(&bench.read(&of_scene("planes.json"))).unwrap();
    let regions = record["curved"].as_array().unwrap();
    let path = bench.folder.join(of_scene("curved.png"));
    let Pixels::U16(labels) = depthplanes_io::read(path, &ReadOptions::default()).unwrap().pixels else { panic!() };
    assert_eq!(usize::from(*labels.iter().max().unwrap()), regions.len());
    let first = labels.iter().filter(|&&label| label == 1).count();
    assert_eq!(regions[0]["pixel_count"], first);
    // Without being asked it does none of this.
    let plain = bench.run(&["detect", scene, "--json"]).ok();
    assert!(serde_json::from_str::<Value>(&plain).unwrap().get("curved").is_none());
}

#[test]
fn a_method_that_does_not_tell_curved_surfaces_says_so() {
    let bench = Bench::with_map("curved_ngaf");
    for flags in [&["--curved"][..], &["--curved-labels", "c.png"]] {
        let ran = bench.run(&[&["detect", "map.pgm", "--method", "ngaf"], flags].concat());
        assert!(ran.fails(2).contains("`ngaf` does not tell curved surfaces; --method planar does"));
    }
}
