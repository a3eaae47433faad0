//! The commands beside `detect`.

mod support;

use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::formats::FORMATS;
use depthplanes_io::presets::SENSOR_PRESETS;
use depthplanes_io::{Pixels, ReadOptions};
use support::{Bench, names_in, two_planes};

#[test]
fn inspect_shows_size_values_and_a_histogram() {
    let bench = Bench::with_map("inspect");
    let out = bench.run(&["inspect", "map.pgm", "--encoding", "millimetre"]).ok();
    assert!(out.starts_with("map.pgm\n  map        32 x 24, u16, format "), "{out}");
    assert!(out.contains("values     1003 to 1503"), "{out}");
    assert!(out.contains("depth      1.003 m to 1.503 m"), "{out}");
    assert!(out.contains("| ########"), "{out}");
}

#[test]
fn inspect_json_is_one_line_for_each_input() {
    let bench = Bench::with_map("inspect_json");
    let out = bench.run(&["inspect", "map.pgm", "scene:room:size=64x48", "--json"]).ok();
    let records: Vec<serde_json::Value> = out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(records.len(), 2);
    assert_eq!(records[0]["schema"], "depthplanes.inspect/1");
    assert_eq!((&records[0]["width"], &records[0]["distinct"]), (&32.into(), &2.into()));
    assert_eq!(records[1]["source"], "scene:room:size=64x48");
}

#[test]
fn inspect_goes_on_after_a_bad_file() {
    let bench = Bench::with_map("inspect_bad");
    bench.write("bad.pgm", b"P5 never");
    let ran = bench.run(&["inspect", "bad.pgm", "map.pgm"]);
    assert!(ran.out.starts_with("map.pgm\n"), "{ran:?}");
    assert!(ran.fails(2).contains("1 of 2 inputs could not be read"));
}

#[test]
fn demo_leaves_a_depth_map_and_every_output() {
    let bench = Bench::new("demo");
    let out = bench.run(&["demo"]).ok();
    let folder = bench.folder.join("depthplanes-demo");
    assert_eq!(names_in(&folder), ["cloud.ply", "depth.png", "labels.png", "mesh.ply", "overlay.png", "planes.json"]);
    let picture = folder.strip_prefix(&bench.folder).unwrap().join("overlay.png");
    assert!(out.contains(&format!("Look at {}", picture.display())), "{out}");
    let labels = depthplanes_io::read(folder.join("labels.png"), &ReadOptions::default()).unwrap();
    let Pixels::U16(labels) = labels.pixels else { panic!("not 16 bits") };
    let record: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("planes.json")).unwrap()).unwrap();
    assert_eq!(usize::from(*labels.iter().max().unwrap()), record["planes"].as_array().unwrap().len());
    assert!(record["planes"].as_array().unwrap().len() >= 10);
}

#[test]
fn the_folder_of_the_demo_holds_one_map_and_many_planes_are_remarked_on() {
    let bench = Bench::new("demo_folder");
    bench.run(&["demo", "--out-dir", "d"]).ok();
    let ran = bench.run(&["detect", "d", "--method", "ngaf", "--rows", "1"]);
    assert!(ran.out.starts_with("d/depth.png: "), "{ran:?}");
    assert!(ran.err.contains("theta 1 is 1 mm here") && ran.err.contains("try --theta 5"), "{ran:?}");
    assert!(!ran.ok().contains("labels.png"));
}

#[test]
fn the_command_that_the_demo_prints_finds_the_same_planes() {
    let bench = Bench::new("demo_again");
    let out = bench.run(&["demo", "--out-dir", "d"]).ok();
    let command = out.lines().last().unwrap().trim().strip_prefix("depthplanes ").unwrap();
    bench.run(&[&command.split(' ').collect::<Vec<_>>()[..], &["--labels", "again.png"]].concat()).ok();
    assert_eq!(bench.read("again.png"), bench.read("d/labels.png"));
}

#[test]
fn every_row_of_every_table_is_listed() {
    let bench = Bench::new("lists");
    let has = |command: &str, names: Vec<&str>| {
        let out = bench.run(&[command]).ok();
        for name in names {
            assert!(out.lines().any(|line| line.split_whitespace().next() == Some(name)), "{command}: {name}\n{out}");
        }
    };
    has("formats", FORMATS.iter().map(|format| format.name).collect());
    has("encodings", ENCODINGS.iter().map(|encoding| encoding.name).collect());
    has("presets", SENSOR_PRESETS.iter().map(|preset| preset.name).collect());
    has("methods", depthplanes::methods::METHODS.iter().map(|method| method.name).collect());
}

