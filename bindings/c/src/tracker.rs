//! The tracker of C: planes that keep their ids from frame to frame.

use crate::border::lent;
use depthplanes::track::{CameraPose, TrackState, TrackedPlane, Tracker};
use depthplanes::{AnyView, Detection, Sensor};
use std::mem::MaybeUninit;

/// How a tracked plane stands in the newest frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum dp_track_state {
    /// Seen for the first time.
    DP_NEW = 0,
    /// Seen again.
    DP_TRACKED = 1,
    /// Not seen: hidden, out of the picture, or missed.
    DP_LOST = 2,
    /// Now part of another plane (`subsumed_by`); if they part again it gets its id back.
    DP_SUBSUMED = 3,
}

/// A plane over frames.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_track {
    /// Its lasting number, from 1; never given twice.
    pub id: u32,
    /// How it stands in this frame.
    pub state: dp_track_state,
    /// Its label in this frame's detection; 0 if it is lost or subsumed.
    pub label: u16,
    /// Frames since it was first seen, this one included.
    pub age: u32,
    /// Frames in which it was seen.
    pub seen: u32,
    /// Frames since it was last seen; 0 while it is.
    pub unseen: u32,
    /// Id of the plane that it is part of now; 0 if of none.
    pub subsumed_by: u32,
    /// Id of the plane that it was part of before; 0 if of none.
    pub split_from: u32,
    /// Unit normal, this frame's camera coordinates, filtered over the frames; NaN where metres are not known.
    pub normal: [f64; 3],
    /// Distance of the camera from the plane, perpendicular, metres; NaN where metres are not known.
    pub distance_m: f64,
    /// Covariance of (nx, ny, nz, distance), row by row.
    pub covariance: [[f64; 4]; 4],
}

impl From<&TrackedPlane> for dp_track {
    fn from(of: &TrackedPlane) -> Self {
        let state = match of.state {
            TrackState::New => dp_track_state::DP_NEW,
            TrackState::Tracked => dp_track_state::DP_TRACKED,
            TrackState::Subsumed => dp_track_state::DP_SUBSUMED,
            _ => dp_track_state::DP_LOST,
        };
        dp_track {
            id: of.id,
            state,
            label: of.label.unwrap_or(0),
            age: of.age,
            seen: of.seen,
            unseen: of.unseen,
            subsumed_by: of.subsumed_by.unwrap_or(0),
            split_from: of.split_from.unwrap_or(0),
            normal: of.plane.map_or([f64::NAN; 3], |plane| plane.normal),
            distance_m: of.plane.map_or(f64::NAN, |plane| plane.distance),
            covariance: of.plane.map_or([[f64::NAN; 4]; 4], |_| of.covariance),
        }
    }
}

/// Follows planes from frame to frame. What its functions return belongs to it, and is valid until the next frame or until it is
/// freed. Threads may read one at the same time.
#[derive(Default)]
pub struct dp_tracker {
    tracker: Tracker,
    tracks: Vec<dp_track>,
    labels: Vec<u16>,
}

impl dp_tracker {
    /// Takes in the next frame.
    ///
    /// # Errors
    /// Those of [`Tracker::track_with_map`].
    pub(crate) fn track(
        &mut self,
        map: AnyView<'_>,
        found: &Detection,
        sensor: &Sensor,
        pose: Option<&CameraPose>,
    ) -> depthplanes::Result<()> {
        let tracks = self.tracker.track_with_map(map, found, sensor, pose)?;
        self.tracks.clear();
        self.tracks.extend(tracks.planes.iter().map(dp_track::from));
        self.labels.clear();
        self.labels.extend_from_slice(&tracks.labels);
        Ok(())
    }
}

/// A tracker that keeps the id of a plane that is not seen for `kept_frames` frames; 0 for the usual number, 30.
#[unsafe(no_mangle)]
pub extern "C" fn dp_tracker_new(kept_frames: u32) -> Box<dp_tracker> {
    let tracker = if kept_frames == 0 { Tracker::default() } else { Tracker::default().kept_frames(kept_frames) };
    Box::new(dp_tracker { tracker, ..dp_tracker::default() })
}

/// Frees a tracker; null is none.
#[unsafe(no_mangle)]
pub extern "C" fn dp_tracker_free(tracker: Option<Box<dp_tracker>>) {
    drop(tracker);
}

/// The planes that are followed, by id: those of this frame, and those that are lost or subsumed. Their number is written to
/// `count`, unless that is null. Null if there are none.
#[unsafe(no_mangle)]
pub extern "C" fn dp_tracker_tracks(
    tracker: Option<&dp_tracker>,
    count: Option<&mut MaybeUninit<usize>>,
) -> *const dp_track {
    lent(tracker.map(|tracker| &tracker.tracks), count)
}

/// The id of a label of this frame; 0 if there is no such label.
#[unsafe(no_mangle)]
pub extern "C" fn dp_tracker_id(tracker: Option<&dp_tracker>, label: u16) -> u32 {
    let mut tracks = tracker.into_iter().flat_map(|tracker| &tracker.tracks);
    tracks.find(|track| label > 0 && track.label == label).map_or(0, |track| track.id)
}

/// This frame's label image with borders that do not flicker, row by row without gaps: where planes meet, pixels that lie on both
/// are of the one that they were of before. Labels are those of the detection. Null before the first frame.
#[unsafe(no_mangle)]
pub extern "C" fn dp_tracker_labels(tracker: Option<&dp_tracker>) -> *const u16 {
    lent(tracker.map(|tracker| &tracker.labels), None)
}
