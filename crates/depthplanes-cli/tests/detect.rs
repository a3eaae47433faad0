//! `depthplanes detect` and its outputs.

mod support;

use depthplanes_io::{Pixels, ReadOptions};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;
use support::{Bench, Ran, names_in, two_planes};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn without_output_flags_a_table_is_printed() {
    let bench = Bench::with_map("table");
    let out = bench.run(&["detect", "map.pgm"]).ok();
    let lines: Vec<&str> = out.lines().collect();
    assert!(lines[0].starts_with("map.pgm: 32 x 24, "), "{out}");
    assert!(lines[1].starts_with("planar, noise estimated"), "{out}");
    assert!(lines[1].ends_with("2 planes on 100.0 % of the valid pixels"), "{out}");
    assert!(lines[2].starts_with("no camera: "), "{out}");
    let heading = "plane pixels share depth mean value per column per row rms columns rows";
    assert!(lines[3].split_whitespace().eq(heading.split(' ')), "{out}");
    let first: Vec<&str> = lines[4].split_whitespace().collect();
    assert_eq!(first[..7], ["1", "384", "51.1", "%", "1.503", "m", "1503"], "{out}");
    assert_eq!(bench.names(), ["map.pgm"]);
}

#[test]
fn with_a_camera_the_table_is_in_metres() {
    let bench = Bench::with_map("metric_table");
    let words = ["detect", "map.pgm", "--intrinsics", "30,-30,15.5,11.5", "--encoding", "millimetre"];
    let out = bench.run(&words).ok();
    assert!(out.contains("distance"), "{out}");
    assert!(out.contains("1.503 m"), "{out}");
}

#[test]
fn json_of_one_map_is_one_document() {
    let bench = Bench::with_map("json");
    let record = json(&bench.run(&["detect", "map.pgm", "--json", "--min-pixels", "10"]).ok());
    assert_eq!(record["schema"], "depthplanes.planes/1");
    assert_eq!(record["source"], "map.pgm");
    assert_eq!(record["method"], "planar");
    assert_eq!(record["parameters"]["inlier-threshold"], 4.0);
    assert_eq!(record["parameters"]["min-pixels"], 10);
    assert_eq!(record["valid_pixels"], 32 * 24 - 16);
    assert_eq!(record["planes"].as_array().unwrap().len(), 2);
    assert_eq!(record["planes"][0]["pixel_count"], 384);
    assert!(record.get("time_ms").is_none());
}

#[test]
fn the_papers_method_is_there_by_its_name() {
    let bench = Bench::with_map("by_name");
    let words = ["detect", "map.pgm", "--method", "ngaf"];
    assert!(bench.run(&words).ok().contains("\nngaf (theta 1, min-pixels 32, window 0): 2 planes on 100.0 %"));
    let record = json(&bench.run(&[&words[..], &["--json", "--theta", "2", "--min-pixels", "10"]].concat()).ok());
    assert_eq!(record["method"], "ngaf");
    assert_eq!((&record["parameters"]["theta"], &record["parameters"]["min-pixels"]), (&2.0.into(), &10.into()));
}

#[test]
fn the_papers_word_for_a_parameter_is_a_flag_and_records_have_its_name() {
    let bench = Bench::with_map("alias");
    let of = |words: &[&str]| bench.run(&[&["detect", "map.pgm", "--json"][..], words].concat());
    for method in ["planar", "ngaf", "ransac"] {
        let by_alias = of(&["--method", method, "--min", "10"]).ok();
        assert_eq!(json(&by_alias)["parameters"]["min-pixels"], 10);
        assert_eq!(by_alias, of(&["--method", method, "--min-pixels", "10"]).ok());
    }
    assert!(of(&["--min", "1.5"]).fails(2).contains("min-pixels"));
    assert!(of(&["--min", "1", "--min-pixels", "2"]).fails(2).contains("--min-pixels"));
    let out = bench.run(&["explain", "map.pgm", "--at", "3,4", "--min", "500"]).ok();
    assert!(out.contains("min-pixels = 500 asks for more") && out.contains("Try --min-pixels"), "{out}");
    assert!(
        bench
            .run(&["compare", "map.pgm", "--methods", "planar,ngaf", "--min", "10", "--repeat", "1"])
            .ok()
            .contains("ngaf")
    );
}

