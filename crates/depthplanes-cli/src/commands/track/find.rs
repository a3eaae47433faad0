//! Frames become planes and, if it is wanted, the ground. Each thread has a finder of its own; no frame knows another.

use crate::args::Track;
use crate::failure::{Failure, Outcome};
use crate::run::{Recipe, Runner};
use depthplanes::Detection;
use depthplanes::ground::{GroundFinder, Up};
use depthplanes_io::outputs;
use depthplanes_video::VideoFrame;
use serde_json::Value;
use std::time::Instant;

/// A frame that was read, and when that was done.
pub(super) struct Read {
    pub(super) start: Instant,
    pub(super) index: u64,
    pub(super) frame: depthplanes_video::Result<VideoFrame>,
}

/// What was found in a frame.
pub(super) struct Found {
    pub(super) detection: Detection,
    pub(super) ground: Option<Ground>,
}

/// The ground of a frame: its record, and its picture where that is the overlay.
pub(super) struct Ground {
    pub(super) record: Value,
    pub(super) png: Option<Vec<u8>>,
}

/// A frame that was searched; a frame that was read and fails is kept for what its map has to say.
pub(super) struct Searched {
    pub(super) start: Instant,
    pub(super) index: u64,
    /// Frames that were dropped before this one.
    pub(super) dropped: u64,
    pub(super) outcome: Outcome<(VideoFrame, Outcome<Found>)>,
}

/// Finds the planes of one frame after the other.
pub(super) struct Finder<'a> {
    wanted: &'a Track,
    runner: Runner<'a>,
    ground: GroundFinder,
}

impl<'a> Finder<'a> {
    pub(super) fn new(wanted: &'a Track, recipe: &'a Recipe) -> Outcome<Self> {
        let ground = GroundFinder::default().camera_height_m(wanted.camera_height)?;
        Ok(Finder { wanted, runner: Runner::new(recipe), ground })
    }

    pub(super) fn search(&mut self, read: Read, dropped: u64) -> Searched {
        let Read { start, index, frame } = read;
        let outcome = frame.map_err(Failure::from).map(|video| {
            let found = self.find(&video);
            (video, found)
        });
        Searched { start, index, dropped, outcome }
    }

    fn find(&mut self, video: &VideoFrame) -> Outcome<Found> {
        let detection = self.runner.detect(&video.frame, 0)?.detection;
        let ground = if self.wanted.floor { Some(self.ground(video, &detection)?) } else { None };
        Ok(Found { detection, ground })
    }

    /// Up as it is stated, or else as the source says it; camera coordinates.
    fn up(&self, video: &VideoFrame) -> Outcome<Up> {
        let stated = match (self.wanted.world_up, &video.pose) {
            (Some(up), Some(pose)) => Some(pose.to_camera(up)),
            (Some(_), None) => {
                return Err(Failure::request(format!("--world-up: {} has no pose; state --up", video.name)));
            }
            (None, _) => self.wanted.up,
        };
        Ok(stated.or(video.up).map_or(Ok(Up::Estimated), Up::known)?)
    }

    fn ground(&mut self, video: &VideoFrame, detection: &Detection) -> Outcome<Ground> {
        let VideoFrame { name, frame, .. } = video;
        let known = self.up(video)?;
        self.ground = std::mem::take(&mut self.ground).up(known);
        let (view, sensor) = (frame.view()?, &frame.sensor);
        let found = self.ground.find(view, detection, sensor)?;
        let picture = || outputs::ground_png(view, sensor, detection, found);
        let png = self.wanted.overlays.as_ref().map(|_| picture()).transpose()?;
        Ok(Ground { record: outputs::ground_record(name, found, known), png })
    }
}
