//! The examples run, and what they write is what they say.

#![allow(dead_code, reason = "an example's own `main` is not called")]

#[path = "../examples/detect_png.rs"]
mod detect_png;
#[path = "../examples/overlay.rs"]
mod overlay;
#[path = "../examples/planes_to_ply.rs"]
mod planes_to_ply;

use depthplanes::scene::{ScenePixels, Spec};
use depthplanes_io::outputs::grey16_png;
use std::path::PathBuf;

fn file(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("examples");
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

#[test]
fn a_png_of_a_room_has_planes() {
    let frame = "room:sensor=clean_mm".parse::<Spec>().unwrap().frame().unwrap();
    let ScenePixels::U16(pixels) = &frame.pixels else { panic!("16 bits") };
    let file = file("depth.png");
    std::fs::write(&file, grey16_png(frame.width, frame.height, pixels)).unwrap();
    assert!(detect_png::detect(&file).unwrap() > 10);
}

#[test]
fn a_buffer_becomes_a_picture_of_its_size() {
    let file = file("overlay.png");
    overlay::picture(&file).unwrap();
    let png = std::fs::read(&file).unwrap();
    assert_eq!((&png[1..4], &png[16..24]), (&b"PNG"[..], &[0, 0, 1, 64, 0, 0, 0, 240][..]));
}

#[test]
fn planes_become_surfaces() {
    let file = file("planes.ply");
    planes_to_ply::surfaces(&file).unwrap();
    let ply = std::fs::read(&file).unwrap();
    let head = String::from_utf8_lossy(&ply[..400]);
    assert!(head.starts_with("ply\nformat binary_little_endian 1.0\n") && !head.contains("element face 0\n"), "{head}");
}
