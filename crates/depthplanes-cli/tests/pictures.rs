//! The pictures of the docs are what the program and the library draw; with DEPTHPLANES_GOLDEN=update
//! they are drawn anew.

mod support;

use depthplanes::internals::Enhancer;
use depthplanes::methods::{self, MethodInfo};
use depthplanes::scene::{ScenePixels, Spec};
use depthplanes::{DepthView, Detection, Detector};
use depthplanes_io::outputs::{OUTPUTS, Report};
use depthplanes_io::{Frame, Pixels, Provenance};
use std::path::{Path, PathBuf};
use support::Bench;

fn check(name: &str, drawn: &[u8]) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/images").join(name);
    if std::env::var_os("DEPTHPLANES_GOLDEN").is_some_and(|value| value == "update") {
        std::fs::write(&path, drawn).unwrap();
    }
    let kept = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(kept == drawn, "docs/images/{name} is not what is drawn now; if that is meant, run `make golden`");
    assert!(drawn.len() < 300_000, "{name} has {} bytes", drawn.len());
}

/// The methods that README shows side by side.
const COMPARED: &str = "planar,ngaf,ransac,hough,normals";

/// The frame is of the Point Cloud Library's tests (BSD-3-Clause).
#[test]
fn the_boxes_of_the_readme_are_what_is_found_of_a_recorded_frame() {
    let Some(data) = support::data() else { return };
    let bench = Bench::new("picture_of_boxes");
    let frame = data.join("gt_real/pcl.depth.png");
    let map = [frame.to_str().unwrap(), "--scale", "1000", "--intrinsics", "525,525,320,240"];
    for (picture, command, given) in [
        ("boxes.png", "detect", &["--overlay", "boxes.png"][..]),
        // No plane is that large, so that the grey map remains.
        ("boxes-depth.png", "detect", &["--overlay", "boxes-depth.png", "--min-pixels", "1000000"]),
        ("compare.png", "compare", &["--repeat", "1", "--picture", "compare.png", "--methods", COMPARED]),
    ] {
        bench.run(&[&[command], &map[..], given].concat()).ok();
        check(picture, &bench.read(picture));
    }
}

#[test]
fn the_room_of_the_readme_is_the_demos() {
    let bench = Bench::new("picture_of_the_room");
    bench.run(&["demo", "--out-dir", "demo"]).ok();
    check("room.png", &bench.read("demo/overlay.png"));
    bench.run(&["detect", "demo/depth.png", "--min-pixels", "1000000", "--overlay", "depth.png"]).ok();
    check("room-depth.png", &bench.read("depth.png"));
}

/// The scene of docs/ngaf.md and the parameters used there.
const SCENE: &str = "boxes:seed=3,sensor=kinect_white,size=320x240";
const WINDOW: u32 = 5;
const PARAMETERS: [(&str, f64); 3] = [("theta", 20.0), ("min-pixels", 64.0), ("window", WINDOW as f64)];

#[test]
fn the_stages_of_ngaf_look_as_the_page_shows_them() {
    let scene = SCENE.parse::<Spec>().unwrap().frame().unwrap();
    let ScenePixels::U16(pixels) = scene.pixels else { panic!("millimetres") };
    let view = DepthView::new(&pixels, scene.width, scene.height).unwrap();
    let mut enhancer = Enhancer::default();
    let (enhanced, _) = enhancer.enhance(&view, WINDOW, 1).unwrap();
    let filled: Vec<u16> = enhanced.rows().flatten().copied().collect();
    let ngaf = methods::find("ngaf").unwrap();
    let mut detector = Detector::new(ngaf.with(&PARAMETERS).unwrap()).unwrap();
    let found = detector.detect(view).unwrap();
    let frame = |pixels| Frame {
        width: scene.width,
        height: scene.height,
        pixels: Pixels::U16(pixels),
        missing: None,
        valid_range: None,
        sensor: scene.sensor,
        format: "scene",
        encoding: "scene",
        provenance: Provenance::default(),
        warnings: Vec::new(),
    };
    let mut nothing = found.clone();
    nothing.labels.fill(0);
    nothing.planes.clear();
    check("ngaf-1-map.png", &overlay(ngaf, &frame(pixels.clone()), &nothing));
    check("ngaf-2-enhanced.png", &overlay(ngaf, &frame(filled.clone()), &nothing));
    check("ngaf-3-planes.png", &overlay(ngaf, &frame(filled), found));
}

#[test]
fn the_room_of_the_page_on_planar_is_what_the_methods_find() {
    let bench = Bench::new("pictures_of_planar");
    let planar: &[&str] = &[];
    let ngaf: &[&str] = &["--method", "ngaf", "--theta", "20", "--min-pixels", "100"];
    for (method, picture) in [(planar, "planar-room.png"), (ngaf, "planar-room-ngaf.png")] {
        let given = ["detect", "scene:room:seed=2,sensor=azure,size=480x360", "--overlay", picture];
        bench.run(&[&given, method].concat()).ok();
        check(picture, &bench.read(picture));
    }
}

#[test]
fn the_scene_of_the_page_on_curved_surfaces_is_what_is_reported() {
    let bench = Bench::new("picture_of_curved");
    let scene = "scene:curved:sensor=kinect_white,size=400x300";
    bench.run(&["detect", scene, "--curved", "--overlay", "curved.png"]).ok();
    check("planar-curved.png", &bench.read("curved.png"));
}

#[test]
fn the_room_of_the_page_on_outlines_is_what_is_outlined() {
    let bench = Bench::new("picture_of_outlines");
    let scene = "scene:room:seed=2,sensor=tof_white,size=480x360";
    bench.run(&["detect", scene, "--outlines", "--overlay", "outlines.png"]).ok();
    check("outlines.png", &bench.read("outlines.png"));
}

fn overlay(method: &'static MethodInfo, frame: &Frame, detection: &Detection) -> Vec<u8> {
    let defaults = method.defaults();
    let report = Report::new(SCENE, frame, method, &defaults, detection);
    let output = OUTPUTS.iter().find(|output| output.name == "overlay").unwrap();
    (output.writer(Path::new("a.png")).unwrap().encode)(&report).unwrap()
}
