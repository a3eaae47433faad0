//! Values that are spread over the channels of a picture: read by encodings of their own, and named where none is stated.

mod common;

use common::*;
use depthplanes_io::encoding::{ENCODINGS, by_name};
use depthplanes_io::{Frame, Pixels, ReadOptions, decode};
use png::{BitDepth, ColorType};

const W: usize = 64;
const H: usize = 48;

fn named(encoding: &str, scale: Option<f64>) -> ReadOptions {
    ReadOptions { encoding: Some(encoding.into()), scale, ..Default::default() }
}

fn depths_m(frame: &Frame) -> Vec<f64> {
    let depth = |value: f64| frame.sensor.value_kind.depth_m(value).unwrap_or(f64::NAN);
    match &frame.pixels {
        Pixels::U8(values) => values.iter().map(|value| depth(f64::from(*value))).collect(),
        Pixels::U16(values) => values.iter().map(|value| depth(f64::from(*value))).collect(),
        Pixels::F32(values) => values.iter().map(|value| depth(f64::from(*value))).collect(),
    }
}

/// Three scenes, metres: a slanted wall, a floor with a box before it, and a noisy wall with gaps.
fn scenes() -> [Vec<f64>; 3] {
    let map = |of: &dyn Fn(f64, f64) -> f64| (0..W * H).map(|at| of((at % W) as f64, (at / W) as f64)).collect();
    let noise = |u: f64, v: f64| ((u * 12.9898 + v * 78.233).sin() * 43_758.545_3).fract() * 0.004;
    let is_gap = |u: f64, v: f64| (u as usize * 7 + v as usize * 3).is_multiple_of(11);
    [
        map(&|u, v| 2.0 + 0.02031 * u + 0.00473 * v),
        map(&|u, v| if (20.0..34.0).contains(&u) && (10.0..30.0).contains(&v) { 1.3 } else { 90.0 / (30.0 + v) }),
        map(&|u, v| if is_gap(u, v) { 0.0 } else { 1.5 + 0.03 * v + noise(u, v) }),
    ]
}

/// The bytes of a number, the lowest first.
fn digits(value: f64) -> [u8; 4] {
    (value.round() as u32).to_le_bytes()
}

type Pack = fn(f64) -> Vec<u8>;

/// Encoding, its scale, how a depth is packed, and by how much it is rounded, metres.
#[rustfmt::skip]
const PACKINGS: &[(&str, Option<f64>, Pack, f64)] = &[
    ("bytes-high-low", None, |z| { let d = digits(z * 1e3); vec![d[1], d[0]] }, 6e-4),
    ("bytes-low-high", None, |z| { let d = digits(z * 1e3); vec![d[0], d[1]] }, 6e-4),
    ("bytes-high-low", None, |z| { let d = digits(z * 1e3); vec![d[1], d[0], 0] }, 6e-4),
    ("bytes-low-high", None, |z| { let d = digits(z * 1e3); vec![0, d[0], d[1]] }, 6e-4),
    ("bytes-low-high", None, |z| { let d = digits(z * 1e3); vec![d[0], d[1], 0, 255] }, 6e-4),
    ("bytes-high-low", None, |z| { let d = digits(z * 1e3); vec![d[1], d[1], d[1], d[0]] }, 6e-4),
    ("rgb24-carla", None, |z| { let d = digits(z * 16_777.215); vec![d[0], d[1], d[2]] }, 6e-5),
    ("rgb24-carla", None, |z| { let d = digits(z * 16_777.215); vec![d[0], d[1], d[2], 255] }, 6e-5),
    ("rgb24-high-low", Some(256_000.0), |z| { let d = digits(z * 256e3); vec![d[2], d[1], d[0]] }, 6e-6),
    ("rgba-float-little-endian", None, |z| (z as f32).to_le_bytes().to_vec(), 1e-6),
    ("rgba-float-big-endian", None, |z| (z as f32).to_be_bytes().to_vec(), 1e-6),
    ("rgba-float-big-endian", Some(1000.0), |z| (z as f32 * 1e3).to_be_bytes().to_vec(), 1e-5),
];

