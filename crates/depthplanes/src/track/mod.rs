//! Planes that keep their identity from frame to frame.
//!
//! In: the [`Detection`] of each frame, and the camera's pose if it is known. Out: [`Tracks`]: each plane with a lasting id
//! and filtered parameters, also while it is hidden for a few frames.
//!
//! ```
//! use depthplanes::{Detector, scene::Walk, track::Tracker};
//! let walk = Walk::new("planes3:size=320x240".parse()?, 1.0); // a camera that moves
//! let (mut detector, mut tracker) = (Detector::default(), Tracker::default());
//! let mut ids = Vec::new();
//! for index in 0..3 {
//!     let frame = walk.frame(index)?;
//!     detector = detector.sensor(frame.sensor);
//!     let tracks = tracker.track(detector.detect(frame.view())?, &frame.sensor, None)?;
//!     ids.push(tracks.ids.clone());
//! }
//! assert!(ids[0].len() == 3 && ids[1] == ids[0] && ids[2] == ids[0]);
//! # Ok::<(), depthplanes::Error>(())
//! ```
//!
//! A plane is the same if it is where it was, in the picture and in space. Where the pose is not known, the camera's motion
//! is estimated from the planes. The answer depends on the frames alone: the same ones give the same ids.

mod association;
mod borders;
mod egomotion;
mod field;
mod filter;
mod homography;
mod pose;
mod tracked;

pub use pose::CameraPose;
pub use tracked::{TrackState, TrackedPlane, Tracks};

use crate::camera::Intrinsics;
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::map::AnyView;
use crate::sensor::Sensor;
use association::Association;
use borders::Borders;
use field::Field;
use filter::State;
use homography::Homography;
use pose::Motion;

/// Frames for which a plane that is not seen is kept if nothing else is stated: a second of most cameras, in which a person
/// has walked by.
pub const KEPT_FRAMES: u32 = 30;
/// A plane is kept for no more than so many frames for each in which it was seen: what shows up once is often noise.
const KEPT_PER_SEEN: u32 = 10;

/// Follows planes from frame to frame, and reuses its memory.
#[derive(Clone, Debug)]
pub struct Tracker {
    kept_frames: u32,
    /// The last id that was given.
    last_id: u32,
    size: [usize; 2],
    pose: Option<CameraPose>,
    /// Filters of the tracks' planes, in their order.
    states: Vec<Option<State>>,
    /// Places of the tracks in the frame before; none of new ones.
    former: Vec<Option<usize>>,
    field: Field,
    association: Association,
    borders: Borders,
    tracks: Tracks,
}

impl Default for Tracker {
    fn default() -> Self {
        Tracker {
            kept_frames: KEPT_FRAMES,
            last_id: 0,
            size: [0; 2],
            pose: None,
            states: Vec::new(),
            former: Vec::new(),
            field: Field::default(),
            association: Association::default(),
            borders: Borders::default(),
            tracks: Tracks::default(),
        }
    }
}

impl Tracker {
    /// For how many frames a plane that is not seen keeps its id; [`KEPT_FRAMES`] by default.
    #[must_use]
    pub fn kept_frames(self, kept_frames: u32) -> Self {
        Tracker { kept_frames, ..self }
    }

    /// Forgets all planes: ids begin at 1 again.
    pub fn forget(&mut self) {
        *self = Tracker::default().kept_frames(self.kept_frames);
    }

    /// Takes in the next frame's planes. `pose` is the camera's, if it is known; without it, or without that of the frame
    /// before, the motion is estimated.
    ///
    /// In a frame of another size than the last one all planes are new.
    ///
    /// # Errors
    /// [`Error::Labels`] if the detection's labels are not `width * height` in number.
    pub fn track(&mut self, found: &Detection, sensor: &Sensor, pose: Option<&CameraPose>) -> Result<&Tracks> {
        self.follow(found, sensor, pose)?;
        self.borders.forget();
        self.tracks.labels.clear();
        Ok(&self.tracks)
    }

