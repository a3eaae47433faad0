//! `depthplanes floor`: the record, the table, the picture, and real frames with figures taken by hand.

mod support;

use serde_json::Value;
use support::{Bench, data};

fn record(bench: &Bench, words: &[&str]) -> Value {
    let ran = bench.run(&[&["floor"], words, &["--json"]].concat());
    assert_eq!(ran.code, Some(0), "{ran:?}");
    serde_json::from_str(&ran.out).unwrap_or_else(|error| panic!("{error}: {}", ran.out))
}

/// The record of a map of the data, if there is data.
fn of_data(bench: &Bench, file: &str, words: &[&str]) -> Option<Value> {
    let path = data()?.join(file);
    Some(record(bench, &[&[path.to_str().unwrap()], words].concat()))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Heights of the planes of a class.
fn heights(record: &Value, class: &str) -> Vec<f64> {
    let planes = record["planes"].as_array().unwrap();
    planes.iter().filter(|plane| plane["class"] == class).map(|plane| number(&plane["height_m"])).collect()
}

#[test]
fn the_record_has_the_floor_the_planes_obstacles_steps_and_sectors() {
    let bench = Bench::new("floor_record");
    let record = record(&bench, &["scene:stairs:sensor=clean_mm,size=320x240"]);
    let floor = &record["floor"];
    assert!((number(&floor["height_m"]) - 1.85).abs() < 0.02, "{floor}");
    assert!((number(&floor["tilt_deg"]) - 13.0).abs() < 0.5, "{floor}");
    for key in ["label", "labels", "height_sd_m", "tilt_sd_deg", "roll_deg", "roll_sd_deg", "confidence"] {
        assert!(!floor[key].is_null(), "{key}");
    }
    for key in ["planes", "obstacles", "steps", "sectors"] {
        assert!(!record[key].as_array().unwrap().is_empty(), "{key}");
    }
    assert_eq!(record["up_from"], "estimated");
}

#[test]
fn no_floor_is_said_with_what_helps_and_is_no_error() {
    let bench = Bench::new("floor_none");
    bench.write("wall.pgm", &wall());
    let camera = ["--intrinsics", "60,60,31.5,23.5"];
    let ran = bench.run(&[&["floor", "wall.pgm"], &camera[..]].concat());
    assert_eq!((ran.code, ran.out.as_str()), (Some(0), "wall.pgm: no floor\n"), "{ran:?}");
    assert!(ran.err.contains("note: wall.pgm: no floor") && ran.err.contains("--up X,Y,Z"), "{ran:?}");
    let ran = bench.run(&[&["floor", "wall.pgm", "--up", "0,-1,0"], &camera[..]].concat());
    assert!(ran.code == Some(0) && ran.err.contains("no plane is level by the --up"), "{ran:?}");
    // The wall is the floor of a camera that looks down at it.
    let record = record(&bench, &[&["wall.pgm", "--up", "0,0,-1"], &camera[..]].concat());
    assert!((number(&record["floor"]["height_m"]) - 2.0).abs() < 1e-3, "{record}");
    assert_eq!(record["up_from"], "stated");
}

/// 64 x 48 pixels, all 2 m away.
fn wall() -> Vec<u8> {
    let mut bytes = b"P5 64 48 65535\n".to_vec();
    bytes.extend((0..64 * 48).flat_map(|_| 2000u16.to_be_bytes()));
    bytes
}

#[test]
fn wrong_use_says_what_is_accepted() {
    let bench = Bench::new("floor_wrong");
    bench.write("wall.pgm", &wall());
    let camera = ["--intrinsics", "60,60,31.5,23.5"];
    for (words, says) in [
        (&["wall.pgm"][..], "`floor` needs planes in metres; state the camera's intrinsics: give --intrinsics"),
        (&["wall.pgm", "--up", "0,0,0"], "`up` is `0,0,0`; accepted: a direction in camera coordinates"),
        (&["wall.pgm", "--up", "0,1"], "accepted: 3 numbers with commas between and no blanks; 2 were given"),
        (&["wall.pgm", "--camera-height", "-1"], "`camera-height` is -1; accepted: a finite number of metres above 0"),
        (&["wall.pgm", "--overlay", "a.jpg"], "--overlay a.jpg: accepted: a name that ends in .png"),
        (&["wall.pgm", "--grid", "a.yaml"], "--grid a.yaml: accepted: a name that ends in .png or .pgm"),
        (&["wall.pgm", "--grid", "a.png", "--overlay", "a.png"], "a.png"),
        (&["wall.pgm", "--grid", "wall.pgm"], "the input wall.pgm"),
        (
            &["wall.pgm", "--grid", "a.png", "--resolution", "2"],
            "`resolution` is 2; accepted: metres of a cell's side, 0.01 to 1",
        ),
        (&["wall.pgm", "wall.pgm", "--overlay", "a.png"], "--overlay names one file, but there are 2 inputs"),
    ] {
        let camera = if words.len() == 1 { &[][..] } else { &camera[..] };
        let ran = bench.run(&[&["floor"], words, camera].concat());
        assert!(ran.code == Some(2) && ran.err.contains(says), "{words:?}: {ran:?}");
    }
}

#[test]
fn several_inputs_give_a_line_each_and_a_bad_one_stops_no_other() {
    let bench = Bench::new("floor_several");
    bench.write("bad.png", b"no picture");
    let scene = "scene:corridor:size=160x120";
    let ran = bench.run(&["floor", scene, "bad.png", scene, "--json"]);
    assert_eq!((ran.code, ran.out.lines().count()), (Some(2), 2), "{ran:?}");
    assert!(ran.err.contains("1 of 3 inputs failed"), "{ran:?}");
    for line in ran.out.lines() {
        assert!(serde_json::from_str::<Value>(line).unwrap()["floor"]["height_m"].is_number());
    }
}

#[test]
fn the_picture_is_as_large_as_the_map() {
    let bench = Bench::new("floor_picture");
    bench.run(&["floor", "scene:boxes:size=160x120", "--overlay", "ground.png"]).ok();
    // Width and height of a PNG file's header.
    assert_eq!(bench.read("ground.png")[16..24], [0, 0, 0, 160, 0, 0, 0, 120]);
}

#[test]
fn the_grid_is_a_map_that_ros_reads() {
    let bench = Bench::new("floor_grid");
    // Looks straight down at a floor 2 m below: 2 m * 64 / 60 across and 2 m * 48 / 60 along, the camera in the middle.
    bench.write("wall.pgm", &wall());
    let words = ["floor", "wall.pgm", "--intrinsics", "60,60,31.5,23.5", "--up", "0,0,-1", "--resolution", "0.1"];
    bench.run(&[&words[..], &["--grid", "map.pgm"]].concat()).ok();
    let yaml = String::from_utf8(bench.read("map.yaml")).unwrap();
    assert_eq!(
        yaml,
        "image: \"map.pgm\"\nmode: trinary\nresolution: 0.1\norigin: [-0.8, -1.1, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n\
         free_thresh: 0.196\n"
    );
    let map = bench.read("map.pgm");
    let pixels = map.strip_prefix(b"P5\n16 22\n255\n").expect("16 cells ahead and back, 22 across");
    assert_eq!(pixels, [254; 16 * 22]);
    // A map of what is not the floor is unknown, and the same in PNG is as large.
    bench.run(&["floor", "wall.pgm", "--intrinsics", "60,60,31.5,23.5", "--grid", "map.png"]).ok();
    assert_eq!(bench.read("map.png")[16..24], [0, 0, 0, 1, 0, 0, 0, 1]);
    assert!(String::from_utf8(bench.read("map.yaml")).unwrap().starts_with("image: \"map.png\""));
}

const POLYLIDAR: [&str; 7] = [
    "00000000_1580908150203",
    "00000001_1580908153638",
    "00000002_1580908154239",
    "00000003_1580908154939",
    "00000004_1580908166279",
    "00000005_1580908170414",
    "00000006_1580908171048",
];

#[test]
fn floors_of_recorded_frames_are_as_high_as_measured_by_hand() {
    let bench = Bench::new("floor_recorded");
    let realsense = ["--intrinsics", "307.853,307.864,204.473,121.658"];
    for (at, name) in POLYLIDAR.iter().enumerate() {
        let Some(record) = of_data(&bench, &format!("realsense_polylidar/depth/{name}.png"), &realsense) else {
            return;
        };
        let floor = &record["floor"];
        let (height, sd) = (number(&floor["height_m"]), number(&floor["height_sd_m"]));
        // By hand for frames 2 to 6; the camera is held as high in the first two.
        assert!((0.76 - 2.0 * sd..0.81 + 2.0 * sd).contains(&height) && sd < 0.1, "{name}: {floor}");
        if (2..6).contains(&at) {
            assert!((0.76..0.81).contains(&height), "{name}: {floor}");
        }
    }
    let kinect = ["--intrinsics", "585,585,320,240", "--missing", "65535"];
    let seven = of_data(&bench, "video_7scenes/frame-000000.depth.png", &kinect).unwrap();
    assert!((number(&seven["floor"]["height_m"]) - 1.35).abs() < 0.03, "{}", seven["floor"]);
    let tables = heights(&seven, "table");
    for by_hand in [0.69, 0.43] {
        assert!(tables.iter().any(|height| (height - by_hand).abs() < 0.06), "{by_hand}: {tables:?}");
    }
    for frame in [150, 171, 199] {
        let tsdf = of_data(&bench, &format!("video_tsdf_fusion/frame-000{frame}.depth.png"), &kinect).unwrap();
        let floor = &tsdf["floor"];
        let (height, sd) = (number(&floor["height_m"]), number(&floor["height_sd_m"]));
        assert!((height - 1.52).abs() < 0.03 + 2.0 * sd && sd < 0.1, "{frame}: {floor}");
    }
    let fr3 = ["--intrinsics", "535.4,539.2,320.1,247.6", "--encoding", "tum"];
    let tum = of_data(&bench, "tum/deplex_fr3_1341848230.910894.png", &fr3).unwrap();
    assert!((number(&tum["floor"]["height_m"]) - 1.52).abs() < 0.03, "{}", tum["floor"]);
    assert!(heights(&tum, "table").iter().any(|height| (height - 0.70).abs() < 0.03));
}

#[test]
fn treads_of_recorded_stairs_are_found_with_the_imu_and_without() {
    let bench = Bench::new("floor_stairs");
    let camera = ["--intrinsics", "365.3,365.3,254.7,208.6"];
    let steps = |record: &Value, key: &str| -> Vec<f64> {
        record["steps"].as_array().unwrap().iter().filter_map(|step| step[key].as_f64()).collect()
    };
    // Straight down at the foot of the stair: up is what the accelerometer beside the frame has, turned into the camera's axes.
    let up = ["--up", "-0.064,-0.202,-0.95"];
    let Some(down) = of_data(&bench, "stairs_kinect_v2/0000_depth.png", &[&camera[..], &up].concat()) else { return };
    // Heights of the labelled planes of gt_real/k2stairs_0 above the labelled floor, at their middles.
    for (height, labelled) in steps(&down, "height_m").iter().zip([0.075, 0.171]) {
        assert!((height - labelled).abs() < 0.01, "{down}");
    }
    assert!(steps(&down, "height_m").len() >= 2, "{down}");
    let ahead = of_data(&bench, "stairs_kinect_v2/0001_depth.png", &camera).unwrap();
    let (rises, runs) = (steps(&ahead, "rise_m"), steps(&ahead, "run_m"));
    assert!(rises.len() >= 4 && rises.iter().all(|rise| (rise - 0.093).abs() < 0.01), "{rises:?}");
    assert!(runs.iter().all(|run| (run - 0.28).abs() < 0.03), "{runs:?}");
}
