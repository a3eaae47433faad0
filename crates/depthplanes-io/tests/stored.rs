//! How a map is stored: turned by a tag, as 16-bit floats, with the sides of its size exchanged, as points.

mod common;
#[path = "common/room.rs"]
mod room;

use common::*;
use depthplanes::Intrinsics;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{Frame, Pixels, ReadOptions, decode};
use room::{CAMERA, ROOM, SIZE, check, depths_m};

/// Six different values, 3 x 2.
const VALUES: [u16; 6] = [1, 2, 3, 4, 5, 6];
/// Columns and values as they are seen, by orientations from 1 (TIFF 6.0: what row 0 and column 0 are).
const SEEN: [(usize, [u16; 6]); 8] = [
    (3, [1, 2, 3, 4, 5, 6]),
    (3, [3, 2, 1, 6, 5, 4]),
    (3, [6, 5, 4, 3, 2, 1]),
    (3, [4, 5, 6, 1, 2, 3]),
    (2, [1, 4, 2, 5, 3, 6]),
    (2, [4, 1, 5, 2, 6, 3]),
    (2, [6, 3, 5, 2, 4, 1]),
    (2, [3, 6, 2, 5, 1, 4]),
];

fn seen(frame: &Frame) -> (usize, Vec<u16>) {
    let Pixels::U16(values) = &frame.pixels else { panic!("16 bits") };
    (frame.width, values.clone())
}

fn is_right(frame: &Frame, orientation: u16) {
    let (columns, values) = SEEN[usize::from(orientation.max(1)) - 1];
    assert_eq!(seen(frame), (columns, values.to_vec()), "{orientation}");
    let is_told = frame.warnings.iter().any(|note| note.contains("orientation"));
    assert_eq!(is_told, orientation > 1, "{orientation}: {:?}", frame.warnings);
}

#[cfg(feature = "tiff")]
#[test]
fn tiff_pictures_are_turned_as_their_tag_says() {
    for big_endian in [false, true] {
        let file = |orientation: u16, channels: u16| {
            let two = |value: &u16| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
            let data = VALUES.iter().flat_map(|value| two(value).repeat(usize::from(channels))).collect();
            let tags = vec![(262, if channels == 1 { 1 } else { 2 }), (274, orientation)];
            let page = TiffPage { width: 3, height: 2, sample: (16, 1), channels, tags, no_data: None, data };
            tiff_by_hand(&[page], big_endian)
        };
        for orientation in 0..=8 {
            is_right(&decode(&file(orientation, 1), "map", &ReadOptions::default()).unwrap(), orientation);
            is_right(&decode(&file(orientation, 3), "map", &ReadOptions::default()).unwrap(), orientation);
        }
        for orientation in [9, 255, 65_535] {
            let error = decode(&file(orientation, 1), "map", &ReadOptions::default()).unwrap_err().to_string();
            assert!(error.contains(&format!("its orientation is {orientation}")), "{error}");
        }
    }
}

/// Exif data with the orientation after another entry.
fn exif(orientation: u16, big_endian: bool) -> Vec<u8> {
    let two = |value: u16| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    let four = |value: u32| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    let mut exif = [if big_endian { *b"MM" } else { *b"II" }, two(42)].concat();
    exif.extend([four(8).to_vec(), two(2).to_vec()].concat());
    for (tag, value) in [(259, 1), (274, orientation)] {
        exif.extend([two(tag).to_vec(), two(3).to_vec(), four(1).to_vec(), two(value).to_vec(), vec![0; 2]].concat());
    }
    [exif, four(0).to_vec()].concat()
}

fn png_with(exif: Vec<u8>) -> Vec<u8> {
    let mut file = Vec::new();
    let mut info = png::Info::with_size(3, 2);
    (info.color_type, info.bit_depth) = (png::ColorType::Grayscale, png::BitDepth::Sixteen);
    info.exif_metadata = Some(exif.into());
    let mut writer = png::Encoder::with_info(&mut file, info).unwrap().write_header().unwrap();
    writer.write_image_data(&bytes_be(&VALUES)).unwrap();
    writer.finish().unwrap();
    file
}

