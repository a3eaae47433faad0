//! Foxglove's messages of a frame: outlines and ids of the planes, label image, camera, and where the camera stands.
//!
//! Fields are those of <https://docs.foxglove.dev/docs/sdk/schemas>.

use super::proto::Proto;
use crate::commands::track::follow::Followed;
use crate::failure::Outcome;
use depthplanes::outline::Outliner;
use depthplanes::track::CameraPose;
use depthplanes::{DistortionModel, Sensor};
use depthplanes_io::outputs::id_colour;
use depthplanes_video::{DrawnPlane, POSE_AHEAD, drawn_planes};
use std::collections::BTreeSet;

/// The frame of coordinates of the map: x right, y down, z forward.
pub(super) const CAMERA: &str = "camera";
/// The one of the poses; of a camera without pose, z up and x forward.
const WORLD: &str = "world";
/// Width of outlines, pixels.
const LINE_PX: f64 = 2.0;
/// Height of an id, pixels.
const TEXT_PX: f64 = 14.0;

/// `google.protobuf.Timestamp` of nanoseconds.
fn stamp(time_ns: u64) -> Proto {
    Proto::default().number(1, time_ns / 1_000_000_000).number(2, time_ns % 1_000_000_000)
}

/// The colour of an id, as in pictures.
fn colour_of(id: u32) -> Proto {
    let [r, g, b] = id_colour(id).map(|part| f64::from(part) / 255.0);
    Proto::of(&[r, g, b, 1.0])
}

/// Where something stands that is not turned.
fn pose_at(point: [f64; 3]) -> Proto {
    Proto::default().message(1, Proto::of(&point)).message(2, Proto::of(&[0.0, 0.0, 0.0, 1.0]))
}

/// What the planes looked like in the frame before: entities that are gone now are deleted.
#[derive(Default)]
pub(super) struct Scene {
    outliner: Outliner,
    shown: BTreeSet<u32>,
}

impl Scene {
    /// `foxglove.SceneUpdate`.
    ///
    /// # Errors
    /// Those of outlines.
    pub(super) fn update(&mut self, frame: &Followed, time_ns: u64) -> Outcome<Vec<u8>> {
        let labels = frame.tracks.labels_of(&frame.detection);
        let outlines = self.outliner.outline_labels(&frame.detection, labels, &frame.video.frame.sensor)?;
        let (mut update, mut shown) = (Proto::default(), BTreeSet::new());
        for plane in drawn_planes(&frame.detection, &frame.tracks, outlines) {
            update = update.message(2, entity(&plane, time_ns));
            shown.insert(plane.id);
        }
        for id in self.shown.difference(&shown) {
            let deletion = Proto::default().message(1, stamp(time_ns)).number(2, 0).text(3, &id.to_string());
            update = update.message(1, deletion);
        }
        self.shown = shown;
        Ok(update.into_bytes())
    }
}

/// `foxglove.SceneEntity` of a plane.
fn entity(plane: &DrawnPlane<'_>, time_ns: u64) -> Proto {
    let (id, name) = (plane.id, plane.id.to_string());
    let mut entity = Proto::default().message(1, stamp(time_ns)).text(2, CAMERA).text(3, &name).number(5, 1);
    for points in plane.rings_m() {
        // A line that is closed, as wide at any distance.
        let line = Proto::default().number(1, 1).message(2, pose_at([0.0; 3])).double(3, LINE_PX).number(4, 1);
        let line = points.fold(line, |line, point| line.message(5, Proto::of(&point)));
        entity = entity.message(11, line.message(6, colour_of(id)));
    }
    match plane.centroid_m() {
        Some(at) => {
            let text = Proto::default().message(1, pose_at(at)).number(2, 1).double(3, TEXT_PX).number(4, 1);
            entity.message(13, text.message(5, colour_of(id)).text(6, &name))
        }
        None => entity,
    }
}

/// `foxglove.RawImage` of labels.
pub(super) fn label_image(labels: &[u16], [width, height]: [usize; 2], time_ns: u64) -> Vec<u8> {
    let mut bytes = vec![0; 2 * labels.len()];
    for (pair, label) in bytes.as_chunks_mut::<2>().0.iter_mut().zip(labels) {
        *pair = label.to_le_bytes();
    }
    let image = Proto::default().message(1, stamp(time_ns)).fixed32(2, width as u32).fixed32(3, height as u32);
    image.text(4, "mono16").fixed32(5, 2 * width as u32).bytes(6, &bytes).text(7, CAMERA).into_bytes()
}

/// `foxglove.CameraCalibration`; none for a camera that is not known.
pub(super) fn calibration(sensor: &Sensor, [width, height]: [usize; 2], time_ns: u64) -> Option<Vec<u8>> {
    let camera = sensor.intrinsics?;
    let (fx, fy, cx, cy) = (camera.fx, camera.fy, camera.cx, camera.cy);
    let (model, d) = lens(sensor);
    let message = Proto::default().message(1, stamp(time_ns)).fixed32(2, width as u32).fixed32(3, height as u32);
    let message = message
        .text(4, model)
        .doubles(5, &d)
        .doubles(6, &[fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0])
        .doubles(7, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])
        .doubles(8, &[fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]);
    Some(message.text(9, CAMERA).into_bytes())
}

/// The name and the coefficients of a lens as ROS has them; without distortion for a model that it does not have.
fn lens(sensor: &Sensor) -> (&'static str, Vec<f64>) {
    let none = ("plumb_bob", vec![0.0; 5]);
    let Some(distortion) = &sensor.distortion else { return none };
    let mut d = distortion.coefficients().to_vec();
    match distortion.model() {
        DistortionModel::KannalaBrandt => ("kannala_brandt", d),
        DistortionModel::BrownConrady => {
            let is_short = d.iter().skip(5).all(|&k| k == 0.0);
            d.resize(if is_short { 5 } else { 8 }, 0.0);
            (if is_short { "plumb_bob" } else { "rational_polynomial" }, d)
        }
        _ => none,
    }
}

/// `foxglove.FrameTransform` of the camera in the world.
pub(super) fn transform(pose: Option<&CameraPose>, time_ns: u64) -> Vec<u8> {
    let (rotation, translation) = pose.map_or(POSE_AHEAD, |pose| (pose.quaternion(), pose.translation_m()));
    let message = Proto::default().message(1, stamp(time_ns)).text(2, WORLD).text(3, CAMERA);
    message.message(4, Proto::of(&translation)).message(5, Proto::of(&rotation)).into_bytes()
}
