//! Every format gives back the map that was written, and refuses pictures that are no maps.

mod common;

use common::*;
use depthplanes_io::formats::{DecodeOptions, FORMATS, Image, decode};
use depthplanes_io::{Error, Pixels};
use png::{BitDepth, ColorType};

fn read(bytes: &[u8]) -> depthplanes_io::Result<Image> {
    decode(bytes, &DecodeOptions::default()).map(|(image, _)| image)
}

fn as_f64(pixels: &Pixels) -> Vec<f64> {
    match pixels {
        Pixels::U8(values) => values.iter().map(|&value| value.into()).collect(),
        Pixels::U16(values) => values.iter().map(|&value| value.into()).collect(),
        Pixels::F32(values) => values.iter().map(|&value| value.into()).collect(),
    }
}

fn wrong(bytes: &[u8]) -> String {
    read(bytes).expect_err("should be refused").to_string()
}

#[test]
fn every_format_is_sniffed_and_gives_the_map_back() {
    let depth: Vec<f64> = depth().into_iter().map(f64::from).collect();
    for (name, kind, bytes) in valid_files() {
        let (image, format) =
            decode(&bytes, &DecodeOptions::default()).unwrap_or_else(|e| panic!("{name} {kind}: {e}"));
        assert_eq!(format.name, name, "{kind}");
        assert_eq!((image.width, image.height), (WIDTH, HEIGHT), "{name} {kind}");
        assert_eq!(as_f64(&image.pixels), depth, "{name} {kind}");
        assert_eq!(image.warnings, Vec::<String>::new(), "{name} {kind}");
    }
}

#[test]
fn every_row_of_the_table_is_written_by_a_test() {
    let written: Vec<_> = valid_files().into_iter().map(|(name, ..)| name).chain(["bmp", "raw"]).collect();
    for format in FORMATS {
        assert!(written.contains(&format.name), "{}", format.name);
        assert!(!format.extensions.is_empty() && !format.about.is_empty());
    }
}

#[test]
fn png_kinds() {
    let grey8: Vec<u8> = (0..35).collect();
    let image = read(&png(7, 5, ColorType::Grayscale, BitDepth::Eight, &grey8)).unwrap();
    assert_eq!(image.pixels, Pixels::U8(grey8.clone()));
    let rgb: Vec<u8> = grey8.iter().flat_map(|&g| [g, g, g]).collect();
    let image = read(&png(7, 5, ColorType::Rgb, BitDepth::Eight, &rgb)).unwrap();
    assert_eq!(image.pixels, Pixels::U8(grey8.clone()));
    assert_eq!(image.warnings, ["3 equal channels: one is kept"]);
    let rgba: Vec<u8> = grey8.iter().flat_map(|&g| [g, g, g, 255 - g]).collect();
    let image = read(&png(7, 5, ColorType::Rgba, BitDepth::Eight, &rgba)).unwrap();
    assert_eq!(image.pixels, Pixels::U8(grey8.clone()));
    assert_eq!(image.warnings.len(), 2);
    let deep: Vec<u8> = depth().iter().flat_map(|g| [g.to_be_bytes(), [1, 2]].concat()).collect();
    let image = read(&png(7, 5, ColorType::GrayscaleAlpha, BitDepth::Sixteen, &deep)).unwrap();
    assert_eq!(image.pixels, Pixels::U16(depth()));
    let bits = read(&png(8, 1, ColorType::Grayscale, BitDepth::One, &[0b1010_0000])).unwrap();
    assert_eq!(bits.pixels, Pixels::U8(vec![255, 0, 255, 0, 0, 0, 0, 0]));
}

