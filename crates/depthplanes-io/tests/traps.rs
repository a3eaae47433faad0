//! The usual traps: each kind of map that is not what it is taken for comes with a note that leads to the right reading, or
//! is read right; ordinary maps come with none.

mod common;
#[path = "common/room.rs"]
mod room;

use depthplanes::ValueKind;
use depthplanes_io::encoding::Stereo;
use depthplanes_io::{Frame, Pixels, ReadOptions, Source, decode};
use room::{CAMERA, ROOM, SIZE, check, depths_m, notes};

/// Distances to 2 %, normals to 0.03, 95 % of the valid pixels.
const CLOSE: [f64; 3] = [0.02, 0.03, 0.95];

fn camera() -> ReadOptions {
    ReadOptions { intrinsics: Some(CAMERA), ..Default::default() }
}

fn encoding(name: &str) -> ReadOptions {
    ReadOptions { encoding: Some(name.into()), ..camera() }
}

fn preset(name: &str) -> ReadOptions {
    ReadOptions { preset: Some(name.into()), ..camera() }
}

fn npy(kind: &str, data: Vec<u8>) -> Vec<u8> {
    let [width, height] = SIZE;
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({height}, {width}), }}");
    let padded = format!("{header:<117}\n");
    [b"\x93NUMPY\x01\x00".as_slice(), &(padded.len() as u16).to_le_bytes(), padded.as_bytes(), &data].concat()
}

/// The room as floats, each depth in metres turned into a value.
fn floats(value: impl Fn(usize, f64) -> f64) -> Vec<u8> {
    let values = depths_m().into_iter().enumerate().map(|(at, depth)| value(at, depth) as f32);
    npy("<f4", values.flat_map(f32::to_le_bytes).collect())
}

/// The room as 16-bit numbers.
fn counts(value: impl Fn(usize, f64) -> f64) -> Vec<u8> {
    let values = depths_m().into_iter().enumerate().map(|(at, depth)| value(at, depth).round() as u16);
    npy("<u2", values.flat_map(u16::to_le_bytes).collect())
}

fn pfm(value: impl Fn(f64) -> f64) -> Vec<u8> {
    let [width, height] = SIZE;
    let depths = depths_m();
    let rows = depths.chunks(width).rev().flatten().flat_map(|depth| (value(*depth) as f32).to_le_bytes());
    [format!("Pf\n{width} {height}\n-1\n").into_bytes(), rows.collect()].concat()
}

fn read(bytes: &[u8], options: &ReadOptions) -> Frame {
    decode(bytes, "room", options).unwrap()
}

/// Asserts that some note has all these words.
fn noted(name: &str, frame: &Frame, words: &[&str]) {
    let notes = notes(frame);
    assert!(notes.lines().any(|note| words.iter().all(|word| note.contains(word))), "{name}: {words:?} in\n{notes}");
}

fn millimetres(_: usize, depth: f64) -> f64 {
    1000.0 * depth
}

fn metres(_: usize, depth: f64) -> f64 {
    depth
}

#[test]
fn ordinary_maps_come_with_no_note() {
    for (name, bytes, options) in [
        ("millimetres", counts(millimetres), camera()),
        ("metres", floats(metres), camera()),
        ("a preset's millimetres", counts(millimetres), preset("azure-kinect")),
        ("stated metres", floats(metres), encoding("metre")),
        ("millimetres as floats", floats(millimetres), encoding("millimetre")),
        ("tum", counts(|_, depth| 5000.0 * depth), encoding("tum")),
    ] {
        let frame = read(&bytes, &options);
        check(name, &frame, &ROOM, CLOSE);
        assert_eq!(notes(&frame), "", "{name}");
    }
}

#[test]
fn a_preset_never_overrides_what_the_file_says() {
    for (name, bytes, of) in [
        ("floats of metres", floats(metres), "kinect1"),
        ("floats of metres, TUM", floats(metres), "tum-fr1"),
        ("floats of millimetres", floats(|_, depth| 1000.0 * depth + 0.25), "realsense-d4xx"),
        ("double precision", npy("<f8", depths_m().into_iter().flat_map(f64::to_le_bytes).collect()), "kinect2"),
    ] {
        let frame = read(&bytes, &preset(of));
        check(name, &frame, &ROOM, CLOSE);
        noted(name, &frame, &[of, "expects the encoding"]);
        assert_eq!(frame.provenance.preset, Some(of));
    }
    // Counts that were saved as floats are the preset's.
    let frame = read(&floats(|_, depth| (5000.0 * depth).round()), &preset("tum-fr1"));
    assert_eq!(frame.sensor.value_kind, ValueKind::Depth { metres: 1.0 / 5000.0 });
    assert_eq!(notes(&frame), "");
    let header = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 8\nHEIGHT 8\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 64\nDATA ascii\n";
    let cloud = format!("{header}{}", "0 0 1.5\n".repeat(64));
    for of in ["kinect1", "tum-fr2", "azure-kinect"] {
        let frame = read(cloud.as_bytes(), &ReadOptions { preset: Some(of.into()), ..Default::default() });
        assert_eq!((frame.encoding, frame.sensor.value_kind), ("metre", ValueKind::Depth { metres: 1.0 }), "{of}");
    }
}

#[test]
fn depths_that_no_camera_sees_name_the_flag_that_is_wrong() {
    let scaled = |scale| ReadOptions { scale: Some(scale), ..camera() };
    let rig = |baseline_m| ReadOptions {
        stereo: Some(Stereo { focal_px: 115.2, baseline_m, doffs_px: 0.0 }),
        ..encoding("kitti")
    };
    let disparity = |_: usize, depth: f64| 256.0 * 115.2 * 0.12 / depth;
    for (name, bytes, options, words) in [
        (
            "metres for millimetres",
            counts(millimetres),
            encoding("metre"),
            ["--encoding metre", "try --encoding millimetre"],
        ),
        (
            "millimetres for metres",
            floats(metres),
            encoding("millimetre"),
            ["--encoding millimetre", "try --encoding metre"],
        ),
        ("a scale the other way up", counts(millimetres), scaled(0.001), ["--scale", "--depth-scale 0.001"]),
        (
            "a depth scale as scale of a preset",
            counts(millimetres),
            ReadOptions { scale: Some(0.001), ..preset("realsense-d4xx") },
            ["--scale", "--depth-scale 0.001"],
        ),
        ("a scale of metres", counts(millimetres), scaled(1.0), ["median depth", "try --scale 1000"]),
        ("a scale of micrometres", counts(millimetres), scaled(1e6), ["median depth", "try --scale 1000"]),
        ("a baseline in millimetres", counts(disparity), rig(120.0), ["--baseline is in metres", "--baseline 0.12"]),
        ("a baseline in kilometres", counts(disparity), rig(0.00012), ["baseline", "--baseline 0.12"]),
    ] {
        noted(name, &read(&bytes, &options), &words);
    }
    let right = read(&counts(disparity), &rig(0.12));
    check("a baseline in metres", &right, &ROOM, CLOSE);
    assert_eq!(notes(&right), "");
    let right = read(&counts(millimetres), &ReadOptions { depth_scale: Some(0.001), ..preset("realsense-d4xx") });
    check("a depth scale", &right, &ROOM, CLOSE);
}

