//! From a scene to the frame of a sensor.

use super::cast::cast;
use super::frame::SceneFrame;
use super::pose::Camera;
use super::sensors::SensorModel;
use super::sensors::exposure::Exposure;
use super::surfaces::Scene;
use super::truth::Truth;
use crate::error::Result;
use crate::sensor::Sensor;

/// What a sensor at the camera's place makes of a scene. The seed drives the sensor's noise alone.
///
/// # Errors
/// As [`Camera::check`].
///
/// ```
/// use depthplanes::scene::{Camera, Pose, Scene, SensorModel, render};
/// let mut scene = Scene::default();
/// // A wall two metres ahead.
/// scene.facet(&[[-9.0, 2.0, -9.0], [9.0, 2.0, -9.0], [9.0, 2.0, 9.0], [-9.0, 2.0, 9.0]]);
/// let camera = Camera::kinect(4, 3, Pose::at_height(1.0, 0.0))?;
/// let frame = render(&scene, &camera, SensorModel::CleanMm, 0)?;
/// assert_eq!(frame.value(0), 2000.0);
/// assert_eq!(frame.truth.planes[0].pixel_count, 12);
/// assert_eq!(frame.truth.planes[0].plane.normal, [0.0, 0.0, -1.0]);
/// # Ok::<(), depthplanes::Error>(())
/// ```
pub fn render(scene: &Scene, camera: &Camera, sensor: SensorModel, seed: u64) -> Result<SceneFrame> {
    render_frame(scene, camera, sensor, seed, None)
}

/// The same for a frame of a video: `lasting` drives the smooth part of the sensor's error, which its frames share.
pub(super) fn render_frame(
    scene: &Scene,
    camera: &Camera,
    sensor: SensorModel,
    seed: u64,
    lasting: Option<u64>,
) -> Result<SceneFrame> {
    camera.check()?;
    let seen = cast(scene, camera);
    let pixels = sensor.pixels(&Exposure { scene, camera, seen: &seen }, seed, lasting);
    let truth = Truth::new(scene, camera, seen);
    let sensor =
        Sensor { value_kind: sensor.value_kind(camera), intrinsics: Some(camera.intrinsics), ..Sensor::default() };
    Ok(SceneFrame { width: camera.width, height: camera.height, pixels, sensor, truth })
}
