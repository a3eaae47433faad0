//! Planes get their ids, one frame after the other.

use super::find::{Found, Ground, Searched};
use super::watch::Watch;
use crate::args::Track;
use crate::failure::Outcome;
use depthplanes::Detection;
use depthplanes::track::{Tracker, Tracks};
use depthplanes_video::{Tracked, VideoFrame};
use std::time::Instant;

/// What is known of a frame in the end.
pub(super) struct Followed {
    pub(super) start: Instant,
    /// The frame, whose pose is the one that was used.
    pub(super) video: VideoFrame,
    pub(super) detection: Detection,
    pub(super) tracks: Tracks,
    pub(super) ground: Option<Ground>,
    /// Frames that were dropped before this one.
    pub(super) dropped: u64,
}

impl Followed {
    /// The highest id of the planes that are seen; ids are given in turn, from 1.
    pub(super) fn last_id(&self) -> u32 {
        self.detection.planes.iter().filter_map(|plane| self.tracks.id_of(plane.label)).max().unwrap_or(0)
    }

    /// As outputs take it.
    pub(super) fn tracked(&self) -> Tracked<'_> {
        let Followed { video, detection, tracks, ground, dropped, .. } = self;
        Tracked { video, detection, tracks, ground: ground.as_ref().map(|ground| &ground.record), dropped: *dropped }
    }
}

/// Follows the planes of one source.
pub(super) struct Follower {
    tracker: Tracker,
    ignore_poses: bool,
    pub(super) watch: Watch,
}

impl Follower {
    pub(super) fn new(wanted: &Track) -> Self {
        let tracker = wanted.kept_frames.map_or_else(Tracker::default, |frames| Tracker::default().kept_frames(frames));
        Follower { tracker, ignore_poses: wanted.ignore_poses, watch: Watch::new(wanted) }
    }

    /// The planes of the next frame.
    ///
    /// # Errors
    /// What kept the frame from being read or searched.
    pub(super) fn follow(&mut self, searched: Searched) -> Outcome<Followed> {
        let Searched { start, dropped, outcome, .. } = searched;
        let (mut video, found) = outcome?;
        self.watch.look(&video);
        let Found { detection, ground } = found?;
        ground.iter().for_each(|ground| self.watch.look_at_ground(ground));
        video.pose = video.pose.filter(|_| !self.ignore_poses);
        let VideoFrame { frame, pose, .. } = &video;
        let tracks = self.tracker.track_with_map(frame.view()?, &detection, &frame.sensor, pose.as_ref())?.clone();
        Ok(Followed { start, video, detection, tracks, ground, dropped })
    }
}