#[test]
fn png_pictures_are_turned_as_their_exif_data_say() {
    for big_endian in [false, true] {
        for orientation in 0..=8 {
            let file = png_with(exif(orientation, big_endian));
            is_right(&decode(&file, "map", &ReadOptions::default()).unwrap(), orientation);
        }
        for cut in 0..exif(3, big_endian).len() {
            let file = png_with(exif(3, big_endian)[..cut].to_vec());
            let _ = decode(&file, "map", &ReadOptions::default()); // Whatever they are, there is no panic.
        }
    }
    let error = decode(&png_with(exif(10, true)), "map", &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("its orientation is 10"), "{error}");
}

fn raw(size: [usize; 2], kind: Option<&str>, bytes: &[u8]) -> Frame {
    let decode_options =
        DecodeOptions { raw_size: Some((size[0], size[1])), raw_type: kind.map(str::to_string), ..Default::default() };
    let options = ReadOptions { decode: decode_options, intrinsics: Some(CAMERA), ..Default::default() };
    let options = if size == SIZE { options } else { ReadOptions { intrinsics: None, ..options } };
    decode(bytes, "map", &options).unwrap()
}

/// A 16-bit float, rounded towards 0.
fn half(value: f64) -> u16 {
    if value == 0.0 {
        return 0;
    }
    let exponent = value.log2().floor();
    (((exponent + 15.0) * 1024.0) + (value / exponent.exp2() - 1.0) * 1024.0) as u16
}

#[test]
fn floats_of_16_bits_without_a_header_are_noticed() {
    for (name, scale, gaps) in
        [("a room", 1.0, false), ("with gaps", 1.0, true), ("small", 0.3, false), ("large", 4.0, true)]
    {
        let halves = depths_m().into_iter().enumerate();
        let halves: Vec<u16> =
            halves.map(|(at, depth)| if gaps && at % 5 == 0 { 0 } else { half(scale * depth) }).collect();
        for (kind, bytes) in [("float16", bytes_le(&halves)), ("float16-be", bytes_be(&halves))] {
            let notes = raw(SIZE, None, &bytes).warnings.join("\n");
            assert!(notes.contains(&format!("try --raw-type {kind}")), "{name}, {kind}: {notes}");
            let stated = raw(SIZE, Some(kind), &bytes);
            assert!(!stated.warnings.join("\n").contains("float"), "{name}: {:?}", stated.warnings);
            if scale == 1.0 {
                check(name, &stated, &ROOM, [0.02, 0.03, 0.95]);
            }
        }
    }
}

#[test]
fn integers_of_16_bits_without_a_header_are_no_floats() {
    for units in [100.0, 256.0, 1000.0, 4000.0, 5000.0, 10_000.0] {
        let counts: Vec<u16> = depths_m().into_iter().map(|depth| (units * depth).round() as u16).collect();
        for bytes in [bytes_le(&counts), bytes_be(&counts)] {
            let notes = raw(SIZE, None, &bytes).warnings.join("\n");
            assert!(!notes.contains("float16"), "{units}: {notes}");
        }
    }
}

#[test]
fn exchanged_sides_of_a_raw_size_are_noticed() {
    let [width, height] = SIZE;
    let millimetres: Vec<u16> = depths_m().into_iter().map(|depth| (1000.0 * depth).round() as u16).collect();
    let noisy = millimetres.iter().enumerate().map(|(at, z)| if at % 7 == 0 { 0 } else { z + (at * 37 % 29) as u16 });
    let noisy: Vec<u16> = noisy.collect();
    let metres: Vec<u8> = depths_m().into_iter().flat_map(|depth| (depth as f32).to_le_bytes()).collect();
    let grey: Vec<u8> = depths_m().into_iter().map(|depth| (50.0 * depth) as u8).collect();
    for (name, bytes) in [
        ("millimetres", bytes_le(&millimetres)),
        ("noise and gaps", bytes_le(&noisy)),
        ("floats", metres),
        ("8 bits", grey),
    ] {
        let notes = raw([height, width], None, &bytes).warnings.join("\n");
        assert!(notes.contains(&format!("try --raw-size {width}x{height}")), "{name}: {notes}");
        let right = raw(SIZE, None, &bytes).warnings.join("\n");
        assert!(!right.contains("--raw-size"), "{name}: {right}");
    }
    // A wall that faces the camera, and noise, look the same whatever the size.
    for bytes in
        [bytes_le(&[2000; 96 * 128]), bytes_le(&millimetres.iter().map(|z| z.wrapping_mul(40_503)).collect::<Vec<_>>())]
    {
        assert!(!raw([height, width], None, &bytes).warnings.join("\n").contains("--raw-size"));
    }
}

