//! TIFF files as other programs write them: pages, planes, white for 0, both byte orders.
#![cfg(feature = "tiff")]

mod common;

use common::*;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{Frame, Pixels, ReadOptions, decode};

const VALUES: [u16; 6] = [500, 1500, 2500, 0, 65_535, 4000];

fn page(sample: (u16, u16), photometric: u16, data: Vec<u8>) -> TiffPage {
    TiffPage { width: 3, height: 2, sample, channels: 1, tags: vec![(262, photometric)], no_data: None, data }
}

fn bytes<const N: usize>(of: impl Fn(f64) -> [u8; N]) -> Vec<u8> {
    VALUES.iter().flat_map(|value| of(f64::from(*value))).collect()
}

fn read(file: &[u8], member: Option<&str>) -> depthplanes_io::Result<Frame> {
    let decode_options = DecodeOptions { member: member.map(str::to_string), ..Default::default() };
    decode(file, "map", &ReadOptions { decode: decode_options, ..Default::default() })
}

fn values(frame: &Frame) -> Vec<f64> {
    match &frame.pixels {
        Pixels::U8(values) => values.iter().map(|value| f64::from(*value)).collect(),
        Pixels::U16(values) => values.iter().map(|value| f64::from(*value)).collect(),
        Pixels::F32(values) => values.iter().map(|value| f64::from(*value)).collect(),
    }
}

fn notes(frame: &Frame) -> String {
    frame.warnings.join("; ")
}

#[test]
fn floats_and_signed_integers_are_as_they_are_though_0_is_white() {
    let right = VALUES.map(f64::from).to_vec();
    for photometric in [0, 1] {
        for (sample, little, big) in [
            ((32, 3), bytes(|v| (v as f32).to_le_bytes()), bytes(|v| (v as f32).to_be_bytes())),
            ((64, 3), bytes(f64::to_le_bytes), bytes(f64::to_be_bytes)),
            ((32, 2), bytes(|v| (v as i32).to_le_bytes()), bytes(|v| (v as i32).to_be_bytes())),
        ] {
            for (data, big_endian) in [(little, false), (big, true)] {
                let frame = read(&tiff_by_hand(&[page(sample, photometric, data)], big_endian), None).unwrap();
                assert_eq!(values(&frame), right, "{sample:?} {photometric} {big_endian}");
                assert!(!notes(&frame).contains("white"), "{}", notes(&frame));
            }
        }
    }
}

#[test]
fn unsigned_integers_are_inverted_where_0_is_white() {
    for (data, big_endian) in
        [(bytes(|v| (v as u16).to_le_bytes()), false), (bytes(|v| (v as u16).to_be_bytes()), true)]
    {
        let frame = read(&tiff_by_hand(&[page((16, 1), 0, data)], big_endian), None).unwrap();
        assert_eq!(values(&frame), VALUES.map(|value| 65_535.0 - f64::from(value)));
        assert!(notes(&frame).contains("0 is white"), "{}", notes(&frame));
    }
    let narrow = read(&tiff_by_hand(&[page((8, 1), 0, vec![0, 1, 2, 3, 254, 255])], false), None).unwrap();
    assert_eq!(narrow.pixels, Pixels::U8(vec![255, 254, 253, 252, 1, 0]));
}

#[test]
fn the_first_page_of_full_size_is_taken_and_another_is_stated() {
    let depth = page((16, 1), 1, bytes(|v| (v as u16).to_le_bytes()));
    let thumbnail = TiffPage { width: 2, height: 1, ..page((8, 1), 1, vec![9, 8]) };
    let mut marked = page((8, 1), 1, vec![1; 6]);
    marked.tags.push((254, 1));
    let larger = TiffPage { width: 4, height: 3, tags: vec![(262, 1), (254, 1)], ..page((8, 1), 1, vec![1; 12]) };
    for (pages, note) in [
        (vec![thumbnail.clone(), depth.clone()], "page 2 of 2 is taken (2x1, 3x2)"),
        (vec![depth.clone(), thumbnail.clone()], "page 1 of 2 is taken (3x2, 2x1)"),
        (vec![marked, depth.clone(), thumbnail.clone()], "page 2 of 3 is taken"),
        (vec![larger, depth.clone()], "page 2 of 2 is taken"),
        (vec![depth.clone(), page((8, 1), 1, vec![7; 6])], "page 1 of 2 is taken (3x2, 3x2)"),
    ] {
        let file = tiff_by_hand(&pages, false);
        let frame = read(&file, None).unwrap();
        assert!(frame.pixels == Pixels::U16(VALUES.to_vec()) && notes(&frame).contains(note), "{}", notes(&frame));
        let last = read(&file, Some(&pages.len().to_string())).unwrap();
        assert!(!notes(&last).contains("is taken ("), "{}", notes(&last));
        for absent in ["0", "4", "x"] {
            assert!(read(&file, Some(absent)).unwrap_err().to_string().contains("--member"));
        }
    }
}

