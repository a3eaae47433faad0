//! `depthplanes eval`: methods over sets of maps, and the report.

mod support;

use serde_json::Value;
use std::collections::BTreeSet;
use support::Bench;

/// The records of an evaluation, each a line.
fn rows(bench: &Bench, file: &str) -> Vec<Value> {
    let text = String::from_utf8(bench.read(file)).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_report_is_one_page_that_needs_nothing_else() {
    let bench = Bench::new("eval_report");
    let out = bench
        .run(&["eval", "scene:planes3:seed=1-2,size=160x120", "--methods", "planar,ngaf", "--report", "report"])
        .ok();
    assert!(out.starts_with("scenes\nmethod"), "{out}");
    let page = String::from_utf8(bench.read("report/report.html")).unwrap();
    for part in ["<table>", "<svg", "data:image/png;base64,", "planar", "ngaf", "truth"] {
        assert!(page.contains(part), "no {part}");
    }
    // Nothing is fetched: the only addresses are names of vocabularies.
    for (at, _) in page.match_indices("http") {
        assert!(page[at..].starts_with("http://www.w3.org/"), "{}", &page[at..at + 60]);
    }
    let markdown = String::from_utf8(bench.read("report/report.md")).unwrap();
    assert!(markdown.contains("## scenes\n\n| method | maps |"), "{markdown}");
    let all = rows(&bench, "report/rows.jsonl");
    assert_eq!(all.len(), 4);
    let found = &all[0]["outcome"]["found"];
    let f_score = found["scores"]["evops.f_score"].as_f64().unwrap();
    assert!(
        all[0]["method"] == "planar" && f_score == 1.0 && found["normal_error_deg"].as_f64().unwrap() < 0.1,
        "{found}"
    );
    let csv = String::from_utf8(bench.read("report/rows.csv")).unwrap();
    assert_eq!(csv.lines().count(), 5);
    assert!(bench.folder.join("report").join(found["labels"].as_str().unwrap()).is_file());
}

#[test]
fn a_killed_evaluation_goes_on_and_redoes_no_row() {
    let bench = Bench::new("eval_killed");
    let words = ["eval", "scene:room:seed=1-12,size=320x240", "--methods", "planar,ngaf", "--report", "report"];
    bench.kill_and_go_on(&words, 24);
    let all = rows(&bench, "report/rows.jsonl");
    let keys: BTreeSet<String> = all.iter().map(|row| format!("{} {}", row["map"], row["method"])).collect();
    assert_eq!((all.len(), keys.len()), (24, 24));
}

#[test]
fn what_is_wrong_with_a_set_is_said() {
    let bench = Bench::new("eval_wrong");
    std::fs::create_dir_all(bench.folder.join("empty")).unwrap();
    let says = |words: &[&str], part: &str| {
        let err = bench.run(&[&["eval"], words, &["--report", "report"]].concat()).fails(2);
        assert!(err.contains(part), "{words:?}: {err}");
    };
    says(&["nowhere"], "there are real, real-presets, middlebury, kinect, segcomp-abw");
    says(&["evops"], "Give evops=DIR, or --data DIR with a folder `gt_evops` in it");
    says(&["evops=absent"], "no such folder; it needs NAME.depth.png");
    says(&["evops=empty"], "no map of this set is in it; it needs NAME.depth.png");
    says(&["scene:planes3:seed=9-2"], "seed=9-2 is no range");
    says(&["scene:nothing"], "nothing");
    says(&["scene:planes3", "scene:planes3"], "twice; give each set once");
    bench.write("empty/a.depth.png", b"");
    says(&["evops=empty"], "its truth empty/a.labels.png is not there");
    assert!(!bench.folder.join("report/report.html").exists());
}

#[test]
fn every_set_of_recorded_maps_is_read() {
    let Some(data) = support::data() else { return };
    let bench = Bench::new("eval_recorded");
    let data = data.to_str().unwrap();
    let listed = bench.run(&["datasets"]).ok();
    let names = listed.lines().skip(1).map(|line| line.split_whitespace().next().unwrap());
    let sets: Vec<&str> = names.filter(|name| !name.starts_with("scene:")).collect();
    assert!(sets.len() >= 7, "{listed}");
    let words =
        [&["eval"], &sets[..], &["--data", data, "--report", "report", "--repeat", "1", "--jobs", "2"]].concat();
    bench.run(&words).ok();
    let all = rows(&bench, "report/rows.jsonl");
    let scored = |set: &str| {
        let is_of_set = |row: &&Value| row["dataset"].as_str().unwrap().split(' ').next() == Some(set);
        let of_set: Vec<&Value> = all.iter().filter(is_of_set).collect();
        let correct = |row: &&Value| row["outcome"]["found"]["scores"]["segcomp.correct"].as_f64();
        (of_set.len(), of_set.iter().filter_map(correct).sum::<f64>())
    };
    assert_eq!((scored("middlebury").1, scored("segcomp-abw").0), (25.0, 10));
    for set in &sets {
        assert!(scored(set).0 > 0, "{set}");
    }
    assert!(scored("segcomp-abw").1 >= 150.0, "{:?}", scored("segcomp-abw"));
    frames_of_real_cameras_are_measured(&bench, &all);
    sets.iter().for_each(|set| println!("{set}: {:?}", scored(set)));
}

/// What stands in the report for partial truths and for sequences, by the names that the page of measures has.
fn frames_of_real_cameras_are_measured(bench: &Bench, all: &[Value]) {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/metrics.md");
    let page = std::fs::read_to_string(page).unwrap();
    let mut surfaces = 0.0;
    for row in all.iter().filter(|row| row["dataset"] == "real") {
        let scores = row["outcome"]["found"]["scores"].as_object().unwrap();
        assert_eq!(scores.len(), 26, "{row}");
        scores.keys().for_each(|name| assert!(page.contains(&format!("`{name}`")), "docs/metrics.md lacks {name}"));
        surfaces += scores["surfaces.all"].as_f64().unwrap();
    }
    let tables: Vec<Value> = serde_json::from_slice(&bench.read("report/tables.json")).unwrap();
    let line = |title: &str, head: &str| {
        let table = tables.iter().find(|table| table["title"] == title).unwrap_or_else(|| panic!("no table {title}"));
        let column = table["head"].as_array().unwrap().iter().position(|cell| cell == head).unwrap();
        table["rows"][0][column].as_str().unwrap().to_string()
    };
    assert_eq!((surfaces, line("real", "surfaces").as_str()), (116.0, "116"));
    assert!(line("real", "correct %").parse::<f64>().unwrap() >= 35.0);
    assert_eq!(line("real, map by map", "map"), "cape_tunnel");
    assert_eq!(line("7scenes, from frame to frame", "pairs of frames"), "39");
    assert!(line("tsdf, from frame to frame", "IoU").parse::<f64>().unwrap() >= 0.6);
    let report = String::from_utf8(bench.read("report/report.html")).unwrap();
    assert!(report.contains("10k correct %") && report.contains("from frame to frame"));
}
