//! A camera's loop: one detector for all frames, polygons in metres, the time of each stage.

use depthplanes::outline::Outliner;
use depthplanes::scene::Spec;
use depthplanes::{Detector, Intrinsics};
use std::time::{Duration, Instant};

pub(crate) fn main() -> depthplanes::Result<()> {
    let mut detector: Option<Detector> = None;
    let mut outliner = Outliner::new(1.5)?; // pixels that a polygon may be off
    for number in 1..=5 {
        // Here your camera's next frame.
        let frame = format!("stairs:seed={number},sensor=kinect,size=320x240").parse::<Spec>()?.frame()?;
        let camera: Intrinsics = frame.sensor.intrinsics.expect("a synthetic camera is known");
        let detector = detector.get_or_insert_with(|| Detector::default().sensor(frame.sensor).threads(2));

        let (start, mut before, mut stages) = (Instant::now(), Duration::ZERO, Vec::new());
        let found = detector.detect_observed(frame.view(), &mut |stage| {
            let now = start.elapsed();
            stages.push((now - before, stage));
            before = now;
        })?;
        let outlines = outliner.outline(found, Some(&camera))?;

        let (time, slowest) = stages.iter().max().expect("a method has stages");
        println!("frame {number}: {} planes, {time:.1?} of {before:.1?} in stage {slowest}", found.planes.len());
        for outline in outlines.iter().take(3) {
            let polygon = outline.polygons().next().expect("a plane has an outer ring");
            let corners: Vec<[f64; 3]> = polygon.outer().points_m().into_iter().flatten().collect();
            println!("  plane {}: a polygon of {} corners, metres", outline.label(), corners.len());
        }
        assert!(!found.planes.is_empty());
    }
    Ok(())
}