#[test]
fn planes_of_colours_are_put_together() {
    let grey = [10u8, 20, 30, 40, 50, 60];
    let planar = |data: Vec<u8>| TiffPage { channels: 3, tags: vec![(262, 2), (284, 2)], ..page((8, 1), 2, data) };
    let equal = read(&tiff_by_hand(&[planar([grey, grey, grey].concat())], false), None).unwrap();
    assert_eq!(equal.pixels, Pixels::U8(grey.to_vec()));
    let differing = [grey, [1, 2, 3, 4, 5, 6], [0; 6]].concat();
    let error = read(&tiff_by_hand(&[planar(differing.clone())], false), None).unwrap_err().to_string();
    assert!(error.contains("differ in 6 pixels"), "{error}");
    let stated = ReadOptions { encoding: Some("bytes-low-high".into()), ..Default::default() };
    let packed = decode(&tiff_by_hand(&[planar(differing)], false), "map", &stated).unwrap();
    assert_eq!(packed.pixels, Pixels::U16(vec![266, 532, 798, 1064, 1330, 1596]));
}

#[test]
fn the_value_that_gdal_calls_missing_is_missing() {
    let data = bytes(|v| (v as u16).to_le_bytes());
    for (text, missing) in
        [("4000", Some(4000.0)), ("65535", Some(65_535.0)), ("0", None), ("-9999", None), ("nan", None)]
    {
        let file = TiffPage { no_data: Some(text), ..page((16, 1), 1, data.clone()) };
        let frame = read(&tiff_by_hand(&[file], false), None).unwrap();
        let by_file = frame.missing.filter(|_| notes(&frame).contains("GDAL_NODATA"));
        assert_eq!(by_file, missing, "{text}");
    }
}

#[test]
fn what_is_not_read_is_named() {
    let palette = page((8, 1), 3, vec![0; 6]);
    let bands = TiffPage { channels: 6, ..page((8, 1), 1, vec![0; 36]) };
    for (file, said) in [(palette, "Palette"), (bands, "6 channels")] {
        let error = read(&tiff_by_hand(&[file], false), None).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn a_page_of_depth_is_taken_before_pictures_of_colours() {
    let depth = page((16, 1), 1, bytes(|v| (v as u16).to_le_bytes()));
    let two = |at: u8| if at % 3 == 2 { 0 } else { at };
    let colours = TiffPage { channels: 3, ..page((8, 1), 2, (0..18).map(two).collect()) };
    let opaque = TiffPage { channels: 4, ..page((8, 1), 2, (0..24).collect()) };
    let larger = TiffPage { width: 4, height: 3, channels: 3, ..page((8, 1), 2, (0..36).collect()) };
    for (pages, note) in [
        (vec![colours.clone(), depth.clone()], "page 2 of 2 is taken"),
        (vec![larger, depth.clone()], "page 2 of 2 is taken"),
        (vec![colours.clone(), opaque, depth.clone()], "page 3 of 3 is taken"),
        (vec![depth.clone(), colours.clone()], "page 1 of 2 is taken"),
    ] {
        let frame = read(&tiff_by_hand(&pages, false), None).unwrap();
        assert!(frame.pixels == Pixels::U16(VALUES.to_vec()) && notes(&frame).contains(note), "{}", notes(&frame));
    }
    // A value spread over channels is what its encoding asks for.
    let stated = ReadOptions { encoding: Some("bytes-low-high".into()), ..Default::default() };
    let packed = decode(&tiff_by_hand(&[colours, depth], false), "map", &stated).unwrap();
    assert_eq!(packed.pixels, Pixels::U16(vec![256, 1027, 1798, 2569, 3340, 4111]));
}
