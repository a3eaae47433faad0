//! `depthplanes score`: label images against the truth.

mod support;

use serde_json::Value;
use support::Bench;

/// An 8-bit PGM of 6 x 2 labels.
fn labels(pixels: [u8; 12]) -> Vec<u8> {
    [b"P5 6 2 255\n".as_slice(), &pixels].concat()
}

const TRUTH: [u8; 12] = [1, 1, 1, 1, 1, 0, 2, 2, 2, 2, 2, 2];
/// Plane 1 is found as 7, plane 2 is cut into 3 and 4.
const PREDICTION: [u8; 12] = [7, 7, 7, 7, 7, 0, 3, 3, 3, 4, 4, 4];

fn bench(name: &str) -> Bench {
    let bench = Bench::new(name);
    bench.write("truth.pgm", &labels(TRUTH));
    bench.write("found.pgm", &labels(PREDICTION));
    bench
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn a_pair_is_a_table_of_measures() {
    let out = bench("score_table").run(&["score", "truth.pgm", "found.pgm"]).ok();
    assert!(out.starts_with("found.pgm against truth.pgm: 6 x 2 pixels\nmeasure "), "{out}");
    let value = |family: &str, name: &str| {
        let words = |line: &str| line.split_whitespace().map(String::from).collect::<Vec<_>>();
        let line = out.lines().map(words).find(|words| words[0] == family && words[1] == name);
        line.unwrap_or_else(|| panic!("no {family} {name}: {out}"))[2].clone()
    };
    assert_eq!((value("planes", "truth"), value("planes", "predicted")), ("2".into(), "3".into()));
    assert_eq!((value("segcomp", "correct"), value("segcomp", "over_segmented")), ("1".into(), "1".into()));
    assert_eq!((value("segcomp", "missed"), value("segcomp", "noise")), ("0".into(), "0".into()));
    assert_eq!((value("synpeb", "f"), value("synpeb", "k")), ("0.500".into(), "0.455".into()));
    assert_eq!((value("evops", "precision"), value("evops", "osr")), ("0.333".into(), "0.500".into()));
    // 9 of the 66 pairs of pixels, those between 3 and 4, are together in the truth alone.
    assert_eq!(value("partition", "rand_index"), "0.864");
}

#[test]
fn json_has_every_measure_and_the_classes_of_each_label() {
    let record = json(&bench("score_json").run(&["score", "truth.pgm", "found.pgm", "--json"]).ok());
    assert_eq!((&record["schema"], &record["tolerance"]), (&"depthplanes.score/1".into(), &0.8.into()));
    let pair = &record["pairs"][0];
    assert_eq!((&pair["truth"], &pair["prediction"]), (&"truth.pgm".into(), &"found.pgm".into()));
    assert_eq!((&pair["width"], &pair["height"]), (&6.into(), &2.into()));
    assert_eq!((&pair["segcomp"]["correct"], &pair["evops"]["recall"]), (&1.into(), &0.5.into()));
    let classes = serde_json::json!({
        "correct": [{"truth": 1, "prediction": 7}],
        "over_segmented": [{"truth": 2, "predictions": [3, 4]}],
        "under_segmented": [],
        "missed": [],
        "noise": [],
    });
    assert_eq!(pair["classes"], classes);
    assert_eq!(record["mean"]["segcomp"]["correct"], 1.0);
}

#[test]
fn the_page_of_measures_names_every_one() {
    let record = json(&bench("score_page").run(&["score", "truth.pgm", "found.pgm", "--json"]).ok());
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/metrics.md");
    let page = std::fs::read_to_string(page).unwrap();
    let mut named = 0;
    for (family, measures) in record["mean"].as_object().unwrap() {
        for name in measures.as_object().unwrap().keys() {
            assert!(page.contains(&format!("`{family}.{name}`")), "docs/metrics.md does not name {family}.{name}");
            named += 1;
        }
    }
    assert!(named > 20, "{named}");
}

#[test]
fn the_tolerance_decides_what_is_correct() {
    let bench = bench("score_tolerance");
    bench.write("part.pgm", &labels([7, 7, 7, 7, 0, 0, 3, 3, 3, 3, 3, 3])); // 4 of the 5 pixels of plane 1
    let correct = |words: &[&str]| {
        let words = [&["score", "truth.pgm", "part.pgm", "--json"], words].concat();
        json(&bench.run(&words).ok())["pairs"][0]["segcomp"]["correct"].clone()
    };
    assert_eq!((correct(&[]), correct(&["--tolerance", "0.75"])), (1.into(), 2.into()));
}

#[test]
fn truth_labels_below_the_lowest_are_no_plane() {
    let out = bench("score_lowest").run(&["score", "truth.pgm", "found.pgm", "--truth-from", "2", "--json"]).ok();
    let pair = &json(&out)["pairs"][0];
    assert_eq!((&pair["planes"]["truth"], &pair["classes"]["noise"]), (&1.into(), &serde_json::json!([7])));
}

#[test]
fn folders_are_paired_by_name_and_end_in_their_mean() {
    let bench = bench("score_folders");
    for folder in ["truth", "found"] {
        std::fs::create_dir(bench.folder.join(folder)).unwrap();
    }
    for (name, pixels) in [("truth/10.labels.pgm", TRUTH), ("truth/9.labels.pgm", TRUTH), ("truth/9.depth.pgm", TRUTH)]
    {
        bench.write(name, &labels(pixels)); // the map beside its truth is not taken for one
    }
    bench.write("found/9.depth.labels.pgm", &labels(TRUTH)); // as `detect` names what it makes of 9.depth.pgm
    bench.write("found/10.labels.pgm", &labels(PREDICTION));
    bench.write("found/11.labels.pgm", &labels(PREDICTION));
    let ran = bench.run(&["score", "truth", "found"]);
    assert!(ran.err.contains("found/11.labels.pgm: no truth of this name"), "{ran:?}");
    let out = ran.ok();
    let column =
        |number: usize| out.lines().map(|line| line.split_whitespace().nth(number).unwrap()).collect::<Vec<_>>();
    assert_eq!((column(0), column(3)), (vec!["pair", "9", "10", "mean"], vec!["correct", "2", "1", "1.500"]), "{out}");
    let record = json(&bench.run(&["score", "truth", "found", "--json"]).ok());
    assert_eq!(record["pairs"].as_array().unwrap().len(), 2);
    assert_eq!(record["mean"]["synpeb"]["f"], 0.75);
}

#[test]
fn a_measure_without_a_value_is_a_dash_null_and_not_in_the_mean() {
    let bench = bench("score_none");
    bench.write("none.pgm", &labels([0; 12]));
    let out = bench.run(&["score", "none.pgm", "found.pgm"]).ok();
    assert!(out.lines().any(|line| line.split_whitespace().take(3).eq(["synpeb", "f", "-"])), "{out}");
    let record = json(&bench.run(&["score", "none.pgm", "found.pgm", "--json"]).ok());
    assert!(record["pairs"][0]["synpeb"]["f"].is_null() && record["mean"]["on_planes"]["rand_index"].is_null());
}

#[test]
fn what_detect_finds_in_a_scene_is_scored_against_its_truth() {
    let bench = Bench::new("score_scene");
    let scene = "scene:room:sensor=clean_mm,size=320x240";
    bench.run(&["detect", scene, "--labels", "labels.npy"]).ok();
    let pair = json(&bench.run(&["score", scene, "labels.npy", "--json"]).ok())["pairs"][0].clone();
    assert_eq!(pair["truth"], scene);
    assert!(pair["segcomp"]["correct"].as_u64().unwrap() > 0, "{pair}");
}

#[test]
fn a_partial_truth_is_told_of() {
    let bench = bench("score_partial");
    let truth: Vec<u8> = [0u16, 1, 1, 1, 65535, 65535].iter().flat_map(|label| label.to_be_bytes()).collect();
    bench.write("partial.pgm", &[b"P5 3 2 65535\n".as_slice(), &truth].concat());
    let ran = bench.run(&["score", "partial.pgm", "partial.pgm"]);
    assert!(ran.code == Some(0) && ran.err.contains("`depthplanes eval real` counts its surfaces"), "{ran:?}");
    assert_eq!(bench.run(&["score", "truth.pgm", "found.pgm"]).err, "");
}

#[test]
fn a_map_taken_for_labels_is_remarked_on() {
    let bench = Bench::new("score_map");
    let mut map = b"P5 64 32 65535\n".to_vec();
    map.extend((0..64 * 32u16).flat_map(|value| (2 * value).to_be_bytes()));
    bench.write("map.pgm", &map);
    let ran = bench.run(&["score", "map.pgm", "map.pgm"]);
    assert!(ran.err.contains("map.pgm: 2048 different labels; is this a map"), "{ran:?}");
    ran.ok();
}
