//! Many inputs: parts for several machines, and runs that go on where others ended.

mod support;

use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Stdio;
use std::time::{Duration, Instant};
use support::{Bench, names_in, two_planes};

/// A folder `maps` of so many maps, each of its own depth.
fn bench(name: &str, maps: u16) -> Bench {
    let bench = Bench::new(name);
    std::fs::create_dir(bench.folder.join("maps")).unwrap();
    for at in 0..maps {
        bench.write(&format!("maps/{at}.pgm"), &two_planes(1000 + 10 * at));
    }
    bench
}

const RESUME: [&str; 7] = ["detect", "maps", "--out-dir", "out", "--table", "planes.csv", "--resume"];

/// The lines of a manifest but the first.
fn lines(bench: &Bench, manifest: &str) -> Vec<Value> {
    let text = String::from_utf8(bench.read(manifest)).unwrap();
    text.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// How many lines each input has, by what they say.
fn count(lines: &[Value], status: &str) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for line in lines.iter().filter(|line| line["status"] == status) {
        *counts.entry(line["input"].as_str().unwrap().to_string()).or_default() += 1;
    }
    counts
}

/// All files of a folder of results but the manifests.
fn results(bench: &Bench, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let names = names_in(&bench.folder.join(folder)).into_iter().filter(|name| !name.starts_with("manifest."));
    names.map(|name| (name.clone(), bench.read(&format!("{folder}/{name}")))).collect()
}

#[test]
fn parts_are_the_whole() {
    let bench = bench("scale_parts", 11);
    bench.run(&["detect", "maps", "--out-dir", "whole", "--table", "whole.csv"]).ok();
    let mut rows = Vec::new();
    for part in ["1/3", "2/3", "3/3"] {
        let table = format!("{}.csv", &part[..1]);
        let out =
            bench.run(&["detect", "maps", "--out-dir", "parts", "--table", &table, "--shard", part, "--resume"]).ok();
        assert!(out.contains("planes of 4 inputs") || part == "3/3" && out.contains("planes of 3 inputs"), "{out}");
        rows.extend(String::from_utf8(bench.read(&table)).unwrap().lines().skip(1).map(String::from));
    }
    assert!(results(&bench, "parts") == results(&bench, "whole"));
    let whole = String::from_utf8(bench.read("whole.csv")).unwrap();
    let mut whole: Vec<String> = whole.lines().skip(1).map(String::from).collect();
    rows.sort();
    whole.sort();
    assert_eq!(rows, whole);
    // What other parts did is done: with other parts, and with none.
    let again = bench.run(&["detect", "maps", "--out-dir", "parts", "--table", "all.csv", "--resume"]);
    assert!(again.err.contains("11 of 11 inputs are done already"), "{again:?}");
    assert_eq!(bench.read("all.csv"), bench.read("whole.csv"));
    let none = bench.run(&["detect", "maps/1.pgm", "maps/2.pgm", "--shard", "3/3"]);
    assert!(none.code == Some(0) && none.err.contains("3/3"), "{none:?}");
    for wrong in ["0/3", "4/3", "3", "a/b"] {
        assert!(bench.run(&["detect", "maps", "--shard", wrong]).fails(2).contains("such as 1/4 to 4/4"), "{wrong}");
    }
    assert!(bench.run(&["detect", "maps", "--resume"]).fails(2).contains("--out-dir"));
    // What is left out has no output but those of the folder and of the table.
    for other in [&["--json"][..], &["--repeat", "3"], &["--overlay", "o.png"]] {
        let error = bench.run(&[&RESUME[..], other].concat()).fails(2);
        assert!(error.contains("cannot be used with"), "{error}");
    }
}

