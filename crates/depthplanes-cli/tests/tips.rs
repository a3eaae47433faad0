//! What the program says to words of other programs, and what `inspect` proposes.

mod support;

use support::Bench;

#[test]
fn a_file_in_the_place_of_a_command_and_flags_of_other_programs_lead_to_what_to_type() {
    let bench = Bench::with_map("tips");
    for (words, tip) in [
        (&["map.pgm"][..], "depthplanes detect map.pgm"),
        (&["map.pgm", "--json"], "depthplanes detect map.pgm --json"),
        (&["maps/*.png"], "depthplanes detect maps/*.png"),
        (&["scene:room"], "depthplanes detect scene:room"),
        (&["detect", "map.pgm", "-o", "out.png"], "--overlay FILE.png"),
        (&["detect", "map.pgm", "--output=out"], "--out-dir DIR"),
        (&["detect", "map.pgm", "--fx", "500"], "--intrinsics FX,FY,CX,CY"),
        (&["detect", "map.pgm", "-K", "a.txt"], "--intrinsics FX,FY,CX,CY"),
        (&["inspect", "--input", "map.pgm"], "depthplanes detect FILE"),
        (&["inspect", "map.pgm", "--width", "32"], "--raw-size WxH"),
        (&["detekt", "map.pgm"], "detect"),
        (&["detect", "map.pgm", "--max-depth", "5"], "--valid-range LO,HI"),
        (&["detect", "map.pgm", "--min-depth=0.3"], "--valid-range LO,HI"),
        (&["detect", "map.pgm", "--threshold", "0.01"], "--noise METRES"),
        (&["detect", "map.pgm", "--max-planes", "5"], "--rows N"),
        (&["detect", "map.pgm", "--num-planes", "5"], "--rows N"),
        (&["detect", "map.pgm", "--ply", "a.ply"], "--cloud FILE.ply"),
        (&["detect", "map.pgm", "--csv", "a.csv"], "--planes FILE.csv"),
        (&["detect", "map.pgm", "--format", "png"], "--encoding"),
        (&["detect", "map.pgm", "--iterations", "100"], "--method ransac"),
        (&["detect", "map.pgm", "--units", "mm"], "--scale"),
        (&["detect", "map.pgm", "--fov", "60"], "--intrinsics FX,FY,CX,CY"),
        (&["detect", "map.pgm", "--show"], "--overlay FILE.png"),
        (&["detect", "map.pgm", "--quiet"], "2>/dev/null"),
        (&["detect", "map.pgm", "--encoding", "cm"], "--scale 100"),
        (&["detect", "map.pgm", "--encoding", "Feet"], "--scale 3.28"),
        (&["detect", "map.pgm", "--encoding", "parsec"], "depthplanes encodings"),
        (&["detect", "map.pgm", "--preset", "kinect"], "--preset kinect1 (Kinect v1, Xtion) or kinect2"),
        (&["detect", "map.pgm", "--preset", "tum-freiburg1"], "tum-fr1, tum-fr2 or tum-fr3"),
        (&["detect", "map.pgm", "--preset", "d435"], "--preset realsense-d4xx"),
        (&["detect", "map.pgm", "--preset", "L515"], "--scale 4000"),
        (&["detect", "map.pgm", "--preset", "oak"], "--camera"),
        (&["inspect", "map.pgm", "--preset", "some-camera"], "depthplanes presets"),
        (&["detect", "map.pgm", "--out-dir", "out", "--only", "ply"], "--only cloud,mesh"),
    ] {
        let told = bench.run(words).fails(2);
        assert!(told.contains("tip:") && told.contains(tip), "{words:?}: {told}");
        assert!(!told.contains("as a value") && told.matches("tip:").count() == 1, "{words:?}: {told}");
    }
}

#[test]
fn a_flag_that_nobody_knows_is_not_taken_for_a_file() {
    let bench = Bench::with_map("unknown_flag");
    for flag in ["--nonsense-of-mine", "--qqq", "--xyzzy=3"] {
        let told = bench.run(&["detect", "map.pgm", flag]).fails(2);
        assert!(told.contains("unexpected argument") && !told.contains("as a value"), "{told}");
    }
}

#[test]
fn numbers_of_a_camera_in_other_words_lead_to_intrinsics() {
    let bench = Bench::with_map("numbers");
    for numbers in ["535,539,320,247", "10, 10, 15.5, 11.5", "1e1,1e1,15.5,11.5"] {
        let told = bench.run(&["detect", "map.pgm", "--camera", numbers]).fails(2);
        assert!(told.contains(&format!("--intrinsics={numbers}")), "{told}");
    }
    let told = bench.run(&["detect", "map.pgm", "--intrinsics", "518", "519", "325.5", "253.5"]).fails(2);
    assert!(told.contains("commas between and no blanks"), "{told}");
    for unit in ["millimeter", "millimeters", "millimetres", "mm"] {
        bench.run(&["detect", "map.pgm", "--encoding", unit]).ok();
    }
    for unit in ["meters", "metres", "m"] {
        let told = bench.run(&["inspect", "map.pgm", "--encoding", unit]).ok();
        assert!(told.contains("metre"), "{told}");
    }
}

#[test]
fn a_folder_of_results_is_said_to_have_no_map() {
    let bench = Bench::with_map("results_alone");
    bench.run(&["detect", "map.pgm", "--out-dir", "res"]).ok();
    let told = bench.run(&["detect", "res"]).fails(2);
    assert!(told.contains("no map in this folder") && told.contains("results of this program"), "{told}");
    assert!(told.contains("*.labels.png") && told.contains("*.overlay.png"), "{told}");
}

