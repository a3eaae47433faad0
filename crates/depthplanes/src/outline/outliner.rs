//! From a detection to its outlines, plane after plane.

use super::holes::HoleFilter;
use super::hull::Huller;
use super::outlines::Outlines;
use super::rectangle::Fitter;
use super::simplify::Simplifier;
use super::trace::Tracer;
use crate::camera::Intrinsics;
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::sensor::Sensor;

/// The tolerance of [`Outliner::default`], pixels. The cracks along a straight edge are stairs of up
/// to the square root of 2 across, so that 1.5 is enough to make a line of any of them.
pub const DEFAULT_TOLERANCE_PX: f64 = 1.5;

/// Makes outlines of detection after detection. Its memory grows to what the most intricate one
/// needed; after that it allocates nothing.
///
/// ```
/// use depthplanes::{DepthView, Detector, Ngaf, outline::Outliner};
/// let depth_mm: [u16; 20] = [
///     1000, 1000, 1000, 1000, 2000,
///     1000,    0, 1000, 1000, 2000,
///     1000, 1000, 1000, 1000, 2000,
///     1000, 1000, 1000, 1000, 2000,
/// ];
/// let mut detector = Detector::new(Ngaf::default().theta(1.0).min_pixels(3))?;
/// let found = detector.detect(DepthView::new(&depth_mm, 5, 4)?)?;
/// let mut outliner = Outliner::new(0.0)?;
/// let outlines = outliner.outline(found, None)?;
/// let largest = outlines.get(1).unwrap().polygons().next().unwrap();
/// let corners: Vec<[f64; 2]> = largest.outer().points_px().collect();
/// assert_eq!(corners, [[-0.5, -0.5], [-0.5, 3.5], [3.5, 3.5], [3.5, -0.5]]);
/// assert_eq!(largest.holes().len(), 1);
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Debug)]
pub struct Outliner {
    tracer: Tracer,
    holes: HoleFilter,
    simplifier: Simplifier,
    huller: Huller,
    fitter: Fitter,
    outlines: Outlines,
}

impl Default for Outliner {
    /// Simplifies to within [`DEFAULT_TOLERANCE_PX`].
    fn default() -> Self {
        Self::new(DEFAULT_TOLERANCE_PX).expect("the default is accepted")
    }
}

impl Outliner {
    /// Simplifies rings to within `tolerance_px` pixels; 0 keeps every corner.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless it is a finite number of at least 0.
    pub fn new(tolerance_px: f64) -> Result<Self> {
        if !(tolerance_px >= 0.0 && tolerance_px.is_finite()) {
            let accepted = "a number of pixels from 0 up".to_string();
            return Err(Error::Parameter { name: "outlines", given: tolerance_px, accepted });
        }
        Ok(Outliner {
            tracer: Tracer::default(),
            holes: HoleFilter::default(),
            simplifier: Simplifier::new(tolerance_px),
            huller: Huller::default(),
            fitter: Fitter::default(),
            outlines: Outlines { tolerance_px, ..Outlines::default() },
        })
    }

    /// Leaves out holes of fewer than `pixels` pixels, so that outlines run over them. What of the same plane stands in such
    /// a hole is then part of the polygon around it. 0, the default, and 1 keep every hole. Hulls and rectangles do not
    /// depend on it.
    ///
    /// ```
    /// use depthplanes::{DepthView, Detector, Ngaf, outline::Outliner};
    /// let depth_mm = [1000u16, 1000, 1000, 1000, 0, 1000, 1000, 1000, 1000]; // one pixel is missing
    /// let mut detector = Detector::new(Ngaf::default().min_pixels(3))?;
    /// let found = detector.detect(DepthView::new(&depth_mm, 3, 3)?)?;
    /// let outlines = Outliner::default().min_hole_px(2).outline(found, None)?.clone();
    /// assert_eq!(outlines.get(1).unwrap().polygons().next().unwrap().holes().len(), 0);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn min_hole_px(mut self, pixels: usize) -> Self {
        self.holes.min_px = pixels;
        self.outlines.min_hole_px = pixels;
        self
    }

    /// The outline of each plane that has pixels, in order of label. `camera` is the one that the
    /// detection was made with; without it outlines are in pixels alone.
    ///
    /// # Errors
    /// [`Error::Size`] and [`Error::Length`] if the label image is not one.
    pub fn outline(&mut self, detection: &Detection, camera: Option<&Intrinsics>) -> Result<&Outlines> {
        self.outline_seen_by(detection, &Sensor::default().intrinsics(camera.copied()))
    }

    /// As [`Outliner::outline`], with all that is known of the sensor that the detection was made with: behind a lens that distorts,
    /// points in metres lie on the true rays of the rings' corners.
    ///
    /// # Errors
    /// As [`Outliner::outline`].
    pub fn outline_seen_by(&mut self, detection: &Detection, sensor: &Sensor) -> Result<&Outlines> {
        self.outline_labels(detection, &detection.labels, sensor)
    }

    /// As [`Outliner::outline_seen_by`], of another label image of the detection's planes, such as
    /// [`Tracks::labels_of`](crate::track::Tracks::labels_of) gives.
    ///
    /// # Errors
    /// As [`Outliner::outline`].
    pub fn outline_labels(&mut self, detection: &Detection, labels: &[u16], sensor: &Sensor) -> Result<&Outlines> {
        let Outliner { tracer, holes, simplifier, huller, fitter, outlines } = self;
        outlines.clear(sensor);
        tracer.trace(detection, labels)?;
        holes.filter(&mut tracer.rings, &tracer.corners);
        for rings in tracer.rings.chunk_by(|a, b| a.label == b.label) {
            simplifier.simplify(rings, &tracer.corners, &mut tracer.keep);
            let first = outlines.ends();
            outlines.add_rings(rings, &tracer.corners, &tracer.keep);
            outlines.add_hull(huller, rings, &tracer.corners);
            let plane = &detection.planes[usize::from(rings[0].label) - 1];
            outlines.add_plane(fitter, plane, first);
        }
        Ok(outlines)
    }
}