    /// As [`Tracker::track`], given the frame's map as well, by which it makes [`Tracks::labels`]: the label image whose
    /// borders do not flicker.
    ///
    /// # Errors
    /// As [`Tracker::track`], and [`Error::Labels`] if the map is not of the detection's size.
    pub fn track_with_map<'m>(
        &mut self,
        map: impl Into<AnyView<'m>>,
        found: &Detection,
        sensor: &Sensor,
        pose: Option<&CameraPose>,
    ) -> Result<&Tracks> {
        self.track_view(map.into(), found, sensor, pose)
    }

    fn track_view(
        &mut self,
        map: AnyView<'_>,
        found: &Detection,
        sensor: &Sensor,
        pose: Option<&CameraPose>,
    ) -> Result<&Tracks> {
        if [map.width(), map.height()] != [found.width, found.height] {
            return Err(Error::Labels { given: found.labels.len(), pixels: map.width() * map.height() });
        }
        let motion = self.follow(found, sensor, pose)?;
        let Tracks { ids, labels, .. } = &mut self.tracks;
        self.borders.hold(map, found, sensor, &motion, ids, labels);
        Ok(&self.tracks)
    }

    /// Brings all tracks to the next frame; returns how the camera moved.
    fn follow(&mut self, found: &Detection, sensor: &Sensor, pose: Option<&CameraPose>) -> Result<Motion> {
        let pixels = found.width * found.height;
        if found.labels.len() != pixels {
            return Err(Error::Labels { given: found.labels.len(), pixels });
        }
        if self.size != [found.width, found.height] {
            self.size = [found.width, found.height];
            self.field.forget();
            self.borders.forget();
        }
        let known = self.pose.zip(pose).map(|(before, now)| before.motion_to(now));
        self.pose = pose.copied();
        let motion = self.predict(found, sensor, known);
        self.association.assign(found, &self.field, &self.states, &self.tracks.planes);
        self.count_frames();
        self.name(found);
        self.field.renew(
            found,
            self.tracks.planes.len(),
            |track| self.tracks.planes[track].label,
            |track| self.former[track],
        );
        self.filter(found);
        Ok(motion)
    }

    /// Where the planes are now if they have not moved, and which labels are there; returns how the camera moved.
    fn predict(&mut self, found: &Detection, sensor: &Sensor, known: Option<Motion>) -> Motion {
        let motion = known.unwrap_or_else(|| {
            self.field.overlaps(found, &mut self.association.overlaps);
            self.association.egomotion(found, &self.field, &self.states)
        });
        if let Some(camera) = sensor.intrinsics.filter(|_| motion != Motion::NONE) {
            self.shift(&motion, &camera);
        }
        self.states.iter_mut().flatten().for_each(|state| state.predict(&motion));
        if known.is_some() || motion != Motion::NONE {
            self.field.overlaps(found, &mut self.association.overlaps);
        }
        motion
    }

    fn shift(&mut self, motion: &Motion, camera: &Intrinsics) {
        for (track, state) in self.states.iter().enumerate() {
            if let Some(state) = state {
                self.field.shift(track, &Homography::new(motion, &state.plane, camera));
            }
        }
    }

    /// What the association says of each track, and for how long.
    fn count_frames(&mut self) {
        let Association { labels, subsumed_by, .. } = &self.association;
        for (track, plane) in self.tracks.planes.iter_mut().enumerate() {
            plane.age = plane.age.saturating_add(1);
            plane.label = labels[track];
            plane.subsumed_by = subsumed_by[track];
            plane.state = match (plane.label, plane.subsumed_by) {
                (Some(_), _) => TrackState::Tracked,
                (None, Some(_)) => TrackState::Subsumed,
                (None, None) => TrackState::Lost,
            };
            let is_seen = plane.label.is_some();
            plane.seen = plane.seen.saturating_add(u32::from(is_seen));
            plane.unseen = if is_seen { 0 } else { plane.unseen.saturating_add(1) };
        }
    }

    /// Drops the tracks that were not seen for long, and makes new ones of the planes that have none.
    fn name(&mut self, found: &Detection) {
        let (tracks, former) = (&mut self.tracks, &mut self.former);
        former.clear();
        for track in 0..tracks.planes.len() {
            let TrackedPlane { seen, unseen, .. } = tracks.planes[track];
            if unseen <= self.kept_frames.min(KEPT_PER_SEEN.saturating_mul(seen)) {
                tracks.planes[former.len()] = tracks.planes[track];
                self.states[former.len()] = self.states[track];
                former.push(Some(track));
            }
        }
        tracks.planes.truncate(former.len());
        self.states.truncate(former.len());
        tracks.ids.clear();
        tracks.ids.resize(found.planes.len(), 0);
        for plane in &tracks.planes {
            if let Some(label) = plane.label {
                tracks.ids[usize::from(label) - 1] = plane.id;
            }
        }
        for (at, id) in tracks.ids.iter_mut().enumerate().filter(|(_, id)| **id == 0) {
            self.last_id += 1;
            *id = self.last_id;
            tracks.planes.push(TrackedPlane::new(*id, found.planes[at].label, self.association.split_from[at]));
            self.states.push(None);
            former.push(None);
        }
    }

    /// Brings the planes' parameters to what was found of them.
    fn filter(&mut self, found: &Detection) {
        for (plane, state) in self.tracks.planes.iter_mut().zip(&mut self.states) {
            if let Some(label) = plane.label {
                match (&mut *state, &found.planes[usize::from(label) - 1].metric) {
                    (Some(state), Some(metric)) => state.update(metric),
                    (state, metric) => *state = metric.as_ref().map(State::new),
                }
            }
            plane.plane = state.map(|state| state.plane);
            plane.covariance = state.map_or([[0.0; 4]; 4], |state| state.covariance());
        }
    }
}