#[test]
fn a_scale_is_map_units_per_metre_whatever_the_preset() {
    let tenths = counts(|_, depth| 10_000.0 * depth);
    for of in ["realsense-d4xx", "kinect1", "azure-kinect", "tof"] {
        let by_scale = read(&tenths, &ReadOptions { scale: Some(10_000.0), ..preset(of) });
        let by_depth_scale = read(&tenths, &ReadOptions { depth_scale: Some(0.0001), ..preset(of) });
        for frame in [by_scale, by_depth_scale] {
            check(of, &frame, &ROOM, CLOSE);
        }
    }
    let both = ReadOptions { scale: Some(1.0), depth_scale: Some(1.0), ..camera() };
    let of_disparity = ReadOptions { depth_scale: Some(1.0), ..encoding("kitti") };
    let no_scale = |scale| ReadOptions { depth_scale: Some(scale), ..camera() };
    for options in [both, of_disparity, no_scale(0.0), no_scale(-0.001), no_scale(f64::NAN), no_scale(f64::INFINITY)] {
        assert!(decode(&tenths, "room", &options).unwrap_err().to_string().contains("--depth-scale"));
    }
}

#[test]
fn what_stands_for_nothing_is_left_out_and_named() {
    let sky = |at: usize| at < 128 * 24;
    let floats_with = |value: f64| floats(move |at, depth| if sky(at) { value } else { depth });
    for (name, value) in
        [("1e10", 1e10), ("FLT_MAX", f64::from(f32::MAX)), ("largest half", 65_504.0), ("largest u32", 4_294_967_295.0)]
    {
        let frame = read(&floats_with(value), &camera());
        noted(name, &frame, &["taken as missing", "--missing"]);
        check(name, &frame, &ROOM, CLOSE);
        let kept = read(&floats_with(value), &ReadOptions { valid_range: Some((0.0, 3.0e38)), ..camera() });
        assert_eq!(kept.missing, None, "{name}: stated to be valid");
    }
    let frame = read(&counts(|at, depth| if sky(at) { 65_535.0 } else { 1000.0 * depth }), &camera());
    noted("65535", &frame, &["taken as missing", "--missing 65535"]);
    check("65535", &frame, &ROOM, CLOSE);
    // The far clip of a renderer may be a wall: it is named and kept.
    for (name, bytes, clip) in [
        ("20 m", floats_with(20.0), "--missing 20"),
        ("1000 m", floats_with(1000.0), "--missing 1000"),
        ("10000 mm", counts(|at, depth| if sky(at) { 10_000.0 } else { 1000.0 * depth }), "--missing 10000"),
        ("5 m beside 4.9 m", floats(|at, depth| if sky(at) { 5.0 } else { depth }), "--missing 5"),
    ] {
        noted(name, &read(&bytes, &camera()), &["far clip", clip]);
    }
}

#[test]
fn planes_out_of_sight_are_named() {
    // Too few pixels for a background, enough for a plane.
    let bytes =
        floats(|at, depth| if at % 128 < 16 && at / 128 < 12 { 500.0 + 0.1 * (at % 128) as f64 } else { depth });
    noted("500 m", &read(&bytes, &camera()), &["lies at a depth of", "a background", "--valid-range"]);
    // One plane of four says nothing of the unit.
    let bytes =
        floats(|at, depth| if at % 128 < 16 && at / 128 < 12 { 0.004 + 1e-6 * (at % 128) as f64 } else { depth });
    noted("4 mm", &read(&bytes, &camera()), &["lies at a depth of", "pixels without depth", "--missing"]);
    let wide = depthplanes::Intrinsics { fx: 1e-2, fy: 1e-2, ..CAMERA };
    let frame = read(&counts(|_, _| 3000.0), &ReadOptions { intrinsics: Some(wide), ..Default::default() });
    noted("a focal length of nothing", &frame, &["m2", "check the camera"]);
}

#[test]
fn pictures_that_are_no_depth_are_named_whatever_is_stated() {
    // Blocks of 16 x 16 pixels, in no order.
    let block = |at: usize| (at % 128 / 16 + at / 128 / 16 * 8) as u32;
    let label = |at: usize, of: &[u8]| of[(block(at).wrapping_mul(2_654_435_761) >> 20) as usize % of.len()];
    let bytes8 = |value: &dyn Fn(usize) -> u8| npy("|u1", (0..128 * 96).map(value).collect());
    for (name, values) in [
        ("few labels", vec![0, 1, 2, 3, 4, 5]),
        ("a mask", vec![0, 255, 255]),
        ("far labels", vec![10, 200, 30, 90, 250, 7, 120]),
    ] {
        let image = bytes8(&|at| label(at, &values));
        noted(name, &read(&image, &camera()), &["label image"]);
        noted(name, &read(&image, &preset("kinect1")), &["label image"]);
        let wide = npy("<u2", (0..128 * 96).flat_map(|at| u16::from(label(at, &values)).to_le_bytes()).collect());
        noted(name, &read(&wide, &encoding("millimetre")), &["label"]);
    }
    let depths = depths_m();
    noted("a picture of depth", &read(&bytes8(&|at| (50.0 * depths[at]) as u8), &camera()), &["8 bits a pixel"]);
}

