//! What the numbers mean: every encoding, the guesses, the presets, and the traps.

mod common;

use common::*;
use depthplanes::ValueKind;
use depthplanes_io::encoding::{ENCODINGS, Stereo};
use depthplanes_io::presets::SENSOR_PRESETS;
use depthplanes_io::{Error, Frame, Pixels, ReadOptions, decode, encoding, inspect};

fn pgm16(width: usize, values: &[u16]) -> Vec<u8> {
    [format!("P5 {width} {} 65535\n", values.len() / width).into_bytes(), bytes_be(values)].concat()
}

fn named(name: &str) -> ReadOptions {
    ReadOptions { encoding: Some(name.into()), ..Default::default() }
}

fn read(values: &[u16], options: &ReadOptions) -> Frame {
    decode(&pgm16(values.len(), values), "test", options).unwrap()
}

fn depth_m(frame: &Frame, value: f64) -> f64 {
    frame.sensor.value_kind.depth_m(value).unwrap()
}

const RIG: Stereo = Stereo { focal_px: 500.0, baseline_m: 0.2, doffs_px: 0.0 };

#[test]
fn units_of_the_depth_encodings() {
    for (name, value, metres) in [
        ("millimetre", 1500, 1.5),
        ("metre", 3, 3.0),
        ("tum", 10_000, 2.0),
        ("icl", 5000, 1.0),
        ("realsense", 1500, 1.5),
    ] {
        let frame = read(&[value, 7], &named(name));
        assert!((depth_m(&frame, value.into()) - metres).abs() < 1e-12, "{name}");
        assert_eq!(frame.pixels, Pixels::U16(vec![value, 7]), "{name} keeps the numbers");
    }
    let fine = ReadOptions { depth_scale: Some(0.0001), ..named("realsense") };
    assert!((depth_m(&read(&[1, 1], &fine), 10_000.0) - 1.0).abs() < 1e-12);
    let scaled = ReadOptions { scale: Some(10_000.0), ..named("millimetre") };
    assert!((depth_m(&read(&[1, 1], &scaled), 10_000.0) - 1.0).abs() < 1e-12);
}

#[test]
fn packed_bits_are_unpacked() {
    assert_eq!(read(&[1234 << 3 | 5, 8], &named("kinect-sdk")).pixels, Pixels::U16(vec![1234, 1]));
    let rotated = 9000u16.rotate_left(3);
    assert_eq!(read(&[rotated, 8], &named("sun-rgbd")).pixels, Pixels::U16(vec![9000, 1]));
}

#[test]
fn raw_kinect_has_its_formula_its_missing_value_and_its_end() {
    let frame = read(&[600, 2047, 1085], &named("kinect-raw"));
    assert!((depth_m(&frame, 600.0) - 1.0 / (3.3309495161 - 0.0030711016 * 600.0)).abs() < 1e-12);
    assert_eq!(depthplanes::with_view!(frame.view().unwrap(), view => view.valid_pixels()), 1);
    let swapped = read(&[600u16.swap_bytes(), 2047u16.swap_bytes()], &named("kinect-raw"));
    assert_eq!((swapped.pixels, swapped.warnings.len()), (Pixels::U16(vec![600, 2047]), 1));
    assert!(decode(&pgm16(2, &[0x1234, 0x5678]), "test", &named("kinect-raw")).is_err());
}

#[test]
fn disparity_is_metric_with_a_rig_only() {
    assert_eq!(read(&[2560, 1], &named("kitti")).sensor.value_kind, ValueKind::Disparity);
    let kitti = read(&[2560, 1], &ReadOptions { stereo: Some(RIG), ..named("kitti") });
    assert!((depth_m(&kitti, 2560.0) - 10.0).abs() < 1e-9);
    let unscaled = ReadOptions { stereo: Some(RIG), ..named("middlebury") };
    assert!(matches!(decode(&pgm16(1, &[80]), "x", &unscaled).unwrap_err().kind(), Error::Parameter { .. }));
    let scaled = read(&[80, 1], &ReadOptions { scale: Some(8.0), ..unscaled });
    assert!((depth_m(&scaled, 80.0) - 10.0).abs() < 1e-9);
    let shifted = Stereo { doffs_px: 10.0, ..RIG };
    let float = decode(&pfm(&depth()), "x", &ReadOptions { stereo: Some(shifted), ..Default::default() }).unwrap();
    assert_eq!(float.encoding, "middlebury");
    assert!((depth_m(&float, 10.0) - 5.0).abs() < 1e-9);
}

#[test]
fn guesses_follow_the_sample_type() {
    let guess = |bytes: &[u8], options: &ReadOptions| decode(bytes, "x", options).unwrap().encoding;
    let none = ReadOptions::default();
    let disparity = ReadOptions { disparity: true, ..Default::default() };
    let floats = |value: f32| npy("<f4", false, "(1, 2)", &[value.to_le_bytes(), value.to_le_bytes()].concat());
    assert_eq!(guess(&pgm16(1, &[900]), &none), "millimetre");
    assert_eq!(guess(b"P5 1 1 255\n\x09", &none), "grey");
    assert_eq!(guess(&pfm(&[6; WIDTH * HEIGHT]), &none), "middlebury");
    assert_eq!(guess(&pfm(&[600; WIDTH * HEIGHT]), &none), "millimetre"); // a disparity of 600 in 7 columns
    assert_eq!(guess(&pfm(&[600; WIDTH * HEIGHT]), &disparity), "middlebury");
    assert_eq!(guess(&floats(2.5), &none), "metre");
    assert_eq!(guess(&floats(2500.0), &none), "millimetre");
    assert_eq!(guess(&pgm16(1, &[20_000]), &disparity), "kitti");
    assert_eq!(guess(&pgm16(1, &[60]), &disparity), "disparity");
    assert_eq!(guess(&floats(60.0), &disparity), "disparity");
    assert_eq!(guess(b"P5 1 1 255\n\x09", &disparity), "middlebury");
}

