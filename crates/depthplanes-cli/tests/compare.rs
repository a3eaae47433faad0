//! `depthplanes compare`: several methods on one map.

mod support;

use depthplanes::methods::METHODS;
use support::Bench;

const SCENE: &str = "scene:planes3:size=160x120";

#[test]
fn every_method_has_a_line_and_a_synthetic_scene_its_truth() {
    let bench = Bench::new("compare_all");
    let out = bench.run(&["compare", SCENE, "--repeat", "1"]).ok();
    let cells = |name: &str| -> Vec<String> {
        let words = |line: &str| line.split_whitespace().map(String::from).collect::<Vec<_>>();
        let line = out.lines().map(words).find(|words| words[0] == name);
        line.unwrap_or_else(|| panic!("no {name}: {out}"))
    };
    assert_eq!(cells("method")[7..], ["ms", "truth", "correct", "F"].map(String::from), "{out}");
    for method in METHODS {
        assert_eq!(cells(method.name)[5], "3", "{out}");
    }
    assert_eq!(cells("planar")[6..], ["3", "1.000"].map(String::from));
}

#[test]
fn a_picture_shows_the_map_the_truth_and_each_method() {
    let bench = Bench::new("compare_picture");
    let words = ["compare", SCENE, "--methods", "planar,gradient", "--repeat", "1", "--picture", "all.png"];
    assert!(bench.run(&words).ok().ends_with("wrote all.png\n"));
    let png = bench.read("all.png");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    // Four pictures of 160 x 120 in a row, 8 pixels apart, a line of text under each.
    assert_eq!((number(16), number(20)), (4 * 168 + 8, 120 + 8 + 22 + 8));
}

#[test]
fn scores_of_a_file_need_a_truth_of_its_size() {
    let bench = Bench::with_map("compare_truth");
    bench.run(&["detect", "map.pgm", "--method", "ngaf", "--labels", "truth.png"]).ok();
    let plain = bench.run(&["compare", "map.pgm", "--methods", "ngaf"]).ok();
    assert!(!plain.contains("correct"), "{plain}");
    let scored = bench.run(&["compare", "map.pgm", "--methods", "ngaf", "--truth", "truth.png"]).ok();
    assert!(scored.lines().last().unwrap().ends_with("2        2  1.000"), "{scored}");
    let err = bench.run(&["compare", SCENE, "--truth", "truth.png"]).fails(2);
    assert!(err.contains("32 x 24 labels, but"), "{err}");
}

#[test]
fn a_parameter_goes_to_the_methods_that_have_it() {
    let bench = Bench::new("compare_parameter");
    let count = |least: &str| {
        let out =
            bench.run(&["compare", SCENE, "--methods", "planar,normals", "--min-pixels", least, "--repeat", "1"]).ok();
        out.lines().skip(2).map(|line| line.split_whitespace().nth(1).unwrap().to_string()).collect::<Vec<_>>()
    };
    assert_eq!(count("1000000"), ["0", "0"]);
    let err = bench.run(&["compare", SCENE, "--methods", "planar", "--theta", "2"]).fails(2);
    assert!(err.contains("none of planar has a parameter `theta`"), "{err}");
}
