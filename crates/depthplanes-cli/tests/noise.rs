//! The command `noise`, and what `detect` makes of its answer.

mod support;

use depthplanes::metrics::{Contingency, SurfaceCounts, partial};
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::read_labels;
use serde_json::Value;
use std::path::Path;
use support::{Bench, data};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn the_flags_it_prints_are_the_estimate_and_detect_takes_them() {
    let bench = Bench::new("noise_flags");
    let out = bench.run(&["noise", "scene:room:sensor=tof_white"]).ok();
    let words: Vec<&str> =
        out.lines().last().unwrap().split_whitespace().skip_while(|word| *word != "detect").collect();
    let of = |flag: &str| {
        let at = words.iter().position(|word| *word == flag).unwrap_or_else(|| panic!("{flag}: {out}"));
        words[at + 1].parse::<f64>().unwrap()
    };
    let sigma_m = of("--noise") + 9.0 * of("--noise-growth");
    assert!((sigma_m / 0.0127 - 1.0).abs() < 0.2, "{sigma_m} m at 3 m: {out}");
    assert!(of("--smooth-noise") + 9.0 * of("--smooth-noise-growth") < 0.35 * sigma_m, "{out}");
    let found = bench.run(&[&words[..], &["scene:room:sensor=tof_white", "--json"]].concat()).ok();
    let record = json(&found);
    assert_eq!(record["parameters"]["noise"], of("--noise"));
    assert_eq!(record["parameters"]["smooth-noise-growth"], of("--smooth-noise-growth"));
    assert_eq!(record["planes"][0]["metric"]["covariance_from"], "noise");
}

#[test]
fn several_maps_give_one_estimate_more() {
    let bench = Bench::new("noise_several");
    let words = ["noise", "scene:room:sensor=tof_white", "scene:stairs:sensor=tof_white"];
    let out = bench.run(&words).ok();
    assert_eq!(out.lines().filter(|line| line.starts_with("scene:")).count(), 2, "{out}");
    assert!(out.contains("all together"), "{out}");
    let record = json(&bench.run(&[&words[..], &["--json"]].concat()).ok());
    assert_eq!(record["schema"], "depthplanes.noise/1");
    let blocks = |one: &Value| one["blocks"].as_u64().unwrap();
    let frames = record["frames"].as_array().unwrap();
    assert_eq!(frames.iter().map(blocks).sum::<u64>(), blocks(&record["all"]));
    assert_eq!(frames[0]["source"], words[1]);
    assert_eq!(record["all"]["space"], "inverse_depth");
    let at_3_m = record["all"]["depth"][2]["sigma_m"].as_f64().unwrap();
    assert!((at_3_m / 0.0127 - 1.0).abs() < 0.2, "{at_3_m}");
}

#[test]
fn disparity_has_its_noise_in_map_units_and_in_depth_where_the_rig_is_known() {
    let bench = Bench::new("noise_disparity");
    let mut map = b"P5 96 96 65535\n".to_vec();
    let mut state = 7u32;
    for at in 0..96 * 96u32 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let value = 9000 + 20 * (at % 96) + (state >> 24); // uniform over 256 units: sigma 74
        map.extend((value as u16).to_be_bytes());
    }
    bench.write("map.pgm", &map);
    let record = json(&bench.run(&["noise", "map.pgm", "--encoding", "kitti", "--json"]).ok());
    let sigma = record["all"]["sigma"].as_f64().unwrap();
    assert!((sigma / 73.9 - 1.0).abs() < 0.1, "{sigma}");
    assert_eq!(record["all"]["depth"][0]["sigma_m"], Value::Null);
    let rig = ["noise", "map.pgm", "--encoding", "kitti", "--focal", "500", "--baseline", "0.2", "--json"];
    let record = json(&bench.run(&rig).ok());
    let expected = sigma / 256.0 / 100.0;
    assert!((record["all"]["depth"][0]["sigma_m"].as_f64().unwrap() / expected - 1.0).abs() < 1e-6, "{record}");
}