#[test]
fn runs_that_are_killed_lose_nothing_and_do_nothing_twice() {
    let bench = bench("scale_killed", 0);
    // Large enough for a kill to hit work in progress.
    let map = |at: u16| -> Vec<u8> {
        let value = |pixel: usize| 1000 + 10 * at + if pixel % 320 < 160 { 0 } else { 500 } + (pixel % 3) as u16;
        let mut bytes = b"P5 320 240 65535\n".to_vec();
        bytes.extend((0..320 * 240).flat_map(|pixel| value(pixel).to_be_bytes()));
        bytes
    };
    const MAPS: usize = 120;
    (0..MAPS).for_each(|at| bench.write(&format!("maps/{at}.pgm"), &map(at as u16)));
    bench.run(&["detect", "maps", "--out-dir", "whole", "--table", "whole.csv"]).ok();
    let done = || {
        std::fs::read(bench.folder.join("out/manifest.jsonl"))
            .unwrap_or_default()
            .iter()
            .filter(|&&byte| byte == b'\n')
            .count()
    };
    let mut random = 7u64;
    for kill in 0..10 {
        let before = done();
        let mut child = bench.command().args(RESUME).args(["--jobs", "2"]).stdout(Stdio::null()).spawn().unwrap();
        let start = Instant::now();
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        while done() <= before + (random >> 61) as usize && start.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_micros(200));
        }
        std::thread::sleep(Duration::from_micros(random >> 50));
        child.kill().unwrap(); // SIGKILL: nothing is tidied up
        child.wait().unwrap();
        assert!(done() > before, "run {kill} did nothing");
        assert!(!bench.folder.join("planes.csv").exists(), "the table is whole or not there");
    }
    let left = MAPS + 1 - done();
    assert!(left > 0, "all was done before the last run");
    bench.run(&RESUME).ok();
    assert!(results(&bench, "out") == results(&bench, "whole"), "{:?}", names_in(&bench.folder.join("out")));
    assert_eq!(bench.read("planes.csv"), bench.read("whole.csv"));
    let counts = count(&lines(&bench, "out/manifest.jsonl"), "done");
    assert!(counts.len() == MAPS && counts.values().all(|&count| count == 1), "{counts:?}");
}

#[test]
fn what_has_changed_is_missing_or_failed_is_done_again() {
    let bench = bench("scale_again", 5);
    bench.write("maps/bad.pgm", b"P5 32 24");
    let first = bench.run(&RESUME);
    assert!(first.code == Some(2) && first.err.contains("1 of 6 inputs failed"), "{first:?}");
    let failed = lines(&bench, "out/manifest.jsonl").into_iter().find(|line| line["status"] == "failed").unwrap();
    assert!(failed["error"].as_str().unwrap().starts_with("maps/bad.pgm: "), "{failed}");
    let table = bench.read("planes.csv");
    bench.write("maps/bad.pgm", &two_planes(2000));
    bench.write("maps/1.pgm", &two_planes(3000));
    std::fs::remove_file(bench.folder.join("out/3.labels.png")).unwrap();
    let again = bench.run(&RESUME);
    assert!(again.code == Some(0) && again.err.contains("3 of 6 inputs are done already"), "{again:?}");
    assert!(bench.folder.join("out/3.labels.png").exists() && bench.read("planes.csv") != table);
    let counts = count(&lines(&bench, "out/manifest.jsonl"), "done");
    assert_eq!(counts.values().copied().collect::<Vec<_>>(), [1, 2, 1, 2, 1, 1], "{counts:?}");
    bench.run(&["detect", "maps", "--out-dir", "whole", "--table", "whole.csv"]).ok();
    assert_eq!(bench.read("planes.csv"), bench.read("whole.csv"));
}

#[test]
fn results_of_other_words_are_not_mixed() {
    let bench = bench("scale_words", 2);
    bench.run(&RESUME).ok();
    let before = bench.read("out/manifest.jsonl");
    for (words, what) in [
        (&["--method", "ngaf"][..], "method: \"planar\" instead of \"ngaf\""),
        (&["--min-pixels", "50"], "parameters"),
        (&["--scale", "1000"], "reading"),
        (&["--curved"], "curved"),
        (&["--only", "labels"], "only"),
    ] {
        let error = bench.run(&[&RESUME[..], words].concat()).fails(2);
        assert!(error.contains(what) && error.contains("another --out-dir"), "{error}");
    }
    // Where the work is done does not matter.
    bench.run(&[&RESUME[..], &["--jobs", "2", "--threads", "2"]].concat()).ok();
    assert_eq!(bench.read("out/manifest.jsonl"), before);
    // A line that a killed run began.
    bench.write("out/manifest.jsonl", &[&before[..], b"{\"input\":\"maps/9"].concat());
    bench.run(&RESUME).ok();
    assert_eq!(bench.read("out/manifest.jsonl"), before);
    for (wrong, what) in
        [(&b"hello\n"[..], "not a manifest"), (b"{\"schema\":\"depthplanes.manifest/9\"}\n", "its schema")]
    {
        bench.write("out/manifest.jsonl", wrong);
        assert!(bench.run(&RESUME).fails(2).contains(what), "{what}");
        assert_eq!(bench.read("out/manifest.jsonl"), wrong);
    }
}

