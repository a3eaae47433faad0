//! The planes of a frame as coloured surfaces for a 3-D viewer: `cargo run --example planes_to_ply -- OUT.ply`.

use depthplanes::Detector;
use depthplanes::outline::Outliner;
use depthplanes::scene::Spec;
use depthplanes_io::outputs::mesh_ply;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: planes_to_ply OUT.ply")?;
    surfaces(Path::new(&file))
}

pub(crate) fn surfaces(file: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let frame = "room:sensor=azure,size=320x240".parse::<Spec>()?.frame()?; // or your own pixels, unit and camera
    let mut detector = Detector::default().sensor(frame.sensor);
    let found = detector.detect(frame.view())?;
    let mut outliner = Outliner::new(2.0)?; // pixels that a surface's border may be off
    let outlines = outliner.outline(found, frame.sensor.intrinsics.as_ref())?;
    std::fs::write(file, mesh_ply(outlines))?; // metres; x right, y down, z forward
    println!("{} planes", outlines.iter().filter(|outline| outline.is_metric()).count());
    Ok(())
}