#[test]
fn relative_inverse_depth_is_noticed_however_it_is_stored() {
    let nearest = depths_m().into_iter().fold(f64::INFINITY, f64::min);
    let relative = |depth: f64| (1.0 / depth - 0.2) / (1.0 / nearest - 0.2);
    for (name, bytes) in [
        ("16 bits", counts(|_, depth| 65_535.0 * relative(depth))),
        ("0 to 1", floats(|_, depth| relative(depth))),
        ("as a network gives it", floats(|_, depth| 3.0 + 20.0 * relative(depth))),
        ("hundreds", floats(|_, depth| 900.0 * relative(depth) + 200.0)),
    ] {
        let frame = read(&bytes, &ReadOptions::default());
        noted(name, &frame, &["--encoding inverse-depth"]);
        let right = ReadOptions { encoding: Some("inverse-depth".into()), ..Default::default() };
        let (planes, share, notes) = room::planes(&read(&bytes, &right));
        assert!(planes.len() == 4 && share > 0.95, "{name}: {} planes on {share}", planes.len());
        assert!(notes.iter().all(|note| !note.contains("inverse")), "{name}: {notes:?}");
    }
    let metric = floats(|_, depth| 100.0 / depth);
    let frame = read(&metric, &ReadOptions { scale: Some(100.0), ..encoding("inverse-depth") });
    check("inverse depth with its scale", &frame, &ROOM, CLOSE);
}

#[test]
fn distances_along_rays_are_noticed_with_noise_and_in_every_type() {
    let along = |at: usize, depth: f64| depth * ray(at);
    let noise = |at: usize| ((at as u32).wrapping_mul(2_654_435_761) >> 16) as f64 / 65_536.0 - 0.5;
    for (name, bytes) in [
        ("millimetres", counts(|at, depth| 1000.0 * along(at, depth))),
        ("metres", floats(along)),
        ("noise of 1 mm", floats(|at, depth| along(at, depth) + 0.0034 * noise(at))),
        ("noise that grows", floats(|at, depth| along(at, depth) * (1.0 + 0.003 * noise(at)))),
    ] {
        let frame = read(&bytes, &camera());
        noted(name, &frame, &["--ray-distance"]);
        let turned = read(&bytes, &ReadOptions { ray_distance: true, ..camera() });
        check(name, &turned, &ROOM, CLOSE);
        assert_eq!(notes(&turned), "", "{name}");
        assert!(turned.provenance.ray_distance);
    }
    let needs = ReadOptions { ray_distance: true, ..Default::default() };
    assert!(decode(&floats(along), "room", &needs).unwrap_err().to_string().contains("--intrinsics"));
    let disparity = ReadOptions { ray_distance: true, ..encoding("kitti") };
    assert!(decode(&counts(along), "room", &disparity).is_err());
}

fn ray(at: usize) -> f64 {
    let [x, y, z] = CAMERA.ray((at % SIZE[0]) as f64, (at / SIZE[0]) as f64);
    (x * x + y * y + z * z).sqrt()
}

#[test]
fn what_is_missing_stays_missing_when_distances_become_depth() {
    let bytes = counts(|at, depth| if at % 3 == 0 { [0.0, 65_535.0][at % 2] } else { 1000.0 * depth * ray(at) });
    let frame = read(&bytes, &ReadOptions { ray_distance: true, ..camera() });
    check("with gaps", &frame, &ROOM, CLOSE);
    let Pixels::F32(values) = &frame.pixels else { panic!("floats") };
    assert!(values.iter().step_by(3).all(|value| value.is_nan()) && values[1].is_finite());
}

#[test]
fn depth_in_pfm_files_is_read_or_noticed() {
    check("millimetres", &read(&pfm(|depth| 1000.0 * depth), &camera()), &ROOM, CLOSE);
    let frame = read(&pfm(|depth| depth), &camera());
    noted("metres", &frame, &["--encoding metre"]);
    let frame = read(&pfm(|depth| depth), &ReadOptions::default());
    noted("metres without a camera", &frame, &["--encoding metre"]);
    check("stated metres", &read(&pfm(|depth| depth), &encoding("metre")), &ROOM, CLOSE);
    let rig = Stereo { focal_px: 115.2, baseline_m: 0.5, doffs_px: 0.0 };
    let disparity = read(&pfm(|depth| 115.2 * 0.5 / depth), &ReadOptions { stereo: Some(rig), ..camera() });
    check("disparity", &disparity, &ROOM, CLOSE);
    assert_eq!(notes(&disparity), "");
}

#[test]
fn who_stated_the_noise_is_known() {
    let stated = depthplanes::noise::SensorNoise::Depth { base: 0.001, growth: 0.0 };
    let options = ReadOptions { noise: Some(stated), ..preset("kinect2") };
    let of = |options: &ReadOptions| {
        let from = read(&counts(millimetres), options).provenance;
        (from.noise, from.smooth_noise, from.encoding)
    };
    assert_eq!(of(&camera()).0, None);
    assert_eq!(of(&preset("kinect1")), (None, Some(Source::Preset), "preset".into()));
    assert_eq!(of(&preset("kinect2")).0, Some(Source::Preset));
    assert_eq!(of(&options).0, Some(Source::Stated));
    assert_eq!(of(&encoding("tum")).2, "stated");
}

#[test]
fn disparity_taken_for_depth_is_noticed_by_where_it_is_large() {
    let disparity = |depth: f64| 115.2 * 0.3 / depth;
    for (name, bytes) in [
        ("pixels as floats", floats(|_, depth| disparity(depth))),
        ("1/256 px", counts(|_, depth| 256.0 * disparity(depth))),
        ("1/16 px", counts(|_, depth| 16.0 * disparity(depth) * 8.0)),
        ("1/m", floats(|_, depth| 1.0 / depth)),
    ] {
        noted(name, &read(&bytes, &camera()), &["--disparity", "--encoding inverse-depth"]);
    }
}

#[test]
fn disparity_of_16_bits_says_its_unit() {
    let rig = Stereo { focal_px: 115.2, baseline_m: 0.3, doffs_px: 0.0 };
    let options = ReadOptions { disparity: true, stereo: Some(rig), ..camera() };
    let disparity = |depth: f64| 115.2 * 0.3 / depth;
    let matched =
        |at: usize, depth: f64| if at.is_multiple_of(16) { 65_520.0 } else { (16.0 * disparity(depth)).round() };
    let frame = read(&counts(matched), &options);
    assert_eq!(frame.encoding, "opencv");
    noted("unsigned", &frame, &["`opencv`", "--scale"]);
    check("unsigned", &frame, &ROOM, CLOSE);
    let signed = depths_m().into_iter().enumerate().map(|(at, depth)| matched(at, depth) as u16);
    let frame = read(&npy("<i2", signed.flat_map(u16::to_le_bytes).collect()), &options);
    check("signed", &frame, &ROOM, CLOSE);
    let frame = read(&counts(|_, depth| 256.0 * disparity(depth)), &options);
    noted("KITTI", &frame, &["`kitti`", "--scale"]);
    check("KITTI", &frame, &ROOM, CLOSE);
    let negative = read(&floats(|_, depth| -disparity(depth)), &options);
    assert!(negative.warnings.iter().any(|note| note.contains("other sign")), "{:?}", negative.warnings);
}

