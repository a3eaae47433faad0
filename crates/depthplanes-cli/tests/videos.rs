//! Many videos: a folder of results for each, parts for several machines, and runs that go on where others ended.

mod support;

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};
use support::{Bench, Ran, data, names_in, two_planes};

/// A folder of so many videos of four frames each, `walks/NAME/depth`, no two alike.
fn bench(name: &str, videos: u16) -> Bench {
    let bench = Bench::new(name);
    for video in 0..videos {
        let folder = format!("walks/{video}/depth");
        std::fs::create_dir_all(bench.folder.join(&folder)).unwrap();
        (0..4).for_each(|frame| bench.write(&format!("{folder}/{frame}.pgm"), &two_planes(900 + 50 * video + frame)));
    }
    bench
}

const WALKS: [&str; 4] = ["track", "walks/*/depth", "--out-dir", "out"];

/// All files below a folder but hidden ones and manifests, by path.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for name in names_in(folder).into_iter().filter(|name| !name.starts_with("manifest.")) {
        let path = folder.join(&name);
        if path.is_dir() {
            files.extend(below(&name, &path));
        } else {
            files.insert(name, std::fs::read(path).unwrap());
        }
    }
    files
}

fn below(name: &str, path: &Path) -> impl Iterator<Item = (String, Vec<u8>)> {
    files(path).into_iter().map(move |(below, bytes)| (format!("{name}/{below}"), bytes))
}

