//! Wrong use and wrong inputs: exit code 2, a message that helps, and nothing left behind.

mod support;

use std::path::Path;
use support::{Bench, Ran, names_in, two_planes};

/// Words after the program's name, and what the message must say.
const WRONG: &[(&[&str], &str)] = &[
    (&["dettect", "map.pgm"], "detect"),
    (&["detect", "map.pgm", "--thetta", "2"], "--theta"),
    (&["detect"], "<INPUT>"),
    (&["detect", "gone.pgm"], "gone.pgm"),
    (&["detect", "notes.txt"], "accepted: PNG"),
    (&["detect", "cut.pgm", "--labels", "l.png"], "cut.pgm"),
    (&["detect", "map.pgm", "--method", "ngaf", "--theta", "-1"], "a number from 0 up"),
    (&["detect", "map.pgm", "--method", "ngaf", "--theta", "nan"], "a number from 0 up"),
    (&["detect", "map.pgm", "--theta", "two"], "`two` is not a number"),
    (&["detect", "map.pgm", "--method", "ngaf", "--window", "4"], "odd whole number from 3 to 31"),
    (&["detect", "map.pgm", "--min-pixels", "1.5"], "a whole number from 0"),
    (&["detect", "map.pgm", "--min-pixels", "-1"], "a whole number from 0"),
    (&["detect", "map.pgm", "--theta", "2"], "`planar` has no parameter `theta`; --method ngaf has it"),
    (&["detect", "map.pgm", "--window", "4"], "--method ngaf has it"),
    (&["explain", "map.pgm", "--at", "1,1", "--margin", "4"], "--method ngaf has it"),
    (&["detect", "map.pgm", "--method", "ngaf", "--noise", "2"], "--method planar or --method mdl has it"),
    (&["detect", "map.pgm", "--method", "magic"], "ngaf"),
    (&["detect", "map.pgm", "--encoding", "furlongs"], "encoding"),
    (&["detect", "map.pgm", "--preset", "eyes"], "preset"),
    (&["detect", "map.pgm", "--intrinsics", "1,2,3"], "4 numbers with commas between and no blanks; 3 were given"),
    (&["detect", "map.pgm", "--intrinsics", "0,1,2,3"], "fx is 0"),
    (&["detect", "map.pgm", "--scale", "0"], "0"),
    (&["detect", "map.pgm", "--valid-range", "9,3"], "9 to 3 is empty"),
    (&["detect", "map.pgm", "--raw-size", "32"], "640x480"),
    (&["detect", "map.pgm", "--raw-size", "9999x9999"], "map.pgm"),
    (&["detect", "map.pgm", "--baseline", "0.1"], "--focal"),
    (&["detect", "map.pgm", "--focal", "500"], "--baseline"),
    (&["detect", "map.pgm", "--camera", "gone.json"], "gone.json"),
    (&["detect", "map.pgm", "--camera", "notes.txt"], "notes.txt"),
    (&["detect", "map.pgm", "--noise-table", "gone.csv"], "gone.csv"),
    (&["detect", "map.pgm", "--noise-table", "notes.txt"], "notes.txt: not a readable table of noise"),
    (&["detect", "map.pgm", "--noise-table", "notes.txt", "--noise", "1"], "cannot be used with"),
    (&["noise"], "<INPUT>"),
    (&["noise", "gone.pgm"], "gone.pgm"),
    (&["detect", "map.pgm", "--repeat", "0"], "from 1 to 1000000"),
    (&["detect", "map.pgm", "--repeat", "9999999999999"], "from 1 to 1000000"),
    (&["detect", "map.pgm", "--jobs", "0"], "from 1 to 1000000"),
    (&["detect", "map.pgm", "--labels", "l.tif"], ".png or .npy"),
    (&["detect", "map.pgm", "--planes", "planes"], ".json, .csv"),
    (&["detect", "map.pgm", "--labels", "no/l.png"], "the folder `no` does not exist"),
    (&["detect", "map.pgm", "--labels", "folder.png"], "this is a folder"),
    (&["detect", "same.png", "--labels", "same.png"], "would overwrite the input same.png"),
    (&["detect", "map.pgm", "--labels", "x.png", "--overlay", "./x.png"], "would overwrite"),
    (&["detect", "map.pgm", "same.png", "--labels", "l.png"], "use --out-dir"),
    (&["detect", "map.pgm", "folder.png/map.pgm", "--out-dir", "d"], "would overwrite the labels of map.pgm"),
    (&["detect", "map.pgm", "--out-dir", "notes.txt"], "this is a file"),
    (&["detect", "map.pgm", "--cloud", "c.ply", "--labels", "l.png"], "--intrinsics"),
    (&["detect", "map.pgm", "--mesh", "m.ply", "--labels", "l.png"], "--intrinsics"),
    (&["detect", "map.pgm", "--disparity", "--mesh", "m.ply"], "--baseline"),
    (&["detect", "map.pgm", "--mesh", "m.obj"], "`mesh` is written as .ply"),
    (&["detect", "map.pgm", "--outlines=-1"], "`outlines` is -1; accepted: a number of pixels from 0 up"),
    (&["detect", "map.pgm", "--outlines=nan"], "`outlines` is NaN; accepted"),
    (&["detect", "map.pgm", "--outlines=inf"], "`outlines` is inf; accepted"),
    (&["detect", "map.pgm", "--outlines=fine"], "`fine` is not a number"),
    (&["detect", "--outlines", "2"], "2: "),
    (&["detect", "empty"], "no map in this folder"),
    (&["detect", "*.exr"], "no file matches"),
    (&["detect", "-", "-"], "only once"),
    (&["detect", "-"], "-: "),
    (&["detect", "scene:atlantis"], "room"),
    (&["detect", "scene:room:sensor=sonar"], "kinect_white"),
    (&["inspect", "notes.txt"], "accepted: PNG"),
    (&["inspect", "gone.pgm"], "gone.pgm"),
    (&["score", "map.pgm"], "<PRED>"),
    (&["score", "map.pgm", "gone.png"], "gone.png"),
    (&["score", "map.pgm", "notes.txt"], "accepted: a label image"),
    (&["score", "cut.pgm", "map.pgm"], "cut.pgm"),
    (&["score", "map.pgm", "floats.pfm"], "floats.pfm: not a readable pfm: it holds floating-point numbers"),
    (&["score", "map.pgm", "small.pgm"], "small.pgm: 2 x 1 labels, but the truth map.pgm has 32 x 24"),
    (&["score", "map.pgm", "map.pgm", "--tolerance", "0.5"], "is 0.5; accepted: a number from 0.51 to 0.95"),
    (&["score", "map.pgm", "map.pgm", "--tolerance", "nan"], "a number from 0.51 to 0.95"),
    (&["score", "map.pgm", "map.pgm", "--tolerance", "much"], "`much` is not a number"),
    (&["score", "map.pgm", "map.pgm", "--truth-from", "0"], "a whole number from 1 to 65535"),
    (&["score", "map.pgm", "folder.png"], "folder.png: this is a folder, but map.pgm is not"),
    (&["score", "folder.png", "twice"], "twice/map."),
    (&["score", "folder.png", "empty"], "empty: no label image in this folder"),
    (&["score", "twice", "folder.png"], "keep one of them"),
    (&["score", "folder.png", "other"], "folder.png/map.pgm: no prediction for it; other/map.labels.png would be one"),
    (&["score", "scene:atlantis", "map.pgm"], "room"),
    (&["score", "scene:room", "map.pgm"], "both must be of the same map"),
    (&["params", "magic"], "ngaf"),
    (&["completions", "dosshell"], "bash"),
    (&["demo", "--out-dir", "notes.txt"], "notes.txt"),
];

