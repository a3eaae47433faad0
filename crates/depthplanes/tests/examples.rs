//! The examples run, and what they assert holds.

#[path = "../examples/camera_loop.rs"]
mod camera_loop;
#[path = "../examples/floor_height.rs"]
mod floor_height;
#[path = "../examples/own_pixels.rs"]
mod own_pixels;

#[test]
fn own_pixels_are_two_walls() {
    own_pixels::main().unwrap();
}

#[test]
fn a_camera_loop_gives_polygons_in_metres() {
    camera_loop::main().unwrap();
}

#[test]
fn the_camera_is_as_high_above_the_floor_as_the_room_has_it() {
    floor_height::main().unwrap();
}

#[test]
fn a_detector_says_what_it_is() {
    let text = format!("{:?}", depthplanes::Detector::default().threads(2));
    assert!(
        text.starts_with("Detector { method: \"planar\", sensor: Sensor {") && text.contains("threads: 2"),
        "{text}"
    );
}