/// The points that a camera sees in the room, with another coordinate by `bend`.
fn points(camera: Intrinsics, gaps: bool, bend: f64) -> Vec<[f32; 3]> {
    let point = |(at, depth): (usize, f64)| {
        let [x, y, _] = camera.ray((at % SIZE[0]) as f64, (at / SIZE[0]) as f64);
        let bent = 1.0 + bend * (x * x + y * y);
        let depth = if gaps && at % 3 == 0 { f64::NAN } else { depth };
        [x * bent * depth, y * bent * depth, depth].map(|part| part as f32)
    };
    depths_m().into_iter().enumerate().map(point).collect()
}

/// The same points as files of each kind.
fn clouds(points: &[[f32; 3]]) -> Vec<(&'static str, Vec<u8>)> {
    let [width, height] = SIZE;
    let floats: Vec<u8> = points.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
    let doubles: Vec<u8> = points.iter().flatten().flat_map(|&part| f64::from(part).to_le_bytes()).collect();
    let shape = format!("({height}, {width}, 3)");
    let header = |data: &str| {
        format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {width}\nHEIGHT {height}\n\
             VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {data}\n",
            width * height
        )
    };
    let text: String = points.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    vec![
        ("npy", npy("<f4", false, &shape, &floats)),
        ("npy of doubles", npy("<f8", false, &shape, &doubles)),
        ("binary pcd", [header("binary").into_bytes(), floats].concat()),
        ("ascii pcd", [header("ascii").into_bytes(), text.into_bytes()].concat()),
    ]
}

#[test]
fn organised_clouds_say_their_camera() {
    let other = Intrinsics { fx: 140.0, fy: 118.5, cx: 70.25, cy: 40.0 };
    let up = Intrinsics { fy: -115.2, ..CAMERA };
    for (camera, gaps) in [(CAMERA, false), (CAMERA, true), (other, true), (up, false)] {
        for (name, file) in clouds(&points(camera, gaps, 0.0)) {
            let frame = decode(&file, "map", &ReadOptions::default()).unwrap();
            let found = frame.sensor.intrinsics.unwrap_or_else(|| panic!("{name}: {:?}", frame.warnings));
            let off = [found.fx - camera.fx, found.fy - camera.fy, found.cx - camera.cx, found.cy - camera.cy];
            assert!(off.iter().all(|off| off.abs() < 0.01), "{name}: {found:?}");
            assert!(frame.warnings.iter().any(|note| note.contains("points of the cloud")), "{:?}", frame.warnings);
            if camera == CAMERA && !gaps {
                check(name, &frame, &ROOM, [0.02, 0.03, 0.95]);
            }
            // What is stated goes before.
            let stated = ReadOptions { intrinsics: Some(other), ..Default::default() };
            assert_eq!(decode(&file, "map", &stated).unwrap().sensor.intrinsics, Some(other), "{name}");
        }
    }
    // Points behind a lens that distorts have no pinhole camera.
    for bend in [0.05, -0.1, 0.3] {
        for (name, file) in clouds(&points(CAMERA, false, bend)) {
            let frame = decode(&file, "map", &ReadOptions::default()).unwrap();
            assert_eq!(frame.sensor.intrinsics, None, "{name}");
        }
    }
}

#[test]
fn focal_lengths_below_0_say_what_they_mean() {
    let millimetres: Vec<u16> = depths_m().into_iter().map(|depth| (1000.0 * depth).round() as u16).collect();
    let file = npy("<u2", false, "(96, 128)", &bytes_le(&millimetres));
    for (fx, fy, words) in
        [(115.2, -115.2, ""), (-115.2, 115.2, "x points to the left"), (-115.2, -115.2, "x points to the left")]
    {
        let options = ReadOptions { intrinsics: Some(Intrinsics { fx, fy, ..CAMERA }), ..Default::default() };
        let frame = decode(&file, "map", &options).unwrap();
        assert_eq!(frame.warnings.is_empty(), words.is_empty(), "{:?}", frame.warnings);
        assert!(frame.warnings.iter().all(|note| note.contains(words)), "{:?}", frame.warnings);
        let [sx, sy] = [fx.signum(), fy.signum()];
        let mirrored = ROOM.map(|(distance, [x, y, z])| (distance, [sx * x, sy * y, z]));
        check(words, &frame, &mirrored, [0.02, 0.03, 0.95]);
    }
}