#[test]
fn raw_disparity_of_a_kinect_is_no_millimetres() {
    let raw = |depth: f64| (3.3309495161 - 1.0 / depth) / 0.0030711016;
    for (name, options) in [("guessed", camera()), ("with the wrong preset", preset("kinect1"))] {
        let frame = read(&counts(|at, depth| if at % 9 == 0 { 2047.0 } else { raw(depth) }), &options);
        noted(name, &frame, &["--preset kinect1-raw"]);
    }
}

#[test]
fn cameras_in_other_words_are_named() {
    let of = |fx, fy, cx, cy| ReadOptions { intrinsics: Some(depthplanes::Intrinsics { fx, fy, cx, cy }), ..camera() };
    let refused = |options| decode(&counts(millimetres), "room", &options).unwrap_err().to_string();
    assert!(refused(of(0.9, 1.2, 0.5, 0.5)).contains("parts of the picture"), "{}", refused(of(0.9, 1.2, 0.5, 0.5)));
    let frame = read(&counts(millimetres), &of(115.2, 63.5, 112.0, 47.5));
    assert!(frame.warnings.iter().any(|note| note.contains("order")), "{:?}", frame.warnings);
    let sized = |size| ReadOptions { camera_size: Some(size), ..of(576.0, 576.0, 319.5, 239.5) };
    check("a camera of five times the size", &read(&counts(millimetres), &sized((640, 480))), &ROOM, CLOSE);
    assert!(
        refused(ReadOptions { camera_size: Some((480, 640)), ..of(576.0, 576.0, 239.5, 319.5) })
            .contains("turned by 90")
    );
}

#[test]
fn depths_beyond_the_presets_sensor_are_named() {
    for of in ["kinect1", "kinect2", "structure", "7-scenes", "azure-kinect", "realsense-d4xx"] {
        let frame = read(&counts(|_, depth| 16_000.0 * depth), &preset(of));
        noted(of, &frame, &["the preset's sensor sees about", "--scale"]);
    }
}

#[test]
fn depths_nearer_than_the_presets_sensor_sees_are_named() {
    for of in ["kinect1", "kinect2", "structure", "7-scenes"] {
        let coarse = read(&counts(|_, depth| 62.0 * depth), &preset(of));
        noted(of, &coarse, &["the preset's sensor sees from", "--scale"]);
        assert_eq!(notes(&read(&counts(millimetres), &preset(of))), "", "{of}");
    }
}

#[test]
fn units_that_make_rooms_too_deep_are_asked_for() {
    for units in [4000.0, 5000.0, 6000.0, 10_000.0] {
        let bytes = counts(|at, depth| (units * depth + (at % 7) as f64).min(65_000.0));
        noted("guessed", &read(&bytes, &camera()), &["farther than rooms are", "--encoding millimetre"]);
        for options in [encoding("millimetre"), ReadOptions { scale: Some(units), ..camera() }] {
            assert!(!notes(&read(&bytes, &options)).contains("farther"), "{units}");
        }
    }
    for units in [1000.0, 2000.0] {
        assert!(!notes(&read(&counts(|_, depth| units * depth), &camera())).contains("farther"), "{units}");
    }
}

