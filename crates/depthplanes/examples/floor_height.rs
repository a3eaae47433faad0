//! How high the camera is above the floor: the largest plane whose normal is near the direction that is up.

use depthplanes::Detector;
use depthplanes::scene::Spec;

/// Up in camera coordinates (x right, y down, z forward), from an IMU or from how the camera is mounted: here looking down by
/// 15 degrees.
const UP: [f64; 3] = [0.0, -0.966, -0.259];

pub(crate) fn main() -> depthplanes::Result<()> {
    let frame = "room:seed=2,sensor=azure,size=320x240".parse::<Spec>()?.frame()?;
    let mut detector = Detector::default().sensor(frame.sensor);
    let found = detector.detect(frame.view())?;
    let cosine = |normal: [f64; 3]| normal.iter().zip(UP).map(|(a, b)| a * b).sum::<f64>();
    let is_level = |normal: [f64; 3]| cosine(normal) > 0.95; // within 18 degrees
    let floor = found.planes.iter().find(|plane| plane.normal().is_some_and(is_level)).expect("a floor is in view");
    let metric = floor.metric.expect("it has a normal");
    let sigma = metric.covariance[3][3].sqrt();
    println!("{:.3} m above the floor, give or take {sigma:.3} m", metric.plane.distance);
    assert!((metric.plane.distance - 1.55).abs() < 3.0 * sigma);
    Ok(())
}