#[test]
fn every_parameter_is_listed_and_is_a_flag() {
    let bench = Bench::new("params");
    let help = bench.run(&["detect", "--help"]).ok();
    let defaults: Vec<&str> = depthplanes::methods::default().params.iter().map(|param| param.name).collect();
    for method in depthplanes::methods::METHODS {
        let out = bench.run(&["params", method.name]).ok();
        for param in method.params {
            let flag = format!("--{}", param.name.replace('_', "-"));
            let line = out.lines().find(|line| line.split([' ', ',']).next() == Some(&flag)).unwrap();
            assert!(line.contains(&param.default.to_string()) && line.contains(param.meaning), "{line}");
            assert!(line.contains(param.source.unwrap_or("ours")), "{line}");
            assert!(param.alias.is_none_or(|alias| line.contains(&format!(", --{alias} "))), "{line}");
            let shown = help.contains(&format!("{flag} <NUMBER>"));
            assert_eq!(shown, defaults.contains(&param.name), "{flag}\n{help}");
        }
    }
}

#[test]
fn encodings_and_presets_can_be_chosen_by_every_name_listed() {
    let bench = Bench::with_map("names");
    for preset in SENSOR_PRESETS {
        let ran = bench.run(&["inspect", "map.pgm", "--preset", preset.name]);
        assert!(!ran.err.contains("possible values"), "{ran:?}");
    }
    for encoding in ENCODINGS.iter().flat_map(|encoding| encoding.aliases.iter().chain([&encoding.name])) {
        let ran = bench.run(&["inspect", "map.pgm", "--encoding", encoding]);
        assert!(!ran.err.contains("possible values"), "{ran:?}");
    }
}

#[test]
fn completions_are_made_for_each_shell() {
    let bench = Bench::new("completions");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = bench.run(&["completions", shell]).ok();
        assert!(script.contains("depthplanes") && script.contains("theta"), "{shell}");
    }
}

#[test]
fn manual_pages_are_printed_or_written() {
    let bench = Bench::new("man");
    let page = bench.run(&["man"]).ok();
    assert!(page.contains(".TH depthplanes 1"), "{page}");
    bench.run(&["man", "--out-dir", "man1"]).ok();
    let names = names_in(&bench.folder.join("man1"));
    assert!(names.contains(&"depthplanes.1".into()) && names.contains(&"depthplanes-detect.1".into()), "{names:?}");
    assert_eq!(String::from_utf8(bench.read("man1/depthplanes.1")).unwrap(), page);
}

