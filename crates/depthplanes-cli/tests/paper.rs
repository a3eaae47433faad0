//! `depthplanes paper`: the paper's protocol, with its maps and without.

mod support;

use serde_json::Value;
use support::Bench;

/// The number of planes of a row.
fn planes(rows: &[Value], map: &str, label: &str) -> u64 {
    let row = rows.iter().find(|row| row["map"] == map && row["label"] == label);
    let row = row.unwrap_or_else(|| panic!("no row of {label} on {map}"));
    row["outcome"]["found"]["planes"].as_u64().unwrap()
}

fn rows(bench: &Bench) -> Vec<Value> {
    let text = String::from_utf8(bench.read("report/rows.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// A bench with an empty folder of maps, and the words that run `ngaf` and other methods.
fn without_maps(name: &str, methods: &'static str) -> (Bench, Vec<&'static str>) {
    let bench = Bench::new(name);
    std::fs::create_dir_all(bench.folder.join("none")).unwrap();
    let words = ["paper", "--data", "none", "--methods", methods, "--repeat", "1", "--jobs", "2", "--report", "report"];
    (bench, words.to_vec())
}

#[test]
fn synthetic_maps_stand_in_for_the_papers_and_the_report_says_so() {
    let (bench, words) = without_maps("paper_synthetic", "fpdidm");
    let ran = bench.run(&words);
    assert!(ran.err.contains("not in none: synthetic maps stand in for Sawtooth, Venus,"), "{ran:?}");
    let out = ran.ok();
    let page = String::from_utf8(bench.read("report/report.md")).unwrap();
    let rows = rows(&bench);
    let [ngaf, fpdidm] = ["ngaf min 256", "fpdidm min 256"].map(|label| planes(&rows, "Sawtooth (synthetic)", label));
    let counts =
        format!("| Sawtooth (synthetic) | 256 | {ngaf} | {fpdidm} | {} |", if ngaf == fpdidm { "yes" } else { "no" });
    for part in [
        "All maps here are synthetic: none of the files is at hand.",
        "| Sawtooth (synthetic) | Middlebury | middlebury/sawtooth/disp2.pgm | scene:planes3:",
        "33 times as fast as HSBSR (here ransac, its detector) | Middlebury | ransac was not run | - |",
        "about 8 % more planes than FPDIDM (our reconstruction) | Kinect | ",
        &counts,
        "## What these measures hide\n\nTime, number of planes",
        "Depth with a truth: 5 maps with 100 planes. ngaf min 64: ",
    ] {
        assert!(page.contains(part), "no {part}: {page}");
    }
    assert!(out.contains("Fig. 9") && out.contains("Claims"), "{out}");
    let html = String::from_utf8(bench.read("report/report.html")).unwrap();
    for part in ["Fig. 9", "Fig. 11", "Fig. 12", "Fig. 13", "Fig. 14", "Fig. 15", "data:image/png;base64,", "<svg"] {
        assert!(html.contains(part), "no {part}");
    }
}

#[test]
fn a_killed_run_of_the_protocol_goes_on_and_redoes_no_row() {
    let (bench, words) = without_maps("paper_killed", "ngaf");
    // Eleven maps of the paper and ten with a truth, by four values of min.
    bench.kill_and_go_on(&words, 84);
    assert_eq!(rows(&bench).len(), 84);
}

#[test]
fn a_folder_that_is_not_there_is_refused() {
    let bench = Bench::new("paper_nowhere");
    let err = bench.run(&["paper", "--data", "nowhere", "--report", "report"]).fails(2);
    assert!(err.contains("--data nowhere: no such folder; give one that holds the paper's maps"), "{err}");
    assert!(!bench.folder.join("report").exists());
}

#[test]
fn planes_of_the_papers_maps_are_those_of_its_page_of_tables() {
    let Some(data) = support::data() else { return };
    let bench = Bench::new("paper_recorded");
    let data = data.to_str().unwrap();
    let ran = bench.run(&[
        "paper",
        "--data",
        data,
        "--methods",
        "ngaf",
        "--repeat",
        "1",
        "--jobs",
        "2",
        "--report",
        "report",
    ]);
    assert!(!ran.err.contains("synthetic"), "{ran:?}");
    ran.ok();
    let rows = rows(&bench);
    let page = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/paper-tables.md");
    let page = std::fs::read_to_string(page).unwrap();
    let mut compared = 0;
    for line in page.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        // map, unit, theta, window, min, valid, filled, planes, ..; frames of sensors are filled here.
        if cells.len() < 10 || ![["1", "off"], ["2", "5"]].contains(&[cells[3], cells[4]]) {
            continue;
        }
        let found = planes(&rows, cells[1], &format!("ngaf min {}", cells[5]));
        assert_eq!(found.to_string(), cells[8], "{line}");
        compared += 1;
    }
    assert_eq!(compared, 44);
}
