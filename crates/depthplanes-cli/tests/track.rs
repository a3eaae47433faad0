//! `depthplanes track`: lines, label images and pictures of videos, whole and broken ones.

mod support;

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::process::Stdio;
use std::time::{Duration, Instant};
use support::{Bench, Ran, data, two_planes};

fn lines(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"))).collect()
}

fn ids(line: &Value) -> Vec<u64> {
    line["planes"].as_array().unwrap().iter().map(|plane| plane["id"].as_u64().unwrap()).collect()
}

const SCENE: &str = "scene:boxes:size=160x120,frames=4";

#[test]
fn each_frame_is_a_line_a_label_image_and_a_picture() {
    let bench = Bench::new("track_outputs");
    let out = bench.run(&["track", SCENE, "--out", "t.jsonl", "--labels", "labels", "--overlays", "pictures"]).ok();
    assert!(out.starts_with("id  frames  first  last  mean pixels"), "{out}");
    let lines = lines(&String::from_utf8(bench.read("t.jsonl")).unwrap());
    assert_eq!(lines.len(), 4);
    for (index, line) in lines.iter().enumerate() {
        assert_eq!((&line["schema"], &line["index"]), (&"depthplanes.track/1".into(), &index.into()));
        assert!((line["time_s"].as_f64().unwrap() - index as f64 / 30.0).abs() < 1e-9 && line["pose"].is_object());
        let plane = &line["planes"][0];
        for key in ["id", "label", "state", "age", "pixel_count", "normal", "distance_m", "covariance", "area_m2"] {
            assert!(!plane[key].is_null(), "{key}: {plane}");
        }
        // The pixels of the label image are those of the line, under the ids.
        let mut decoder = image(&bench.read(&format!("labels/{index:06}.png")));
        let labelled = line["planes"].as_array().unwrap().iter();
        for (id, count) in labelled.map(|plane| (plane["id"].as_u64().unwrap(), plane["pixel_count"].as_u64().unwrap()))
        {
            assert_eq!(decoder.remove(&id), Some(count), "{id}");
        }
        decoder.remove(&0);
        assert!(decoder.is_empty(), "{decoder:?}");
        assert_eq!(&bench.read(&format!("pictures/{index:06}.png"))[1..4], b"PNG");
    }
    let kept: BTreeSet<u64> = ids(&lines[0]).into_iter().filter(|id| ids(&lines[3]).contains(id)).collect();
    assert!(kept.len() >= 3, "{lines:?}");
    let streamed = bench.run(&["track", SCENE, "--out", "-"]).ok();
    assert_eq!(streamed.as_bytes(), bench.read("t.jsonl"), "the same source gives the same lines");
}

/// How often each value occurs in a 16-bit grey PNG, by the program's own reader.
fn image(png: &[u8]) -> BTreeMap<u64, u64> {
    let labels = depthplanes_io::labels::decode_labels(png, "labels.png", &Default::default()).unwrap();
    let mut counts = BTreeMap::new();
    labels.labels.iter().for_each(|&label| *counts.entry(u64::from(label)).or_default() += 1);
    counts
}

#[test]
fn the_ground_is_in_the_lines_if_it_is_wanted() {
    let bench = Bench::new("track_floor");
    let out = bench.run(&["track", "scene:corridor:size=320x240,frames=3", "--floor", "--out", "-"]).ok();
    for line in lines(&out) {
        let height = line["ground"]["floor"]["height_m"].as_f64().unwrap();
        assert!((height - 1.45).abs() < 0.15, "{line}");
        assert!(line["ground"]["sectors"].as_array().is_some_and(|sectors| !sectors.is_empty()));
    }
    assert!(lines(&bench.run(&["track", SCENE, "--out", "-"]).ok())[0].get("ground").is_none());
}

