//! Outputs on disks that fail, through links, beside what other runs have left, and on standard output.
#![cfg(unix)]

mod support;

use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use support::Bench;

#[test]
fn a_link_keeps_pointing_also_where_nothing_is_yet() {
    let bench = Bench::with_map("written_links");
    std::fs::create_dir(bench.folder.join("there")).unwrap();
    symlink("there/real.png", bench.folder.join("one.png")).unwrap();
    symlink("one.png", bench.folder.join("two.png")).unwrap();
    for _ in 0..2 {
        bench.run(&["detect", "map.pgm", "--labels", "two.png"]).ok();
        assert!(bench.read("there/real.png").starts_with(b"\x89PNG"));
        for link in ["one.png", "two.png"] {
            assert!(bench.folder.join(link).is_symlink(), "{link}");
        }
    }
    symlink("nowhere/real.png", bench.folder.join("lost.png")).unwrap();
    let said = bench.run(&["detect", "map.pgm", "--labels", "lost.png"]).fails(2);
    assert!(said.contains("the folder `nowhere` does not exist"), "{said}");
    symlink("round.png", bench.folder.join("round.png")).unwrap();
    assert!(bench.run(&["detect", "map.pgm", "--labels", "round.png"]).fails(1).contains("in a circle"));
    // Two names of one file that is not there.
    symlink("x.png", bench.folder.join("y.png")).unwrap();
    let said = bench.run(&["detect", "map.pgm", "--labels", "x.png", "--overlay", "y.png"]).fails(2);
    assert!(said.contains("would overwrite"), "{said}");
}

#[test]
fn names_may_be_as_long_as_the_disk_takes_them() {
    let bench = Bench::with_map("written_long");
    for length in [100, 200, 240, 255] {
        for letter in ["a", "é"] {
            let name = letter.repeat((length - 4) / letter.len()) + ".png";
            bench.run(&["detect", "map.pgm", "--labels", &name]).ok();
            assert!(bench.read(&name).starts_with(b"\x89PNG"));
        }
    }
    let name = std::ffi::OsStr::from_bytes(b"\xff\xfe.png");
    assert!(bench.command().args(["detect", "map.pgm", "--labels"]).arg(name).output().unwrap().status.success());
    assert!(bench.folder.join(name).is_file());
    let longer = "a".repeat(252) + ".png";
    assert!(bench.run(&["detect", "map.pgm", "--labels", &longer]).fails(1).contains("cannot be written"));
}

#[test]
fn inputs_of_the_longest_names_have_results_of_their_own_in_a_folder() {
    let bench = Bench::new("written_long_inputs");
    for letter in ["a", "é", "深"] {
        let stem = letter.repeat(248 / letter.len());
        // Names that differ at their ends alone.
        for end in ["1.pgm", "2.pgm"] {
            bench.write(&format!("{stem}{end}"), &support::two_planes(1003));
        }
    }
    bench.run(&["detect", "*.pgm", "--out-dir", "all", "--only", "labels,planes"]).ok();
    let names = support::names_in(&bench.folder.join("all"));
    assert_eq!(names.iter().filter(|name| name.ends_with(".labels.png")).count(), 6, "{names:?}");
    assert_eq!(names.len(), 12, "{names:?}");
    let all = bench.folder.join("every");
    bench.run(&["detect", &format!("{}1.pgm", "a".repeat(248)), "--out-dir", "every"]).ok();
    assert!(support::names_in(&all).len() > 2);
}

#[test]
fn what_killed_runs_left_goes_and_nothing_else_does() {
    let bench = Bench::with_map("written_left");
    let living = format!(".l.png.{}-0.part", std::process::id());
    // No process has so high a number.
    let ours = [".l.png.4194999-0.part", ".l.png.4194998-17.part"];
    let others = [&living, ".l.png.part", ".m.png.4194999-0.part", ".l.png.4194999.part", "l.png.4194999-0.part"];
    for name in ours.iter().chain(&others) {
        bench.write(name, b"half");
    }
    bench.run(&["detect", "map.pgm", "--labels", "l.png"]).ok();
    let names = bench.names();
    assert!(!names.iter().any(|name| ours.contains(&name.as_str())), "{names:?}");
    assert!(others.iter().all(|name| names.iter().any(|is| is == name)), "{names:?}");
    // One that somebody holds is not left, whatever its number.
    bench.write(ours[0], b"half");
    let held = std::fs::File::open(bench.folder.join(ours[0])).unwrap();
    held.lock().unwrap();
    bench.run(&["detect", "map.pgm", "--labels", "l.png"]).ok();
    assert!(bench.folder.join(ours[0]).exists());
}