/// The same picture in every format that has its channels.
fn pictures(samples: &[u8], channels: usize) -> Vec<(&'static str, Vec<u8>)> {
    let color = [ColorType::GrayscaleAlpha, ColorType::Rgb, ColorType::Rgba][channels - 2];
    let wide: Vec<u8> = samples.iter().flat_map(|byte| [*byte, *byte]).collect(); // 257 times as much
    let mut files = vec![
        ("png", png(W, H, color, BitDepth::Eight, samples)),
        ("png of 16 bits", png(W, H, color, BitDepth::Sixteen, &wide)),
        ("npy", npy("|u1", false, &format!("({H}, {W}, {channels})"), samples)),
        ("npz", zip(&[("rgb.npy", npy("|u1", false, &format!("({H}, {W}, {channels})"), samples))], true)),
    ];
    if channels == 3 {
        files.push(("ppm", [format!("P6 {W} {H} 255\n").into_bytes(), samples.to_vec()].concat()));
        let floats: Vec<u8> = samples.chunks(3 * W).rev().flatten().flat_map(|b| f32::from(*b).to_le_bytes()).collect();
        files.push(("pfm", [format!("PF {W} {H} -1\n").into_bytes(), floats].concat()));
    }
    if channels >= 3 {
        let mut bgr = samples.to_vec();
        bgr.chunks_exact_mut(channels).for_each(|pixel| pixel.swap(0, 2));
        let rows: Vec<Vec<u8>> = bgr.chunks(channels * W).rev().map(<[u8]>::to_vec).collect();
        files.push(("bmp", bmp(W as i32, H as i32, 8 * channels as u16, &[], &rows)));
    }
    files
}

/// The encoding and scale that a message says first.
fn first_guess(message: &str) -> (String, Option<f64>) {
    let rest = message.split("try --encoding ").nth(1).unwrap_or_else(|| panic!("no guess in {message}"));
    let guess = rest.split([',', ';']).next().unwrap();
    let mut words = guess.split(" --scale ");
    (words.next().unwrap().to_string(), words.next().map(|scale| scale.parse().unwrap()))
}

#[test]
fn spread_bytes_are_named_and_the_encoding_named_first_reads_them() {
    for (encoding, scale, pack, within) in PACKINGS {
        for (index, scene) in scenes().iter().enumerate() {
            let samples: Vec<u8> = scene.iter().flat_map(|z| pack(*z)).collect();
            for (format, file) in pictures(&samples, samples.len() / scene.len()) {
                let what = format!("{encoding} {scale:?}, scene {index}, {format}");
                let message = decode(&file, "map", &ReadOptions::default()).expect_err(&what).to_string();
                assert!(message.contains("the bytes of one value"), "{what}: {message}");
                assert_eq!(first_guess(&message), (encoding.to_string(), *scale), "{what}: {message}");
                let frame = decode(&file, "map", &named(encoding, *scale)).unwrap_or_else(|e| panic!("{what}: {e}"));
                for (read, right) in depths_m(&frame).iter().zip(scene) {
                    assert!(*right == 0.0 || (read - right).abs() < *within, "{what}: {read} is not {right}");
                }
            }
        }
    }
}

#[test]
fn every_encoding_of_channels_is_read_by_a_test() {
    for encoding in ENCODINGS.iter().filter(|encoding| encoding.channels) {
        let is_tested = PACKINGS.iter().any(|(name, ..)| *name == encoding.name);
        assert!(is_tested || encoding.name == "rgb24-low-high", "{}", encoding.name);
    }
    let picture = png(1, 1, ColorType::Rgb, BitDepth::Eight, &[0x10, 0x20, 0x01]);
    let value = |encoding: &str| depths_m(&decode(&picture, "map", &named(encoding, None)).unwrap())[0];
    // 0x012010 = 73744 and 0x102001 = 1056769 millimetres; a part of 1000 m.
    assert!((value("rgb24-low-high") - 73.744).abs() < 1e-9);
    assert!((value("rgb24-high-low") - 1056.769).abs() < 1e-9);
    assert!((value("carla") - 73_744.0 / 16_777.215).abs() < 1e-9);
    let near = decode(&picture, "map", &named("carla", Some(100.0))).unwrap();
    assert!((depths_m(&near)[0] - 7_374.4 / 16_777.215).abs() < 1e-9);
    assert_eq!(by_name("carla").unwrap().name, "rgb24-carla");
}

#[test]
fn the_sky_of_carla_is_missing() {
    let picture = png(2, 1, ColorType::Rgb, BitDepth::Eight, &[255, 255, 255, 0, 0, 4]);
    let frame = decode(&picture, "map", &named("carla", None)).unwrap();
    let valid = depthplanes::with_view!(frame.view().unwrap(), view => view.valid_pixels());
    assert_eq!(valid, 1);
}

/// Colours of a scale from 0 to 1: jet, viridis and inferno (by their control points), hot and a grey-blue.
fn colours(t: f64) -> [[u8; 3]; 5] {
    let byte = |value: f64| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    let between = |points: &[[f64; 3]]| {
        let at = t * (points.len() - 1) as f64;
        let below = (at as usize).min(points.len() - 2);
        let part = at - below as f64;
        [0, 1, 2].map(|c| byte((points[below][c] * (1.0 - part) + points[below + 1][c] * part) / 255.0))
    };
    let viridis = [[68., 1., 84.], [62., 74., 137.], [31., 158., 137.], [109., 205., 89.], [253., 231., 37.]];
    let inferno = [[0., 0., 4.], [85., 15., 109.], [186., 54., 85.], [249., 140., 10.], [252., 255., 164.]];
    [
        [3.0, 2.0, 1.0].map(|k| byte(1.5 - (4.0 * t - k).abs())),
        between(&viridis),
        between(&inferno),
        [byte(3.0 * t), byte(3.0 * t - 1.0), byte(3.0 * t - 2.0)],
        [byte(t), byte(t), byte(0.2 + 0.8 * t)],
    ]
}

