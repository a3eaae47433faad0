//! The program: its help, wrong invocations, and the commands of docs/video.md. What it records is compared with `track` by Rerun's
//! own package in tests/oracles/test_rerun.py.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn run(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_depthplanes-rerun")).current_dir(folder).args(words).output().unwrap()
}

#[test]
fn help_is_a_page() {
    let output = run(&folder("rerun_help"), &["--help"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && text.contains("--world-up"), "{text}");
    assert!(text.lines().count() < 45, "{} lines", text.lines().count());
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

#[test]
fn what_is_wrong_is_said_with_what_is_accepted() {
    let folder = folder("rerun_wrong");
    let scene = "scene:room:size=64x48,frames=1";
    for (words, code, told) in [
        (&[scene, "--out", "walk.mcap"][..], 2, "accepted: a file that ends in .rrd"),
        (&["nowhere", "--out", "a.rrd"], 2, "there is no such file or folder"),
        (&[scene, "--out", "missing/a.rrd"], 1, "missing/a.rrd: No such file"),
        (&[scene, "--out", "a.rrd", "--up", "0,-1,0"], 2, "--floor"),
        (&[scene, "--out", "a.rrd", "--floor", "--up", "0,0,0"], 2, "accepted: a direction in camera coordinates"),
        (&[scene, "--out", "a.rrd", "--floor", "--up", "1,2"], 2, "accepted: 3 numbers"),
        (&[scene, "--out", "a.rrd", "--intrinsics", "0,1,2,3"], 2, "fx"),
        (&[scene, "--out", "a.rrd", "--encoding", "none"], 2, "none"),
        (&[scene], 2, "--out"),
    ] {
        let output = run(&folder, words);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{words:?}: {said}");
        assert!(said.contains(told) && !said.contains("panicked"), "{words:?}: {said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_the_machines_fault() {
    let folder = folder("rerun_full");
    std::os::unix::fs::symlink("/dev/full", folder.join("full.rrd")).unwrap();
    let output = run(&folder, &["scene:room:size=64x48,frames=2", "--out", "full.rrd"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("full.rrd") && said.contains("No space left"), "{said}");
}

#[test]
fn the_commands_of_the_page_record() {
    let folder = folder("rerun_page");
    let page = include_str!("../../../docs/video.md");
    let commands: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("depthplanes-rerun ")).collect();
    assert_eq!(commands.len(), 2);
    for command in commands {
        let words: Vec<&str> = command.split_whitespace().collect();
        let output = run(&folder, &words);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && said.contains("30 frames, 0 failed"), "{command}: {said}");
        let file = std::fs::read(folder.join(words[words.len() - 1])).unwrap();
        assert!(file.starts_with(b"RRF2") && file.len() > 100_000, "{command}: {} bytes", file.len());
    }
}
