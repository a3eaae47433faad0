//! Small maps after those of public reports: spread over channels, headerless, of several pages. The right answers are
//! those of `reports/reports.tsv` among the recorded maps.

mod support;

use serde_json::Value;
use support::Bench;

/// Distances of the room's planes, metres, and their normals.
const ROOM: [(f64, [f64; 3]); 4] =
    [(4.0, [0.0, 0.199, -0.980]), (1.2, [0.0, -0.980, -0.199]), (1.5, [1.0, 0.0, 0.0]), (2.6, [0.0, 0.199, -0.980])];

#[track_caller]
fn is_the_room(file: &str, flags: &[&str]) {
    let Some(data) = support::data() else { return };
    let file = data.join("reports").join(file);
    let bench = Bench::new(&format!("reports_formats_{}", file.file_stem().unwrap().display()));
    let fixed = ["detect", file.to_str().unwrap(), "--intrinsics", "115.2,115.2,63.5,47.5", "--json"];
    let out = bench.run(&[&fixed, flags].concat()).ok();
    let record: Value = serde_json::from_str(&out).unwrap();
    let planes = record["planes"].as_array().unwrap();
    assert_eq!(planes.len(), ROOM.len(), "{out}");
    for (distance, normal) in ROOM {
        let near = planes.iter().filter(|plane| {
            let metric = &plane["metric"];
            let off: f64 = (0..3)
                .map(|axis| (metric["normal"][axis].as_f64().unwrap() - normal[axis]).powi(2))
                .sum::<f64>()
                .sqrt();
            (metric["distance_m"].as_f64().unwrap() / distance - 1.0).abs() <= 0.02 && off <= 0.03
        });
        assert_eq!(near.count(), 1, "{distance} m in {out}");
    }
}

#[test]
fn the_room_is_found_in_values_spread_over_channels() {
    is_the_room("packed_rgb24.png", &["--encoding", "rgb24-carla"]);
    is_the_room("packed_hi_lo.png", &["--encoding", "bytes-high-low"]);
    is_the_room("packed_grey_alpha.png", &["--encoding", "bytes-low-high"]);
}

#[test]
fn values_spread_over_channels_are_named_with_the_encoding_first() {
    let Some(data) = support::data() else { return };
    let bench = Bench::new("reports_formats_named");
    for (file, encoding) in [
        ("packed_rgb24.png", "rgb24-carla"),
        ("packed_hi_lo.png", "bytes-high-low"),
        ("packed_grey_alpha.png", "bytes-low-high"),
    ] {
        let file = data.join("reports").join(file);
        let error = bench.run(&["detect", file.to_str().unwrap()]).fails(2);
        assert!(
            error.contains("the bytes of one value") && error.contains(&format!("try --encoding {encoding}")),
            "{error}"
        );
    }
}

#[test]
fn the_room_is_found_in_the_quantised_inverse_depth_of_a_topic() {
    is_the_room("depth_32FC1.compressedDepth", &[]);
}

#[test]
fn the_room_is_found_in_headerless_floats() {
    is_the_room("raw_float32_128x96.bin", &["--raw-size", "128x96"]);
    is_the_room("raw_float32_128x96.bin", &["--raw-size", "128x96", "--raw-type", "float32"]);
}

#[test]
fn the_room_is_found_in_floats_of_which_0_is_white_and_behind_a_thumbnail() {
    is_the_room("tiff_white_is_zero_f32.tif", &[]);
    is_the_room("tiff_thumbnail_first.tif", &[]);
    is_the_room("tiff_thumbnail_first.tif", &["--member", "2"]);
}
