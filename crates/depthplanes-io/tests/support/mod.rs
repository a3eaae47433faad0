//! A small frame with three planes written by hand, and golden files.

use depthplanes::detection::{Detection, MapFit, MetricPlane, PixelBox, Plane};
use depthplanes::{HessianNormalForm, Intrinsics, Sensor, ValueKind};
use depthplanes_io::outputs::Report;
use depthplanes_io::{Frame, Pixels, Provenance};
use std::path::PathBuf;

pub const WIDTH: usize = 48;
pub const HEIGHT: usize = 32;

/// A floor in the lower half, a near box at the left, a far wall; one corner is missing.
pub fn frame() -> Frame {
    let value = |at: usize| match (at % WIDTH, at / WIDTH) {
        (u, v) if u > 40 && v < 4 => 0,
        (u, v) if u < 12 && v > 8 => 900,
        (_, v) if v >= 16 => 2500 - 40 * (v as u16 - 16),
        _ => 3000,
    };
    Frame {
        width: WIDTH,
        height: HEIGHT,
        pixels: Pixels::U16((0..WIDTH * HEIGHT).map(value).collect()),
        missing: None,
        valid_range: None,
        sensor: Sensor::default().value_kind(ValueKind::Depth { metres: 0.001 }).intrinsics(Some(Intrinsics {
            fx: 40.0,
            fy: 40.0,
            cx: 23.5,
            cy: 15.5,
        })),
        format: "png",
        encoding: "mm",
        provenance: Provenance { encoding: "stated".into(), ..Provenance::default() },
        warnings: vec!["made by hand".into()],
    }
}

pub fn detection() -> Detection {
    let label = |at: usize| match (at % WIDTH, at / WIDTH) {
        (u, v) if u > 40 && v < 4 => 0,
        (u, v) if u < 12 && v > 8 => 3,
        (u, v) if v >= 16 && u > 44 => 0,
        (_, v) if v >= 16 => 2,
        _ => 1,
    };
    let labels: Vec<u16> = (0..WIDTH * HEIGHT).map(label).collect();
    let planes = (1..=3).map(|label| plane(label, &labels)).collect();
    let valid_pixels = WIDTH * HEIGHT - 28;
    let mut detection = Detection::default();
    (detection.width, detection.height, detection.valid_pixels) = (WIDTH, HEIGHT, valid_pixels);
    (detection.labels, detection.planes) = (labels, planes);
    detection
}

fn plane(label: u16, labels: &[u16]) -> Plane {
    let mine: Vec<usize> = (0..labels.len()).filter(|&at| labels[at] == label).collect();
    let column = |at: &usize| (at % WIDTH) as u32;
    let row = |at: &usize| (at / WIDTH) as u32;
    let mean = |of: &dyn Fn(&usize) -> u32| mine.iter().map(|at| f64::from(of(at))).sum::<f64>() / mine.len() as f64;
    let mut metric = MetricPlane::new(HessianNormalForm { normal: [0.0, 0.0, -1.0], distance: 3.0 }, [0.1, -0.2, 3.0]);
    (metric.rms_m, metric.area_m2, metric.covariance) = (0.002, Some(3.5), [[0.25; 4]; 4]);
    let bounding_box = PixelBox {
        u_min: mine.iter().map(column).min().unwrap(),
        v_min: mine.iter().map(row).min().unwrap(),
        u_max: mine.iter().map(column).max().unwrap(),
        v_max: mine.iter().map(row).max().unwrap(),
    };
    let mut plane = Plane::new(label, mine.len(), bounding_box);
    plane.share_of_valid = mine.len() as f64 / (WIDTH * HEIGHT - 28) as f64;
    plane.centroid = [mean(&column), mean(&row)];
    plane.fit = (label < 3).then_some(MapFit { gradient: [0.0, -40.0], offset: 3140.0, rms: 0.5 });
    plane.metric = (label == 1).then_some(metric);
    plane
}

pub fn report<'a>(frame: &'a Frame, detection: &'a Detection) -> Report<'a> {
    let ngaf = depthplanes::methods::find("ngaf").unwrap();
    Report::new("room, left.png", frame, ngaf, &[1.5, 32.0, 0.0], detection)
}

/// Compares bytes with tests/golden/NAME; with DEPTHPLANES_GOLDEN=update it writes them instead.
pub fn golden(name: &str, actual: &[u8], same: fn(&[u8], &[u8]) -> bool) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var_os("DEPTHPLANES_GOLDEN").is_some_and(|value| value == "update") {
        std::fs::write(&path, actual).unwrap();
        return;
    }
    let expected = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(same(&expected, actual), "{name} has changed; if that is meant, run with DEPTHPLANES_GOLDEN=update");
}

/// The samples of a PNG, so that golden pictures do not depend on the compressor.
pub fn png_samples(bytes: &[u8]) -> (png::OutputInfo, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    let about = reader.next_frame(&mut samples).unwrap();
    (about, samples)
}