/// The lines of a manifest but the first.
fn lines(bench: &Bench, manifest: &str) -> Vec<Value> {
    let text = String::from_utf8(bench.read(manifest)).unwrap();
    text.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn each_video_has_the_results_that_it_has_alone() {
    let bench = bench("videos_each", 3);
    let out = bench.run(&[&WALKS[..], &["scene:boxes:size=64x48,frames=3", "--jobs", "6"]].concat()).ok();
    let starts: Vec<&str> = out.lines().map(|line| line.split(" planes").next().unwrap()).collect();
    assert_eq!(
        starts,
        [
            "walks/0/depth: 4 frames, 2",
            "walks/1/depth: 4 frames, 2",
            "walks/2/depth: 4 frames, 2",
            "scene:boxes:size=64x48,frames=3: 3 frames, 11"
        ],
        "{out}"
    );
    for (source, folder) in
        [("walks/1/depth", "1/depth"), ("scene:boxes:size=64x48,frames=3", "scene_boxes_size_64x48_frames_3")]
    {
        std::fs::create_dir(bench.folder.join("alone")).unwrap();
        for (flag, file) in
            [("out", "planes.jsonl"), ("labels", "labels"), ("overlays", "overlays"), ("out", "planes.mcap")]
        {
            bench.run(&["track", source, &format!("--{flag}"), &format!("alone/{file}")]).ok();
        }
        assert!(files(&bench.folder.join("alone")) == files(&bench.folder.join("out").join(folder)), "{source}");
        std::fs::remove_dir_all(bench.folder.join("alone")).unwrap();
    }
    assert_eq!(names_in(&bench.folder.join("out/1/depth")), ["labels", "overlays", "planes.jsonl", "planes.mcap"]);
    bench.run(&["track", "walks/0/depth", "--out-dir", "few", "--only", "labels,lines"]).ok();
    assert_eq!(names_in(&bench.folder.join("few/depth")), ["labels", "planes.jsonl"]);
}

#[test]
fn recorded_videos_have_the_results_that_they_have_alone() {
    let bench = Bench::new("videos_recorded");
    let Some(data) = data() else { return };
    let both = ["video_7scenes", "video_tsdf_fusion"].map(|name| data.join(name).to_str().unwrap().to_string());
    bench.run(&["track", &both[0], &both[1], "--out-dir", "out", "--only", "lines", "--floor", "--jobs", "5"]).ok();
    for (path, name) in both.iter().zip(["video_7scenes", "video_tsdf_fusion"]) {
        bench.run(&["track", path, "--out", "alone.jsonl", "--floor", "--jobs", "1"]).ok();
        assert!(bench.read("alone.jsonl") == bench.read(&format!("out/{name}/planes.jsonl")), "{name}");
    }
}

#[test]
fn parts_are_the_whole() {
    let bench = bench("videos_parts", 5);
    bench.run(&[&WALKS[..3], &["whole"]].concat()).ok();
    for part in ["1/2", "2/2"] {
        bench.run(&[&WALKS[..], &["--resume", "--shard", part]].concat()).ok();
    }
    assert!(files(&bench.folder.join("out")) == files(&bench.folder.join("whole")));
    let again = bench.run(&[&WALKS[..], &["--resume"]].concat());
    assert!(again.err.contains("5 of 5 inputs are done already"), "{again:?}");
}

#[test]
fn runs_that_are_killed_lose_nothing_and_do_no_video_twice() {
    let bench = bench("videos_killed", 60);
    bench.run(&[&WALKS[..3], &["whole", "--only", "lines,labels"]].concat()).ok();
    let words = [&WALKS[..], &["--only", "lines,labels", "--resume"]].concat();
    let done = || {
        let manifest = std::fs::read(bench.folder.join("out/manifest.jsonl")).unwrap_or_default();
        manifest.iter().filter(|&&byte| byte == b'\n').count()
    };
    let mut random = 11u64;
    for kill in 0..10 {
        let before = done();
        let mut child = bench
            .command()
            .args(&words)
            .args(["--jobs", "5"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let start = Instant::now();
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        while done() <= before + (random >> 62) as usize && start.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_micros(200));
        }
        std::thread::sleep(Duration::from_micros(random >> 50));
        child.kill().unwrap(); // SIGKILL: nothing is tidied up
        child.wait().unwrap();
        assert!(done() > before, "run {kill} did nothing");
    }
    assert!(done() <= 60, "all was done before the last run");
    bench.run(&words).ok();
    assert!(files(&bench.folder.join("out")) == files(&bench.folder.join("whole")));
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for line in lines(&bench, "out/manifest.jsonl") {
        assert_eq!(line["status"], "done");
        *counts.entry(line["input"].to_string()).or_default() += 1;
    }
    // A kill between a video's line and its name makes it be done again: a few microseconds of each video's time.
    let twice = counts.values().filter(|&&count| count > 1).count();
    assert!(counts.len() == 60 && twice <= 1, "{counts:?}");
}

#[test]
fn what_has_changed_or_failed_is_done_again_and_failed_frames_are_counted() {
    let bench = bench("videos_again", 3);
    bench.write("walks/1/depth/2.pgm", b"P5 32 24");
    let words = [&WALKS[..], &["missing", "--resume"]].concat();
    let first = bench.run(&words);
    assert_eq!(first.code, Some(2));
    for said in
        ["walks/1/depth: 1 frame failed; the others are done", "missing: there is no such", "1 of 4 inputs failed"]
    {
        assert!(first.err.contains(said), "{said}: {first:?}");
    }
    let line = &lines(&bench, "out/manifest.jsonl")[1];
    assert!(line["frames"] == 3 && line["failed_frames"] == 1 && line["planes"] == 2, "{line}");
    let before = bench.read("out/0/depth/planes.jsonl");
    bench.write("walks/0/depth/4.pgm", &two_planes(3000));
    let again = bench.run(&words);
    assert!(again.code == Some(2) && again.err.contains("2 of 4 inputs are done already"), "{again:?}");
    let after = bench.read("out/0/depth/planes.jsonl");
    assert!(after.starts_with(&before) && after.len() > before.len(), "the video has a frame more");
    assert!(names_in(&bench.folder.join("out/0")) == ["depth"], "{:?}", names_in(&bench.folder.join("out/0")));
    // Of a single video that has failed frames, the others are there, and the exit code says it.
    let part = bench.run(&["track", "walks/1/depth", "--out-dir", "part"]);
    assert!(part.code == Some(2) && part.err.contains("1 of 1 inputs failed in part"), "{part:?}");
}

#[test]
fn results_never_take_the_place_of_something_else() {
    let bench = bench("videos_place", 2);
    std::fs::create_dir_all(bench.folder.join("out/1/depth")).unwrap();
    bench.write("out/1/depth/mine", b"mine");
    for resume in [&["--resume"][..], &[]] {
        let error = bench.run(&[&WALKS[..], resume].concat()).fails(2);
        assert!(error.contains("out/1/depth is there already") && error.contains("--resume"), "{error}");
    }
    assert!(!bench.folder.join("out/0").exists() && bench.read("out/1/depth/mine") == b"mine");
    for (words, said) in [
        (&["track", "walks/0/depth", "walks/1/depth"][..], "2 videos were given"),
        (&["track", "walks/0/depth", "walks/1/depth", "--out-dir", "o"], "would both have their results in depth"),
        (&["track", "walks/0/depth", "--out-dir", "walks/0/depth/o"], "lies in the source"),
        (&["track", "nothing*", "--out-dir", "o"], "no file or folder matches"),
        (&["track", "-", "--out-dir", "o"], "standard input has no name"),
        (&["track", "walks/0/depth", "--out-dir", "o", "--out", "p"], "cannot be used with"),
        (&["track", "walks/0/depth", "--only", "lines"], "--out-dir"),
        (&["track", "walks/0/depth", "--out-dir", "o", "--only", "pictures"], "overlays"),
    ] {
        let error = bench.run(words).fails(2);
        assert!(error.contains(said), "{error}");
    }
    assert!(!bench.folder.join("o").exists());
    // Other words do not go on in the same folder.
    bench.run(&["track", "walks/0/depth", "--out-dir", "other", "--resume"]).ok();
    let error = bench.run(&["track", "walks/0/depth", "--out-dir", "other", "--resume", "--floor"]).fails(2);
    assert!(error.contains("another floor: false instead of true"), "{error}");
    let error = bench.run(&["detect", "walks/0/depth", "--out-dir", "other", "--resume"]).fails(2);
    assert!(error.contains("another command: \"track\" instead of \"detect\""), "{error}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_whole_videos_only() {
    let bench = bench("videos_interrupted", 1);
    let words = [&WALKS[..], &["scene:boxes:size=64x48,frames=1000000", "--only", "lines", "--resume"]].concat();
    let child = bench.command().args(&words).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let hidden = bench.folder.join("out/.scene_boxes_size_64x48_frames_1000000.partial/planes.jsonl");
    let start = Instant::now();
    while hidden.metadata().map_or(0, |file| file.len()) < 20_000 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(bench.command_of("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let ran = Ran::from(child.wait_with_output().unwrap());
    assert!(ran.code == Some(130) && ran.err.contains("interrupted") && ran.err.contains("go on"), "{ran:?}");
    assert_eq!(names_in(&bench.folder.join("out")), ["0", "manifest.jsonl"]);
    assert_eq!(lines(&bench, "out/manifest.jsonl").len(), 1);
}
