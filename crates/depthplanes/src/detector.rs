//! The front door: one method, one sensor, and the memory they reuse from frame to frame.

use crate::coplanar::{Coplanar, Joiner};
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::explanation::{Explanation, Verdict};
use crate::lens::Lens;
use crate::map::AnyView;
use crate::methods::method::{Configured, Job, MethodInfo, Parameters, names};
use crate::methods::{self, METHODS};
use crate::sensor::Sensor;
use crate::util::parallel::install;

/// Finds planes in frame after frame; after the first frame of a size it allocates nothing.
///
/// [`Detector::default`] takes the default method, [`crate::Planar`], which needs no parameter.
///
/// ```
/// use depthplanes::{DepthView, Detector};
/// // Two walls with an edge between, 16-bit depth, 40 x 16 pixels.
/// let depth_mm: Vec<u16> = (0..40 * 16).map(|at| if at % 40 < 20 { 1000 } else { 2000 }).collect();
/// let found = Detector::default().detect(DepthView::new(&depth_mm, 40, 16)?)?.clone();
/// assert_eq!(found.planes.len(), 2);
/// assert_eq!(found.planes[0].pixel_count, 20 * 16);
/// # Ok::<(), depthplanes::Error>(())
/// ```
///
/// [`Detector::new`] takes the parameters of a method, here of the paper's:
///
/// ```
/// use depthplanes::{DepthView, Detector, Ngaf};
/// // Two surfaces, one 1.0 m and one 2.0 m away, and a hole.
/// let depth_mm: [u16; 20] = [
///     1000, 1000, 1001, 2000, 2000,
///     1000, 1001, 1001, 2001, 2001,
///     1001, 1001,    0, 2001, 2002,
///     1001, 1002, 1002, 2002, 2002,
/// ];
/// let mut detector = Detector::new(Ngaf::default().theta(1.0).min_pixels(7))?;
/// let found = detector.detect(DepthView::new(&depth_mm, 5, 4)?)?;
/// assert_eq!(found.planes.len(), 2);
/// assert_eq!(found.planes[0].pixel_count, 11);
/// assert_eq!(found.labels[..5], [1, 1, 1, 2, 2]);
/// # Ok::<(), depthplanes::Error>(())
/// ```
pub struct Detector {
    method: Configured,
    sensor: Sensor,
    threads: usize,
    curved: bool,
    joiner: Option<Joiner>,
    detection: Detection,
    lens: Lens,
}

impl std::fmt::Debug for Detector {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Detector")
            .field("method", &self.method.info().name)
            .field("sensor", &self.sensor)
            .field("threads", &self.threads)
            .field("curved", &self.curved)
            .field("planes", &self.detection.planes.len())
            .finish_non_exhaustive()
    }
}

impl Default for Detector {
    /// A detector of the first of [`crate::methods::METHODS`] with its defaults, one thread, camera unknown.
    fn default() -> Self {
        let info = methods::default();
        Self::of(info.of_values(&info.defaults()).expect("a method accepts its own defaults"))
    }
}