#[test]
fn a_map_of_noise_is_no_surface() {
    let random = |at: usize| ((at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / (1u64 << 24) as f64;
    let frame = read(&counts(|at, _| 500.0 + 3000.0 * random(at)), &camera());
    if !room::planes(&frame).0.is_empty() {
        noted("noise", &frame, &["scatter by", "noise or a photograph rather than a surface"]);
    }
}

#[test]
fn a_picture_widened_to_16_bits_is_named() {
    let frame = read(&counts(|_, depth| 257.0 * (40.0 * depth).round()), &camera());
    noted("8 bits", &frame, &["multiples of 257", "--encoding grey"]);
    for step in [5.0, 10.0, 20.0, 50.0] {
        let frame = read(&counts(|_, depth| step * (1000.0 * depth / step).round()), &camera());
        assert!(!notes(&frame).contains("multiples"), "rounded to {step} mm: {}", notes(&frame));
    }
}

#[test]
fn depth_that_is_taken_for_distance_is_noticed() {
    let frame = read(&floats(metres), &ReadOptions { ray_distance: true, ..camera() });
    noted("depth", &frame, &["leave --ray-distance out"]);
}

#[test]
fn wide_disparities_and_two_focal_lengths_are_named() {
    let rig = |focal_px| ReadOptions {
        stereo: Some(Stereo { focal_px, baseline_m: 0.3, doffs_px: 0.0 }),
        ..encoding("disparity")
    };
    let sixteenths = counts(|_, depth| 16.0 * 115.2 * 0.3 / depth);
    noted("sixteenths", &read(&sixteenths, &rig(115.2)), &["in 128 columns", "--scale 16"]);
    let pixels = floats(|_, depth| 115.2 * 0.3 / depth);
    noted("another focal length", &read(&pixels, &rig(230.4)), &["one of them is wrong"]);
}

#[test]
fn cameras_of_turned_and_cut_pictures_are_noticed() {
    let [width, height] = SIZE.map(|side| side as f64);
    let of = |cx, cy| ReadOptions { intrinsics: Some(depthplanes::Intrinsics { cx, cy, ..CAMERA }), ..camera() };
    let turned = read(&counts(millimetres), &of((height - 1.0) / 2.0, (width - 1.0) / 2.0));
    noted("turned", &turned, &["exchanged", "turned by 90 degrees"]);
    let bytes = [b"P5 640 360 65535\n".to_vec(), [7, 208].repeat(640 * 360)].concat();
    let options = ReadOptions {
        intrinsics: Some(depthplanes::Intrinsics { fx: 576.0, fy: 576.0, cx: 319.5, cy: 239.5 }),
        ..Default::default()
    };
    noted("cut", &read(&bytes, &options), &["the middle of 640 x 480", "crop of that picture"]);
}

#[test]
fn maps_that_few_pixels_were_measured_of_are_named() {
    for (name, words, is_measured) in [
        (
            "one of 16",
            ["one pixel of 16 was", "bins of 4 x 4"],
            &(|u: usize, v: usize| u.is_multiple_of(4) && v.is_multiple_of(4)) as &dyn Fn(usize, usize) -> bool,
        ),
        ("every third row", ["one pixel of 3 was", "bins of 1 x 3"], &|_: usize, v: usize| v.is_multiple_of(3)),
        ("every second column", ["one pixel of 2 was", "bins of 2 x 1"], &|u: usize, _: usize| u.is_multiple_of(2)),
        ("a chequered lattice", ["one pixel of 9 was", "bins of 3 x 3"], &|u: usize, v: usize| {
            u % 3 == 1 && v % 3 == 1
        }),
    ] {
        let bytes = counts(|at, depth| if is_measured(at % SIZE[0], at / SIZE[0]) { 1000.0 * depth } else { 0.0 });
        let frame = read(&bytes, &camera());
        noted(name, &frame, &words);
        assert!(!notes(&frame).contains("are missing"), "{name}");
    }
}

#[test]
fn maps_that_were_enlarged_by_repeating_pixels_are_named() {
    let source = |u: usize, v: usize| (v * SIZE[0] + u).min(SIZE[0] * SIZE[1] - 1);
    for (factor, words) in
        [([2, 2], "2 x 2 times"), ([4, 4], "4 x 4 times"), ([3, 3], "3 x 3 times"), ([2, 4], "2 x 4 times")]
    {
        let [x, y] = factor;
        let depths = depths_m();
        let depth = |at: usize| depths[source(at % SIZE[0] / x * x, at / SIZE[0] / y * y)];
        let frame = read(&counts(|at, _| 1000.0 * depth(at)), &camera());
        let pixels = format!("{} x {} pixels that it was made from", SIZE[0].div_ceil(x), SIZE[1].div_ceil(y));
        noted(words, &frame, &[words, &pixels, "by repeating pixels"]);
    }
}

#[test]
fn values_between_nothing_and_a_surface_are_named() {
    let is_hole = |u: usize, v: usize| (u / 4 * 7 + v / 4 * 5) % 11 < 2;
    let depths = depths_m();
    let value = |u: usize, v: usize| if is_hole(u, v) { 0.0 } else { 1000.0 * depths[v * SIZE[0] + u] };
    // From every n-th pixel of the room, linear between them.
    let enlarged = |n: usize, at: usize, curve: fn(f64) -> f64| {
        let place = |at: usize, side: usize| {
            let (low, share) = (at / n * n, curve((at % n) as f64 / n as f64));
            (low, (low + n).min((side - 1) / n * n), share)
        };
        let ((u0, u1, a), (v0, v1, b)) = (place(at % SIZE[0], SIZE[0]), place(at / SIZE[0], SIZE[1]));
        let row = |v: usize| value(u0, v) * (1.0 - a) + value(u1, v) * a;
        row(v0) * (1.0 - b) + row(v1) * b
    };
    let linear = |share| share;
    let cubic = |share: f64| share * share * (3.0 - 2.0 * share);
    for (name, n, curve) in [
        ("twice, linear", 2, linear as fn(f64) -> f64),
        ("four times, linear", 4, linear),
        ("three times, smooth", 3, cubic),
    ] {
        let frame = read(&counts(|at, _| enlarged(n, at, curve)), &camera());
        noted(name, &frame, &["edges of holes", "resized with interpolation"]);
    }
    let floats = floats(|at, _| enlarged(4, at, linear) / 1000.0);
    noted("metres", &read(&floats, &camera()), &["edges of holes", "resized with interpolation"]);
    for nearest in [2, 3, 4] {
        let bytes = counts(|at, _| value(at % SIZE[0] / nearest * nearest, at / SIZE[0] / nearest * nearest));
        assert!(!notes(&read(&bytes, &camera())).contains("interpolation"), "{nearest}");
    }
}

#[test]
fn floats_from_0_to_1_are_no_metres() {
    let depths = depths_m();
    let [nearest, farthest] =
        [f64::min as fn(f64, f64) -> f64, f64::max].map(|of| depths.iter().copied().reduce(of).unwrap());
    let buffer = |near: f64, far: f64| floats(move |_, depth| far * (depth - near) / (depth * (far - near)));
    for (name, bytes, words) in [
        ("a share of the largest", floats(|_, depth| depth / farthest), ["share of the largest depth", "--scale"]),
        ("a share of 4.4 m", floats(|_, depth| depth / (1.05 * farthest)), ["share of the largest depth", "--scale"]),
        ("a depth buffer", buffer(0.1, 100.0), ["depth buffer", "near far"]),
        ("another depth buffer", buffer(0.05, 20.0), ["depth buffer", "near far"]),
        ("normalised", floats(|_, depth| (depth - nearest) / (farthest - nearest)), ["whole range", "--scale"]),
    ] {
        noted(name, &read(&bytes, &camera()), &words);
        assert!(!notes(&read(&bytes, &encoding("metre"))).contains("share"), "{name}: stated");
    }
    for closer in [3.0, 4.0, 6.0] {
        let notes = notes(&read(&floats(|_, depth| depth / closer), &camera()));
        assert!(!notes.contains("depth buffer") || farthest / closer > 0.9, "a table at {closer}: {notes}");
    }
}

#[test]
fn centimetres_are_asked_for() {
    for (name, bytes) in [
        ("16 bits", counts(|_, depth| 100.0 * depth)),
        ("floats", floats(|_, depth| 100.0 * depth)),
        ("a smaller room", counts(|_, depth| 70.0 * depth)),
        ("a desk", counts(|_, depth| 35.0 * depth)),
    ] {
        noted(name, &read(&bytes, &camera()), &["centimetres", "--scale 100"]);
        let right = read(&bytes, &ReadOptions { scale: Some(100.0), ..camera() });
        assert!(!notes(&right).contains("centimetres"), "{name}: {}", notes(&right));
    }
    check(
        "by its scale",
        &read(&floats(|_, depth| 100.0 * depth), &ReadOptions { scale: Some(100.0), ..camera() }),
        &ROOM,
        CLOSE,
    );
}

#[test]
fn a_preset_of_another_unit_is_doubted() {
    // As a Kinect's millimetres, of which the lowest bits are any.
    let mm = |shift: f64| counts(move |at, depth| 1000.0 * depth + shift + (at % 5) as f64);
    for shift in [0.0, 3.0, 200.0] {
        noted("Kinect SDK", &read(&mm(shift), &preset("kinect1-sdk")), &["lowest three bits", "--encoding millimetre"]);
        noted("packed", &read(&mm(shift), &encoding("kinect-sdk")), &["lowest three bits", "--encoding millimetre"]);
        let disparity = notes(&read(&mm(shift), &preset("stereo")));
        assert!(disparity.contains("they are depth: try --encoding millimetre"), "{disparity}");
        for of in ["tum-fr1", "tum-fr2", "tum-fr3"] {
            noted(of, &read(&mm(shift), &preset(of)), &["no multiples of 5", "--encoding millimetre"]);
        }
        for of in ["kinect1", "structure", "7-scenes"] {
            let scaled = ReadOptions { scale: Some(10_000.0), ..preset(of) };
            noted(of, &read(&mm(shift), &scaled), &["leave --scale out"]);
        }
    }
    let players = counts(|at, depth| 8.0 * (1000.0 * depth).round() + f64::from(u8::from(at % 128 < 20)) * 2.0);
    check("players", &read(&players, &preset("kinect1-sdk")), &ROOM, CLOSE);
    assert_eq!(notes(&read(&players, &preset("kinect1-sdk"))), "");
    let tum = counts(|_, depth| 5.0 * (1000.0 * depth).round());
    assert_eq!(notes(&read(&tum, &ReadOptions { intrinsics: Some(CAMERA), ..preset("tum-fr1") })), "");
}

#[test]
fn a_rig_beside_depth_in_millimetres_is_doubted() {
    for baseline_m in [0.05, 0.1, 0.5] {
        let rig = Stereo { focal_px: 115.2, baseline_m, doffs_px: 0.0 };
        let frame = read(&counts(millimetres), &ReadOptions { stereo: Some(rig), ..camera() });
        noted("a rig", &frame, &["--encoding millimetre if it is depth"]);
    }
}

#[test]
fn millimetres_in_few_steps_are_no_packed_bits() {
    for step in [8.0, 16.0, 24.0] {
        let frame = read(&counts(|_, depth| step * (1000.0 * depth / step).round()), &camera());
        assert!(!notes(&frame).contains("kinect-sdk"), "steps of {step} mm: {}", notes(&frame));
    }
    let packed = read(&counts(|_, depth| 8.0 * (1000.0 * depth).round()), &camera());
    noted("packed", &packed, &["multiples of 8", "--encoding kinect-sdk"]);
}

#[test]
fn a_photograph_of_16_bits_is_no_surface_with_and_without_a_camera() {
    let random = |at: usize| ((at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / (1u64 << 24) as f64;
    for (brightness, spread) in [(2000.0, 1500.0), (900.0, 800.0), (3000.0, 2500.0)] {
        let photo = counts(|at, _| brightness + spread * (random(at) - 0.5) + 300.0 * random(at / 16));
        for options in [ReadOptions::default(), camera()] {
            let frame = read(&photo, &options);
            if !room::planes(&frame).0.is_empty() {
                noted("a photograph", &frame, &["scatter by", "photograph"]);
            }
        }
    }
}

#[test]
fn a_missing_value_that_was_stated_is_not_asked_for_again() {
    for (share, value) in [(60, 3500.0), (80, 65_535.0), (55, 1.0)] {
        let bytes = counts(|at, depth| if at % SIZE[0] * 100 < share * SIZE[0] { value } else { 1000.0 * depth });
        let frame = read(&bytes, &ReadOptions { missing: Some(value), ..camera() });
        assert!(!notes(&frame).contains("are missing"), "{value}: {}", notes(&frame));
    }
}

#[test]
fn pictures_without_some_rows_and_cropped_ones_get_their_cameras() {
    let of = |width: usize, height: usize, fx: f64, fy: f64, cx: f64, cy: f64| {
        let bytes = [format!("P5 {width} {height} 65535\n").into_bytes(), [7, 208].repeat(width * height)].concat();
        let intrinsics = Some(depthplanes::Intrinsics { fx, fy, cx, cy });
        match decode(&bytes, "map", &ReadOptions { intrinsics, ..Default::default() }) {
            Ok(frame) => frame.warnings.join("\n"),
            Err(refusal) => refusal.to_string(),
        }
    };
    for (size, right) in [
        ((640, 240), [576.0, 288.0, 319.5, 119.5]),
        ((320, 480), [288.0, 576.0, 159.5, 239.5]),
        ((640, 160), [576.0, 192.0, 319.5, 79.5]),
    ] {
        let [fx, fy, cx, cy] = right;
        let (notes, flag) =
            (of(size.0, size.1, 576.0, 576.0, 319.5, 239.5), format!("--intrinsics={fx},{fy},{cx},{cy}"));
        assert!(notes.contains(&flag) && notes.contains("crop of that picture"), "{size:?}: {notes}");
        assert!(!notes.contains("--camera-size"), "{size:?}: {notes}");
        assert!(!of(size.0, size.1, fx, fy, cx, cy).contains("square"), "{size:?}");
    }
    let notes = of(320, 240, 576.0, 576.0, 319.5, 239.5);
    assert!(notes.contains("--camera-size 640x480") && notes.contains("subtract the crop's left column"), "{notes}");
    // A scanner's pixels.
    assert!(!of(512, 512, 1586.0, 2301.0, 255.0, 255.0).contains("square"));
}

#[test]
fn pictures_that_were_turned_get_their_cameras() {
    let refused = |size, [fx, fy, cx, cy]: [f64; 4]| {
        let bytes = [b"P5 480 640 65535\n".to_vec(), [7, 208].repeat(480 * 640)].concat();
        let intrinsics = Some(depthplanes::Intrinsics { fx, fy, cx, cy });
        let options = ReadOptions { intrinsics, camera_size: Some(size), ..Default::default() };
        decode(&bytes, "map", &options).unwrap_err().to_string()
    };
    for (size, camera, [clockwise, other]) in [
        ((640, 480), [570.0, 580.0, 320.0, 240.0], ["580,570,239,320", "580,570,240,319"]),
        ((1280, 960), [1140.0, 1160.0, 640.5, 480.5], ["580,570,239,320", "580,570,240,319"]),
        ((640, 480), [500.0, 500.0, 300.0, 250.0], ["500,500,229,300", "500,500,250,339"]),
    ] {
        let refusal = refused(size, camera);
        for four in [clockwise, other] {
            assert!(
                refusal.contains("turned by 90") && refusal.contains(&format!("--intrinsics={four}")),
                "{four}: {refusal}"
            );
        }
    }
}

#[test]
fn depth_in_few_steps_is_said_to_hide_how_surfaces_lie_and_finer_steps_are_not() {
    for (baseline_m, step_px, is_coarse) in [
        (0.2, 1.0, true),
        (0.3, 1.0, true),
        (0.1, 0.5, true),
        (0.3, 0.25, false),
        (0.2, 0.125, false),
        (0.3, 0.0625, false),
    ] {
        let frame = read(
            &counts(|_, depth_m| {
                let disparity = (CAMERA.fx * baseline_m / depth_m / step_px).round().max(1.0) * step_px;
                1e3 * CAMERA.fx * baseline_m / disparity
            }),
            &encoding("millimetre"),
        );
        let notes = notes(&frame);
        let is_said = notes.contains("surfaces between two steps cannot be told apart");
        assert_eq!(is_said, is_coarse, "baseline {baseline_m}, steps of {step_px}: {notes:?}");
        assert!(!notes.contains("--ray-distance"), "{notes:?}");
    }
}

#[test]
fn a_lens_that_folds_within_the_picture_is_noted_with_the_share_of_it() {
    use depthplanes::DistortionModel::*;
    let lens = |model: depthplanes::DistortionModel, coefficients: &[f64], scale: f64| {
        let camera = format!(
            r#"{{"width":{},"height":{},"ppx":{},"ppy":{},"fx":{},"fy":{},"model":"{}","coeffs":{coefficients:?}}}"#,
            SIZE[0],
            SIZE[1],
            CAMERA.cx,
            CAMERA.cy,
            CAMERA.fx * scale,
            CAMERA.fy * scale,
            model.name()
        );
        let camera = depthplanes_io::camera_file::parse(&camera).unwrap();
        let options = ReadOptions { encoding: Some("metre".into()), ..ReadOptions::default() }.camera(&camera);
        decode(&floats(|_, depth| depth), "m.npy", &options).unwrap().warnings
    };
    let folds = |notes: &[String]| notes.iter().find(|note| note.contains("have no ray")).cloned();
    for (model, coefficients, angle) in [
        (BrownConrady, &[-1.5][..], "25 degrees"),
        (ModifiedBrownConrady, &[-1.5], "25 degrees"),
        (BrownConrady, &[0.0, -2.0], "29 degrees"),
        (KannalaBrandt, &[-1.5], "27 degrees"),
    ] {
        let note = folds(&lens(model, coefficients, 1.0)).unwrap_or_else(|| panic!("{model:?}"));
        assert!(note.contains(&format!("the distortion model folds beyond {angle}")), "{note}");
        assert!(note.contains(" % of the pixels have no ray"), "{note}");
        // Where the picture ends before the fold nothing is said.
        assert_eq!(folds(&lens(model, coefficients, 4.0)), None, "{model:?}");
    }
    for (model, coefficients) in
        [(BrownConrady, &[-0.05][..]), (BrownConrady, &[0.1, -0.05]), (KannalaBrandt, &[0.0; 4])]
    {
        assert_eq!(folds(&lens(model, coefficients, 1.0)), None, "{model:?}");
    }
}

/// The room with a value on the pixels that `is` says, the rest with noise of some millimetres.
fn noisy_with(value: f64, is: impl Fn(usize, usize) -> bool) -> Vec<u8> {
    let noise = |at: usize| ((at as u32).wrapping_mul(2_654_435_761) >> 16) as f64 / 65_536.0 - 0.5;
    counts(move |at, depth| if is(at % SIZE[0], at / SIZE[0]) { value } else { 1000.0 * depth + 12.0 * noise(at) })
}

#[test]
fn one_exact_value_on_many_pixels_is_named() {
    let ragged = |u: usize, v: usize| (u / 4 * 7 + v / 4 * 5) % 11 < 2;
    let shadow = |u: usize, v: usize| u > 104 && u < 108 && v > 40 && v < 90;
    let sky = |_: usize, v: usize| v < 24;
    for (name, bytes, options, value) in [
        // Within the values, at the top, at the bottom; from 1 % to 25 % of the pixels.
        ("12 bits full, within", noisy_with(4095.0, ragged), camera(), 4095.0),
        ("2 m, within", noisy_with(2000.0, sky), camera(), 2000.0),
        ("no round number", noisy_with(3127.0, ragged), camera(), 3127.0),
        ("a shadow of 1 %", noisy_with(10_000.0, shadow), camera(), 10_000.0),
        ("a clip beyond the room", noisy_with(8191.0, sky), camera(), 8191.0),
        ("1 mm", noisy_with(1.0, ragged), camera(), 1.0),
        ("10 mm", noisy_with(10.0, shadow), encoding("millimetre"), 10.0),
        ("999 m", floats(|at, depth| if ragged(at % SIZE[0], at / SIZE[0]) { 999.0 } else { depth }), camera(), 999.0),
        (
            "1000 m",
            floats(|at, depth| if shadow(at % SIZE[0], at / SIZE[0]) { 1000.0 } else { depth }),
            camera(),
            1000.0,
        ),
        ("0.01 m", floats(|at, depth| if sky(at % SIZE[0], at / SIZE[0]) { 0.01 } else { depth }), camera(), 0.01),
    ] {
        let frame = read(&bytes, &options);
        noted(name, &frame, &["of the pixels are exactly", &format!("--missing {value}")]);
        assert!(!notes(&frame).contains("where no camera sees"), "{name}: {}", notes(&frame));
        let stated = read(&bytes, &ReadOptions { missing: Some(value), ..options });
        assert!(!notes(&stated).contains("exactly"), "{name}: {}", notes(&stated));
        check(name, &stated, &ROOM, CLOSE);
    }
}

#[test]
fn what_matchers_write_for_no_match_is_named() {
    let ragged = |at: usize| (at % SIZE[0] / 4 * 7 + at / SIZE[0] / 4 * 5) % 11 < 2;
    let px = |depth: f64| 115.2 * 0.5 / depth;
    let rig = Stereo { focal_px: 115.2, baseline_m: 0.5, doffs_px: 0.0 };
    let of = |name: &str, scale: Option<f64>| ReadOptions { stereo: Some(rig), scale, ..encoding(name) };
    for (name, bytes, options, value) in [
        (
            "SGBM from 8 px on",
            counts(|at, depth| if ragged(at) { 7.0 * 16.0 } else { 16.0 * px(depth) }),
            of("opencv", None),
            112.0,
        ),
        (
            "SGBM from 4 px on",
            counts(|at, depth| if ragged(at) { 3.0 * 16.0 } else { 16.0 * px(depth) }),
            of("opencv", None),
            48.0,
        ),
        ("SGBM as pixels", floats(|at, depth| if ragged(at) { 9.0 } else { px(depth) }), of("disparity", None), 9.0),
        (
            "255 of 8 bits",
            npy(
                "|u1",
                depths_m()
                    .iter()
                    .enumerate()
                    .map(|(at, &z)| if ragged(at) { 255 } else { (4.0 * px(z)) as u8 })
                    .collect(),
            ),
            of("middlebury", Some(4.0)),
            255.0,
        ),
        ("1000 px", floats(|at, depth| if ragged(at) { 1000.0 } else { px(depth) }), of("disparity", None), 1000.0),
    ] {
        noted(name, &read(&bytes, &options), &["of the pixels are exactly", &format!("--missing {value}")]);
    }
}

#[test]
fn surfaces_of_one_exact_value_are_no_missing_values() {
    // Renderings without noise: a wall that faces the camera is the farthest, a box or a table the nearest.
    let box_at = |at: usize| (40..80).contains(&(at % SIZE[0])) && (30..70).contains(&(at / SIZE[0]));
    let floor = |at: usize| 115.2 * 1.2 / ((at / SIZE[0]) as f64 - 47.5).max(0.1);
    for (name, bytes) in [
        ("a wall at 3.21 m", counts(|at, _| 1000.0 * floor(at).min(3.21))),
        ("a wall and a box", counts(|at, _| if box_at(at) { 1733.0 } else { 1000.0 * floor(at).min(3.777) })),
        ("a box in the room", counts(|at, depth| if box_at(at) { 1377.0 } else { 1000.0 * depth })),
        ("floats", floats(|at, _| floor(at).min(3.21))),
    ] {
        let notes = notes(&read(&bytes, &camera()));
        assert!(!notes.contains("--missing"), "{name}: {notes}");
    }
}

#[test]
fn a_scale_that_is_stated_is_not_asked_for() {
    let px = |at: usize, depth: f64| if at.is_multiple_of(16) { 65_520.0 } else { 16.0 * 115.2 * 0.3 / depth };
    let rig = Stereo { focal_px: 115.2, baseline_m: 0.3, doffs_px: 0.0 };
    for (times, bytes) in [
        (1.0, counts(px)),
        (2.0, counts(|at, depth| if at % 16 == 0 { 65_520.0 } else { 2.0 * px(at, depth) })),
        (16.0, counts(|_, depth| 16.0 * px(1, depth))),
    ] {
        let options = ReadOptions { disparity: true, stereo: Some(rig), scale: Some(16.0 * times), ..camera() };
        let frame = read(&bytes, &options);
        check("stated", &frame, &ROOM, CLOSE);
        let left_out = "read as `opencv`, since 65520 is the -16 of OpenCV's matchers: those pixels are missing";
        assert_eq!(notes(&frame), if times < 16.0 { left_out } else { "" }, "{times}");
        let guessed = ReadOptions { scale: None, ..options };
        noted("guessed", &read(&bytes, &guessed), &["state --encoding or --scale"]);
    }
}

#[test]
fn finer_units_of_values_spread_over_channels_are_a_scale() {
    let [width, height] = SIZE;
    for (name, units) in
        [("rgb24-low-high", 1e6), ("rgb24-high-low", 1e6), ("rgb24-low-high", 1e5), ("rgb24-high-low", 2e6)]
    {
        let bytes = depths_m().into_iter().flat_map(|depth| {
            let [low, middle, high, _] = ((units * depth) as u32).to_le_bytes();
            if name == "rgb24-low-high" { [low, middle, high] } else { [high, middle, low] }
        });
        let picture = [format!("P6\n{width} {height}\n255\n").into_bytes(), bytes.collect()].concat();
        noted(
            name,
            &read(&picture, &encoding(name)),
            &["the median depth would be", &format!("--scale {}", units.min(1e6))],
        );
        let right = read(&picture, &ReadOptions { scale: Some(units), ..encoding(name) });
        check(name, &right, &ROOM, CLOSE);
        assert_eq!(notes(&right), "", "{name}");
    }
}

#[test]
fn maps_that_were_enlarged_by_less_than_2_are_named() {
    let depths = depths_m();
    let noise = |at: usize| 0.004 * (((at as u32).wrapping_mul(2_654_435_761) >> 16) as f64 / 65_536.0 - 0.5);
    let [width, height] = SIZE;
    for (factors, sides, edge) in [
        ([1.25, 1.25], "102 x 77", 0.5),
        ([1.5, 1.5], "85 x 64", 0.5),
        ([1.5, 1.25], "85 x 77", 0.0),
        ([1.333, 1.333], "96 x 72", 0.5),
        ([1.6, 1.75], "80 x 55", 0.0),
    ] {
        let place = |at: usize, factor: f64| ((at as f64 + edge) / factor) as usize;
        let source = |at: usize| place(at / width, factors[1]) * width + place(at % width, factors[0]);
        for (type_, bytes) in [
            ("millimetres", counts(|at, _| 1000.0 * (depths[source(at)] + noise(source(at))))),
            ("metres", floats(|at, _| depths[source(at)] + noise(source(at)))),
        ] {
            let frame = read(&bytes, &camera());
            let is_said = frame.warnings.iter().any(|note| note.contains("by repeating some of its pixels"));
            assert!(is_said, "{factors:?} {type_} {sides}: {:?}", frame.warnings);
        }
    }
    let floor = |at: usize| 115.2 * 1.2 / ((at / width) as f64 - 47.5).max(0.1);
    for bytes in [
        counts(|at, _| 1000.0 * floor(at).min(3.21)),
        counts(|at, _| 1000.0 + 3.0 * ((at % width) / 3 * 3) as f64 + (at / width) as f64),
        counts(|at, _| (1000.0 + 0.66 * (at % width) as f64 + 0.66 * (at / width) as f64).round()),
        counts(|at, _| {
            1000.0 + (20.0 + 0.4 * (at % width) as f64).floor() + (0.4 * (height - at / width) as f64).floor()
        }),
    ] {
        let notes = notes(&read(&bytes, &camera()));
        assert!(!notes.contains("by repeating some"), "{notes}");
    }
}