#[test]
fn json_of_several_maps_is_one_line_each() {
    let bench = Bench::with_map("json_lines");
    bench.write("other.pgm", &two_planes(700));
    let out = bench.run(&["detect", "other.pgm", "map.pgm", "--json"]).ok();
    let sources: Vec<Value> = out.lines().map(|line| json(line)["source"].clone()).collect();
    assert_eq!(sources, ["other.pgm", "map.pgm"]);
}

#[test]
fn repeat_measures_the_whole_and_each_stage() {
    let bench = Bench::with_map("repeat");
    let record = json(&bench.run(&["detect", "map.pgm", "--json", "--repeat", "4"]).ok());
    let stages = depthplanes::methods::find("planar").unwrap().stages;
    let times = record["time_ms"].as_object().unwrap();
    assert_eq!(times.len(), stages.len() + 1);
    for name in stages.iter().chain([&"total"]) {
        let (median, min) = (times[*name]["median"].as_f64().unwrap(), times[*name]["min"].as_f64().unwrap());
        assert!(0.0 <= min && min <= median, "{name}: {min} {median}");
    }
    assert!(times["total"]["min"].as_f64().unwrap() > 0.0);
    assert!(bench.run(&["detect", "map.pgm", "--repeat", "3"]).ok().contains("\ntime: "));
}

#[test]
fn all_outputs_are_written_and_can_be_read_again() {
    let bench = Bench::with_map("outputs");
    let camera = ["--encoding", "millimetre", "--intrinsics", "30,30,15.5,11.5"];
    let files = [
        "--labels",
        "l.png",
        "--overlay",
        "o.png",
        "--planes",
        "p.json",
        "--cloud",
        "c.ply",
        "--mesh",
        "m.ply",
        "--legend",
    ];
    let out = bench.run(&[&["detect", "map.pgm"], &camera[..], &files].concat()).ok();
    assert!(out.contains("wrote l.png, o.png, p.json, c.ply, m.ply"), "{out}");
    assert_eq!(bench.names(), ["c.ply", "l.png", "m.ply", "map.pgm", "o.png", "p.json"]);
    let record = json(&String::from_utf8(bench.read("p.json")).unwrap());
    assert!((record["planes"][0]["metric"]["distance_m"].as_f64().unwrap() - 1.503).abs() < 1e-9);
    let vertices = format!("element vertex {}\n", 32 * 24 - 16);
    assert!(String::from_utf8_lossy(&bench.read("c.ply")).contains(&vertices));
    let mesh = bench.read("m.ply");
    assert!(String::from_utf8_lossy(&mesh).contains("element vertex 10\n"), "a rectangle and an L-shape");
    assert!(String::from_utf8_lossy(&mesh).contains("element face 6\n"));
}

#[test]
fn outlines_are_in_the_record_and_in_the_times_where_they_are_asked_for() {
    let bench = Bench::with_map("outlines");
    let camera = ["--encoding", "millimetre", "--intrinsics", "30,-30,15.5,11.5"];
    let words = [&["detect", "map.pgm", "--json", "--repeat", "2"], &camera[..]].concat();
    let plain = json(&bench.run(&words).ok());
    assert!(plain.get("outline_tolerance_px").is_none() && plain["planes"][0].get("outline").is_none());
    assert!(plain["time_ms"].get("outline").is_none());
    let record = json(&bench.run(&[&words[..], &["--outlines"]].concat()).ok());
    assert_eq!(record["outline_tolerance_px"], 1.5);
    assert!(record["time_ms"]["outline"]["median"].as_f64().unwrap() >= 0.0);
    let (plane, outline) = (&record["planes"][0], &record["planes"][0]["outline"]);
    // The picture is mirrored: counter-clockwise in space is clockwise on it.
    assert_eq!(
        outline["polygons_px"][0]["outer"],
        serde_json::json!([[15.5, -0.5], [31.5, -0.5], [31.5, 23.5], [15.5, 23.5]])
    );
    let sides = &outline["rectangle_m"]["sides"];
    let area = sides[0].as_f64().unwrap() * sides[1].as_f64().unwrap();
    assert!((area - plane["metric"]["area_m2"].as_f64().unwrap()).abs() < 1e-5, "{record}");
    let exact = json(&bench.run(&["detect", "map.pgm", "--json", "--outlines=0"]).ok());
    assert_eq!(exact["outline_tolerance_px"], 0.0);
    assert!(exact["planes"][0]["outline"]["polygons_m"].is_null());
    assert!(exact["planes"][0]["outline"]["rectangle_px"].is_object());
}

