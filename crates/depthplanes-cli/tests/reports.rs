//! Small maps after those of public reports: with gaps, coarse steps, repeated pixels. The right answers are those of
//! `reports/reports.tsv` among the recorded maps.

mod support;

use depthplanes::noise::{EnlargementFinder, SparseFinder};
use depthplanes::{DepthView, Pixel};
use depthplanes_io::{Pixels, ReadOptions};
use serde_json::Value;
use std::path::{Path, PathBuf};
use support::Bench;

/// A plane: its distance, metres, and its normal, towards the camera.
type Plane = (f64, [f64; 3]);

const WALL: [f64; 3] = [0.0, 0.199, -0.980];
const FLOOR: Plane = (1.2, [0.0, -0.980, -0.199]);
const SIDE: Plane = (1.5, [1.0, 0.0, 0.0]);
const ROOM: &[Plane] = &[(4.0, WALL), FLOOR, SIDE, (2.6, WALL)];

/// What is right of a map.
struct Right {
    file: &'static str,
    intrinsics: &'static str,
    planes: &'static [Plane],
    /// How far a distance may be off, as a part of it, and a normal, by its length.
    within: [f64; 2],
    /// Share of the valid pixels that lie on the planes, at least.
    share: f64,
}

const fn gaps(file: &'static str) -> Right {
    Right { file, intrinsics: "115.2,115.2,63.5,47.5", planes: ROOM, within: [0.02, 0.03], share: 0.95 }
}

/// Maps with gaps.
const GAPS: [Right; 5] = [
    gaps("gaps_full.png"),
    gaps("gaps_checker.png"),
    gaps("gaps_rand35.png"),
    gaps("gaps_row1of2.png"),
    gaps("gaps_row1of4.png"),
];

/// Eighths of a pixel of disparity, in millimetres of depth.
const EIGHTHS: Right = Right {
    file: "steps_eighth_px_mm.png",
    intrinsics: "290,290,159.5,119.5",
    planes: &[(4.0, WALL), FLOOR, SIDE],
    within: [0.02, 0.05],
    share: 0.95,
};

/// Half precision, metres.
const HALVES: Right = Right {
    file: "steps_float16_m.npy",
    intrinsics: "144,144,79.5,59.5",
    planes: &[(3.0, WALL), FLOOR, SIDE],
    within: [0.02, 0.03],
    share: 0.95,
};

/// Enlarged by repeating pixels.
const NEAREST: Right = Right {
    file: "steps_nearest_7p5x.png",
    intrinsics: "432,432,239.5,179.5",
    planes: ROOM,
    within: [0.04, 0.06],
    share: 0.9,
};

/// Holds what the program finds in a map against what is right: these planes, once each, and no other.
#[track_caller]
fn check(right: &Right) {
    let Some(data) = support::data() else { return };
    let file = data.join("reports").join(right.file);
    let bench = Bench::new(&format!("reports_{}", right.file));
    let out = bench.run(&["detect", file.to_str().unwrap(), "--intrinsics", right.intrinsics, "--json"]).ok();
    check_record(right, &out);
}

/// Holds a record of the program against what is right.
#[track_caller]
fn check_record(right: &Right, out: &str) {
    let record: Value = serde_json::from_str(out).unwrap();
    let found: Vec<Plane> = record["planes"].as_array().unwrap().iter().map(plane_of).collect();
    let is_near = |&(distance, normal): &Plane, &(right_m, direction): &Plane| {
        let off = (0..3).map(|axis| (normal[axis] - direction[axis]).powi(2)).sum::<f64>().sqrt();
        (distance / right_m - 1.0).abs() <= right.within[0] && off <= right.within[1]
    };
    for plane in right.planes {
        let count = found.iter().filter(|found| is_near(found, plane)).count();
        assert_eq!(count, 1, "{}: {plane:?} is found {count} times in {found:?}", right.file);
    }
    assert_eq!(found.len(), right.planes.len(), "{}: {found:?}", right.file);
    let share = record["labelled_share"].as_f64().unwrap();
    assert!(share >= right.share, "{}: {share} of the valid pixels", right.file);
}

fn plane_of(record: &Value) -> Plane {
    let metric = &record["metric"];
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    (number(&metric["distance_m"]), [0, 1, 2].map(|axis| number(&metric["normal"][axis])))
}