#[test]
fn a_full_disk_leaves_what_was_there() {
    let bench = Bench::with_map("written_full");
    bench.write("map2.npy", b"");
    let before = bench.run(&["detect", "map.pgm", "--cloud", "c.ply", "--intrinsics", "30,30,16,12"]);
    before.ok();
    let (cloud, names) = (bench.read("c.ply"), bench.names());
    let line = "ulimit -f 1; exec $DP detect map.pgm --cloud c.ply --intrinsics 30,30,16,12";
    let said = bench.shell(line).fails(1);
    assert!(said.contains("c.ply: cannot be written"), "{said}");
    assert_eq!((bench.read("c.ply"), bench.names()), (cloud, names));
    assert!(bench.shell("$DP detect map.pgm --labels /dev/full").fails(1).contains("cannot be written"));
    bench.shell("$DP detect map.pgm --labels /dev/null").ok();
    assert!(bench.run(&["detect", "map.pgm", "--labels", "/proc/l.png"]).fails(1).contains("cannot be written"));
}

#[test]
fn a_standard_output_that_takes_nothing_is_a_failure() {
    let bench = Bench::with_map("written_standard");
    for words in [
        "--help",
        "-h",
        "--version",
        "detect --help",
        "help",
        "completions bash",
        "man",
        "methods",
        "params",
        "formats",
        "detect map.pgm",
        "detect map.pgm --json",
        "detect map.pgm --labels -",
        "inspect map.pgm",
        "noise map.pgm",
        "score map.pgm map.pgm",
        "explain map.pgm --at 9,9",
    ] {
        let ran = bench.shell(&format!("$DP {words} >/dev/full"));
        assert!(ran.code == Some(1) && ran.err.contains("error: standard output: "), "{words}: {ran:?}");
        // One that nobody reads any more is none.
        let ran = bench.shell(&format!("{{ $DP {words}; echo $? >&2; }} | true"));
        assert!(ran.err.trim_end().ends_with('0') && !ran.err.contains("error"), "{words}: {ran:?}");
    }
    // Wrong use is wrong use, whoever hears of it.
    assert_eq!(bench.shell("$DP detect --nothing 2>/dev/full").code, Some(2));
}

#[test]
fn one_output_may_go_to_standard_output() {
    let bench = Bench::with_map("written_dash");
    bench.run(&["detect", "map.pgm", "--labels", "l.png", "--planes", "p.json"]).ok();
    for name in ["-", "/dev/stdout"] {
        bench.shell(&format!("$DP detect map.pgm --labels {name} >d.png 2>said")).ok();
        assert_eq!(bench.read("d.png"), bench.read("l.png"));
        let said = String::from_utf8(bench.read("said")).unwrap();
        assert!(said.starts_with("map.pgm: 32 x 24") && !said.contains("wrote"), "{said}");
    }
    let ran = bench.run(&["detect", "map.pgm", "--planes", "-", "--labels", "m.png"]);
    assert!(ran.err.contains("wrote m.png"), "{ran:?}");
    assert_eq!(ran.ok().into_bytes(), bench.read("p.json"));
    let piped = bench.shell("$DP detect map.pgm --labels - 2>/dev/null | $DP score map.pgm - 2>&1; true");
    assert!(!piped.out.contains("panicked"));
    bench.shell("mkfifo pipe; cat pipe >piped.png & $DP detect map.pgm --labels pipe; wait").ok();
    assert_eq!(bench.read("piped.png"), bench.read("l.png"));
    let said = |words: &[&str]| bench.run(words).fails(2);
    assert!(said(&["detect", "map.pgm", "--labels", "-", "--planes", "-"]).contains("takes one output"));
    assert!(said(&["detect", "map.pgm", "--labels", "-", "--json"]).contains("takes one output"));
    assert!(said(&["detect", "map.pgm", "map.pgm", "--labels", "-"]).contains("use --out-dir"));
}

