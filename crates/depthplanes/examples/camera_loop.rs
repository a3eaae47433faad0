//! A camera's loop: one detector for all frames, polygons in metres, the time of each stage.

use depthplanes::outline::Outliner;
use depthplanes::scene::Spec;
use depthplanes::{Detector, Intrinsics};
use std::time::Instant;

pub(crate) fn main() -> depthplanes::Result<()> {
    let mut detector: Option<Detector> = None;
    let mut outliner = Outliner::new(1.5)?; // pixels that a polygon may be off
    for number in 1..=5 {
        // Here your camera's next frame.
        let frame = format!("stairs:seed={number},sensor=kinect,size=320x240").parse::<Spec>()?.frame()?;
        let camera: Intrinsics = frame.sensor.intrinsics.expect("a made-up camera is known");
        let detector = detector.get_or_insert_with(|| Detector::default().sensor(frame.sensor).threads(2));

        let (start, mut stages) = (Instant::now(), Vec::new());
        let found = detector.detect_observed(frame.view(), &mut |stage| stages.push((stage, start.elapsed())))?;
        let outlines = outliner.outline(found, Some(&camera))?;

        let slowest = stages.windows(2).max_by_key(|pair| pair[1].1 - pair[0].1).map_or("-", |pair| pair[1].0);
        println!("frame {number}: {} planes in {:.1?}, slowest stage {slowest}", found.planes.len(), start.elapsed());
        for outline in outlines.iter().take(3) {
            let polygon = outline.polygons().next().expect("a plane has an outer ring");
            let corners: Vec<[f64; 3]> = polygon.outer().points_m().into_iter().flatten().collect();
            println!("  plane {}: a polygon of {} corners, metres", outline.label(), corners.len());
        }
        assert!(!found.planes.is_empty());
    }
    Ok(())
}
