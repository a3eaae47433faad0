//! What the entities of a recording are in each frame. docs/video.md has the list.

use crate::depth::depth_image;
use crate::failure::Outcome;
use crate::names::{self, Names};
use crate::recording::Recording;
use depthplanes::Intrinsics;
use depthplanes::ground::{Ground, PlaneClass};
use depthplanes::outline::Outliner;
use depthplanes::track::CameraPose;
use depthplanes_io::outputs::id_colour;
use depthplanes_video::{DrawnPlane, POSE_AHEAD, Tracked, drawn_planes};
use re_log_types::TimePoint;
use re_sdk_types::archetypes::{
    Arrows3D, LineStrips3D, Pinhole, SegmentationImage, TextLog, Transform3D, ViewCoordinates,
};
use re_sdk_types::components::{ImageFormat, Radius, TextLogLevel};
use re_sdk_types::datatypes::{ChannelDatatype, ClassId, Quaternion, Rgba32};

/// The world of the poses; of a camera without pose, z up and x ahead.
const WORLD: &str = "world";
/// The camera: x right, y down, z ahead.
const CAMERA: &str = "world/camera";
const IMAGE: &str = "world/camera/image";
const DEPTH: &str = "world/camera/image/depth";
const IDS: &str = "world/camera/image/ids";
const GROUND: &str = "world/camera/image/ground";
const OUTLINES: &str = "world/camera/planes/outlines";
const NORMALS: &str = "world/camera/planes/normals";
/// What could not be read or searched, and what looks wrong.
const LOG: &str = "log";

/// Half the width of lines, points of the screen.
const LINE: f32 = 1.0;
/// Length of normals, metres.
const NORMAL_M: f64 = 0.2;

/// Writes one frame after the other.
pub(crate) struct Scene {
    recording: Recording,
    outliner: Outliner,
    names: Names,
    /// The camera and size that were written last.
    camera: Option<(Intrinsics, [usize; 2])>,
}

impl Scene {
    /// Writes what stays.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn new(mut recording: Recording) -> Outcome<Self> {
        let always = TimePoint::default();
        recording.log(WORLD, &always, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        recording.log(GROUND, &always, &names::of_marks())?;
        Ok(Scene { recording, outliner: Outliner::default(), names: Names::default(), camera: None })
    }

    /// Writes a frame.
    ///
    /// # Errors
    /// What the machine says, and ids that no label image holds.
    pub(crate) fn write(&mut self, time: &TimePoint, frame: &Tracked<'_>, ground: Option<&Ground>) -> Outcome {
        let size = [frame.detection.width, frame.detection.height];
        self.recording.log(CAMERA, time, &transform(frame.video.pose.as_ref()))?;
        self.camera(time, frame.video.frame.sensor.intrinsics, size)?;
        if let Some(depth) = depth_image(&frame.video.frame)? {
            self.recording.log(DEPTH, time, &depth)?;
        }
        if let Some(names) = frame.tracks.ids.iter().max().and_then(|id| self.names.up_to(*id)) {
            self.recording.log(CAMERA, &TimePoint::default(), &names)?;
        }
        self.recording.log(IDS, time, &labels(&frame.labels()?, size))?;
        if let Some(ground) = ground {
            // Without a floor nobody knows what pixels are.
            let unknown = || vec![0; size[0] * size[1]];
            let marks = if ground.marks.is_empty() { unknown() } else { ground.marks.clone() };
            self.recording.log(GROUND, time, &segmentation(marks, ChannelDatatype::U8, size))?;
        }
        let shown = frame.tracks.labels_of(frame.detection);
        let outlines = self.outliner.outline_labels(frame.detection, shown, &frame.video.frame.sensor)?;
        let planes: Vec<DrawnPlane<'_>> = drawn_planes(frame.detection, frame.tracks, outlines).collect();
        self.recording.log(OUTLINES, time, &rings(&planes))?;
        self.recording.log(NORMALS, time, &normals(&planes, frame, ground))
    }