#[test]
fn a_room_is_found_in_a_map_without_gaps() {
    check(&GAPS[0]);
}

#[test]
fn a_room_is_found_in_a_chequered_map() {
    check(&GAPS[1]);
}

#[test]
fn a_room_is_found_with_35_percent_of_the_pixels_missing_at_random() {
    check(&GAPS[2]);
}

#[test]
fn a_room_is_found_with_every_second_row_missing() {
    check(&GAPS[3]);
}

#[test]
fn a_room_is_found_with_every_fourth_row_missing() {
    check(&GAPS[4]);
}

#[test]
fn planes_are_found_in_eighths_of_a_pixel_stored_as_millimetres() {
    check(&EIGHTHS);
}

#[test]
fn planes_are_found_in_half_precision() {
    check(&HALVES);
}

#[test]
fn a_room_is_found_in_a_map_that_was_enlarged_by_repeating_pixels() {
    check(&NEAREST);
}

#[test]
fn a_camera_of_another_size_is_refused_with_the_one_to_type() {
    let Some(data) = support::data() else { return };
    let [map, camera] =
        ["other_size_256x192.png", "other_size_1920x1440.csv"].map(|name| data.join("reports").join(name));
    let [map, camera] = [map.to_str().unwrap(), camera.to_str().unwrap()];
    let bench = Bench::new("reports_other_size");
    let refused = bench.run(&["detect", map, "--camera", camera]);
    assert!(refused.err.contains("--intrinsics=212,212,127.5,95.5"), "{}", refused.err);
    let right = Right { file: "other_size_256x192.png", intrinsics: "212,212,127.5,95.5", ..GAPS[0] };
    check(&right);
    let scaled = bench.run(&["detect", map, "--camera", camera, "--camera-size", "1920x1440", "--json"]).ok();
    check_record(&right, &scaled);
}

#[test]
fn planes_behind_a_lens_are_found_with_the_camera_file_that_states_it() {
    let Some(data) = support::data() else { return };
    let [map, camera] = ["distorted_k1.png", "distorted_k1.yaml"].map(|name| data.join("reports").join(name));
    let words = ["detect", map.to_str().unwrap(), "--camera", camera.to_str().unwrap(), "--json"];
    let bench = Bench::new("reports_distorted");
    let ran = bench.run(&words);
    assert!(ran.err.contains("--rectified"), "{}", ran.err);
    let planes: &[Plane] = &[(4.0, WALL), FLOOR, SIDE];
    check_record(&Right { file: "distorted_k1.png", planes, share: 0.9, ..GAPS[0] }, &ran.ok());
    let flat = bench.run(&[&words[..], &["--rectified"]].concat());
    assert!(!flat.err.contains("--rectified"), "{}", flat.err);
}

/// The maps of a folder and of those in it.
fn maps(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { maps(&path) } else { vec![path] }).collect()
}

/// Whether a map is taken for an enlarged one, and for a sparse one.
fn taken_for<T: Pixel>(pixels: &[T], [width, height]: [usize; 2]) -> [bool; 2] {
    let map = DepthView::new(pixels, width, height).unwrap();
    [EnlargementFinder::default().find(&map).is_some(), SparseFinder::default().find(&map).is_some()]
}

#[test]
fn no_recorded_map_is_taken_for_an_enlarged_one_or_a_sparse_one() {
    let Some(data) = support::data() else { return };
    let mut looked_at = 0;
    for path in maps(&data) {
        // Pictures, labels and files that are no maps are not asked.
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let is_asked = !["label", "derived", "GT", "color"].iter().any(|word| name.contains(word));
        let Ok(image) = depthplanes_io::read(&path, &ReadOptions::default()) else { continue };
        let size = [image.width, image.height];
        let [is_enlarged, is_sparse] = match &image.pixels {
            Pixels::U8(pixels) => taken_for(pixels, size),
            Pixels::U16(pixels) => taken_for(pixels, size),
            Pixels::F32(pixels) => taken_for(pixels, size),
        };
        looked_at += usize::from(is_asked);
        assert!(!is_asked || is_enlarged == (name == NEAREST.file), "{name}");
        assert!(!is_asked || is_sparse == (name == "gaps_row1of2.png"), "{name}");
    }
    assert!(looked_at > 100, "{looked_at} maps");
}
