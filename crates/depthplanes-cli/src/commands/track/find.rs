//! Frames become planes and, if it is wanted, the ground. Each thread has a finder of its own; no frame knows another.

use crate::args::Track;
use crate::failure::{Failure, Outcome};
use crate::run::Recipe;
use depthplanes::Detection;
use depthplanes::ground::GroundFinder;
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

/// Finds what there is in one frame after the other.
pub(super) struct Finder {
    finder: depthplanes_video::Finder,
    /// Whether the picture of a frame is that of its ground.
    draws_ground: bool,
}

impl Finder {
    pub(super) fn new(wanted: &Track, recipe: &Recipe) -> Outcome<Self> {
        let ground = GroundFinder::default().camera_height_m(wanted.camera_height)?;
        let planes = depthplanes_video::Finder::new(recipe.detector());
        let finder = if wanted.floor { planes.with_ground(ground, wanted.up)? } else { planes };
        Ok(Finder { finder, draws_ground: wanted.draws() })
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
        let VideoFrame { name, frame, .. } = video;
        let found = self.finder.find(video)?;
        let detection = found.detection;
        let picture = |ground| outputs::ground_png(frame.view()?, &frame.sensor, detection, ground);
        let ground = |ground| -> Outcome<Ground> {
            let png = if self.draws_ground { Some(picture(ground)?) } else { None };
            Ok(Ground { record: outputs::ground_record(name, ground, found.up), png })
        };
        Ok(Found { detection: detection.clone(), ground: found.ground.map(ground).transpose()? })
    }
}
