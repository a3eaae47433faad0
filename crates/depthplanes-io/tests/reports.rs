//! Inputs that users reported, with their right values: read with the flags of the reports, each gives the planes that are
//! there, or a note that leads to them.

mod common;
#[path = "common/room.rs"]
mod room;

use depthplanes::Intrinsics;
use depthplanes_io::encoding::Stereo;
use depthplanes_io::{Frame, ReadOptions, read};
use room::{CAMERA, FLOOR, FRONT, ROOM, SIDE, WALL, check, notes};

/// Distances to 2 %, normals to 0.03, 95 % of the valid pixels.
const CLOSE: [f64; 3] = [0.02, 0.03, 0.95];

fn with(intrinsics: Intrinsics) -> ReadOptions {
    ReadOptions { intrinsics: Some(intrinsics), ..Default::default() }
}

fn report(name: &str, options: &ReadOptions) -> Option<Frame> {
    let path = common::data()?.join("reports").join(name);
    Some(read(&path, options).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn a_room_with_gaps_of_any_pattern_has_its_planes() {
    for name in ["full", "checker", "rand35", "row1of2", "row1of4"] {
        let Some(frame) = report(&format!("gaps_{name}.png"), &with(CAMERA)) else { return };
        check(name, &frame, &ROOM, CLOSE);
    }
}

#[test]
fn coarse_steps_leave_the_planes_whole() {
    let camera = |f, cx, cy| with(Intrinsics { fx: f, fy: f, cx, cy });
    let Some(frame) = report("steps_eighth_px_mm.png", &camera(290.0, 159.5, 119.5)) else { return };
    check("eighths of a pixel", &frame, &[WALL, FLOOR, SIDE], [0.02, 0.05, 0.95]);
    let frame = report("steps_float16_m.npy", &camera(144.0, 79.5, 59.5)).unwrap();
    check("float16", &frame, &[(3.0, WALL.1), FLOOR, SIDE], CLOSE);
    let frame = report("steps_nearest_7p5x.png", &camera(432.0, 239.5, 179.5)).unwrap();
    check("enlarged 7.5 times", &frame, &ROOM, [0.04, 0.06, 0.90]);
}

#[test]
fn distances_along_rays_are_noticed_and_turned_into_depth() {
    let Some(frame) = report("ray_distance_m.npy", &with(CAMERA)) else { return };
    assert!(notes(&frame).contains("--ray-distance"), "{}", notes(&frame));
    let turned = report("ray_distance_m.npy", &ReadOptions { ray_distance: true, ..with(CAMERA) }).unwrap();
    check("ray distance", &turned, &ROOM, CLOSE);
}

#[test]
fn depth_in_a_pfm_file_is_read_as_depth() {
    let Some(frame) = report("depth_mm.pfm", &with(CAMERA)) else { return };
    check("PFM of millimetres", &frame, &ROOM, CLOSE);
}

#[test]
fn relative_inverse_depth_is_noticed_and_has_its_planes() {
    let Some(frame) = report("relative_inverse16.png", &ReadOptions::default()) else { return };
    assert!(notes(&frame).contains("--disparity") && notes(&frame).contains("--encoding inverse-depth"));
    for options in [
        ReadOptions { encoding: Some("inverse-depth".into()), ..Default::default() },
        ReadOptions { disparity: true, ..Default::default() },
    ] {
        let frame = report("relative_inverse16.png", &options).unwrap();
        let (planes, share, _) = room::planes(&frame);
        assert!(planes.len() == 4 && share >= 0.95, "{} planes on {share}", planes.len());
    }
}

#[test]
fn what_stands_for_nothing_is_no_plane() {
    let Some(frame) = report("background_1e10.npy", &with(CAMERA)) else { return };
    check("1e10", &frame, &ROOM, CLOSE);
    assert!(notes(&frame).contains("1e10") && notes(&frame).contains("--missing"));
    let rig = Stereo { focal_px: 115.2, baseline_m: 0.3, doffs_px: 0.0 };
    let options = ReadOptions { disparity: true, scale: Some(16.0), stereo: Some(rig), ..with(CAMERA) };
    let frame = report("disparity_65520.png", &options).unwrap();
    check("65520", &frame, &[WALL, FLOOR, FRONT], CLOSE);
    assert!(notes(&frame).contains("65520 is the -16"));
}
