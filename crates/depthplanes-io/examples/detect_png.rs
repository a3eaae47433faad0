//! The planes of a 16-bit PNG of depth: `cargo run --example detect_png -- FILE.png`.

use depthplanes::{Detector, Intrinsics};
use depthplanes_io::{ReadOptions, read};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: detect_png FILE.png")?;
    detect(Path::new(&file)).map(drop)
}

/// Prints the planes; how many there are.
pub(crate) fn detect(file: &Path) -> Result<usize, Box<dyn std::error::Error>> {
    let mut frame = read(file, &ReadOptions::default())?; // millimetres, unless the options or the file say otherwise
    frame.warnings.iter().for_each(|warning| eprintln!("note: {warning}"));
    let camera = Intrinsics::new(525.0, 525.0, 319.5, 239.5)?; // fx, fy, cx, cy in pixels: here your camera's
    frame.sensor = frame.sensor.intrinsics(camera);
    let mut detector = Detector::default().sensor(frame.sensor);
    let found = detector.detect(frame.view()?)?;
    for plane in &found.planes {
        let distance_m = plane.distance_m().expect("unit and camera are known");
        println!("{:3}  {:7} pixels, {distance_m:.3} m away", plane.label, plane.pixel_count);
    }
    Ok(found.planes.len())
}