#[test]
fn colourised_pictures_are_named_as_before() {
    for (index, scene) in scenes().iter().enumerate() {
        let far = scene.iter().copied().fold(0.0, f64::max);
        for scale in 0..5 {
            for ripple in [0.0, 6.0] {
                // As a lossy picture has it.
                let lossy = |at: usize, byte: u8| {
                    let wave = ripple * ((at % 8) as f64 * 0.9).cos() * ((at / W % 8) as f64 * 0.7).sin();
                    (f64::from(byte) + wave).round().clamp(0.0, 255.0) as u8
                };
                let pixel = |(at, z): (usize, &f64)| colours(z / far)[scale].map(|byte| lossy(at, byte));
                let samples: Vec<u8> = scene.iter().enumerate().flat_map(pixel).collect();
                let opaque: Vec<u8> = samples.chunks(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect();
                for (format, file) in pictures(&samples, 3).into_iter().chain(pictures(&opaque, 4)) {
                    let message = decode(&file, "map", &ReadOptions::default()).unwrap_err().to_string();
                    let what = format!("scene {index}, colours {scale}, ripple {ripple}, {format}");
                    assert!(message.contains("colourised picture"), "{what}: {message}");
                }
            }
        }
    }
}

#[test]
fn opacity_that_is_a_mask_is_noted() {
    let grey = |at: usize| (40 + at % W + at / W) as u8;
    type Opacity = fn(usize) -> u8;
    let opacities: [(Opacity, &str); 3] = [
        (|_| 255, "the opacity channel is ignored"),
        (|at| if at % W < 30 { 0 } else { 255 }, "the opacity channel is ignored"),
        (|at| (4 * (at % W)) as u8, "the opacity channel is ignored; if it holds the low or high byte"),
    ];
    for (opacity, note) in opacities {
        let samples: Vec<u8> = (0..W * H).flat_map(|at| [grey(at), opacity(at)]).collect();
        let file = png(W, H, ColorType::GrayscaleAlpha, BitDepth::Eight, &samples);
        let frame = decode(&file, "map", &ReadOptions::default()).unwrap();
        assert!(frame.warnings[0].starts_with(note), "{:?}", frame.warnings);
        assert_eq!(frame.warnings[0] == note, !note.contains(';'));
    }
}

#[test]
fn a_high_byte_that_is_the_same_everywhere_is_named() {
    let low = |at: usize| (at % W + 3 * (at / W)) as u8;
    for (pixel, encoding) in [
        ((|low| vec![7, low, 0]) as fn(u8) -> Vec<u8>, "bytes-high-low"),
        (|low| vec![low, 7, 0], "bytes-low-high"),
        (|low| vec![7, low], "bytes-high-low"),
    ] {
        let samples: Vec<u8> = (0..W * H).flat_map(|at| pixel(low(at))).collect();
        let (_, file) = pictures(&samples, pixel(0).len()).remove(0);
        let message = decode(&file, "map", &ReadOptions::default()).unwrap_err().to_string();
        assert_eq!(first_guess(&message).0, encoding, "{message}");
        let frame = decode(&file, "map", &named(encoding, None)).unwrap();
        assert!((depths_m(&frame)[5] - 1.797).abs() < 1e-9, "7 * 256 + 5 millimetres");
    }
}

#[test]
fn encodings_of_channels_refuse_other_pictures() {
    let grey = png(2, 1, ColorType::Grayscale, BitDepth::Eight, &[1, 2]);
    let deep = png(1, 1, ColorType::Rgb, BitDepth::Sixteen, &[1, 2, 3, 4, 5, 6]);
    let rgb = png(2, 1, ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6]);
    for (file, encoding, said) in [
        (&grey, "rgb24-carla", "this one has 1 of uint8"),
        (&grey, "bytes-high-low", "this one has 1 of uint8"),
        (&deep, "rgb24-carla", "this one has 3 of uint16"),
        (&rgb, "rgba-float-big-endian", "this one has 3 of uint8"),
        (&rgb, "bytes-high-low", "here 3 do"),
    ] {
        let message = decode(file, "map", &named(encoding, None)).unwrap_err().to_string();
        assert!(message.contains(said), "{encoding}: {message}");
    }
}
