//! Frames become planes with ids: detection, tracking and, if it is wanted, the ground.

use super::watch::Watch;
use crate::args::Track;
use crate::commands::floor::record as floor_record;
use crate::failure::Outcome;
use crate::run::{Recipe, Runner};
use depthplanes::Detection;
use depthplanes::ground::{GroundFinder, Up};
use depthplanes::track::{CameraPose, Tracker, Tracks};
use depthplanes_io::{Frame, outputs};
use depthplanes_video::VideoFrame;
use serde_json::Value;
use std::time::Instant;

/// A frame that was read, and when that began.
pub(super) type Read = (Instant, u64, depthplanes_video::Result<VideoFrame>);

/// What is known of a frame in the end.
pub(super) struct Followed {
    pub(super) start: Instant,
    pub(super) index: u64,
    pub(super) name: String,
    pub(super) time_s: Option<f64>,
    pub(super) pose: Option<CameraPose>,
    pub(super) detection: Detection,
    pub(super) tracks: Tracks,
    /// The ground's record, if it was asked for.
    pub(super) ground: Option<Value>,
    /// The picture of the ground, where that is the overlay.
    pub(super) ground_png: Option<Vec<u8>>,
    /// The map, for pictures.
    pub(super) frame: Frame,
    /// Frames that were dropped before this one.
    pub(super) dropped: u64,
}

/// Follows the planes of one source.
pub(super) struct Follower<'a> {
    wanted: &'a Track,
    runner: Runner<'a>,
    tracker: Tracker,
    ground: GroundFinder,
    pub(super) watch: Watch,
}

impl<'a> Follower<'a> {
    pub(super) fn new(wanted: &'a Track, recipe: &'a Recipe) -> Outcome<Self> {
        let ground = GroundFinder::default().camera_height_m(wanted.camera_height)?;
        let tracker = wanted.kept_frames.map_or_else(Tracker::default, |frames| Tracker::default().kept_frames(frames));
        Ok(Follower { wanted, runner: Runner::new(recipe), tracker, ground, watch: Watch::default() })
    }

    /// The planes of the next frame.
    pub(super) fn follow(&mut self, start: Instant, video: VideoFrame, dropped: u64) -> Outcome<Followed> {
        self.watch.look(&video);
        let VideoFrame { index, name, time_s, up, frame, .. } = video;
        let pose = video.pose.filter(|_| !self.wanted.ignore_poses);
        let detection = self.runner.detect(&frame, 0)?.detection;
        let tracks = self.tracker.track(&detection, &frame.sensor, pose.as_ref())?.clone();
        let (mut ground, mut ground_png) = (None, None);
        if self.wanted.floor {
            let known = up.or(self.wanted.up).map_or(Ok(Up::Estimated), Up::known)?;
            self.ground = std::mem::take(&mut self.ground).up(known);
            let found = self.ground.find(frame.view()?, &detection, &frame.sensor)?;
            ground = Some(floor_record::record(&name, found, known));
            if self.wanted.overlays.is_some() {
                ground_png = Some(outputs::ground_png(frame.view()?, &frame.sensor, &detection, found)?);
            }
        }
        Ok(Followed { start, index, name, time_s, pose, detection, tracks, ground, ground_png, frame, dropped })
    }
}
