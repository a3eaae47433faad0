//! Whatever the bytes, a reader answers: random bytes behind a valid start, and valid files with
//! some bytes changed.

mod common;

use common::*;
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::formats::{DecodeOptions, FORMATS, Limits};
use depthplanes_io::{ReadOptions, camera_file, decode, inspect};
use proptest::prelude::*;

fn options() -> ReadOptions {
    let limits = Limits { max_pixels: 1 << 20, max_bytes: 1 << 24 };
    ReadOptions { decode: DecodeOptions { limits, ..Default::default() }, ..Default::default() }
}

/// Reads by sniffing and by every format in turn.
fn read_all(bytes: &[u8]) {
    let options = options();
    if let Ok(frame) = decode(bytes, "random", &options) {
        assert!(frame.view().is_ok());
        let summary = inspect::summary(&frame, 10).unwrap();
        assert!(summary.missing >= 0.0 && summary.missing <= 1.0);
    }
    for encoding in ENCODINGS.iter().filter(|encoding| encoding.channels) {
        let stated = ReadOptions { encoding: Some(encoding.name.into()), ..options.clone() };
        if let Ok(frame) = decode(bytes, "random", &stated) {
            assert!(frame.view().is_ok());
        }
    }
    for (raw_type, each) in [(None, 4), (Some("float64-be"), 8), (Some("int16"), 2)] {
        let raw_size = Some((bytes.len() / each, 1));
        let raw_type = raw_type.map(str::to_string);
        let stated = DecodeOptions { raw_size, raw_type, ..options.decode.clone() };
        let _ = depthplanes_io::formats::decode(bytes, &stated);
    }
    for format in FORMATS {
        let stated = DecodeOptions { channels: true, member: Some("1".into()), ..options.decode.clone() };
        if let Ok(image) = (format.decode)(bytes, &stated) {
            assert!(image.width * image.height <= options.decode.limits.max_pixels, "{}", format.name);
        }
        if let Ok(image) = (format.decode)(bytes, &options.decode) {
            assert!(image.width * image.height <= options.decode.limits.max_pixels, "{}", format.name);
        }
    }
}

/// Files of several channels, planes and pages.
fn channelled_files() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    let bytes: Vec<u8> = (0..140).map(|at| (at * 37 % 256) as u8).collect();
    let rgba = png(7, 5, png::ColorType::Rgba, png::BitDepth::Eight, &bytes);
    let mut files = vec![("png", "RGBA", rgba), ("npy", "stack", npy("|u1", false, "(4, 5, 7)", &bytes))];
    if cfg!(feature = "tiff") {
        let page = TiffPage {
            width: 7,
            height: 5,
            sample: (8, 1),
            channels: 3,
            tags: vec![(262, 2), (284, 2)],
            no_data: Some("7"),
            data: bytes[..105].to_vec(),
        };
        let white = TiffPage { channels: 1, tags: vec![(262, 0)], data: bytes[..35].to_vec(), ..page.clone() };
        files.push(("tiff", "planes", tiff_by_hand(&[page, white.clone()], true)));
        files.push(("tiff", "0 is white", tiff_by_hand(&[white], false)));
    }
    files
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..Default::default() })]

    #[test]
    fn random_bytes_behind_a_valid_start(file in 0..14usize, keep in 0.0..1.0f64, tail in prop::collection::vec(any::<u8>(), 0..200)) {
        let (_, _, valid) = &valid_files()[file];
        let keep = (keep * valid.len() as f64) as usize;
        read_all(&[&valid[..keep], &tail].concat());
    }

    #[test]
    fn valid_files_with_some_bytes_changed(file in 0..64usize, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let files = [valid_files(), channelled_files()].concat();
        let (_, _, mut bytes) = files[file % files.len()].clone();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        read_all(&bytes);
    }

    #[test]
    fn camera_files_of_any_text(words in prop::collection::vec(prop_oneof![
        Just("K:"), Just("P:"), Just("camera_matrix:"), Just("data:"), Just("["), Just("]"), Just("\n"), Just("- "), Just("1e308"),
        Just("0"), Just("500"), Just(","), Just("nan"), Just("cam0=["), Just(";"), Just("{\"fx\":"), Just("}"), Just("-1"), Just("#"),
        Just("<a>"), Just("</a>"), Just("[LEFT_CAM_HD]\n"), Just("fx="), Just("fy: "), Just("1 OPENCV 640 480 "), Just(" "), Just("P_rect_02: "),
        Just("\"cameraData\": [[0, {"), Just("Camera.fx: 1\n"), Just("ppx,3\n"), Just("intrinsic\n"), Just("extrinsic\n"), Just("'"), Just("!!"),
    ], 0..40)) {
        let _ = camera_file::parse(&words.concat());
    }
}