#[test]
fn colourised_pictures_are_refused_with_advice() {
    let mut rgb: Vec<u8> = (0..35).flat_map(|g| [g, g, g]).collect();
    rgb[10] ^= 1;
    let ppm = [b"P6 7 5 255\n".to_vec(), rgb.clone()].concat();
    let bitmap = bmp(7, 5, 24, &[], &rgb.chunks(21).map(<[u8]>::to_vec).collect::<Vec<_>>());
    let floats: Vec<u8> = rgb.iter().flat_map(|&g| f32::from(g).to_le_bytes()).collect();
    let pfm = [b"PF 7 5 -1\n".to_vec(), floats].concat();
    for file in [png(7, 5, ColorType::Rgb, BitDepth::Eight, &rgb), ppm, bitmap, pfm] {
        let error = wrong(&file);
        assert!(error.contains("colourised") && error.contains("in 1 pixels"), "{error}");
    }
}

#[test]
fn bmp_gives_the_palettes_grey_whatever_the_depth_and_direction() {
    let values: Vec<u8> = (0..35).map(|i| i * 7).collect();
    let rows: Vec<Vec<u8>> = values.chunks(7).map(<[u8]>::to_vec).collect();
    let bottom_up: Vec<Vec<u8>> = rows.iter().rev().cloned().collect();
    let expected = Pixels::U8(values.iter().map(|v| 255 - v).collect());
    assert_eq!(read(&bmp(7, 5, 8, &grey_palette(), &bottom_up)).unwrap().pixels, expected);
    assert_eq!(read(&bmp(7, -5, 8, &grey_palette(), &rows)).unwrap().pixels, expected);
    let four = read(&bmp(3, 1, 4, &grey_palette()[..16], &[vec![0x12, 0xf0]])).unwrap();
    assert_eq!(four.pixels, Pixels::U8(vec![254, 253, 240]));
    let one = read(&bmp(3, 1, 1, &grey_palette()[..2], &[vec![0b0100_0000]])).unwrap();
    assert_eq!(one.pixels, Pixels::U8(vec![255, 254, 255]));
    let colour = read(&bmp(2, 1, 24, &[], &[vec![5, 5, 5, 6, 6, 6]])).unwrap();
    assert_eq!((colour.pixels, colour.warnings.len()), (Pixels::U8(vec![5, 6]), 1));
    let opaque = read(&bmp(2, 1, 32, &[], &[vec![5, 5, 5, 255, 6, 6, 6, 255]])).unwrap();
    assert_eq!(opaque.pixels, Pixels::U8(vec![5, 6]));
}

#[test]
fn pnm_widths_comments_and_maxval() {
    assert_eq!(read(b"P2 # c\n2 2\n255\n1 2 # three\n 3 4").unwrap().pixels, Pixels::U8(vec![1, 2, 3, 4]));
    assert_eq!(read(b"P2 2 1 256 1 256").unwrap().pixels, Pixels::U16(vec![1, 256]));
    assert_eq!(read(b"P5 2 1 100\n\x05\x64").unwrap().pixels, Pixels::U8(vec![5, 100]));
    assert_eq!(read(b"P3 1 1 255 9 9 9").unwrap().pixels, Pixels::U8(vec![9]));
    assert_eq!(read(b"P6 1 1 65535\n\x01\x02\x01\x02\x01\x02").unwrap().pixels, Pixels::U16(vec![0x102]));
    assert!(wrong(b"P5 2 1 100\n\x05\x65").contains("101"));
}

