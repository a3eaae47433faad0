//! `depthplanes track --out FILE.mcap`, read back by our own reader. What others read of it is in
//! `tests/oracles/test_mcap.py`.

mod support;

use depthplanes_io::Pixels;
use depthplanes_video::{SourceOptions, VideoFrame, open};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};
use support::{Bench, two_planes};

const SCENE: &str = "scene:boxes:size=160x120,frames=4";

/// The label images of a recording, and what is wrong at its end.
fn labels(path: &Path) -> (Vec<VideoFrame>, Option<String>) {
    let mut source = open(&format!("{}:/depthplanes/labels", path.display()), &SourceOptions::default()).unwrap();
    let mut frames = Vec::new();
    loop {
        match source.next_frame() {
            Some(Ok(frame)) => frames.push(frame),
            Some(Err(error)) => {
                assert!(source.next_frame().is_none());
                return (frames, Some(error.to_string()));
            }
            None => return (frames, None),
        }
    }
}

#[test]
fn a_recording_has_the_label_images_of_the_folder() {
    let bench = Bench::new("record_labels");
    let out = bench.run(&["track", SCENE, "--out", "t.mcap", "--labels", "labels"]).ok();
    assert!(out.starts_with("id  frames  first  last  mean pixels"), "{out}");
    let (frames, fault) = labels(&bench.folder.join("t.mcap"));
    assert_eq!((frames.len(), fault), (4, None));
    for frame in frames {
        let png = bench.read(&format!("labels/{:06}.png", frame.index));
        let expected = depthplanes_io::labels::decode_labels(&png, "labels.png", &Default::default()).unwrap();
        assert_eq!(frame.frame.pixels, Pixels::U16(expected.labels));
        assert!((frame.time_s.unwrap() - frame.index as f64 / 30.0).abs() < 1e-6 || frame.index == 0);
    }
    // Label images are no depth.
    let error = bench.run(&["track", "t.mcap"]).fails(2);
    assert!(error.contains("no depth in it") && error.contains("/depthplanes/labels"), "{error}");
}

#[test]
fn what_ends_the_program_leaves_whole_chunks() {
    let bench = Bench::new("record_killed");
    let words = ["track", "scene:boxes:size=64x48,frames=1000000", "--out", "t.mcap"];
    let mut child = bench.command().args(words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let (start, path) = (Instant::now(), bench.folder.join("t.mcap"));
    let length = || std::fs::metadata(&path).map_or(0, |file| file.len());
    while length() < 500_000 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    let (frames, fault) = labels(&path);
    assert!(frames.len() >= 20, "{}", frames.len());
    assert!(frames.iter().enumerate().all(|(index, frame)| frame.index == index as u64));
    assert!(fault.unwrap().contains("was the recorder killed?"));
}

#[test]
fn a_recording_says_which_frames_could_not_be_read_and_is_never_overwritten_by_itself() {
    let bench = Bench::new("record_broken");
    std::fs::create_dir(bench.folder.join("video")).unwrap();
    (0..3).for_each(|at| bench.write(&format!("video/{at}.pgm"), &two_planes(1000)));
    bench.write("video/1.pgm", b"P5 32 24 65535\nshort");
    let ran = bench.run(&["track", "video", "--encoding", "millimetre", "--min-pixels", "50", "--out", "t.MCAP"]);
    assert_eq!(ran.code, Some(2), "{ran:?}");
    // Without a camera there are labels all the same.
    std::fs::rename(bench.folder.join("t.MCAP"), bench.folder.join("t.mcap")).unwrap();
    let (frames, fault) = labels(&bench.folder.join("t.mcap"));
    assert_eq!((frames.len(), fault), (2, None));
    let times: Vec<f64> = frames.iter().map(|frame| (frame.time_s.unwrap() * 30.0).round()).collect();
    assert_eq!(times, [0.0, 2.0]);
    for source in ["t.mcap", "t.mcap:/depthplanes/labels"] {
        let error = bench.run(&["track", source, "--out", "t.mcap"]).fails(2);
        assert!(error.contains("belongs to the source"), "{error}");
    }
    assert_eq!(labels(&bench.folder.join("t.mcap")).0.len(), 2);
}
