//! What is known of a plane that is followed from frame to frame.

use crate::camera::HessianNormalForm;
use crate::detection::Detection;

/// How a tracked plane stands in the newest frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum TrackState {
    /// Seen for the first time.
    New,
    /// Seen again.
    Tracked,
    /// Not seen: hidden, out of the picture, or missed.
    Lost,
    /// Now part of another plane ([`TrackedPlane::subsumed_by`]); if they part again it gets its id back.
    Subsumed,
}

impl TrackState {
    /// `new`, `tracked`, `lost` or `subsumed`, as in records.
    pub fn name(self) -> &'static str {
        match self {
            TrackState::New => "new",
            TrackState::Tracked => "tracked",
            TrackState::Lost => "lost",
            TrackState::Subsumed => "subsumed",
        }
    }
}

/// A plane over frames.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct TrackedPlane {
    /// Its lasting number, from 1; never given twice.
    pub id: u32,
    /// How it stands in this frame.
    pub state: TrackState,
    /// Its label in this frame's [`crate::Detection`]; `None` of planes that are lost or subsumed.
    pub label: Option<u16>,
    /// Frames since it was first seen, this one included.
    pub age: u32,
    /// Frames in which it was seen.
    pub seen: u32,
    /// Frames since it was last seen; 0 while it is.
    pub unseen: u32,
    /// The plane that it is part of now.
    pub subsumed_by: Option<u32>,
    /// The plane that it was part of before.
    pub split_from: Option<u32>,
    /// Its parameters in this frame's camera coordinates, filtered over the frames; `None` of planes that are not metric.
    pub plane: Option<HessianNormalForm>,
    /// Covariance of (nx, ny, nz, distance), row by row; 0 without `plane`. Its white part shrinks as frames are averaged,
    /// the rest does not.
    pub covariance: [[f64; 4]; 4],
}

impl TrackedPlane {
    pub(super) fn new(id: u32, label: u16, split_from: Option<u32>) -> Self {
        TrackedPlane {
            id,
            state: TrackState::New,
            label: Some(label),
            age: 1,
            seen: 1,
            unseen: 0,
            subsumed_by: None,
            split_from,
            plane: None,
            covariance: [[0.0; 4]; 4],
        }
    }
}

/// All planes that are followed.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Tracks {
    /// By id: those of this frame, and those that are lost or subsumed.
    pub planes: Vec<TrackedPlane>,
    /// The ids of this frame's labels: label 1 has the first.
    pub ids: Vec<u32>,
    /// The frame's label image with borders that do not flicker: where planes meet, pixels that lie on both are of the one that
    /// they were of before. Made by [`Tracker::track_with_map`](super::Tracker::track_with_map), otherwise empty. The planes of
    /// the [`Detection`](crate::Detection) are those of its own label image.
    pub labels: Vec<u16>,
}

impl Tracks {
    /// The id of a label of this frame; `None` for 0 and for a label that does not occur.
    pub fn id_of(&self, label: u16) -> Option<u32> {
        self.ids.get(usize::from(label).checked_sub(1)?).copied()
    }

    /// The label image to be shown: [`Tracks::labels`] if it was made, else the detection's own.
    pub fn labels_of<'a>(&'a self, found: &'a Detection) -> &'a [u16] {
        if self.labels.len() == found.labels.len() { &self.labels } else { &found.labels }
    }

    /// The plane of that id; `None` if it is not followed any more.
    pub fn plane(&self, id: u32) -> Option<&TrackedPlane> {
        let at = self.planes.binary_search_by_key(&id, |plane| plane.id).ok()?;
        self.planes.get(at)
    }
}