#[test]
fn pfm_both_byte_orders_and_equal_channels() {
    let big =
        [b"Pf\n2 2\n1.0\n".to_vec(), [1f32, 2.0, 3.0, 4.0].iter().flat_map(|v| v.to_be_bytes()).collect()].concat();
    assert_eq!(read(&big).unwrap().pixels, Pixels::F32(vec![3.0, 4.0, 1.0, 2.0]));
    let odd: Vec<u8> = [1f32, 2.0, 3.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let image = read(&[b"Pf 1 3 -0.5\n".to_vec(), odd].concat()).unwrap();
    assert_eq!((image.pixels, image.warnings.len()), (Pixels::F32(vec![3.0, 2.0, 1.0]), 1));
    let equal: Vec<u8> = [7f32, 7.0, 7.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(read(&[b"PF 1 1 -1\n".to_vec(), equal].concat()).unwrap().pixels, Pixels::F32(vec![7.0]));
}

#[test]
fn npy_types_orders_and_shapes() {
    let expected = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    macro_rules! check {
        ($t:ty, $code:literal) => {
            let values = expected.map(|value| value as $t);
            let little: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let big: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
            for (order, data) in [("<", &little), (">", &big)] {
                let image = read(&npy(&format!("{order}{}", $code), false, "(2, 3)", data)).unwrap();
                assert_eq!(as_f64(&image.pixels), expected, "{order}{}", $code);
                assert_eq!((image.width, image.height), (3, 2));
            }
        };
    }
    check!(u8, "u1");
    check!(i8, "i1");
    check!(u16, "u2");
    check!(i16, "i2");
    check!(u32, "u4");
    check!(i32, "i4");
    check!(u64, "u8");
    check!(i64, "i8");
    check!(f32, "f4");
    check!(f64, "f8");
    let half: Vec<u8> =
        [0x3c00u16, 0xc000, 0x7c00, 0x0001, 0x3555, 0x7bff].iter().flat_map(|v| v.to_le_bytes()).collect();
    let halves = as_f64(&read(&npy("<f2", false, "(2, 3)", &half)).unwrap().pixels);
    assert_eq!(halves, [1.0, -2.0, f64::INFINITY, 2f64.powi(-24), 0.333251953125, 65504.0]);
    for shape in ["(2, 3, 1)", "(1, 2, 3)", "(1, 2, 3, 1)", "(1,1,2,3)", "(2,3,)"] {
        assert_eq!(
            read(&npy("|u1", false, shape, &[1, 2, 3, 4, 5, 6])).unwrap().pixels,
            Pixels::U8(vec![1, 2, 3, 4, 5, 6])
        );
    }
    let columns = read(&npy("|u1", true, "(2, 3)", &[1, 4, 2, 5, 3, 6])).unwrap();
    assert_eq!((columns.pixels, columns.width), (Pixels::U8(vec![1, 2, 3, 4, 5, 6]), 3));
}

#[test]
fn npy_clouds_give_their_z_and_pictures_are_refused() {
    let xyz: Vec<u8> = (0..12).flat_map(|i| (i as f32).to_le_bytes()).collect();
    let cloud = read(&npy("<f4", false, "(2, 2, 3)", &xyz)).unwrap();
    assert_eq!((cloud.pixels, cloud.warnings.len()), (Pixels::F32(vec![2.0, 5.0, 8.0, 11.0]), 1));
    let columns = read(&npy("<f4", true, "(2, 2, 3)", &xyz)).unwrap();
    assert_eq!(columns.pixels, Pixels::F32(vec![8.0, 10.0, 9.0, 11.0]));
    assert!(wrong(&npy("|u1", false, "(2, 2, 3)", &[1, 2, 3, 1, 2, 3, 1, 2, 3, 4, 4, 5])).contains("colour"));
}

#[test]
fn integers_that_do_not_fit_and_negative_ones() {
    let negative: Vec<u8> = [-5i32, 7].iter().flat_map(|value| value.to_le_bytes()).collect();
    let image = read(&npy("<i4", false, "(1, 2)", &negative)).unwrap();
    assert_eq!((image.pixels, image.warnings.len(), image.sample), (Pixels::U16(vec![0, 7]), 1, "int32"));
    let large: Vec<u8> = [70_000u32, 7].iter().flat_map(|value| value.to_le_bytes()).collect();
    let image = read(&npy("<u4", false, "(1, 2)", &large)).unwrap();
    assert_eq!((image.pixels, image.warnings.len()), (Pixels::F32(vec![70_000.0, 7.0]), 1));
}

#[test]
fn npz_with_several_arrays_asks_for_the_member() {
    let (a, b) = (npy("|u1", false, "(2, 2)", &[1, 2, 3, 4]), npy("|u1", false, "(2, 2)", &[5, 6, 7, 8]));
    let k = npy("|u1", false, "(3,)", &[1, 2, 3]);
    for deflated in [false, true] {
        let one = read(&zip(&[("K.npy", k.clone()), ("depth.npy", a.clone())], deflated)).unwrap();
        assert_eq!((one.pixels, one.warnings.len()), (Pixels::U8(vec![1, 2, 3, 4]), 1));
        let two = zip(&[("a.npy", a.clone()), ("b.npy", b.clone()), ("note.txt", b"hi".to_vec())], deflated);
        assert!(wrong(&two).contains("`a`, `b`"), "{}", wrong(&two));
        let named = DecodeOptions { member: Some("b".into()), ..Default::default() };
        assert_eq!(decode(&two, &named).unwrap().0.pixels, Pixels::U8(vec![5, 6, 7, 8]));
        let absent = DecodeOptions { member: Some("c".into()), ..Default::default() };
        assert!(matches!(decode(&two, &absent), Err(Error::Parameter { .. })));
    }
}

#[test]
fn an_unorganised_cloud_is_refused_with_advice() {
    let ascii: String = points(&depth()).iter().map(|[x, y, z, c]| format!("{x} {y} {z} {c}\n")).collect();
    let error = wrong(&pcd(35, 1, "ascii", ascii.as_bytes()));
    assert!(error.contains("unorganised") && error.contains("organised cloud"), "{error}");
}

#[test]
fn a_cloud_keeps_its_nan() {
    let image = read(&pcd(1, 2, "ascii", b"0 0 nan 0\n1 1 2.5 0\n")).unwrap();
    let Pixels::F32(z) = image.pixels else { panic!() };
    assert!(z[0].is_nan() && z[1] == 2.5);
}

#[test]
fn raw_samples_need_their_size() {
    let options = DecodeOptions { raw_size: Some((WIDTH, HEIGHT)), ..Default::default() };
    let (image, format) = decode(&bytes_le(&depth()), &options).unwrap();
    assert_eq!((image.pixels, format.name), (Pixels::U16(depth()), "raw"));
    assert!(matches!(decode(&[0; 69], &options), Err(Error::Parameter { .. })));
}

#[test]
fn the_header_of_a_float_compressed_depth_gives_its_measure() {
    let bytes = [config_header(200.0, -30.0), rvl(7, 5, &depth())].concat();
    let value_kind = depthplanes_io::formats::inverse_depth_value_kind(&bytes).unwrap();
    // z = A / (v - B)
    let z = value_kind.depth_m(70.0).unwrap();
    assert!((z - 2.0).abs() < 1e-12);
    assert!(depthplanes_io::formats::inverse_depth_value_kind(&config_header(0.0, 0.0)).is_err());
}

#[cfg(feature = "tiff")]
#[test]
fn tiff_floats_and_packings() {
    use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, colortype};
    let values: Vec<f32> = depth().into_iter().map(f32::from).collect();
    for packing in
        [Compression::Uncompressed, Compression::Packbits, Compression::Lzw, Compression::Deflate(DeflateLevel::Fast)]
    {
        let mut file = std::io::Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut file).unwrap().with_compression(packing);
        encoder.write_image::<colortype::Gray32Float>(7, 5, &values).unwrap();
        assert_eq!(read(&file.into_inner()).unwrap().pixels, Pixels::F32(values.clone()));
    }
    let mut file = std::io::Cursor::new(Vec::new());
    TiffEncoder::new(&mut file).unwrap().write_image::<colortype::RGB8>(1, 1, &[1, 2, 3]).unwrap();
    assert!(wrong(&file.into_inner()).contains("colourised"));
}

