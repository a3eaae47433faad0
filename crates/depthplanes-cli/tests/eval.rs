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

/// Runs `eval` over a folder of depth maps by name; the label image of each map and what it came to.
#[cfg(unix)]
fn of_folder(bench: &Bench, folder: &str, names: &[&[u8]], sizes: [[u16; 2]; 2]) -> Vec<Value> {
    use std::os::unix::ffi::OsStrExt;
    std::fs::create_dir_all(bench.folder.join(folder)).unwrap();
    for (at, name) in names.iter().enumerate() {
        // Planes of the left and the right part, or of the upper and the lower: labels differ.
        let [width, height] = sizes[at % 2];
        let mut map = format!("P5 {width} {height} 65535\n").into_bytes();
        let far = |u: u16, v: u16| if at.is_multiple_of(2) { u >= width / 2 } else { v >= height / 2 };
        let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
        map.extend(pixels.flat_map(|(u, v)| (1000 + 500 * u16::from(far(u, v))).to_be_bytes()));
        std::fs::write(bench.folder.join(folder).join(std::ffi::OsStr::from_bytes(name)), map).unwrap();
    }
    let report = format!("report_{folder}");
    bench.run(&["eval", &format!("kinect={folder}"), "--repeat", "1", "--report", &report]).ok();
    rows(bench, &format!("{report}/rows.jsonl"))
}

#[cfg(unix)]
#[test]
fn maps_whose_names_are_almost_the_same_have_label_images_of_their_own() {
    let bench = Bench::new("eval_names");
    let long = |last: &str| "depth".repeat(48) + last + ".png";
    let (long, longer) = (long("a"), long("b"));
    let names: [&[u8]; 10] = [
        b"x<depth.png",
        b"x>depth.png",
        b"x_depth.png",
        b"X_depth.png",
        b"x\ndepth.png",
        b"x depth.png",
        b"\xffdepth.png",
        b"\xfedepth.png",
        long.as_bytes(),
        longer.as_bytes(),
    ];
    for (folder, sizes) in [("equal", [[40, 30], [40, 30]]), ("other", [[40, 30], [50, 20]])] {
        let all = of_folder(&bench, folder, &names, sizes);
        assert_eq!(all.len(), names.len());
        let mut files = BTreeSet::new();
        for row in &all {
            let file = row["outcome"]["found"]["labels"].as_str().unwrap();
            assert!(files.insert(file.to_lowercase()), "{file} twice");
            let path = bench.folder.join(format!("report_{folder}")).join(file);
            let image = depthplanes_io::read_labels(path, &Default::default()).unwrap();
            assert_eq!(serde_json::json!([image.width, image.height]), row["size"]);
        }
        let again =
            bench.run(&["eval", &format!("kinect={folder}"), "--repeat", "1", "--report", &format!("report_{folder}")]);
        assert!(again.err.contains("10 of 10 results are there already"), "{again:?}");
    }
}

#[test]
fn rows_that_share_a_label_image_are_made_anew() {
    let bench = Bench::new("eval_shared");
    let words = ["eval", "scene:planes3:seed=1-2,size=160x120", "--repeat", "1", "--report", "report"];
    bench.run(&words).ok();
    let all = rows(&bench, "report/rows.jsonl");
    let file = |row: &Value| row["outcome"]["found"]["labels"].as_str().unwrap().to_string();
    let text = String::from_utf8(bench.read("report/rows.jsonl")).unwrap();
    bench.write("report/rows.jsonl", text.replace(&file(&all[0]), &file(&all[1])).as_bytes());
    bench.run(&words).ok();
    let again = bench.run(&words);
    assert!(again.err.contains("2 of 2 results are there already"), "{again:?}");
}

#[test]
fn torn_lines_are_set_aside_and_made_anew() {
    let bench = Bench::new("eval_torn");
    let words = ["eval", "scene:planes3:seed=1-4,size=160x120", "--repeat", "1", "--report", "report"];
    bench.run(&words).ok();
    let whole = bench.read("report/rows.jsonl");
    let lines: Vec<&[u8]> = whole.split_inclusive(|&byte| byte == b'\n').collect();
    let half = |at: usize| &lines[at][..lines[at].len() / 2];
    let torn: [Vec<u8>; 5] = [
        [half(0), b"\n", lines[1], lines[2], lines[3]].concat(),
        [lines[0], half(1), lines[2], lines[3]].concat(),
        [lines[0], lines[1], lines[2], half(3)].concat(),
        [&whole[..], b"0.1579408113302188}}}\n"].concat(),
        [lines[0], b"\0\0\xff\0\n", lines[2], lines[3]].concat(),
    ];
    for (at, text) in torn.iter().enumerate() {
        let _ = std::fs::remove_file(bench.folder.join("report/rows.torn.jsonl"));
        bench.write("report/rows.jsonl", text);
        let ran = bench.run(&words);
        assert!(ran.err.contains("set aside in report/rows.torn.jsonl"), "{at}: {ran:?}");
        ran.ok();
        assert_eq!(rows(&bench, "report/rows.jsonl").len(), 4, "{at}");
        let aside = bench.read("report/rows.torn.jsonl");
        assert!(!aside.is_empty() && aside.ends_with(b"\n"), "{at}");
        let again = bench.run(&words);
        assert!(
            again.err.contains("4 of 4 results are there already") && !again.err.contains("torn"),
            "{at}: {again:?}"
        );
    }
    let Some(data) = support::data() else { return };
    let text = std::fs::read(data.join("reports/faults/eval-torn/rows.jsonl")).unwrap();
    bench.write("report/rows.jsonl", &text);
    let ran = bench.run(&words);
    assert!(ran.err.contains("torn, and no row: line 25;"), "{ran:?}");
    ran.ok();
    assert_eq!(rows(&bench, "report/rows.jsonl").len(), 28);
}

#[test]
fn one_run_at_a_time_writes_into_a_report() {
    let bench = Bench::new("eval_lock");
    let words = ["eval", "scene:room:seed=1-200,size=320x240", "--report", "report"];
    let mut first = bench.command().args(words).stdout(std::process::Stdio::null()).spawn().unwrap();
    let start = std::time::Instant::now();
    while !bench.folder.join("report/rows.jsonl").exists() && start.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let said = bench.run(&["eval", "scene:planes3:size=160x120", "--report", "report"]).fails(2);
    assert!(said.contains(&format!("another run (process {}) writes into this folder", first.id())), "{said}");
    first.kill().unwrap();
    first.wait().unwrap();
    // The lock goes with the process.
    bench.run(&["eval", "scene:planes3:size=160x120", "--report", "report"]).ok();
}
