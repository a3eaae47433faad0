//! A frame becomes what the page shows of it: planes, their ids and outlines, and the ground.

use crate::config::Config;
use depthplanes::ground::{Ground, GroundFinder};
use depthplanes::methods::MethodInfo;
use depthplanes::outline::{Outliner, Outlines};
use depthplanes::track::{Tracker, Tracks};
use depthplanes::{Detection, Detector, Error};
use depthplanes_video::{Finder, VideoFrame};
use std::time::Instant;

/// Pixels of the smallest hole that outlines keep: smaller ones are specks on the page.
const LEAST_HOLE_PX: usize = 100;

/// The method with its parameters, and the memory that it reuses.
pub(crate) struct Pipeline {
    pub(crate) method: &'static MethodInfo,
    values: Vec<f64>,
    finder: Finder,
    outliner: Outliner,
    tracker: Tracker,
    ignores_poses: bool,
}

/// What was found in a frame.
pub(crate) struct Found<'a> {
    pub(crate) detection: &'a Detection,
    pub(crate) outlines: &'a Outlines,
    pub(crate) tracks: &'a Tracks,
    /// `None` where the map is not metric.
    pub(crate) ground: Option<&'a Ground>,
    /// Milliseconds of each stage, in order.
    pub(crate) stages: Vec<(&'static str, f64)>,
}

impl Pipeline {
    /// # Errors
    /// A parameter or a height that is out of range.
    pub(crate) fn new(config: &Config) -> depthplanes::Result<Self> {
        let ground = GroundFinder::default().camera_height_m(config.camera_height_m)?;
        let detector = Detector::new(config.method.of_values(&config.values)?)?;
        Ok(Pipeline {
            method: config.method,
            values: config.values.clone(),
            finder: Finder::new(detector).with_ground_where_possible(ground, config.up)?,
            outliner: Outliner::default().min_hole_px(LEAST_HOLE_PX),
            tracker: Tracker::default().kept_frames(config.kept_frames),
            ignores_poses: config.ignore_poses,
        })
    }

    /// A value for each parameter of the method, in order.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Sets a parameter.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a value out of range, [`Error::Unknown`] for another method's name; all stay as they are then.
    pub(crate) fn set(&mut self, name: &str, value: f64) -> depthplanes::Result<()> {
        let accepted = || self.method.params.iter().map(|param| param.name).collect::<Vec<_>>().join(", ");
        let unknown = || Error::Unknown { what: "parameter", given: name.into(), accepted: accepted() };
        let mut values = self.values.clone();
        values[self.method.position(name).ok_or_else(unknown)?] = value;
        self.set_all(values)
    }

    /// Sets all parameters.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a value out of range.
    pub(crate) fn set_all(&mut self, values: Vec<f64>) -> depthplanes::Result<()> {
        self.finder.set_detector(Detector::new(self.method.of_values(&values)?)?);
        self.values = values;
        Ok(())
    }

    /// Forgets the planes of the frames before.
    pub(crate) fn forget(&mut self) {
        self.tracker.forget();
    }

    /// Finds all there is to find in a frame.
    ///
    /// # Errors
    /// What the library says of the map, and too little memory for it.
    pub(crate) fn find(&mut self, video: &VideoFrame) -> depthplanes_video::Result<Found<'_>> {
        let sensor = &video.frame.sensor;
        let mut clock = Clock::new();
        let found = self.finder.find_observed(video, &mut |stage| clock.ends(stage))?;
        let pose = video.pose.as_ref().filter(|_| !self.ignores_poses);
        let tracks = self.tracker.track_with_map(video.frame.view()?, found.detection, sensor, pose)?;
        clock.ends("track");
        let outlines = self.outliner.outline_labels(found.detection, tracks.labels_of(found.detection), sensor)?;
        clock.ends("outlines");
        Ok(Found { detection: found.detection, outlines, tracks, ground: found.ground, stages: clock.stages })
    }
}

/// Milliseconds of stage after stage.
struct Clock {
    start: Instant,
    stages: Vec<(&'static str, f64)>,
}

impl Clock {
    fn new() -> Self {
        Clock { start: Instant::now(), stages: Vec::with_capacity(16) }
    }

    /// Ends a stage; one that ends twice has both times.
    fn ends(&mut self, stage: &'static str) {
        let now = Instant::now();
        let ms = (now - self.start).as_secs_f64() * 1e3;
        self.start = now;
        match self.stages.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, sum)) => *sum += ms,
            None => self.stages.push((stage, ms)),
        }
    }
}