/// The folder of every wrong invocation.
fn bench(name: &str) -> Bench {
    let bench = Bench::with_map(name);
    bench.write("notes.txt", b"hello");
    bench.write("same.png", &two_planes(700));
    let whole = two_planes(700);
    bench.write("cut.pgm", &whole[..whole.len() / 2]);
    std::fs::create_dir(bench.folder.join("empty")).unwrap();
    std::fs::create_dir(bench.folder.join("folder.png")).unwrap();
    bench.write("folder.png/map.pgm", &whole);
    bench.write("small.pgm", b"P5 2 1 255\n\x00\x01");
    bench.write("floats.pfm", b"Pf\n1 1\n-1.0\n\x00\x00\x80\x3f");
    for folder in ["twice", "other"] {
        std::fs::create_dir(bench.folder.join(folder)).unwrap();
    }
    bench.write("twice/map.pgm", &whole);
    bench.write("twice/map.pnm", &whole);
    bench.write("other/another.pgm", &whole);
    bench
}

/// Every file with its bytes, and every folder.
fn everything(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for name in names_in(folder) {
        let path = folder.join(&name);
        if path.is_dir() {
            all.push((name, Vec::new()));
            all.extend(everything(&path));
        } else {
            let bytes = std::fs::read(&path).unwrap();
            all.push((name, bytes));
        }
    }
    all
}