#[cfg(unix)]
#[test]
fn files_are_written_though_nobody_reads_the_summary() {
    let bench = Bench::with_map("summary_unread");
    let program = env!("CARGO_BIN_EXE_depthplanes");
    let map = std::fs::read(bench.folder.join("map.pgm")).unwrap();
    std::fs::create_dir(bench.folder.join("maps")).unwrap();
    for at in 0..12 {
        bench.write(&format!("maps/{at}.pgm"), &map);
    }
    for (flags, count) in [("--out-dir out --only labels", 12), ("--out-dir both --only labels,planes", 24)] {
        let script = format!("'{program}' detect maps {flags} --table all.csv | head -n 1");
        let ran = bench.command_of("bash").args(["-c", &script]).output().unwrap();
        assert!(ran.status.success() && !String::from_utf8_lossy(&ran.stderr).contains("error"), "{ran:?}");
        let folder = flags.split(' ').nth(1).unwrap();
        assert_eq!(std::fs::read_dir(bench.folder.join(folder)).unwrap().count(), count);
        let table = std::fs::read_to_string(bench.folder.join("all.csv")).unwrap();
        assert!((0..12).all(|at| table.contains(&format!("{at}.pgm"))), "{table}");
        std::fs::remove_file(bench.folder.join("all.csv")).unwrap();
    }
}

#[test]
fn failures_among_several_inputs_are_counted_in_words() {
    let bench = Bench::with_map("counted");
    bench.write("one.pgm", b"P5 never");
    bench.write("two.pgm", b"P5 never");
    let told = |words: &[&str]| bench.run(&[&["detect"], words].concat()).fails(2);
    assert!(told(&["one.pgm", "map.pgm"]).contains("1 of 2 inputs failed and has no output; the other one is done"));
    assert!(told(&["one.pgm", "map.pgm", "map.pgm"]).contains("has no output; the other 2 are done"));
    let all = told(&["one.pgm", "two.pgm"]);
    assert!(all.contains("2 of 2 inputs failed and have no output") && !all.contains("other"), "{all}");
}

#[test]
fn tables_of_numbers_lead_to_numpy() {
    let bench = Bench::new("tables");
    for (name, text, call) in [
        ("spaces", "1.000000e+00 2.5e-01\n3.0e+00 nan\n", "numpy.loadtxt(FILE)"),
        ("header", "# depth of x, y: metres\n1.0 2.0 3.0\n4.0 5.0 6.0\n", "numpy.loadtxt(FILE)"),
        ("commas", "1.0e+00,2.0e+00\n3.0e+00,inf\n", "delimiter=','"),
        ("semicolons", "1.0;2.0;3.0\n4.0;5.0;6.0\n", "delimiter=';'"),
    ] {
        bench.write(name, text.as_bytes());
        let told = bench.run(&["detect", name]).fails(2);
        assert!(told.contains("a text of numbers") && told.contains(call), "{name}: {told}");
    }
}

#[test]
fn inspect_proposes_no_planes_of_a_label_image() {
    let bench = Bench::new("no_planes");
    let labels = |label: fn(usize, usize) -> u16| {
        let values = (0..80 * 80).flat_map(|at| label(at % 80, at / 80).to_be_bytes());
        [b"P5 80 80 65535\n".to_vec(), values.collect()].concat()
    };
    bench.write("quarters.pgm", &labels(|u, v| [7, 2, 9, 4][u / 40 + v / 40 * 2]));
    bench.write("mask.pgm", &labels(|u, v| u16::from(u > 30 && v > 20)));
    bench.write("stripes.pgm", &labels(|u, _| [1, 5, 3, 8, 2][u / 16]));
    for name in ["quarters.pgm", "mask.pgm", "stripes.pgm"] {
        let told = bench.run(&["inspect", name]).ok();
        assert!(told.contains("label image") && told.contains("depthplanes score"), "{name}: {told}");
        assert!(!told.contains("depthplanes detect"), "{name}: {told}");
    }
}

#[test]
fn inspect_proposes_the_type_and_the_size_of_headerless_samples() {
    let bench = Bench::new("headerless");
    let [width, height] = [96, 64];
    let slope = |at: usize| 1.0 + 0.02 * (at % width) as f64 + 0.01 * (at / width) as f64;
    let half = |value: f64| {
        let exponent = value.log2().floor();
        ((exponent + 15.0) * 1024.0 + (value / exponent.exp2() - 1.0) * 1024.0) as u16
    };
    let samples =
        |of: &dyn Fn(f64) -> u16| (0..width * height).flat_map(|at| of(slope(at)).to_le_bytes()).collect::<Vec<_>>();
    bench.write("half.raw", &samples(&half));
    bench.write("mm.raw", &samples(&|metres| (1000.0 * metres) as u16));
    let told = bench.run(&["inspect", "half.raw", "--raw-size", "96x64"]).ok();
    assert!(told.contains("detect half.raw --raw-size 96x64 --raw-type float16"), "{told}");
    let told = bench.run(&["inspect", "mm.raw", "--raw-size", "64x96"]).ok();
    assert!(told.contains("detect mm.raw --raw-size 96x64"), "{told}");
    let told = bench.run(&["inspect", "mm.raw", "--raw-size", "96x64"]).ok();
    assert!(!told.contains("try --raw"), "{told}");
}
