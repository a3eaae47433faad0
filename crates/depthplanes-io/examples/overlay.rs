//! A picture of the planes in a buffer of depth: `cargo run --example overlay -- OUT.png`.

use depthplanes::scene::{ScenePixels, Spec};
use depthplanes::{DepthView, Detector, Sensor};
use depthplanes_io::outputs::overlay_png;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: overlay OUT.png")?;
    picture(Path::new(&file))
}

pub(crate) fn picture(file: &Path) -> Result<(), Box<dyn std::error::Error>> {
    // Your own buffer instead: 16-bit millimetres, row by row, 0 where nothing was measured.
    let frame = "room:sensor=kinect,size=320x240".parse::<Spec>()?.frame()?;
    let ScenePixels::U16(depth_mm) = &frame.pixels else { unreachable!("this sensor has 16 bits") };

    let (map, sensor) = (DepthView::new(depth_mm, 320, 240)?, Sensor::default());
    let mut detector = Detector::default().sensor(sensor);
    std::fs::write(file, overlay_png(map, &sensor, detector.detect(map)?, None)?)?;
    Ok(())
}