#[test]
fn what_the_words_do_not_say_counts_as_well() {
    let bench = bench("scale_silent", 2);
    // A camera file with other numbers in it is another camera.
    bench.write("cam.txt", b"30,30,15.5,11.5");
    let words = ["detect", "maps", "--camera", "cam.txt", "--out-dir", "out", "--only", "planes", "--resume"];
    bench.run(&words).ok();
    bench.run(&words).ok();
    bench.write("cam.txt", b"15,15,15.5,11.5");
    assert!(bench.run(&words).fails(2).contains("another files"), "another camera");
    // Nothing tells one standard input from another.
    let error = bench.shell("$DP detect - --out-dir s --resume <maps/0.pgm").fails(2);
    assert!(error.contains("standard input"), "{error}");
    // What nobody but a run of this program wrote stays.
    std::fs::create_dir(bench.folder.join("mine")).unwrap();
    bench.write("mine/manifest.jsonl", b"my own notes");
    let error = bench.run(&["detect", "maps", "--out-dir", "mine", "--resume"]).fails(2);
    assert!(error.contains("not a manifest"), "{error}");
    assert_eq!(bench.read("mine/manifest.jsonl"), b"my own notes");
    // A first line that a killed run has begun.
    std::fs::create_dir(bench.folder.join("begun")).unwrap();
    bench.write("begun/manifest.jsonl", b"{\"schema\":\"depthpl");
    bench.run(&["detect", "maps", "--out-dir", "begun", "--only", "labels", "--resume"]).ok();
    assert_eq!(lines(&bench, "begun/manifest.jsonl").len(), 2);
}

#[cfg(unix)]
#[test]
fn an_input_that_is_replaced_while_it_is_worked_on_is_done_again() {
    let bench = bench("scale_replaced", 1);
    // The run has read the first bytes of a pipe of that name, which becomes a file before it is done.
    let line = "rm maps/0.pgm; mkfifo maps/0.pgm; $DP detect maps/0.pgm --out-dir out --only labels --resume >/dev/null & child=$!; \
                timeout 20 sh -c 'exec 3>maps/0.pgm; mv later maps/0.pgm; cat first >&3'; wait $child";
    bench.write("first", &two_planes(1000));
    bench.write("later", &two_planes(2000));
    bench.shell(line).ok();
    let again = bench.run(&["detect", "maps/0.pgm", "--out-dir", "out", "--only", "labels", "--resume"]);
    assert!(!again.err.contains("are done already"), "{again:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_a_manifest_of_whole_lines() {
    let bench = bench("scale_full", 20);
    // Files may grow to a few lines of the manifest behind its head, which label images do not.
    let words = ["detect", "maps", "--out-dir", "out", "--only", "labels", "--resume"];
    bench.run(&words).ok();
    let whole = bench.read("out/manifest.jsonl");
    std::fs::remove_dir_all(bench.folder.join("out")).unwrap();
    let head = whole.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    let ran = bench.shell(&format!("ulimit -f {}; $DP {}", head.div_ceil(512) + 1, words.join(" ")));
    assert!(ran.code == Some(1) && ran.err.contains("manifest.jsonl"), "{ran:?}");
    let left = bench.read("out/manifest.jsonl");
    assert!(
        left.ends_with(b"\n") && left.len() > head && whole.starts_with(&left),
        "{}",
        String::from_utf8_lossy(&left)
    );
    bench.run(&words).ok();
    assert_eq!(bench.read("out/manifest.jsonl"), whole);
}

#[test]
fn two_runs_do_not_work_on_the_same_inputs() {
    let bench = bench("scale_two", 2);
    // The first run waits for a pipe.
    let line = "mkfifo pipe; $DP detect maps pipe --out-dir out --resume >/dev/null 2>&1 & child=$!; \
                for i in $(seq 100); do test -s out/manifest.jsonl && break; sleep 0.05; done; \
                $DP detect maps pipe --out-dir out --resume; echo $?; timeout 20 sh -c 'cat maps/1.pgm >pipe'; wait $child; echo $?";
    let ran = bench.shell(line);
    assert!(ran.err.contains("another run is at work"), "{ran:?}");
    assert_eq!(ran.out.lines().collect::<Vec<_>>(), ["2", "0"], "{ran:?}");
    assert_eq!(lines(&bench, "out/manifest.jsonl").len(), 3);
}