#[test]
fn unsupported_files_are_named() {
    for (start, name) in
        [(&b"\xff\xd8\xff\xe0 jfif"[..], "JPEG"), (b"\x1a\x45\xdf\xa3 mkv", "Matroska"), (b"\x1f\x8b\x08", "gzip")]
    {
        assert!(wrong(start).contains(name), "{}", wrong(start));
    }
    assert!(wrong(b"").contains("no bytes"));
    assert!(wrong(&[7; 70]).contains("--raw-size"));
}

#[test]
fn limits_hold_for_every_format() {
    use depthplanes_io::formats::Limits;
    let refused = |bytes: &[u8], limits: Limits| {
        let options = DecodeOptions { limits, ..Default::default() };
        matches!(decode(bytes, &options), Err(Error::Limit { .. }))
    };
    for (name, kind, bytes) in valid_files() {
        let few = Limits { max_pixels: WIDTH * HEIGHT - 1, ..Default::default() };
        assert!(refused(&bytes, few), "{name} {kind}");
        let short = Limits { max_bytes: bytes.len() - 1, ..Default::default() };
        assert!(refused(&bytes, short), "{name} {kind}");
    }
    // 4 million zeros pack into a few thousand bytes.
    let zeros = png(2000, 2000, ColorType::Grayscale, BitDepth::Eight, &vec![0; 4_000_000]);
    assert!(zeros.len() < 20_000 && read(&zeros).is_ok());
    assert!(refused(&zeros, Limits { max_bytes: 1 << 20, ..Default::default() }));
    let array = zip(&[("a.npy", npy("|u1", false, "(2000, 2000)", &vec![0; 4_000_000]))], true);
    assert!(array.len() < 20_000 && read(&array).is_ok());
    assert!(refused(&array, Limits { max_bytes: 1 << 20, ..Default::default() }));
}