    /// Writes that a frame could not be read or searched: the planes are those of no frame then.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn write_failed(&mut self, time: &TimePoint, error: &str) -> Outcome {
        self.recording.log(LOG, time, &TextLog::new(error).with_level(TextLogLevel::ERROR))?;
        self.recording.log(OUTLINES, time, &rings(&[]))?;
        self.recording.log(NORMALS, time, &Arrows3D::from_vectors([[0.0f32; 3]; 0]))
    }

    /// Writes what a person should know.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn note(&mut self, time: &TimePoint, text: &str) -> Outcome {
        self.recording.log(LOG, time, &TextLog::new(text).with_level(TextLogLevel::WARN))
    }

    /// As [`Recording::finish`].
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn finish(self) -> Outcome {
        self.recording.finish()
    }

    /// The camera where it is another one than before. Rerun has no distortion of a lens: the outlines are where they are in space,
    /// and the cloud that it draws of the map is that of a camera without.
    fn camera(&mut self, time: &TimePoint, camera: Option<Intrinsics>, size: [usize; 2]) -> Outcome {
        let Some(camera) = camera.filter(|camera| self.camera != Some((*camera, size))) else { return Ok(()) };
        self.camera = Some((camera, size));
        let [fx, fy, cx, cy] = [camera.fx, camera.fy, camera.cx, camera.cy].map(|number| number as f32);
        // By columns.
        let pinhole = Pinhole::new([[fx, 0.0, 0.0], [0.0, fy, 0.0], [cx, cy, 1.0]]);
        self.recording.log(IMAGE, time, &pinhole.with_resolution(size.map(|pixels| pixels as f32)))
    }
}

/// Where the camera stands.
fn transform(pose: Option<&CameraPose>) -> Transform3D {
    let (rotation, translation_m) = pose.map_or(POSE_AHEAD, |pose| (pose.quaternion(), pose.translation_m()));
    let rotation = Quaternion::from_xyzw(rotation.map(|number| number as f32));
    Transform3D::new().with_translation(translation_m).with_quaternion(rotation)
}

fn labels(labels: &[u16], size: [usize; 2]) -> SegmentationImage {
    let bytes: Vec<u8> = labels.iter().flat_map(|label| label.to_le_bytes()).collect();
    segmentation(bytes, ChannelDatatype::U16, size)
}

fn segmentation(bytes: Vec<u8>, samples: ChannelDatatype, size: [usize; 2]) -> SegmentationImage {
    SegmentationImage::new(bytes, ImageFormat::segmentation(size.map(|pixels| pixels as u32), samples))
}

/// The rings of all planes, each closed, with the ids of their planes.
fn rings(planes: &[DrawnPlane<'_>]) -> LineStrips3D {
    let rings = planes.iter().flat_map(|plane| {
        plane.rings_m().map(|ring| {
            let corners: Vec<[f64; 3]> = ring.collect();
            let closed: Vec<[f64; 3]> = corners.iter().chain(corners.first()).copied().collect();
            (plane.id, closed)
        })
    });
    let (ids, rings): (Vec<u32>, Vec<Vec<[f64; 3]>>) = rings.unzip();
    LineStrips3D::new(rings)
        .with_radii([Radius::new_ui_points(LINE)])
        .with_colors(ids.iter().map(|id| Rgba32::from(id_colour(*id))))
        .with_class_ids(ids.iter().map(|id| class(*id)))
        .with_labels(ids.iter().map(u32::to_string))
        .with_show_labels(false) // those of the normals are shown, one for each plane
}

/// A normal for each plane, filtered over the frames, with its id and what the plane is.
fn normals(planes: &[DrawnPlane<'_>], frame: &Tracked<'_>, ground: Option<&Ground>) -> Arrows3D {
    let arrow = |plane: &DrawnPlane<'_>| {
        let normal = frame.tracks.plane(plane.id)?.plane?.normal;
        Some((plane.id, plane.centroid_m()?, normal.map(|part| NORMAL_M * part), name(plane, ground)))
    };
    let arrows: Vec<_> = planes.iter().filter_map(arrow).collect();
    Arrows3D::from_vectors(arrows.iter().map(|(_, _, vector, _)| *vector))
        .with_origins(arrows.iter().map(|(_, origin, _, _)| *origin))
        .with_colors(arrows.iter().map(|(id, ..)| Rgba32::from(id_colour(*id))))
        .with_class_ids(arrows.iter().map(|(id, ..)| class(*id)))
        .with_labels(arrows.iter().map(|(.., name)| name.as_str()))
        .with_show_labels(true)
}

/// `7`, or `7 floor` where it is known what the plane is.
fn name(plane: &DrawnPlane<'_>, ground: Option<&Ground>) -> String {
    let classes = ground.map_or(&[][..], |ground| &ground.planes);
    match classes.iter().find(|class| class.label == plane.plane.label) {
        Some(known) if known.class != PlaneClass::Other => format!("{} {}", plane.id, known.class.name()),
        _ => plane.id.to_string(),
    }
}

/// The class of an id in the list of names; [`Tracked::labels`] refuses larger ones.
fn class(id: u32) -> ClassId {
    ClassId(id as u16)
}