#[test]
fn up_in_the_world_of_the_poses_is_up_in_every_frame() {
    let bench = Bench::new("track_world_up");
    let run = |up: &[&str]| {
        let words = ["track", "scene:robot:seed=5001,size=320x240,frames=3", "--floor", "--out", "-"];
        lines(&bench.run(&[&words, up].concat()).ok())
    };
    let (estimated, known) = (run(&[]), run(&["--world-up", "0,0,1"]));
    for (line, of_pose) in estimated.iter().zip(&known) {
        let floor = |line: &Value, of: &str| line["ground"]["floor"][of].as_f64().unwrap();
        assert!((floor(line, "height_m") - floor(of_pose, "height_m")).abs() < 0.03, "{line} {of_pose}");
        // Of the pose, up is the last row of the rotation.
        let row = of_pose["pose"]["rotation"][2].as_array().unwrap();
        let up = of_pose["ground"]["up"].as_array().unwrap();
        assert!(row.iter().zip(up).all(|(a, b)| (a.as_f64().unwrap() - b.as_f64().unwrap()).abs() < 1e-9), "{of_pose}");
    }
    let words =
        ["track", "scene:robot:seed=5001,size=320x240,frames=2", "--floor", "--world-up", "0,0,-1", "--out", "-"];
    let ran = bench.run(&words);
    assert!(ran.code == Some(0), "{}", ran.err);
    assert!(ran.err.contains("no frame has a floor with the up that --world-up states"), "{}", ran.err);
    assert!(known.iter().all(|line| line["ground"]["floor"].is_object()), "the right one has a floor");
    let words =
        ["track", "scene:boxes:frames=1,pose=none,size=160x120", "--floor", "--world-up", "0,0,1", "--out", "-"];
    let ran = bench.run(&words);
    assert!(
        ran.code == Some(2)
            && ran.err.contains("there is no pose; accepted: poses, or an up in the camera's coordinates (--up)"),
        "{}",
        ran.err
    );
}

#[test]
fn a_broken_frame_is_said_and_survived_and_so_are_other_sizes_and_times() {
    let bench = Bench::new("track_broken");
    std::fs::create_dir(bench.folder.join("video")).unwrap();
    for (name, near) in
        [("1580908150200", 1000), ("1580908150233", 1001), ("1580908150266", 1002), ("1580908159000", 1003)]
    {
        bench.write(&format!("video/{name}.pgm"), &two_planes(near));
    }
    bench.write("video/1580908150300.pgm", b"P5 32 24 65535\nshort");
    bench.write("video/1580908159033.pgm", &[b"P5 16 16 65535\n".as_slice(), &[4; 512]].concat());
    let ran = bench.run(&["track", "video", "--out", "-", "--encoding", "millimetre", "--min-pixels", "50"]);
    assert_eq!(ran.code, Some(2), "{ran:?}");
    let lines = lines(&ran.out);
    assert_eq!(lines.len(), 6);
    assert!(lines[3]["error"].as_str().unwrap().contains("1580908150300.pgm"), "{}", lines[3]);
    assert_eq!((ids(&lines[0]), ids(&lines[4])), (vec![1, 2], vec![1, 2]), "{}", ran.out);
    for said in ["time jumps by 8.7", "16 x 16 pixels, before 32 x 24", "1 frame failed; the others are done"] {
        assert!(ran.err.contains(said), "{said}: {}", ran.err);
    }
}

#[test]
fn other_names_of_files_are_refused_and_planes_beyond_the_table_are_counted() {
    let bench = Bench::new("track_names");
    let error = bench.run(&["track", "scene:boxes:frames=1,size=64x48", "--out", "t.txt"]).fails(2);
    assert!(error.contains("t.txt ends in .txt; accepted: .jsonl") && !bench.folder.join("t.txt").exists(), "{error}");
    let words = ["track", "scene:boxes:seed=3,frames=12,size=320x240,sensor=kinect", "--min-pixels", "20"];
    let table = bench.run(&words).ok();
    let lines = lines(&bench.run(&[&words[..], &["--out", "-"]].concat()).ok());
    let last = lines.iter().flat_map(ids).max().unwrap();
    assert!(last > 21, "{last}");
    assert!(
        table.ends_with(&format!("and {} planes seen in fewer pixels; --out FILE.jsonl has all\n", last - 20)),
        "{table}"
    );
}

#[test]
fn what_fails_of_every_frame_is_said_a_few_times_and_is_in_every_line() {
    let bench = Bench::new("track_no_camera");
    std::fs::create_dir(bench.folder.join("video")).unwrap();
    (0..9).for_each(|at| bench.write(&format!("video/{at}.pgm"), &two_planes(1000)));
    let ran = bench.run(&["track", "video", "--encoding", "millimetre", "--floor", "--out", "-"]);
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert_eq!(ran.err.matches("error: `floor` needs").count(), 5, "{}", ran.err);
    assert_eq!(ran.err.matches("no camera: --preset").count(), 1, "{}", ran.err);
    assert!(ran.err.contains("9 frames failed, and no other came from the source"), "{}", ran.err);
    assert!(
        lines(&ran.out).iter().all(|line| line["error"].as_str().unwrap().contains("planes in metres")),
        "{}",
        ran.out
    );
}

/// How a run ends that is given these bytes on standard input.
fn fed(bench: &Bench, words: &[&str], bytes: &[u8]) -> Ran {
    let mut command = bench.command();
    command.args(words).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all(bytes).unwrap();
    drop(pipe);
    Ran::from(child.wait_with_output().unwrap())
}