#[test]
fn headerless_samples_of_every_type() {
    let values = [0.0, 1.5, 2.25, 3.0, 4.0, 100.0];
    let read = |bytes: &[u8], raw_type: Option<&str>, size| {
        let options =
            DecodeOptions { raw_size: Some(size), raw_type: raw_type.map(str::to_string), ..Default::default() };
        decode(bytes, &options).map(|(image, _)| image)
    };
    let of = |little: &dyn Fn(f64) -> Vec<u8>| values.iter().flat_map(|value| little(*value)).collect::<Vec<u8>>();
    let little32 = of(&|value| (value as f32).to_le_bytes().to_vec());
    let big32 = of(&|value| (value as f32).to_be_bytes().to_vec());
    let little64 = of(&|value| value.to_le_bytes().to_vec());
    let big64 = of(&|value| value.to_be_bytes().to_vec());
    for (bytes, name, others) in [
        (&little32, "float32", ["float32", "f32", "<f4"]),
        (&big32, "float32-be", ["float32-be", "f32be", ">f4"]),
        (&little64, "float64", ["float64", "f64", "f8"]),
        (&big64, "float64-be", ["float64-be", "f64-be", ">f8"]),
    ] {
        let guessed = read(bytes, None, (3, 2)).unwrap();
        assert_eq!(as_f64(&guessed.pixels), values, "{name}");
        assert!(guessed.warnings[0].contains(&format!("read as {name};")), "{:?}", guessed.warnings);
        for stated in others {
            let image = read(bytes, Some(stated), (3, 2)).unwrap();
            assert_eq!((as_f64(&image.pixels), image.warnings), (values.to_vec(), vec![]), "{stated}");
        }
    }
    let millimetres = [0u32, 1500, 2250, 70_000, 4000, 100];
    let integers: Vec<u8> = millimetres.iter().flat_map(|value| value.to_le_bytes()).collect();
    let image = read(&integers, None, (3, 2)).unwrap();
    assert_eq!(as_f64(&image.pixels), millimetres.map(f64::from));
    assert!(image.warnings[0].contains("read as uint32"), "{:?}", image.warnings);
    assert_eq!(read(&[1, 2, 3, 4, 5, 6], None, (3, 2)).unwrap().pixels, Pixels::U8(vec![1, 2, 3, 4, 5, 6]));
    let swapped = read(&[1, 2, 3, 4], Some("uint16-be"), (2, 1)).unwrap();
    assert_eq!(swapped.pixels, Pixels::U16(vec![0x102, 0x304]));
    let noise: Vec<u8> = (0..24u32).map(|i| (i * 7919 % 251) as u8).collect();
    let error = read(&noise, None, (3, 2)).unwrap_err().to_string();
    assert!(error.contains("float32") && error.contains("--raw-type"), "{error}");
    let error = read(&noise, Some("float33"), (3, 2)).unwrap_err().to_string();
    assert!(error.contains("float33") && error.contains("float64-be"), "{error}");
}

