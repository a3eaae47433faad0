//! A frame becomes planes, ids and ground.

use crate::options::Options;
use depthplanes::ground::{Ground, GroundFinder, Up};
use depthplanes::track::{Tracker, Tracks};
use depthplanes::{Detection, Detector, Result, Sensor};
use depthplanes_io::Frame;

/// Above this id planes are counted from 1 again: label images of 16 bits end at 65535, and a robot runs for days. A frame
/// has some hundred planes at most.
const LAST_ID: u32 = 60_000;

/// Searches one frame after the other.
pub(crate) struct Search {
    options: Options,
    up: Up,
    sensor: Sensor,
    detector: Detector,
    tracker: Tracker,
    /// The largest id of the frame before.
    last_id: u32,
    ground: GroundFinder,
}

/// What was found in a frame.
pub(crate) struct Found<'a> {
    pub(crate) detection: &'a Detection,
    pub(crate) tracks: &'a Tracks,
    pub(crate) ground: &'a Ground,
    /// Whether the ids begin at 1 again.
    pub(crate) is_renumbered: bool,
}

impl Search {
    pub(crate) fn new(options: &Options) -> Result<Self> {
        let up = options.up.map_or(Ok(Up::Estimated), Up::known)?;
        let sensor = Sensor::default();
        Ok(Search {
            options: options.clone(),
            up,
            sensor,
            detector: detector(options, sensor)?,
            tracker: Tracker::default().kept_frames(options.kept_frames),
            last_id: 0,
            ground: GroundFinder::default().up(up).camera_height_m(options.camera_height_m)?,
        })
    }

    /// What is known of up.
    pub(crate) fn up(&self) -> Up {
        self.up
    }

    /// Searches the next frame.
    ///
    /// # Errors
    /// Those of the library.
    pub(crate) fn search(&mut self, frame: &Frame) -> Result<Found<'_>> {
        if frame.sensor != self.sensor {
            self.detector = detector(&self.options, frame.sensor)?;
            self.sensor = frame.sensor;
        }
        let view = frame.view()?;
        let detection = self.detector.detect(view)?;
        let ground = self.ground.find(view, detection, &frame.sensor)?;
        let is_renumbered = self.last_id > LAST_ID;
        if is_renumbered {
            self.tracker = Tracker::default().kept_frames(self.options.kept_frames);
        }
        let tracks = self.tracker.track(detection, &frame.sensor, None)?;
        self.last_id = tracks.ids.iter().copied().max().unwrap_or(0);
        Ok(Found { detection, tracks, ground, is_renumbered })
    }
}

fn detector(options: &Options, sensor: Sensor) -> Result<Detector> {
    let method = options.method.with(&options.parameters)?;
    Ok(Detector::new(method)?.threads(options.threads).sensor(sensor))
}