#[test]
fn raw_frames_come_from_a_pipe_and_an_end_in_the_middle_is_said() {
    let bench = Bench::new("track_raw");
    let words = ["track", "-", "--raw-size", "32x24", "--encoding", "millimetre", "--min-pixels", "50", "--out", "-"];
    let frame: Vec<u8> =
        (0..32 * 24).flat_map(|at| (if at % 32 < 16 { 1000u16 } else { 1500 }).to_le_bytes()).collect();
    let ran = fed(&bench, &words, &[&frame[..], &frame, &frame, &frame[..500]].concat());
    assert_eq!(lines(&ran.out).iter().take(3).map(ids).collect::<Vec<_>>(), vec![vec![1, 2]; 3], "{}", ran.err);
    assert!(ran.err.contains("500 of 1536 bytes") && ran.code == Some(2), "{}", ran.err);
}

#[test]
fn a_source_that_stalls_is_said_once_and_waited_for() {
    let bench = Bench::new("track_stalls");
    let words = ["track", "-", "--raw-size", "32x24", "--encoding", "millimetre", "--min-pixels", "50", "--out", "-"];
    let mut command = bench.command();
    command.args(words).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all(&[4; 32 * 24 * 2]).unwrap();
    std::thread::sleep(Duration::from_secs(8));
    pipe.write_all(&[4; 32 * 24 * 2]).unwrap();
    drop(pipe);
    let ran = Ran::from(child.wait_with_output().unwrap());
    assert_eq!((lines(&ran.out).len(), ran.code), (2, Some(0)), "{}", ran.err);
    assert_eq!(ran.err.matches("no frame has come from the source for").count(), 1, "{}", ran.err);
}

#[test]
fn frames_searched_at_the_same_time_give_the_same_lines() {
    let bench = Bench::new("track_jobs");
    let run = |jobs: &str| {
        bench.run(&["track", "scene:room:size=160x120,frames=20", "--floor", "--jobs", jobs, "--out", "-"]).ok()
    };
    let one = run("1");
    assert_eq!(lines(&one).len(), 20);
    assert!(run("2") == one && run("5") == one);
}

