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
    ] {
        let told = bench.run(words).fails(2);
        assert!(told.contains("tip:") && told.contains(tip), "{words:?}: {told}");
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