#[test]
fn maps_that_tell_nothing_are_failures_and_the_others_are_done() {
    let bench = Bench::with_map("noise_nothing");
    bench.write("empty.pgm", &[b"P5 200 200 65535\n".to_vec(), vec![0; 80_000]].concat());
    let said = bench.run(&["noise", "empty.pgm"]).fails(2);
    assert!(said.contains("empty.pgm: the noise cannot be told from 0 blocks"), "{said}");
    let ran = bench.run(&["noise", "empty.pgm", "scene:room:size=320x240", "map.pgm"]);
    assert!(ran.err.contains("1 of 3 inputs have no estimate") && ran.out.contains("scene:room"), "{ran:?}");
    ran.fails(2);
    bench.run(&["noise", "scene:room:sensor=disparity", "scene:room"]).fails(2);
}

#[test]
fn a_map_without_noise_has_nothing_to_tell() {
    let bench = Bench::new("noise_none");
    bench.write("flat.pgm", &[b"P5 200 200 255\n".to_vec(), vec![90; 40_000]].concat());
    let out = bench.run(&["noise", "flat.pgm", "--encoding", "middlebury"]).ok();
    assert!(out.contains("no noise beside rounding"), "{out}");
}

#[test]
fn detect_takes_the_noise_as_a_table() {
    let bench = Bench::new("noise_table");
    bench.write("tof.csv", b"range_m,sigma_m\n1,0.0023\n2,0.0062\n3,0.0127\n4,0.0218\n5,0.0335\n");
    let scene = "scene:room:sensor=tof_white";
    let detect = ["detect", scene, "--json"];
    let with = |words: &[&str]| json(&bench.run(&[&detect[..], words].concat()).ok())["planes"].clone();
    let (by_table, by_flags) =
        (with(&["--noise-table", "tof.csv"]), with(&["--noise", "0.001", "--noise-growth", "0.0013"]));
    let (many, others) = (by_table.as_array().unwrap().len(), by_flags.as_array().unwrap().len());
    assert!(many.abs_diff(others) * 10 <= others, "{many} planes by the table, {others} by the formula");
    let ngaf = json(
        &bench.run(&["detect", scene, "--method", "ngaf", "--theta", "30", "--json", "--noise-table", "tof.csv"]).ok(),
    );
    assert_eq!(ngaf["planes"][0]["metric"]["covariance_from"], "noise");
    let ngaf = json(&bench.run(&["detect", scene, "--method", "ngaf", "--theta", "30", "--json"]).ok());
    assert_eq!(ngaf["planes"][0]["metric"]["covariance_from"], "residuals");
}

/// What becomes of a recorded frame's labelled surfaces.
fn surfaces(bench: &Bench, frame: &Path, flags: &[&str], coplanar: &[Vec<u16>]) -> SurfaceCounts {
    let words = [&["detect", frame.to_str().unwrap(), "--labels", "found.png"], flags].concat();
    bench.run(&words).ok();
    let labels = |path: &Path| read_labels(path, &DecodeOptions::default()).unwrap().labels;
    let truth = labels(Path::new(&frame.to_str().unwrap().replace(".depth.", ".labels.")));
    let found = labels(&bench.folder.join("found.png"));
    partial(&Contingency::new(&truth, &found).unwrap(), coplanar).of_at_least(0)
}

#[test]
fn the_flags_it_prints_find_the_surfaces_of_recorded_frames_as_no_flags_do() {
    let Some(folder) = data().map(|data| data.join("gt_real")) else { return };
    let bench = Bench::new("noise_recorded");
    let (mut without, mut with) = (SurfaceCounts::default(), SurfaceCounts::default());
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let Some(name) = path.to_str().unwrap().strip_suffix(".json") else { continue };
        let about = json(&std::fs::read_to_string(&path).unwrap());
        let reading: Vec<&str> = about["flags"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        let coplanar: Vec<Vec<u16>> = serde_json::from_value(about["coplanar"].clone()).unwrap();
        let depth = format!("{name}.depth.png");
        let told = json(&bench.run(&[&["noise", "--json", &depth], &reading[..]].concat()).ok());
        let flags = told["all"]["flags"].as_str().unwrap().split_whitespace();
        let stated: Vec<&str> = reading.iter().copied().chain(flags).collect();
        let plain = surfaces(&bench, Path::new(&depth), &reading, &coplanar);
        let told = surfaces(&bench, Path::new(&depth), &stated, &coplanar);
        assert!(told.correct + 1 >= plain.correct, "{name}: {told:?} with the flags, {plain:?} without");
        without += plain;
        with += told;
    }
    println!("{} of {} surfaces are correct with the flags, {} without", with.correct, with.surfaces, without.correct);
    assert!(with.correct >= without.correct, "{} with the flags, {} without", with.correct, without.correct);
}