#[test]
fn options_that_contradict_are_refused() {
    let bytes = pgm16(2, &[900, 901]);
    let refused = |options: ReadOptions| match decode(&bytes, "x", &options).unwrap_err().kind() {
        Error::Parameter { .. } | Error::Library(_) => {}
        other => panic!("{other}"),
    };
    refused(named("no-such"));
    refused(ReadOptions { preset: Some("no-such".into()), ..Default::default() });
    refused(ReadOptions { disparity: true, ..named("tum") });
    refused(ReadOptions { scale: Some(2.0), ..named("kinect-sdk") });
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 5e-324] {
        refused(ReadOptions { scale: Some(scale), ..named("tum") });
    }
    for missing in [65_536.0, -1.0, 0.5, f64::NAN] {
        refused(ReadOptions { missing: Some(missing), ..Default::default() });
    }
    refused(ReadOptions { valid_range: Some((5.0, 4.0)), ..Default::default() });
    refused(ReadOptions { stereo: Some(Stereo { baseline_m: 0.0, ..RIG }), ..Default::default() });
    let camera = depthplanes::Intrinsics { fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0 };
    refused(ReadOptions { intrinsics: Some(camera), camera_size: Some((640, 480)), ..Default::default() });
    let bytes = npy("<f4", false, "(1, 1)", &[0; 4]);
    for options in [named("kinect-raw"), named("sun-rgbd"), ReadOptions { swap_bytes: true, ..Default::default() }] {
        assert!(decode(&bytes, "x", &options).is_err());
    }
}

#[test]
fn negative_floats_are_missing() {
    let values: Vec<u8> = [-1.0f32, 2.0, f32::NAN, f32::INFINITY].iter().flat_map(|v| v.to_le_bytes()).collect();
    let frame = decode(&npy("<f4", false, "(2, 2)", &values), "x", &ReadOptions::default()).unwrap();
    assert_eq!(depthplanes::with_view!(frame.view().unwrap(), view => view.valid_pixels()), 1);
}

#[test]
fn presets_name_encodings_and_use_their_camera_at_its_size_only() {
    for preset in SENSOR_PRESETS {
        encoding::by_name(preset.encoding).unwrap();
        if let Some((_, _, camera)) = preset.camera {
            depthplanes::Intrinsics::new(camera.fx, camera.fy, camera.cx, camera.cy).unwrap();
        }
    }
    let options = ReadOptions { preset: Some("7-scenes".into()), ..Default::default() };
    let small = read(&[900, 65_535], &options);
    assert_eq!((small.sensor.intrinsics, small.missing, small.warnings.len()), (None, Some(65_535.0), 1));
    let whole = decode(&pgm16(640, &vec![900; 640 * 480]), "x", &options).unwrap();
    assert_eq!(whole.sensor.intrinsics.unwrap().fx, 585.0);
}

#[test]
fn names_and_aliases_are_different() {
    let mut names: Vec<_> = ENCODINGS.iter().flat_map(|e| e.aliases.iter().chain([&e.name])).collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
}

/// A slanted plane of 64 x 64 values with `factor` between neighbouring levels.
fn slope(from: u16, factor: u16) -> Vec<u16> {
    (0..4096u16).map(|i| from + (i % 64 + i / 64 * 2) * factor).collect()
}

#[test]
fn traps_name_the_option_to_try() {
    let warnings =
        |values: Vec<u16>| decode(&pgm16(64, &values), "x", &ReadOptions::default()).unwrap().warnings.join("; ");
    assert_eq!(warnings(slope(1001, 1)), "");
    assert!(warnings(slope(5000, 8)).contains("--encoding kinect-sdk"));
    assert!(warnings(slope(5000, 5)).contains("--encoding tum"));
    assert!(warnings(slope(20, 1)).contains("--encoding grey"));
    assert!(warnings(slope(1001, 1).iter().map(|v| v.swap_bytes()).collect()).contains("--swap-bytes"));
    let mut holes = slope(1001, 1);
    holes[..2100].fill(0);
    assert!(warnings(holes.clone()).contains("51 % of the pixels are missing"));
    holes[..2100].fill(65_535);
    assert!(warnings(holes).contains("--missing 65535"));
    let far: Vec<u8> = slope(1000, 1).iter().flat_map(|&v| f32::from(v).to_le_bytes()).collect();
    let frame = decode(&npy("<f4", false, "(64, 64)", &far), "x", &named("metre")).unwrap();
    assert!(inspect::summary(&frame, 4).unwrap().warnings.join("; ").contains("--encoding millimetre"));
}

#[test]
fn a_summary_counts_every_pixel_of_a_small_map() {
    let frame = read(&[0, 1000, 1001, 1001, 1004, 2000], &ReadOptions::default());
    let summary = inspect::summary(&frame, 2).unwrap();
    assert_eq!((summary.pixels, summary.distinct, summary.range), (6, 4, Some([1000.0, 1001.0, 2000.0])));
    assert!((summary.missing - 1.0 / 6.0).abs() < 1e-12);
    assert_eq!(summary.histogram.iter().map(|bin| bin.count).collect::<Vec<_>>(), [4, 1]);
    for (metres, expected) in summary.range_m.unwrap().into_iter().zip([1.0, 1.001, 2.0]) {
        assert!((metres - expected).abs() < 1e-12);
    }
    let blank = inspect::summary(&read(&[0, 0], &ReadOptions::default()), 2).unwrap();
    assert_eq!((blank.range, blank.histogram.len(), blank.missing), (None, 0, 1.0));
}