#[test]
fn headerless_files_of_another_size_name_those_that_fit() {
    let wrong = |bytes: usize, size, raw_type: Option<&str>| {
        let options =
            DecodeOptions { raw_size: Some(size), raw_type: raw_type.map(str::to_string), ..Default::default() };
        decode(&vec![0x41; bytes], &options).unwrap_err().to_string()
    };
    assert!(wrong(2 * 640 * 480, (480, 360), None).contains("640x480 (2 bytes a pixel)"));
    assert!(wrong(4 * 256 * 192, (320, 240), None).contains("256x192 (4 bytes a pixel)"));
    assert!(wrong(2 * 848 * 480, (640, 480), Some("u16")).contains("848x480 (2 bytes a pixel) fits"));
    let header = wrong(2 * 320 * 240 + 54, (320, 240), None);
    assert!(header.contains("54 bytes more") && header.contains("tail -c +55"), "{header}");
    let options = DecodeOptions { raw_size: Some((9, 9)), ..Default::default() };
    let error = decode(&pgm(&depth()), &options).unwrap_err().to_string();
    assert!(error.contains("the file is pnm") && error.contains("leave --raw-size out"), "{error}");
}

#[test]
fn stacks_of_maps_and_arrays_of_other_numbers() {
    let bytes: Vec<u8> = (1..=24).collect();
    let member_of = |shape: &str, fortran, member: Option<&str>| {
        let options = DecodeOptions { member: member.map(str::to_string), ..Default::default() };
        decode(&npy("|u1", fortran, shape, &bytes), &options).map(|(image, _)| image)
    };
    let second = member_of("(2, 2, 6)", false, Some("1")).unwrap();
    assert_eq!((second.width, second.pixels), (6, Pixels::U8((13..=24).collect())));
    assert!(second.warnings[0].contains("map 1 of 2"), "{:?}", second.warnings);
    let columns = member_of("(2, 2, 6)", true, Some("0")).unwrap();
    assert_eq!(columns.pixels, Pixels::U8(vec![1, 5, 9, 13, 17, 21, 3, 7, 11, 15, 19, 23]));
    for member in [None, Some("2"), Some("-1"), Some("depth")] {
        let error = member_of("(2, 2, 6)", false, member).unwrap_err().to_string();
        assert!(error.contains("0 to 1") && error.contains("--member"), "{error}");
    }
    for (descr, said) in [
        ("|O", "pickled"),
        ("<c8", "complex"),
        ("|b1", "a mask"),
        ("<U4", "text"),
        ("<M8[ns]", "no numbers that are read"),
    ] {
        let error = wrong(&npy(descr, false, "(2, 2)", &[0; 64]));
        assert!(error.contains(said), "{error}");
    }
    let structured = npy("|u1", false, "(2, 2)", &[0; 64]);
    let at = structured.windows(5).position(|window| window == b"'|u1'").unwrap();
    let text =
        [&structured[10..at], b"[('z', '<f4'), ('c', '|u1')]", &structured[at + 5..structured.len() - 64]].concat();
    let length = (text.len() as u16).to_le_bytes();
    let error = wrong(&[&structured[..8], &length, &text, &[0; 64]].concat());
    assert!(error.contains("a structured array"), "{error}");
    let beyond: Vec<u8> = [1e300f64, 2.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let image = read(&npy("<f8", false, "(1, 2)", &beyond)).unwrap();
    assert!(image.warnings[0].contains("1 values beyond 3.4e38"), "{:?}", image.warnings);
}

#[test]
fn compressed_depth_is_inverse_depth_where_its_header_says_so() {
    use depthplanes_io::{ReadOptions, decode};
    let depths = [0.5, 1.0, 2.0, 4.0, 8.0];
    for (quantum, farthest) in [(100.0f64, 10.0), (100.0, 100.0), (20.0, 9.0)] {
        let (a, b) = (quantum * (quantum + 1.0), 1.0 - quantum * (quantum + 1.0) / farthest);
        let values: Vec<u16> = (0..35).map(|at| (a / depths[at % 5] + b) as u16).collect();
        let bytes = [config_header(a as f32, b as f32), rvl(7, 5, &values)].concat();
        let frame = decode(&bytes, "map", &ReadOptions::default()).unwrap();
        assert_eq!(frame.encoding, "compressed-depth");
        assert!(frame.warnings[0].contains("--encoding millimetre"), "{:?}", frame.warnings);
        for (value, depth) in values.iter().zip(depths) {
            let read = frame.sensor.value_kind.depth_m(f64::from(*value)).unwrap();
            // The value is cut to a whole number, by less than 1.
            assert!((1.0 / read - 1.0 / depth).abs() < 1.0 / a, "{read} is not {depth}");
        }
        let preset = ReadOptions { preset: Some("kinect1".into()), ..Default::default() };
        assert_eq!(decode(&bytes, "map", &preset).unwrap().encoding, "compressed-depth");
        let stated = ReadOptions { encoding: Some("mm".into()), ..Default::default() };
        let stated = decode(&bytes, "map", &stated).unwrap();
        assert_eq!(stated.encoding, "millimetre");
        assert!(stated.warnings.iter().all(|note| !note.contains("32FC1")), "{:?}", stated.warnings);
    }
    // What memory held: nothing, tiny, huge, not a number, and numbers that make no depths.
    for (a, b) in [(0.0, 0.0), (4.6e-41, 0.0), (1e30, -1e30), (f32::NAN, 1.0), (1.0, 0.0), (-10_100.0, -1009.0)] {
        let bytes = [config_header(a, b), rvl(7, 5, &depth())].concat();
        let frame = decode(&bytes, "map", &ReadOptions::default()).unwrap();
        assert_eq!(
            (frame.encoding, frame.warnings.iter().any(|w| w.contains("32FC1"))),
            ("millimetre", false),
            "{a} {b}"
        );
        let stated = ReadOptions { encoding: Some("compressed-depth".into()), ..Default::default() };
        assert!(decode(&bytes, "map", &stated).is_err());
    }
}

#[test]
fn files_of_other_kinds_are_named() {
    let mut tar = vec![b'x'; 300];
    tar[257..262].copy_from_slice(b"ustar");
    for (start, name) in [
        (&b"RIFF\x10\0\0\0WEBPVP8 "[..], "WebP"),
        (b"\0\0\0\x18ftypheic\0\0\0\0", "HEIC"),
        (b"\0\0\0\x1cftypavif\0\0\0\0", "AVIF"),
        (b"\0\0\0\x20ftypisom\0\0\x02\0", "MP4"),
        (b"GIF89a....", "GIF"),
        (b"\x89HDF\r\n\x1a\n", "HDF5"),
        (b"MATLAB 5.0 MAT-file", "MATLAB"),
        (b"ply\nformat ascii 1.0\n", "PLY"),
        (b"LASF\0\0\0\0", "LAS"),
        (b"#ROSBAG V2.0\n", "ROS 1 bag"),
        (b"SQLite format 3\0", "ROS 2"),
        (b"\x89MCAP0\r\n", "MCAP"),
        (b"\x80\x04\x95\x10\0\0\0", "pickle"),
        (b"%PDF-1.4\n", "PDF"),
        (b"\n <!DOCTYPE HTML><html>404", "web page"),
        (b"version https://git-lfs.github.com/spec/v1\noid", "git lfs pull"),
        (b"\x28\xb5\x2f\xfd....", "zstd"),
        (b"\xfd7zXZ\0....", "xz"),
        (b"{\"fx\": 500}", "--camera"),
        (b"1.5 2.5 3.5\n1.5 2.5 3.5\n", "numpy.loadtxt"),
        (b"P7\nWIDTH 2\n", "PAM"),
        (&tar, "tar"),
    ] {
        let error = wrong(start);
        assert!(error.contains(name), "{name}: {error}");
        assert!(error.contains("a depth map"), "{name}: {error}");
    }
}