#[test]
fn what_ends_the_program_leaves_whole_lines() {
    let bench = Bench::new("track_killed");
    let words = ["track", "scene:boxes:size=64x48,frames=1000000", "--out", "t.jsonl"];
    let mut child = bench.command().args(words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    let text = || std::fs::read_to_string(bench.folder.join("t.jsonl")).unwrap_or_default();
    while text().lines().count() < 20 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    let text = text();
    let whole = &text[..=text.rfind('\n').unwrap()];
    let lines = lines(whole);
    assert!(lines.len() >= 20, "{}", lines.len());
    assert!(lines.iter().enumerate().all(|(index, line)| line["index"] == index));
}

#[test]
fn live_drops_frames_rather_than_falling_behind() {
    let bench = Bench::new("track_live");
    let words = ["track", "-", "--raw-size", "32x24", "--encoding", "millimetre", "--live", "--out", "-"];
    let ran = fed(&bench, &words, &vec![4u8; 32 * 24 * 2 * 3000]);
    let lines = lines(&ran.out);
    let dropped = lines.last().unwrap()["dropped"].as_u64().unwrap();
    assert_eq!(lines.len() as u64 + dropped, 3000, "{}", ran.err);
    assert_eq!(lines.last().unwrap()["index"], 2999, "the newest frame is there");
    assert_eq!(dropped > 0, ran.err.contains("frames were dropped"), "{}", ran.err);
}

#[test]
fn wrong_words_are_refused_before_anything_is_written() {
    let bench = Bench::new("track_wrong");
    for (words, said) in [
        (&["nowhere"][..], "nowhere: there is no such file or folder"),
        (&["-"], "--raw-size"),
        (&[SCENE, "--method", "ngaf", "--noise-scale", "2"], "has no parameter"),
        (&[SCENE, "--camera-height", "-1", "--floor"], "camera-height"),
        (&[SCENE, "--out", "nowhere/t.jsonl"], "nowhere"),
    ] {
        let words = if words.contains(&"--out") { words.to_vec() } else { [words, &["--out", "t.jsonl"]].concat() };
        let error = bench.run(&[&["track"], &words[..]].concat()).fails(2);
        assert!(error.contains(said), "{error}");
        assert!(bench.names().is_empty(), "{:?}", bench.names());
    }
}

#[test]
fn frames_are_never_overwritten_by_what_is_made_from_them() {
    let bench = Bench::new("track_overwrite");
    std::fs::create_dir_all(bench.folder.join("video/depth")).unwrap();
    let map = two_planes(1000);
    bench.write("video/000000.pgm", &map);
    bench.write("video/depth/000000.png", &map);
    for words in [
        &["--labels", "video"][..],
        &["--overlays", "video/depth"],
        &["--labels", "./video/../video"],
        &["--out", "video/000000.pgm"],
        &["--labels", "new", "--overlays", "new"],
    ] {
        let error = bench.run(&[&["track", "video"], words].concat()).fails(2);
        assert!(error.contains("belongs to the source video") || error.contains("the same folder"), "{error}");
    }
    assert!(bench.read("video/000000.pgm") == map && bench.read("video/depth/000000.png") == map);
    assert_eq!(bench.names(), ["video"]);
    bench.run(&["track", "video", "--encoding", "millimetre", "--labels", "video/ids", "--out", "video/t.jsonl"]).ok();
    assert_eq!(bench.read("video/000000.pgm"), map);
}

#[cfg(unix)]
#[test]
fn inputs_are_not_overwritten_under_other_names_either() {
    let bench = Bench::new("track_inputs");
    std::fs::create_dir_all(bench.folder.join("video")).unwrap();
    bench.write("video/0.pgm", &two_planes(1000));
    bench.write("camera.json", br#"{"fx": 30, "fy": 30, "cx": 15.5, "cy": 11.5, "width": 32, "height": 24}"#);
    bench.write("raw.bin", &[4; 32 * 24 * 2]);
    bench.run(&["track", "scene:boxes:frames=2,size=64x48", "--out", "t.mcap"]).ok();
    std::fs::hard_link(bench.folder.join("t.mcap"), bench.folder.join("same.mcap")).unwrap();
    let before = bench.read("t.mcap");
    let error = bench.run(&["track", "t.mcap:/depthplanes/labels", "--out", "same.mcap"]).fails(2);
    assert!(error.contains("same.mcap is the file of t.mcap") && bench.read("t.mcap") == before, "{error}");
    let error = bench.run(&["track", "video", "--camera", "camera.json", "--out", "camera.json"]).fails(2);
    assert!(
        error.contains("is the file of camera.json") && bench.read("camera.json").starts_with(b"{\"fx\""),
        "{error}"
    );
    let words = ["track", "-", "--raw-size", "32x24", "--out", "raw.bin"];
    let mut command = bench.command();
    let stdin = std::fs::File::open(bench.folder.join("raw.bin")).unwrap();
    let ran = Ran::from(command.args(words).stdin(stdin).output().unwrap());
    assert!(ran.code == Some(2) && ran.err.contains("standard input"), "{}", ran.err);
    assert_eq!(bench.read("raw.bin"), [4; 32 * 24 * 2]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_recording_is_finished() {
    let bench = Bench::new("track_interrupted");
    let words = ["track", "scene:boxes:size=64x48,frames=1000000", "--out", "t.mcap"];
    let child = bench.command().args(words).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    let size = || bench.folder.join("t.mcap").metadata().map_or(0, |file| file.len());
    while size() < 20_000 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    let signalled = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(signalled.success());
    let ran = Ran::from(child.wait_with_output().unwrap());
    assert!(ran.code == Some(130) && ran.err.contains("interrupted after "), "{ran:?}");
    assert!(bench.read("t.mcap").ends_with(b"\x89MCAP0\r\n"), "the file has its end");
}

/// Ids of the recorded videos by the frames in which their plane has at least so many pixels.
fn frames_of_ids(lines: &[Value], least: u64) -> BTreeMap<u64, usize> {
    let mut frames = BTreeMap::new();
    for plane in lines.iter().flat_map(|line| line["planes"].as_array().unwrap()) {
        if plane["pixel_count"].as_u64().unwrap() >= least {
            *frames.entry(plane["id"].as_u64().unwrap()).or_default() += 1;
        }
    }
    frames
}

#[test]
fn large_planes_of_recorded_videos_keep_one_id() {
    let bench = Bench::new("track_recorded");
    let Some(data) = data() else { return };
    // Of 7-Scenes at most 8 planes are so large at once, and there are 8 ids in 40 frames. Of TSDF, where the camera turns
    // away, walls, cupboards and the floor are 6 planes; a seventh id is that of one frame in which two of them are one.
    for (folder, least, ids, whole) in [("video_7scenes", 8000, 8, 6), ("video_tsdf_fusion", 15_000, 7, 2)] {
        let out = bench.run(&["track", data.join(folder).to_str().unwrap(), "--out", "-"]).ok();
        let lines = lines(&out);
        let frames = frames_of_ids(&lines, least);
        let all = frames.values().filter(|&&count| count == lines.len()).count();
        assert!(frames.len() <= ids && all >= whole, "{folder}, {} frames: {frames:?}", lines.len());
    }
}