#[test]
fn help_states_the_exit_codes() {
    let bench = Bench::new("help");
    for words in [&["--help"][..], &["detect", "--help"]] {
        let help = bench.run(words).ok();
        assert!(help.contains("Exit codes:") && help.contains("unreadable file"), "{help}");
    }
    assert_eq!(bench.run(&["--version"]).ok(), format!("depthplanes {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn headerless_samples_are_read_with_their_size() {
    let bench = Bench::new("raw");
    let pgm = two_planes(1003);
    let samples: Vec<u8> = pgm[pgm.len() - 32 * 24 * 2..].chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect();
    bench.write("map.raw", &samples);
    let out = bench.run(&["detect", "map.raw", "--raw-size", "32x24", "--json"]).ok();
    let record: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(record["planes"].as_array().unwrap().len(), 2);
}

/// Columns and lines of a page of help.
const PAGE: (usize, usize) = (100, 45);

#[test]
fn the_short_help_of_every_command_is_a_page() {
    let bench = Bench::new("short_help");
    let whole = bench.run(&["-h"]).ok();
    let listed = whole.lines().filter(|line| line.starts_with("  ") && line.as_bytes()[2].is_ascii_lowercase());
    let commands: Vec<&str> =
        listed.filter_map(|line| line.split_whitespace().next()).filter(|word| *word != "depthplanes").collect();
    assert!(commands.len() >= 17, "{whole}");
    for command in std::iter::once(None).chain(commands.into_iter().map(Some)) {
        let words: Vec<&str> = command.into_iter().chain(["-h"]).collect();
        let help = bench.run(&words).ok();
        assert!(help.lines().count() < PAGE.1, "{words:?}: {} lines\n{help}", help.lines().count());
        assert!(help.lines().all(|line| line.chars().count() <= PAGE.0), "{words:?}\n{help}");
    }
}

#[test]
fn help_tells_users_commands_from_those_of_research() {
    let bench = Bench::new("groups");
    let help = bench.run(&["-h"]).ok();
    let (users, research) = help.split_once("\nResearch").unwrap();
    for (part, commands) in [
        (users, &["detect", "inspect", "explain", "demo", "noise", "presets", "encodings", "formats", "params"][..]),
        (users, &["methods", "completions", "man"]),
        (research, &["score", "compare", "eval", "datasets", "paper"]),
    ] {
        for command in commands {
            assert!(part.contains(&format!("\n  {command} ")), "{command}\n{help}");
        }
    }
}

#[test]
fn help_shows_the_default_methods_parameters_and_takes_those_of_all() {
    let bench = Bench::with_map("help_parameters");
    let help = bench.run(&["detect", "--help"]).ok();
    assert!(!help.contains("--theta") && !help.contains("ngaf:"), "{help}");
    let short = bench.run(&["detect", "-h"]).ok();
    for flag in
        ["--preset", "--intrinsics", "--camera", "--encoding", "--scale", "--labels", "--out-dir", "--min-pixels"]
    {
        assert!(short.contains(flag), "{flag}\n{short}");
    }
    assert!(short.contains("[pixels, default 100; or --min]"), "{short}");
    bench.run(&["detect", "map.pgm", "--method", "ngaf", "--theta", "3"]).ok();
    let man = bench.run(&["man", "--out-dir", "m"]).ok();
    assert!(man.contains("pages in m"));
    let page = String::from_utf8(bench.read("m/depthplanes-detect.1")).unwrap();
    assert!(page.contains("theta"), "{page}");
}

/// The command that `inspect` ends with, and all it prints.
fn typed_next(bench: &Bench, words: &[&str]) -> (Vec<String>, String) {
    let out = bench.run(&[&["inspect"], words].concat()).ok();
    let line = out.lines().find_map(|line| line.trim_start().strip_prefix("type next  depthplanes "));
    let words = line.unwrap_or_else(|| panic!("{out}")).split(' ').map(|word| word.trim_matches('\'').to_string());
    (words.collect(), out.clone())
}

#[test]
fn what_inspect_says_to_type_next_works() {
    let bench = Bench::with_map("type_next");
    let fives: Vec<u8> = (0..64 * 48u32).flat_map(|at| (5000 + 5 * (at % 64) as u16).to_be_bytes()).collect();
    bench.write("fives.pgm", &[b"P5 64 48 65535\n".to_vec(), fives].concat());
    let plane = |at: u32| (900_000 / (500 + (at % 640 + at / 640) / 5)) as u16;
    let size: Vec<u8> = (0..640 * 480).flat_map(|at| plane(at).to_be_bytes()).collect();
    bench.write("vga.pgm", &[b"P5 640 480 65535\n".to_vec(), size].concat());
    bench
        .write("grey.pgm", &[b"P5 64 48 255\n".to_vec(), (0..64 * 48u32).map(|at| (at % 64) as u8).collect()].concat());
    for (words, wanted, more) in [
        (&["map.pgm"][..], "detect map.pgm --encoding millimetre", "--intrinsics FX,FY,CX,CY or --camera FILE"),
        (&["fives.pgm"], "detect fives.pgm --encoding tum", "--camera FILE"),
        (&["vga.pgm"], "detect vga.pgm --encoding millimetre", "--preset kinect1 "),
        (&["vga.pgm", "--preset", "kinect1"], "detect vga.pgm --preset kinect1", ""),
        (&["vga.pgm", "--scale", "500"], "detect vga.pgm --scale 500", "--camera FILE"),
        (&["map.pgm", "--disparity"], "detect map.pgm --disparity", "--baseline METRES"),
        (&["grey.pgm", "--encoding", "grey"], "detect grey.pgm --encoding grey", ""),
        (&["scene:room:size=64x48"], "detect scene:room:size=64x48", ""),
    ] {
        let (next, out) = typed_next(&bench, words);
        assert_eq!(next.join(" "), wanted, "{out}");
        assert!(out.contains(more), "{out}");
        bench.run(&next.iter().map(String::as_str).collect::<Vec<_>>()).ok();
    }
}

#[test]
fn what_inspect_says_to_type_next_works_for_recorded_maps() {
    let Some(data) = support::data() else { return };
    let bench = Bench::new("type_next_recorded");
    for file in
        ["gt_real/pcl.depth.png", "gt_real/tum_fr3.depth.png", "pcl_kinect/office1.pcd", "pfm/terrace/disp0.pfm"]
    {
        let path = data.join(file);
        let (next, _) = typed_next(&bench, &[path.to_str().unwrap()]);
        bench.run(&next.iter().map(String::as_str).collect::<Vec<_>>()).ok();
    }
}
