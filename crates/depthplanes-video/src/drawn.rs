//! Planes as they are drawn in space: outlines with ids. Recordings and messages for other programs have this in common.

use depthplanes::outline::{Outline, Outlines};
use depthplanes::track::Tracks;
use depthplanes::{Detection, Plane};

/// The pose of a camera that has none, as a quaternion x, y, z, w and a place: at the origin of a world whose z points up, looking
/// along x. It turns x right, y down and z ahead to that.
pub const POSE_AHEAD: ([f64; 4], [f64; 3]) = ([-0.5, 0.5, -0.5, 0.5], [0.0; 3]);

/// A plane that is seen and that has an outline in space.
#[derive(Clone, Copy, Debug)]
pub struct DrawnPlane<'a> {
    /// Its lasting number.
    pub id: u32,
    /// What was found of it in this frame.
    pub plane: &'a Plane,
    outline: Outline<'a>,
}

impl<'a> DrawnPlane<'a> {
    /// The corners of each ring, camera coordinates, metres: of every part of the plane, each followed by the holes in it. The
    /// first corner does not come again at the end.
    pub fn rings_m(&self) -> impl Iterator<Item = impl ExactSizeIterator<Item = [f64; 3]> + use<'a>> + use<'a> {
        let rings = self.outline.polygons().flat_map(|polygon| std::iter::once(polygon.outer()).chain(polygon.holes()));
        rings.filter_map(|ring| ring.points_m())
    }

    /// Where its id is written, camera coordinates, metres: the middle of its pixels.
    pub fn centroid_m(&self) -> Option<[f64; 3]> {
        self.plane.metric.map(|metric| metric.centroid_m)
    }
}

/// The planes of a frame that can be drawn in space, the largest first; none without a camera. `tracks` and `outlines` are those
/// of the detection.
///
/// ```
/// use depthplanes::{Detector, outline::Outliner, track::Tracker};
/// use depthplanes_video::{SourceOptions, drawn_planes, open};
/// let mut source = open("scene:boxes:sensor=kinect,size=160x120,frames=1", &SourceOptions::default())?;
/// let frame = source.next_frame().unwrap()?;
/// let (mut detector, mut tracker, mut outliner) = (Detector::default(), Tracker::default(), Outliner::default());
/// detector.set_sensor(frame.frame.sensor);
/// let found = detector.detect(frame.frame.view()?)?;
/// let tracks = tracker.track(found, &frame.frame.sensor, None)?;
/// let outlines = outliner.outline_labels(found, tracks.labels_of(found), &frame.frame.sensor)?;
/// for plane in drawn_planes(found, tracks, outlines) {
///     let corners: usize = plane.rings_m().map(|ring| ring.len()).sum();
///     assert!(plane.id > 0 && corners >= 3);
/// }
/// # Ok::<(), depthplanes_video::Error>(())
/// ```
pub fn drawn_planes<'a>(
    detection: &'a Detection,
    tracks: &'a Tracks,
    outlines: &'a Outlines,
) -> impl Iterator<Item = DrawnPlane<'a>> {
    detection.planes.iter().filter_map(|plane| {
        let outline = outlines.get(plane.label).filter(Outline::is_metric)?;
        Some(DrawnPlane { id: tracks.id_of(plane.label)?, plane, outline })
    })
}
