//! A frame becomes planes, ids and ground.

use crate::options::Options;
use depthplanes::ground::{Ground, GroundFinder, Up};
use depthplanes::track::{Tracker, Tracks};
use depthplanes::{Detection, Detector};
use depthplanes_video::{Finder, Result, StatedUp, VideoFrame};

/// Above this id planes are counted from 1 again: label images of 16 bits end at 65535, and a robot runs for days. A frame
/// has some hundred planes at most.
const LAST_ID: u32 = 60_000;

/// Searches one frame after the other.
pub(crate) struct Search {
    finder: Finder,
    tracker: Tracker,
    /// The largest id of the frame before.
    last_id: u32,
}

/// What was found in a frame.
pub(crate) struct Found<'a> {
    pub(crate) detection: &'a Detection,
    pub(crate) tracks: &'a Tracks,
    /// `None` where the map is not metric.
    pub(crate) ground: Option<&'a Ground>,
    /// What was known of up.
    pub(crate) up: Up,
    /// Whether the ids begin at 1 again.
    pub(crate) is_renumbered: bool,
}

impl Search {
    /// # Errors
    /// A parameter, a height or an up that is out of range.
    pub(crate) fn new(options: &Options) -> Result<Self> {
        let detector = Detector::new(options.method.with(&options.parameters)?)?.threads(options.threads);
        let ground = GroundFinder::default().camera_height_m(options.camera_height_m)?;
        let up = options.up.map_or(StatedUp::Nothing, StatedUp::Camera);
        Ok(Search {
            finder: Finder::new(detector).with_ground_where_possible(ground, up)?,
            tracker: Tracker::default().kept_frames(options.kept_frames),
            last_id: 0,
        })
    }

    /// Searches the next frame.
    ///
    /// # Errors
    /// Those of the library.
    pub(crate) fn search(&mut self, video: &VideoFrame) -> Result<Found<'_>> {
        let found = self.finder.find(video)?;
        let is_renumbered = self.last_id > LAST_ID;
        if is_renumbered {
            self.tracker.forget();
        }
        let (map, sensor) = (video.frame.view()?, &video.frame.sensor);
        let tracks = self.tracker.track_with_map(map, found.detection, sensor, video.pose.as_ref())?;
        self.last_id = tracks.ids.iter().copied().max().unwrap_or(0);
        Ok(Found { detection: found.detection, tracks, ground: found.ground, up: found.up, is_renumbered })
    }
}