impl Detector {
    /// A detector of the given method, one thread, camera unknown: `parameters` is [`crate::Planar`], [`crate::Ngaf`], or
    /// any method by name ([`crate::methods::find`]), at its defaults or with other parameters.
    ///
    /// ```
    /// use depthplanes::{Detector, Planar, methods};
    /// Detector::new(Planar::default().min_pixels(500))?;
    /// Detector::new(methods::find("ransac")?)?;
    /// Detector::new(methods::find("ransac")?.with(&[("epsilon", 0.02)])?)?;
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Parameter`] if the method's parameters are out of range.
    pub fn new(parameters: impl Parameters) -> Result<Self> {
        Ok(Self::of(parameters.configured()?))
    }

    fn of(method: Configured) -> Self {
        Detector {
            method,
            sensor: Sensor::default(),
            threads: 1,
            curved: false,
            joiner: None,
            detection: Detection::default(),
            lens: Lens::default(),
        }
    }

    /// States what the map's numbers mean and which camera saw them; needed for metric planes.
    ///
    /// Behind a lens that distorts ([`Sensor::distortion`]) planes are found in the picture that a pinhole camera in its place
    /// would have made. Labels, pixel counts, boxes, centroids, shares and [`crate::Plane::fit`] are of the pixels of the map that is
    /// given; what is in metres is of the pinhole picture, and so are parameters in pixels. Pixels further than 75
    /// degrees from the axis get no label.
    #[must_use]
    pub fn sensor(mut self, sensor: Sensor) -> Self {
        self.set_sensor(sensor);
        self
    }

    /// As [`Detector::sensor`], between two frames of a video whose sensor may change.
    pub fn set_sensor(&mut self, sensor: Sensor) {
        self.sensor = sensor;
    }

    /// Its method's row in [`crate::methods::METHODS`].
    pub fn method(&self) -> &'static MethodInfo {
        self.method.info()
    }

    /// Threads for large maps, 1 and up (0 counts as 1). The answer is the same for any number. With more than one,
    /// all of a frame is worked on in rayon's thread pool.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads.max(1);
        self
    }

    /// Whether to report curved surfaces as well ([`Detection::curved`]), which costs time; the stage `label` then ends twice. `planar` tells them from
    /// planes ([`crate::methods::MethodInfo::tells_curved`]); with a method that does not, a detection is an error.
    #[must_use]
    pub fn curved(mut self, yes: bool) -> Self {
        self.curved = yes;
        self
    }

    /// Joins separate pieces of one geometric plane: one record for their union, fitted anew from all of its pixels, and
    /// the pieces' own in [`Detection::parts`]. Needs a sensor whose planes are in metres. See [`crate::coplanar`].
    ///
    /// # Errors
    /// [`Error::Parameter`] if a limit is out of range.
    pub fn merge_coplanar(mut self, within: Coplanar) -> Result<Self> {
        self.joiner = Some(Joiner::new(within)?);
        Ok(self)
    }

    /// Finds planes in one map.
    ///
    /// # Errors
    /// [`Error::Camera`] for a unit or a camera whose numbers mean nothing.
    /// [`Error::NotMetric`] if coplanar planes are to be joined, or a parameter is in metres, and the sensor is not known
    /// well enough for planes in metres.
    /// [`Error::NoCurved`] if curved surfaces are asked of a method that does not tell them.
    /// [`Error::TooManyPlanes`] if there are more planes than 16-bit labels can name.
    pub fn detect<'m>(&mut self, map: impl Into<AnyView<'m>>) -> Result<&Detection> {
        self.detect_observed(map, &mut |_| ())
    }

    /// Gives the last detection away and takes one whose memory the next is written to: for callers that keep the detections
    /// of several frames. What stands in `spare` does not matter. With detections that come back, later frames allocate
    /// nothing here either.
    ///
    /// ```
    /// use depthplanes::{DepthView, Detection, Detector};
    /// let (near, far) = ([1000u16; 400], [3000u16; 400]);
    /// let mut detector = Detector::default();
    /// detector.detect(DepthView::new(&near, 20, 20)?)?;
    /// let first = detector.exchange(Detection::default());
    /// let second = detector.detect(DepthView::new(&far, 20, 20)?)?;
    /// assert_eq!([first.planes[0].fit.unwrap().offset, second.planes[0].fit.unwrap().offset], [1000.0, 3000.0]);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn exchange(&mut self, spare: Detection) -> Detection {
        std::mem::replace(&mut self.detection, spare)
    }

    /// As [`Detector::detect`]; `observer` is told the name of each stage as it ends, for timing.
    ///
    /// # Errors
    /// As [`Detector::detect`].
    pub fn detect_observed<'m>(
        &mut self,
        map: impl Into<AnyView<'m>>,
        observer: &mut (dyn FnMut(&'static str) + Send),
    ) -> Result<&Detection> {
        self.detect_view(map.into(), observer)
    }

    fn detect_view(&mut self, map: AnyView<'_>, observer: &mut (dyn FnMut(&'static str) + Send)) -> Result<&Detection> {
        self.sensor.check()?;
        let info = self.method.info();
        if self.curved && !info.tells_curved {
            let accepted = names(METHODS.iter().filter(|method| method.tells_curved).map(|method| method.name));
            return Err(Error::NoCurved { method: info.name, accepted });
        }
        if self.joiner.is_some() {
            self.sensor.check_metric("merge-coplanar")?;
        }
        self.detection.parts.clear();
        let Detector { method, sensor, threads, curved, joiner, detection, lens } = self;
        let (info, threads, curved) = (method.info(), *threads, *curved);
        let mut joiner = joiner.as_mut();
        if !Lens::is_needed(sensor) {
            let mut job = Job { sensor: *sensor, threads, curved, joiner, observer };
            install(threads, || method.0.run(map, &mut job, detection)).map_err(|error| named(error, info))?;
            return Ok(detection);
        }
        if let Some(joiner) = &mut joiner {
            joiner.keep_pieces();
        }
        let run = |picture: AnyView<'_>, sensor, joiner: Option<&mut Joiner>, found: &mut Detection| {
            let mut job = Job { sensor, threads, curved, joiner, observer };
            method.0.run(picture, &mut job, found)
        };
        install(threads, || lens.through(&map, sensor, joiner, run, detection)).map_err(|error| named(error, info))?;
        observer("label"); // once more: labels are carried back
        Ok(detection)
    }

    /// Says why the pixel in column `at[0]`, row `at[1]` belongs to a plane or to none: what each stage saw there,
    /// and which parameters would give it one. Runs the method several times and allocates; [`Detector::detect`] pays
    /// nothing for it. Coplanar planes are not joined here.
    ///
    /// # Errors
    /// [`Error::Pixel`] for a pixel outside of the map, and those of [`Detector::detect`].
    ///
    /// ```
    /// use depthplanes::{DepthView, Detector, Planar};
    /// let wall = [1000u16; 64];
    /// let mut detector = Detector::new(Planar::default())?;
    /// let why = detector.explain(DepthView::new(&wall, 8, 8)?, [3, 4])?;
    /// assert_eq!(why.verdict.kind(), "small"); // 64 pixels, and `min-pixels` is 100
    /// assert_eq!(why.suggestions[0].parameters[0].0, "min-pixels");
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn explain<'m>(&mut self, map: impl Into<AnyView<'m>>, at: [usize; 2]) -> Result<Explanation> {
        self.explain_view(map.into(), at)
    }

    fn explain_view(&mut self, map: AnyView<'_>, at: [usize; 2]) -> Result<Explanation> {
        let (width, height) = (map.width(), map.height());
        if at[0] >= width || at[1] >= height {
            return Err(Error::Pixel { at, width, height });
        }
        self.sensor.check()?;
        if Lens::is_needed(&self.sensor) {
            return self.explain_through_lens(&map, at).map_err(|error| named(error, self.method.info()));
        }
        let mut job =
            Job { sensor: self.sensor, threads: self.threads, curved: false, joiner: None, observer: &mut |_| () };
        self.method.0.explain(map, &mut job, at).map_err(|error| named(error, self.method.info()))
    }

    /// The explanation of the pinhole picture's pixel, with the labels that the map's own pixels have.
    fn explain_through_lens(&mut self, map: &AnyView<'_>, at: [usize; 2]) -> Result<Explanation> {
        let Detector { method, sensor, threads, lens, .. } = self;
        let method_name = method.info().name;
        let mut out = Detection::default();
        let run = |picture: AnyView<'_>, sensor, joiner: Option<&mut Joiner>, found: &mut Detection| {
            let mut job = Job { sensor, threads: *threads, curved: false, joiner, observer: &mut |_| () };
            method.0.run(picture, &mut job, found)
        };
        lens.through(map, sensor, None, run, &mut out)?;
        let explained = lens.explain(map, sensor, at, |picture, sensor, there| {
            let mut job = Job { sensor, threads: *threads, curved: false, joiner: None, observer: &mut |_| () };
            method.0.explain(picture, &mut job, there)
        })?;
        let Some(mut explanation) = explained else {
            let verdict = Verdict::NotMeasured;
            return Ok(Explanation { at, method: method_name, findings: Vec::new(), verdict, suggestions: Vec::new() });
        };
        explanation.at = at;
        let rename = |label: u16| lens.names().get(usize::from(label).wrapping_sub(1)).copied().unwrap_or(0);
        let own = out.labels[at[1] * out.width + at[0]];
        match &mut explanation.verdict {
            Verdict::Plane { label, pixels, .. } if own > 0 => {
                (*label, *pixels) = (own, out.planes[usize::from(own) - 1].pixel_count);
            }
            Verdict::Plane { label, .. } | Verdict::Off { label, .. } | Verdict::Unexplained { label } => {
                *label = rename(*label)
            }
            _ => (),
        }
        Ok(explanation)
    }
}

/// Parameters that leave fewer planes if they are raised, those that do most first.
const FEWER_PLANES: [&str; 7] =
    ["min-pixels", "min-area", "theta", "theta-gradient", "epsilon", "window", "noise-scale"];

/// An error with the names of the method's own parameters.
fn named(error: Error, method: &MethodInfo) -> Error {
    match error {
        Error::TooManyPlanes { found, .. } => {
            let is_in_table = |name: &&str| method.position(name).is_some();
            let raised: Vec<String> =
                FEWER_PLANES.into_iter().filter(is_in_table).map(|name| format!("`{name}`")).collect();
            Error::TooManyPlanes { found, raise: raised.join(" or ") }
        }
        other => other,
    }
}
