//! A frame becomes what the page shows of it: planes, their ids and outlines, and the ground.

use crate::config::Config;
use depthplanes::ground::{Ground, GroundFinder, Up};
use depthplanes::methods::MethodInfo;
use depthplanes::outline::{Outliner, Outlines};
use depthplanes::track::{Tracker, Tracks};
use depthplanes::{Detection, Detector, Error, Sensor, ValueKind};
use depthplanes_io::memory;
use depthplanes_video::VideoFrame;
use std::time::Instant;

/// Bytes a pixel that are used and reserved, the method's and the page's.
const BYTES_A_PIXEL: [u64; 2] = [64, 320];
/// Pixels of the smallest hole that outlines keep: smaller ones are specks on the page.
const LEAST_HOLE_PX: usize = 100;

/// The method with its parameters, and the memory that it reuses.
pub(crate) struct Pipeline {
    pub(crate) method: &'static MethodInfo,
    values: Vec<f64>,
    detector: Detector,
    sensor: Sensor,
    outliner: Outliner,
    kept_frames: u32,
    tracker: Tracker,
    ignores_poses: bool,
    up: Up,
    ground: GroundFinder,
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
        let sensor = Sensor::default();
        Ok(Pipeline {
            method: config.method,
            detector: Detector::new(config.method.of_values(&config.values)?)?.sensor(sensor),
            values: config.values.clone(),
            sensor,
            outliner: Outliner::default().min_hole_px(LEAST_HOLE_PX),
            kept_frames: config.kept_frames,
            tracker: Tracker::default().kept_frames(config.kept_frames),
            ignores_poses: config.ignore_poses,
            up: config.up,
            ground: GroundFinder::default().camera_height_m(config.camera_height_m)?,
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
        self.detector = Detector::new(self.method.of_values(&values)?)?.sensor(self.sensor);
        self.values = values;
        Ok(())
    }

    /// Forgets the planes of the frames before.
    pub(crate) fn forget(&mut self) {
        self.tracker = Tracker::default().kept_frames(self.kept_frames);
    }

    /// Finds all there is to find in a frame.
    ///
    /// # Errors
    /// What the library says of the map, and too little memory for it, as text.
    pub(crate) fn find(&mut self, video: &VideoFrame) -> Result<Found<'_>, String> {
        let frame = &video.frame;
        let [used, reserved] = BYTES_A_PIXEL.map(|bytes| bytes * (frame.width * frame.height) as u64);
        memory::check(used, reserved).map_err(text)?;
        if frame.sensor != self.sensor {
            self.sensor = frame.sensor;
            self.set_all(self.values.clone()).map_err(text)?;
        }
        let view = frame.view().map_err(text)?;
        let mut clock = Clock::new();
        let detection = self.detector.detect_observed(view, &mut |stage| clock.ends(stage)).map_err(text)?;
        let pose = video.pose.as_ref().filter(|_| !self.ignores_poses);
        let tracks = self.tracker.track(detection, &frame.sensor, pose).map_err(text)?;
        clock.ends("track");
        let is_metric = frame.sensor.intrinsics.is_some() && frame.sensor.value_kind != ValueKind::Disparity;
        let mut ground = None;
        if is_metric {
            let up = video.up.map_or(Ok(self.up), Up::known).map_err(text)?;
            self.ground = std::mem::take(&mut self.ground).up(up);
            ground = Some(self.ground.find(view, detection, &frame.sensor).map_err(text)?);
            clock.ends("ground");
        }
        let outlines = self.outliner.outline_seen_by(detection, &frame.sensor).map_err(text)?;
        clock.ends("outlines");
        Ok(Found { detection, outlines, tracks, ground, stages: clock.stages })
    }
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
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
