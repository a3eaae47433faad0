//! Writes the pixels of a synthetic frame, raw and little-endian, for benchmarks and oracles:
//! `bench_frame SPEC FILE`, SPEC as in `room:seed=1,sensor=kinect_white,size=640x480`. Prints its size.

use depthplanes::scene::{ScenePixels, Spec};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [spec, file] = &args[..] else {
        return Err("usage: bench_frame SPEC FILE".into());
    };
    let frame = spec.parse::<Spec>()?.frame()?;
    let bytes: Vec<u8> = match &frame.pixels {
        ScenePixels::U8(pixels) => pixels.clone(),
        ScenePixels::U16(pixels) => pixels.iter().flat_map(|value| value.to_le_bytes()).collect(),
        ScenePixels::F32(pixels) => pixels.iter().flat_map(|value| value.to_le_bytes()).collect(),
    };
    std::fs::write(file, bytes)?;
    println!("{} {}", frame.width, frame.height);
    Ok(())
}
