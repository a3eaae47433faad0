//! Planes of pixels that a program has already: a rectangle of a larger buffer, with a mark for missing ones.

use depthplanes::{DepthView, Detector, Intrinsics, Sensor, ValueKind};

pub(crate) fn main() -> depthplanes::Result<()> {
    // 160 x 120 pixels of depth in metres, in a buffer of 200 a row; a driver writes -1 for missing ones.
    let (width, height, stride) = (160, 120, 200);
    let mut buffer = vec![-1.0f32; stride * height];
    for v in 0..height {
        for u in 0..width {
            // Two walls that meet in column 80.
            let nearness = 0.4 + 0.002 * (u as f32 - 80.0).abs();
            buffer[v * stride + u] = if (7 * u + 13 * v) % 40 == 0 { -1.0 } else { 1.0 / nearness };
        }
    }
    let map = DepthView::with_stride(&buffer, width, height, stride)?;
    let sensor = Sensor::default()
        .value_kind(ValueKind::depth(1.0)?)
        .intrinsics(Some(Intrinsics::new(145.0, 145.0, 79.5, 59.5)?));
    let mut detector = Detector::default().sensor(sensor);
    let found = detector.detect(map)?;
    for plane in &found.planes {
        let ([x, y, z], distance) = (plane.normal().expect("metric"), plane.distance_m().expect("metric"));
        println!("{}: {} pixels, normal {x:.3} {y:.3} {z:.3}, {distance:.3} m", plane.label, plane.pixel_count);
    }
    let first = found.pixels_of(1).next().expect("a plane has pixels");
    println!("plane 1 begins at column {}, row {}", first[0], first[1]);
    assert_eq!(found.planes.len(), 2);
    Ok(())
}