#[test]
fn outlines_are_drawn_on_the_overlay() {
    let bench = Bench::with_map("outlined_overlay");
    bench.run(&["detect", "map.pgm", "--overlay", "plain.png"]).ok();
    bench.run(&["detect", "map.pgm", "--overlay", "outlined.png", "--outlines"]).ok();
    assert_ne!(bench.read("plain.png"), bench.read("outlined.png"));
}

#[test]
fn label_png_and_label_npy_are_the_same() {
    let bench = Bench::with_map("png_npy");
    bench.run(&["detect", "map.pgm", "--labels", "l.png"]).ok();
    bench.run(&["detect", "map.pgm", "--labels", "l.npy"]).ok();
    let read = |name: &str| depthplanes_io::read(bench.folder.join(name), &ReadOptions::default()).unwrap();
    let (png, npy) = (read("l.png"), read("l.npy"));
    assert_eq!((png.width, png.height), (32, 24));
    assert_eq!(png.pixels, npy.pixels);
    let Pixels::U16(labels) = png.pixels else { panic!("not 16 bits") };
    assert_eq!((labels[0], labels[31], labels[32 * 23]), (0, 1, 2));
}

#[test]
fn planes_can_be_a_csv() {
    let bench = Bench::with_map("csv");
    bench.run(&["detect", "map.pgm", "--planes", "p.csv"]).ok();
    let csv = String::from_utf8(bench.read("p.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert!(lines[0].starts_with("source,label,pixel_count,"));
    assert!(lines[1].starts_with("map.pgm,1,384,"), "{csv}");
    assert_eq!(lines.len(), 3);
}

#[test]
fn a_folder_of_results_gets_fixed_names_and_no_cloud_without_a_camera() {
    let bench = Bench::with_map("out_dir");
    bench.run(&["detect", "map.pgm", "--out-dir", "new/results"]).ok();
    let names = ["map.labels.png", "map.overlay.png", "map.planes.json"];
    assert_eq!(names_in(&bench.folder.join("new/results")), names);
}

#[test]
fn many_inputs_on_many_threads_give_the_same_as_one_by_one() {
    let bench = Bench::new("jobs");
    std::fs::create_dir(bench.folder.join("maps")).unwrap();
    for i in 0..12u16 {
        bench.write(&format!("maps/frame{i}.pgm"), &two_planes(600 + 37 * i));
    }
    let many = bench.run(&["detect", "maps", "--jobs", "4", "--out-dir", "many", "--json"]).ok();
    let mut single = String::new();
    for i in 0..12 {
        let name = format!("maps/frame{i}.pgm");
        let word = name.replace('/', std::path::MAIN_SEPARATOR_STR);
        bench.run(&["detect", &word, "--out-dir", "single"]).ok();
        single += &(json(&bench.run(&["detect", &word, "--json"]).ok()).to_string() + "\n");
    }
    let value = |text: &str| text.lines().map(json).collect::<Vec<_>>();
    assert_eq!(value(&many), value(&single), "natural order, same records");
    let names = names_in(&bench.folder.join("many"));
    assert_eq!(names.len(), 36);
    assert_eq!(names, names_in(&bench.folder.join("single")));
    for name in names {
        assert_eq!(bench.read(&format!("many/{name}")), bench.read(&format!("single/{name}")), "{name}");
    }
}

#[test]
fn threads_do_not_change_the_answer() {
    let bench = Bench::new("threads");
    let of = |threads| bench.run(&["detect", "scene:room", "--json", "--threads", threads]).ok();
    assert_eq!(of("1"), of("3"));
}

#[test]
fn a_folder_skips_what_is_no_map_and_its_own_results() {
    let bench = Bench::with_map("skips");
    bench.write("notes.txt", b"not a map");
    bench.run(&["detect", ".", "--out-dir", "."]).ok();
    let out = bench.run(&["detect", ".", "--json"]).ok();
    assert_eq!(json(&out)["planes"].as_array().unwrap().len(), 2);
}

#[test]
fn a_pattern_that_the_shell_left_alone_is_expanded() {
    let bench = Bench::with_map("pattern");
    bench.write("map10.pgm", &two_planes(800));
    bench.write("map9.pgm", &two_planes(900));
    let out = bench.run(&["detect", "map*.pgm", "--json"]).ok();
    let sources: Vec<Value> = out.lines().map(|line| json(line)["source"].clone()).collect();
    assert_eq!(sources, ["map.pgm", "map9.pgm", "map10.pgm"]);
}

#[test]
fn a_map_can_come_from_standard_input() {
    let bench = Bench::new("stdin");
    let mut command = bench.command();
    command.args(["detect", "-", "--json"]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(&two_planes(1003)).unwrap();
    let record = json(&Ran::from(child.wait_with_output().unwrap()).ok());
    assert_eq!(record["source"], "-");
    assert_eq!(record["planes"].as_array().unwrap().len(), 2);
}

#[test]
fn a_synthetic_scene_is_an_input() {
    let bench = Bench::new("scene");
    let record = json(&bench.run(&["detect", "scene:room:size=160x120,seed=3", "--json"]).ok());
    assert_eq!((&record["width"], &record["height"]), (&Value::from(160), &Value::from(120)));
    assert!(record["intrinsics"]["fx"].as_f64().unwrap() > 0.0);
    bench.run(&["detect", "scene:room:size=160x120", "--out-dir", "d"]).ok();
    assert!(names_in(&bench.folder.join("d")).iter().all(|name| name.starts_with("scene_room_size_160x120.")));
}

#[test]
fn reading_flags_that_a_scene_cannot_use_are_remarked_on() {
    let bench = Bench::new("scene_flags");
    let ran = bench.run(&["detect", "scene:room:size=64x48", "--preset", "kinect1"]);
    assert!(ran.err.contains("flags on reading are not used"), "{ran:?}");
    ran.ok();
}

#[test]
fn disparities_with_a_rig_become_metric() {
    let bench = Bench::with_map("rig");
    let words = ["detect", "map.pgm", "--json", "--disparity", "--focal", "1000", "--baseline", "0.1"];
    let record = json(&bench.run(&[&words[..], &["--intrinsics", "1000,1000,16,12"]].concat()).ok());
    assert_eq!(record["measure"]["kind"], "inverse_depth");
    assert!(record["planes"][0]["metric"].is_object(), "{record}");
}

#[test]
fn where_no_plane_is_found_it_says_what_to_try() {
    let bench = Bench::with_map("no_plane");
    let ran = bench.run(&["detect", "map.pgm", "--min-pixels", "100000"]);
    assert!(
        ran.err.contains("no plane found by planar (min-pixels 100000), noise estimated; `depthplanes params planar`"),
        "{ran:?}"
    );
    assert!(ran.ok().contains("0 planes"));
    bench.write("empty.pgm", &[b"P5 4 2 65535\n".to_vec(), vec![0; 16]].concat());
    let ran = bench.run(&["detect", "empty.pgm"]);
    assert!(ran.err.contains("no pixel is valid"), "{ran:?}");
    ran.ok();
}

#[test]
fn a_threshold_of_a_metre_is_remarked_on() {
    let bench = Bench::with_map("metre");
    let ran = bench.run(&["detect", "map.pgm", "--method", "ngaf", "--scale", "1", "--encoding", "millimetre"]);
    assert!(ran.err.contains("theta 1 is 1 m here"), "{ran:?}");
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_quiet() {
    let bench = Bench::with_map("pipe");
    let program = env!("CARGO_BIN_EXE_depthplanes");
    let script = format!("'{program}' detect map.pgm map.pgm map.pgm --json | head -c 1; exit ${{PIPESTATUS[0]:-0}}");
    let ran = Ran::from(bench.command_of("bash").args(["-c", &script]).output().unwrap());
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""), "{ran:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_name_need_not_be_text() {
    use std::os::unix::ffi::OsStrExt;
    let bench = Bench::new("not_text");
    let name = std::ffi::OsStr::from_bytes(b"m\xe4p.pgm");
    std::fs::write(bench.folder.join(name), two_planes(1003)).unwrap();
    let command = &mut bench.command();
    let record = json(&Ran::from(command.args(["detect", "--json"]).arg(name).output().unwrap()).ok());
    assert_eq!(record["planes"].as_array().unwrap().len(), 2);
}

#[test]
fn coplanar_pieces_are_joined_and_their_records_kept() {
    let bench = Bench::new("coplanar");
    // A wall one metre away with a gap of two metres depth in its middle.
    let value = |at: usize| if (12..20).contains(&(at % 32)) { 2000u16 } else { 1000 };
    let mut bytes = b"P5 32 24 65535\n".to_vec();
    bytes.extend((0..32 * 24).flat_map(|at| value(at).to_be_bytes()));
    bench.write("gap.pgm", &bytes);
    let words =
        ["detect", "gap.pgm", "--method", "ngaf", "--encoding", "millimetre", "--intrinsics", "30,30,15.5,11.5"];
    let run = |more: &[&str]| bench.run(&[&words[..], more].concat());
    let plain = json(&run(&["--json"]).ok());
    assert_eq!(plain["planes"].as_array().unwrap().len(), 3);
    assert!(plain.get("merge_coplanar").is_none());
    let joined = json(&run(&["--json", "--outlines", "--merge-coplanar"]).ok());
    assert_eq!(joined["merge_coplanar"], serde_json::json!({"angle_deg": 3.0, "distance_m": 0.03}));
    let planes = joined["planes"].as_array().unwrap();
    assert_eq!(planes.len(), 2);
    assert_eq!(planes[0]["pixel_count"], 24 * 24);
    assert_eq!(planes[0]["outline"]["polygons_px"].as_array().unwrap().len(), 2);
    assert_eq!(planes[0]["parts"], serde_json::json!([plain["planes"][0], plain["planes"][1]]));
    assert!(planes[1].get("parts").is_none());
    assert!(run(&["--merge-coplanar=2,0.01"]).ok().contains("2 planes (1 joined of 2 parts) on 100.0 %"));
    let room = ["detect", "scene:room:seed=2,sensor=tof_white,size=320x240", "--merge-coplanar", "--json"];
    let large = json(&bench.run(&[&room[..], &["--min-area", "0.5"]].concat()).ok());
    assert_eq!(large["parameters"]["min-area"], 0.5);
    let areas: Vec<f64> =
        large["planes"].as_array().unwrap().iter().map(|plane| plane["metric"]["area_m2"].as_f64().unwrap()).collect();
    assert!(areas.len() > 2 && areas.iter().all(|&area| area >= 0.5), "{areas:?}");
}

#[test]
fn what_needs_metres_says_how_to_state_the_camera() {
    let bench = Bench::with_map("not_metric");
    let err = bench.run(&["detect", "map.pgm", "--merge-coplanar"]).fails(2);
    assert!(err.contains("`merge-coplanar` needs planes in metres; state the camera's intrinsics: give --intrinsics"));
    let err = bench.run(&["detect", "map.pgm", "--min-area", "1"]).fails(2);
    assert!(err.contains("`min-area` needs planes in metres; state the camera's intrinsics: give --intrinsics"));
    let err = bench.run(&["detect", "map.pgm", "--disparity", "--merge-coplanar"]).fails(2);
    assert!(err.contains("state the rig's focal length and baseline: give --focal and --baseline"), "{err}");
    let err = bench.run(&["detect", "map.pgm", "--merge-coplanar=91,0.1"]).fails(2);
    assert!(
        err.contains("parameter `merge-coplanar: angle` is 91; accepted: a number of degrees from 0 to 90"),
        "{err}"
    );
    bench.run(&["detect", "map.pgm", "--merge-coplanar=3"]).fails(2);
}

#[test]
fn only_the_outputs_named_are_written() {
    let bench = Bench::with_map("only");
    bench.run(&["detect", "map.pgm", "--out-dir", "d", "--only", "overlay,planes"]).ok();
    assert_eq!(names_in(&bench.folder.join("d")), ["map.overlay.png", "map.planes.json"]);
    let err = bench.run(&["detect", "map.pgm", "--out-dir", "e", "--only", "overlay,pictures"]).fails(2);
    assert!(err.contains("labels, overlay, planes, cloud, mesh, curved-labels"), "{err}");
    let err = bench.run(&["detect", "map.pgm", "--out-dir", "e", "--only", "cloud"]).fails(2);
    assert!(err.contains("--intrinsics fx,fy,cx,cy"), "{err}");
    let err = bench.run(&["detect", "map.pgm", "--only", "overlay"]).fails(2);
    assert!(err.contains("--out-dir"), "{err}");
    bench.run(&["detect", "map.pgm", "--out-dir", "c", "--only", "curved-labels"]).ok();
    assert_eq!(names_in(&bench.folder.join("c")), ["map.curved.png"]);
}

#[test]
fn one_table_holds_the_planes_of_all_inputs_but_the_bad() {
    let bench = Bench::new("one_table");
    std::fs::create_dir(bench.folder.join("maps")).unwrap();
    for i in 0..40u16 {
        bench.write(&format!("maps/frame{i}.pgm"), &two_planes(600 + i));
    }
    bench.write("maps/frame7.pgm", b"P5 never");
    bench.write("all.csv", b"what stood there before");
    let ran = bench.run(&["detect", "maps", "--table", "all.csv", "--jobs", "3"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("maps/frame7.pgm: ") && ran.err.contains("1 of 40 inputs failed"), "{ran:?}");
    assert!(ran.out.contains("\nwrote all.csv: 78 planes of 39 inputs\n"), "{ran:?}");
    assert_eq!(ran.out.matches("no camera: --preset").count(), 1, "{ran:?}");
    let csv = String::from_utf8(bench.read("all.csv")).unwrap();
    let rows: Vec<&str> = csv.lines().collect();
    assert!(rows[0].starts_with("source,label,") && rows.len() == 79, "{csv}");
    assert!(rows[1].starts_with("maps/frame0.pgm,1,") && rows[78].starts_with("maps/frame39.pgm,2,"), "{csv}");
    let ran = bench.run(&["detect", "maps", "--table", "all.jsonl", "--json"]);
    assert_eq!(String::from_utf8(bench.read("all.jsonl")).unwrap(), ran.out);
    assert_eq!(bench.names(), ["all.csv", "all.jsonl", "maps"]);
}

#[test]
fn a_table_that_cannot_be_written_is_refused_and_a_bad_input_leaves_the_old_one() {
    let bench = Bench::with_map("bad_table");
    bench.write("old.csv", b"old");
    bench.write("bad.pgm", b"P5 never");
    for (words, said) in [
        (["map.pgm", "--table", "t.txt"], ".csv or .jsonl"),
        (["map.pgm", "--table", "none/t.csv"], "make it first"),
        (["bad.pgm", "--table", "old.csv"], "bad.pgm"),
    ] {
        let err = bench.run(&[&["detect"], &words[..]].concat()).fails(2);
        assert!(err.contains(said), "{err}");
    }
    let both = ["detect", "map.pgm", "--table", "t.csv", "--planes", "./t.csv"];
    assert!(bench.run(&both).fails(2).contains("would overwrite"));
    assert_eq!(bench.read("old.csv"), b"old");
    assert_eq!(bench.names(), ["bad.pgm", "map.pgm", "old.csv"]);
}

#[test]
fn folders_in_depth_are_named_or_read_with_their_own_folders_of_results() {
    let bench = Bench::new("in_depth");
    for (folder, file) in
        [("seq/left", "a.pgm"), ("seq/left", "b.pgm"), ("seq/right/deep", "a.pgm"), ("seq/.hid", "c.pgm")]
    {
        std::fs::create_dir_all(bench.folder.join(folder)).unwrap();
        bench.write(&format!("{folder}/{file}"), &two_planes(900));
    }
    let err = bench.run(&["detect", "seq"]).fails(2);
    assert!(
        err.contains("seq/left (2 files), seq/right/deep (1 file); give the one you mean, or --recursive"),
        "{err}"
    );
    for _ in 0..2 {
        // The second time the results stand below the folder that is read.
        let words = ["detect", "seq", "--recursive", "--out-dir", "seq/out", "--only", "labels", "--json"];
        let out = bench.run(&words).ok();
        let sources: Vec<Value> = out.lines().map(|line| json(line)["source"].clone()).collect();
        assert_eq!(sources, ["seq/left/a.pgm", "seq/left/b.pgm", "seq/right/deep/a.pgm"]);
    }
    assert_eq!(names_in(&bench.folder.join("seq/out/left")), ["a.labels.png", "b.labels.png"]);
    assert_eq!(names_in(&bench.folder.join("seq/out/right/deep")), ["a.labels.png"]);
    let err = bench.run(&["detect", "seq/left", "seq/right/deep", "--out-dir", "flat"]).fails(2);
    assert!(err.contains("would overwrite"), "{err}");
    assert_eq!(bench.run(&["inspect", "seq", "--recursive", "--json"]).ok().lines().count(), 3);
    std::fs::create_dir(bench.folder.join("empty")).unwrap();
    assert!(bench.run(&["detect", "empty"]).fails(2).contains("no map in this folder; looked for"));
}

#[test]
fn small_holes_of_outlines_are_filled_on_request() {
    let bench = Bench::new("min_hole");
    let value = |at: usize| if [300, 301, 500].contains(&at) { 0u16 } else { 1000 };
    let pixels = (0..32 * 24).flat_map(|at| value(at).to_be_bytes());
    bench.write("holes.pgm", &[b"P5 32 24 65535\n".to_vec(), pixels.collect()].concat());
    let holes = |more: &[&str]| {
        let record = json(&bench.run(&[&["detect", "holes.pgm", "--json", "--outlines=0"], more].concat()).ok());
        let holes = record["planes"][0]["outline"]["polygons_px"][0]["holes"].as_array().unwrap().len();
        (holes, record.get("outline_min_hole_px").cloned())
    };
    assert_eq!(holes(&[]), (2, None));
    assert_eq!(holes(&["--min-hole", "2"]), (1, Some(2.into())));
    assert_eq!(holes(&["--min-hole", "3"]), (0, Some(3.into())));
    assert!(bench.run(&["detect", "holes.pgm", "--min-hole", "3"]).fails(2).contains("--outlines"));
    bench.run(&["detect", "holes.pgm", "--outlines", "--min-hole=-1"]).fails(2);
}

#[test]
fn depth_stands_beside_distance_and_a_missing_camera_is_a_line_of_the_summary() {
    let bench = Bench::with_map("depth_column");
    let ran = bench.run(&["detect", "map.pgm", "--encoding", "millimetre"]);
    assert!(!ran.err.contains("camera"), "{ran:?}");
    assert!(
        ran.out.contains("\nno camera: --preset SENSOR, --intrinsics FX,FY,CX,CY or --camera FILE adds"),
        "{ran:?}"
    );
    assert!(ran.ok().contains("51.1 %  1.503 m"));
    assert!(!bench.run(&["detect", "map.pgm", "--json"]).ok().contains("no camera"));
    let out = bench.run(&["detect", "map.pgm", "--encoding", "grey"]).ok();
    assert!(!out.contains("no camera"), "{out}");
    let out = bench.run(&["detect", "map.pgm", "--disparity"]).ok();
    assert!(out.contains("no camera: --baseline METRES"), "{out}");
    let out = bench.run(&["detect", "map.pgm", "--preset", "azure-kinect"]).ok();
    assert!(out.contains("no camera: --intrinsics"), "{out}");
    let camera = ["--encoding", "millimetre", "--intrinsics", "30,30,15.5,11.5"];
    let out = bench.run(&[&["detect", "map.pgm"], &camera[..]].concat()).ok();
    assert!(!out.contains("no camera") && out.contains("depth: along the view"), "{out}");
}
