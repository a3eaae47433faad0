//! A frame becomes planes and, where it is wanted, the ground. No frame knows another.

use crate::error::Result;
use crate::frame::VideoFrame;
use crate::stated_up::StatedUp;
use depthplanes::ground::{Ground, GroundFinder, Up};
use depthplanes::{Detection, Detector};
use depthplanes_io::memory;

/// Finds what there is in frame after frame, whose sensor and size may change; it reuses its memory.
///
/// ```
/// use depthplanes::{Detector, ground::GroundFinder};
/// use depthplanes_video::{Finder, SourceOptions, StatedUp, open};
/// let mut source = open("scene:robot:size=160x120,frames=2", &SourceOptions::default())?;
/// let up = StatedUp::World([0.0, 0.0, 1.0]);
/// let mut finder = Finder::new(Detector::default()).with_ground(GroundFinder::default(), up)?;
/// while let Some(frame) = source.next_frame() {
///     let frame = frame?;
///     let found = finder.find(&frame)?;
///     assert!(!found.detection.planes.is_empty());
///     assert!(found.ground.is_some_and(|ground| ground.floor.is_some()));
/// }
/// # Ok::<(), depthplanes_video::Error>(())
/// ```
#[derive(Debug)]
pub struct Finder {
    detector: Detector,
    ground: Option<GroundFinder>,
    up: StatedUp,
    /// Whether a frame whose ground cannot be found as it is wanted is no error.
    is_lenient: bool,
    /// Pixels of the largest map that there is memory for.
    pixels: usize,
}

/// What was found in a frame.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Found<'a> {
    /// The planes.
    pub detection: &'a Detection,
    /// The ground, if it is wanted and the map is metric.
    pub ground: Option<&'a Ground>,
    /// What was known of up.
    pub up: Up,
}

impl Finder {
    /// Of planes alone.
    pub fn new(detector: Detector) -> Self {
        Finder { detector, ground: None, up: StatedUp::Nothing, is_lenient: false, pixels: 0 }
    }

    /// With the ground of each frame. A map that is not metric is an error then, and so is an up in the world of a frame
    /// without pose.
    ///
    /// # Errors
    /// Those of [`Up::known`] for an up that is no direction.
    pub fn with_ground(self, finder: GroundFinder, up: StatedUp) -> depthplanes::Result<Self> {
        up.check()?;
        Ok(Finder { ground: Some(finder), up, ..self })
    }

    /// With the ground of those frames whose map is metric ([`depthplanes::Sensor::is_metric`]); an up in the world counts in
    /// those with a pose.
    ///
    /// # Errors
    /// As [`Finder::with_ground`].
    pub fn with_ground_where_possible(self, finder: GroundFinder, up: StatedUp) -> depthplanes::Result<Self> {
        Ok(Finder { is_lenient: true, ..self.with_ground(finder, up)? })
    }

    /// Goes on with another method, or with other parameters.
    pub fn set_detector(&mut self, detector: Detector) {
        (self.detector, self.pixels) = (detector, 0);
    }

    /// Finds what there is in a frame.
    ///
    /// # Errors
    /// What the library says of the map; too little memory for it; an up in the world ([`StatedUp::World`]) of a frame without
    /// pose.
    pub fn find(&mut self, video: &VideoFrame) -> Result<Found<'_>> {
        self.find_observed(video, &mut |_| ())
    }

    /// As [`Finder::find`]; `observer` is told the name of each of the method's stages as it ends, then `ground`.
    ///
    /// # Errors
    /// As [`Finder::find`].
    pub fn find_observed(
        &mut self,
        video: &VideoFrame,
        observer: &mut (dyn FnMut(&'static str) + Send),
    ) -> Result<Found<'_>> {
        let sensor = &video.frame.sensor;
        self.check_memory(video.frame.width, video.frame.height)?;
        self.detector.set_sensor(*sensor);
        let view = video.frame.view()?;
        let detection = self.detector.detect_observed(view, observer)?;
        let is_wanted = sensor.is_metric() || !self.is_lenient;
        let Some(finder) = self.ground.as_mut().filter(|_| is_wanted) else {
            return Ok(Found { detection, ground: None, up: Up::Estimated });
        };
        let stated = if self.is_lenient && video.pose.is_none() { self.up.without_world() } else { self.up };
        let up = stated.of(video)?;
        finder.set_up(up);
        let ground = finder.find(view, detection, sensor)?;
        observer("ground");
        Ok(Found { detection, ground: Some(ground), up })
    }

    /// Whether there is memory for a map, asked once for each larger one.
    fn check_memory(&mut self, width: usize, height: usize) -> Result<()> {
        if width * height > self.pixels {
            let [used, reserved] = memory::of_detection(self.detector.method(), width, height);
            memory::check(used, reserved)?;
            self.pixels = width * height;
        }
        Ok(())
    }
}
