//! Label images from files of every format, and what is no label image.

mod common;

use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::labels::decode_labels;
use depthplanes_io::{Error, read_labels};
use png::{BitDepth, ColorType};

fn decode(bytes: &[u8]) -> depthplanes_io::Result<depthplanes_io::LabelImage> {
    decode_labels(bytes, "labels", &DecodeOptions::default())
}

#[test]
fn labels_of_8_16_and_64_bits_keep_their_numbers() {
    let expected = [0u16, 1, 17, 200];
    let png8 = common::png(2, 2, ColorType::Grayscale, BitDepth::Eight, &[0, 1, 17, 200]);
    let png16 = common::png(2, 2, ColorType::Grayscale, BitDepth::Sixteen, &common::bytes_be(&expected));
    let npy64: Vec<u8> = expected.iter().flat_map(|&label| i64::from(label).to_le_bytes()).collect();
    for bytes in [png8, png16, common::npy("<i8", false, "(2, 2)", &npy64)] {
        let image = decode(&bytes).unwrap();
        assert_eq!((image.width, image.height, &image.labels[..]), (2, 2, &expected[..]));
        assert_eq!(image.warnings, [""; 0]);
    }
}

#[test]
fn negative_labels_are_no_plane_and_are_remarked_on() {
    let image = decode(&common::npy("|i1", false, "(1, 3)", &[255, 0, 4])).unwrap();
    assert_eq!(image.labels, [0, 0, 4]);
    assert!(image.warnings[0].contains("negative"), "{:?}", image.warnings);
}

#[test]
fn what_is_no_label_image_is_refused_with_what_is_accepted() {
    let float: Vec<u8> = [0.0f32, 1.5].iter().flat_map(|value| value.to_le_bytes()).collect();
    let large: Vec<u8> = [0u32, 65_536].iter().flat_map(|value| value.to_le_bytes()).collect();
    let colour = common::png(1, 1, ColorType::Rgb, BitDepth::Eight, &[1, 2, 3]);
    let cut = &common::png(2, 2, ColorType::Grayscale, BitDepth::Eight, &[0, 1, 17, 200])[..40];
    for (bytes, says) in [
        (common::npy("<f4", false, "(1, 2)", &float), "floating-point numbers (float32)"),
        (common::npy("<u4", false, "(1, 2)", &large), "labels above 65535 (uint32)"),
        (colour, "channels differ"),
        (cut.to_vec(), "png"),
        (b"hello".to_vec(), "match no format"),
        (Vec::new(), "no bytes"),
    ] {
        let error = decode(&bytes).unwrap_err();
        assert!(matches!(error.kind(), Error::Unreadable { .. }), "{error:?}");
        let message = error.to_string();
        assert!(message.starts_with("labels: ") && message.contains(says), "{message}");
        assert!(message.contains("accepted: a label image"), "{message}");
    }
}

#[test]
fn limits_and_missing_files_are_their_own_errors() {
    let mut options = DecodeOptions::default();
    options.limits.max_pixels = 3;
    let png = common::png(2, 2, ColorType::Grayscale, BitDepth::Eight, &[0; 4]);
    let error = decode_labels(&png, "labels", &options).unwrap_err();
    assert!(matches!(error.kind(), Error::Limit { given: 4, limit: 3, .. }), "{error:?}");
    let error = read_labels("no/such/file.png", &options).unwrap_err();
    assert!(matches!(error, Error::Io { .. }), "{error:?}");
}

#[test]
fn published_truths_are_read() {
    let Some(data) = common::data() else { return };
    for (path, size, largest) in [
        ("gt_evops/icl_0.labels.png", (640, 480), 17),
        ("gt_segcomp_abw/abw.test.0.labels.png", (512, 512), 36),
        ("gt_synpeb/ppe_test_500.pinhole_labels.png", (560, 460), 0),
    ] {
        let image = read_labels(data.join(path), &DecodeOptions::default()).unwrap();
        assert_eq!((image.width, image.height), size, "{path}");
        assert!(largest == 0 || image.labels.iter().max() == Some(&largest), "{path}");
    }
}