#[test]
fn every_wrong_invocation_helps_and_leaves_nothing_behind() {
    let bench = bench("wrong");
    let before = everything(&bench.folder);
    for (words, says) in WRONG {
        let ran = bench.run(words);
        assert_eq!(ran.out, "", "{words:?}");
        let message = ran.fails(2);
        assert!(message.contains(says), "{words:?} should say `{says}`: {message}");
        assert_eq!(everything(&bench.folder), before, "{words:?} changed the folder");
    }
}

#[test]
fn without_a_word_the_program_prints_its_help_and_fails() {
    let bench = Bench::new("no_words");
    let ran = bench.run(&[]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("Usage: depthplanes"), "{ran:?}");
}

#[test]
fn after_a_bad_file_the_others_are_done() {
    let bench = bench("one_bad");
    for jobs in ["1", "3"] {
        let words = ["detect", "map.pgm", "cut.pgm", "notes.txt", "same.png", "--out-dir", "d", "--jobs", jobs];
        let ran = bench.run(&words);
        let message = ran.fails(2);
        assert!(message.contains("error: cut.pgm: "), "{message}");
        assert!(message.contains("error: notes.txt: "), "{message}");
        assert!(message.contains("2 of 4 inputs failed"), "{message}");
        let names = names_in(&bench.folder.join("d"));
        let stems: Vec<&str> = names.iter().map(|name| name.split('.').next().unwrap()).collect();
        assert_eq!(stems, ["map", "map", "map", "same", "same", "same"]);
        std::fs::remove_dir_all(bench.folder.join("d")).unwrap();
    }
}

#[test]
fn if_every_file_is_bad_no_folder_is_made() {
    let bench = bench("all_bad");
    bench.run(&["detect", "cut.pgm", "notes.txt", "--out-dir", "d"]).fails(2);
    assert!(!bench.folder.join("d").exists());
}

#[test]
fn a_parameter_that_the_method_lacks_is_named() {
    // Each method has its own; where one lacks a flag of another, the message lists what it has.
    let bench = Bench::with_map("lacks");
    for method in depthplanes::methods::METHODS {
        let others = depthplanes::methods::METHODS.iter().flat_map(|other| other.params);
        let lacking = others.filter(|param| method.params.iter().all(|own| own.name != param.name));
        for param in lacking {
            let flag = format!("--{}", param.name.replace('_', "-"));
            let ran = bench.run(&["detect", "map.pgm", "--method", method.name, &flag, &param.default.to_string()]);
            let message = ran.fails(2);
            assert!(
                message.contains(&format!("method `{}` has no parameter `{}`", method.name, param.name)),
                "{message}"
            );
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_refuses_is_exit_code_1() {
    let bench = Bench::with_map("disk");
    let message = bench.run(&["detect", "map.pgm", "--labels", "/proc/labels.png"]).fails(1);
    assert!(message.contains("/proc/labels.png: cannot be written"), "{message}");
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let ran = Ran::from(bench.command().args(["detect", "map.pgm"]).stdout(full).output().unwrap());
    assert!(ran.fails(1).contains("standard output"));
}