#[test]
fn a_run_that_is_interrupted_leaves_nothing_half_written() {
    let bench = Bench::with_map("written_interrupted");
    bench.write("t.csv", b"old");
    // Under nohup, HUP ends neither the tests nor the program.
    let signals = [("INT", 130), ("TERM", 143), ("HUP", 129)];
    let is_heard = |signal: &str| bench.shell(&format!("sh -c 'kill -{signal} $$'; test $? -gt 128")).code == Some(0);
    for (signal, code) in signals.into_iter().filter(|(signal, _)| is_heard(signal)) {
        // The table is open while the second input, a pipe, is waited for.
        bench.shell("rm -f pipe; mkfifo pipe").ok();
        let words = ["detect", "map.pgm", "pipe", "--table", "t.csv", "--out-dir", "o", "--only", "labels"];
        let mut command = bench.command();
        command.args(words).stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped());
        let child = command.spawn().unwrap();
        let start = std::time::Instant::now();
        while !bench.folder.join("o/map.labels.png").exists() && start.elapsed().as_secs() < 20 {
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        assert!(bench.names().iter().any(|name| name.ends_with(".part")), "{signal}");
        bench.shell(&format!("kill -{signal} {}", child.id())).ok();
        let ran = support::Ran::from(child.wait_with_output().unwrap());
        assert!(
            ran.code == Some(code) && ran.err.contains("interrupted: files that were finished are kept"),
            "{ran:?}"
        );
        assert_eq!(bench.names(), ["map.pgm", "o", "pipe", "t.csv"], "{signal}");
        assert_eq!(bench.read("t.csv"), b"old");
        assert_eq!(support::names_in(&bench.folder.join("o")), ["map.labels.png"]);
        std::fs::remove_dir_all(bench.folder.join("o")).unwrap();
    }
    // Whoever started it may want it to live on.
    let line = "rm -f pipe; mkfifo pipe; trap '' HUP; $DP detect map.pgm pipe --table t.csv & child=$!; \
                for i in 1 2 3 4 5 6 7 8 9; do ls .t.csv.*.part >/dev/null 2>&1 && break; sleep 0.05; done; sleep 0.2; kill -HUP $child; timeout 20 sh -c 'cat map.pgm >pipe'; wait $child";
    bench.shell(line).ok();
    assert!(bench.read("t.csv").len() > 100);
}

#[test]
fn a_new_file_has_the_permissions_of_the_one_that_it_replaces() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::with_map("written_mode");
    let mode = |name: &str| bench.folder.join(name).metadata().unwrap().permissions().mode() & 0o7777;
    for (umask, fresh) in [("022", 0o644), ("077", 0o600), ("002", 0o664)] {
        let outputs = "--labels l.png --planes p.json --table t.csv";
        let run = || bench.shell(&format!("umask {umask}; exec $DP detect map.pgm {outputs}")).ok();
        run();
        for name in ["l.png", "p.json", "t.csv"] {
            assert_eq!(mode(name), fresh, "{umask} {name}");
        }
        for kept in [0o600, 0o640, 0o664, 0o444, 0o755] {
            for name in ["l.png", "p.json", "t.csv"] {
                let path = bench.folder.join(name);
                std::fs::set_permissions(path, std::fs::Permissions::from_mode(kept)).unwrap();
            }
            run();
            for name in ["l.png", "p.json", "t.csv"] {
                assert_eq!(mode(name), kept, "{umask} {name}");
            }
        }
        // Through a link it is the file that counts.
        let _ = std::fs::remove_file(bench.folder.join("link.png"));
        symlink("l.png", bench.folder.join("link.png")).unwrap();
        std::fs::set_permissions(bench.folder.join("l.png"), std::fs::Permissions::from_mode(0o620)).unwrap();
        bench.shell(&format!("umask {umask}; exec $DP detect map.pgm --labels link.png")).ok();
        assert_eq!(mode("l.png"), 0o620);
        for name in ["l.png", "p.json", "t.csv"] {
            std::fs::remove_file(bench.folder.join(name)).unwrap();
        }
    }
}
