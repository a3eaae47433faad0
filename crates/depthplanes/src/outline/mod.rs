//! Outlines of planes: polygons with holes, convex hulls and rectangles of least area.
//!
//! In: a [`Detection`], and the camera if it is known. Out: [`Outlines`], in pixels, and in metres
//! where a plane is metric; those points lie on the fitted plane, whatever noise the map has.
//!
//! `labels -> trace -> simplify -> hull -> Outlines`. Rings run along the cracks between pixels, so
//! that their corners lie at half-integers, and are simplified by Douglas and Peucker ("Algorithms
//! for the reduction of the number of points ...", 1973). The cost grows with the planes' perimeter
//! and one look at each label.
//!
//! What holds for any label image: a ring never meets itself; rings of one plane share single
//! points at most; holes lie within their outer ring and beside each other; a ring deviates by at
//! most the tolerance from the pixels' cracks, and at tolerance 0 not at all.
//!
//! Outer rings run counter-clockwise seen from the camera, that is around the normal by the
//! right-hand rule; holes run clockwise. On the picture that looks the same, except where `fx fy` is
//! negative (ICL-NUIM): such a picture is mirrored, and there outer rings look clockwise on it.

mod conflicts;
mod hull;
mod outlines;
mod rectangle;
mod simplify;
mod trace;

use crate::camera::{Hessian, Intrinsics};
use crate::detection::{Detection, Plane};
use crate::error::{Error, Result};
use hull::Huller;
use outlines::{PlaneRecord, RingRecord};
use rectangle::Fitter;
use simplify::Simplifier;
use trace::{TracedRing, Tracer};

pub use outlines::{Outline, Outlines, Polygon, Ring};
pub use rectangle::Rectangle;

/// The tolerance of [`Outliner::default`], pixels. The cracks along a straight edge are stairs of up
/// to the square root of 2 across, so that 1.5 is enough to make a line of any of them.
pub const DEFAULT_TOLERANCE_PX: f64 = 1.5;

/// A point where pixels meet: (x, y) is picture point (x - 1/2, y - 1/2).
type Corner = [u16; 2];

/// `(b - a) x (c - a)`; below 0 where the way a, b, c turns counter-clockwise on the picture.
#[inline]
fn turn(a: Corner, b: Corner, c: Corner) -> i64 {
    let [ax, ay, bx, by, cx, cy] = [a[0], a[1], b[0], b[1], c[0], c[1]].map(i64::from);
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

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
/// let mut detector = Detector::new(Ngaf { theta: 1.0, min: 3, ..Ngaf::default() })?;
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
            simplifier: Simplifier::new(tolerance_px),
            huller: Huller::default(),
            fitter: Fitter::default(),
            outlines: Outlines { tolerance_px, ..Outlines::default() },
        })
    }

    /// The outline of each plane that has pixels, in order of label. `camera` is the one that the
    /// detection was made with; without it outlines are in pixels alone.
    ///
    /// # Errors
    /// [`Error::Size`] and [`Error::Length`] if the label image is not one.
    pub fn outline(&mut self, detection: &Detection, camera: Option<&Intrinsics>) -> Result<&Outlines> {
        let Outliner { tracer, simplifier, huller, fitter, outlines } = self;
        outlines.clear(camera);
        tracer.trace(detection)?;
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

/// How many rings, corners and corners of hulls there are.
#[derive(Clone, Copy)]
struct Ends {
    rings: usize,
    corners: usize,
    hulls: usize,
}

impl Outlines {
    fn clear(&mut self, camera: Option<&Intrinsics>) {
        self.camera = camera.copied();
        self.corners.clear();
        self.hulls.clear();
        self.rings.clear();
        self.planes.clear();
    }

    fn ends(&self) -> Ends {
        Ends { rings: self.rings.len(), corners: self.corners.len(), hulls: self.hulls.len() }
    }

    /// Adds rings of those corners that are kept.
    fn add_rings(&mut self, rings: &[TracedRing], corners: &[Corner], keep: &[bool]) {
        for ring in rings {
            let start = self.corners.len();
            self.corners.extend(ring.range().filter(|&at| keep[at]).map(|at| corners[at]));
            face_camera(&mut self.corners[start..], self.camera);
            self.rings.push(RingRecord { corners: start..self.corners.len(), is_hole: ring.is_hole });
        }
    }

    /// Adds the hull of the outer rings.
    fn add_hull(&mut self, huller: &mut Huller, rings: &[TracedRing], corners: &[Corner]) {
        let start = self.hulls.len();
        let outer = rings.iter().filter(|ring| !ring.is_hole);
        huller.hull(outer.flat_map(|ring| &corners[ring.range()]), &mut self.hulls);
        face_camera(&mut self.hulls[start..], self.camera);
    }

    /// Adds the plane of the rings and the hull since `first`.
    fn add_plane(&mut self, fitter: &mut Fitter, plane: &Plane, first: Ends) {
        let (surface, hull) = (self.surface(plane, first), &self.hulls[first.hulls..]);
        let record = PlaneRecord {
            label: plane.label,
            rings: first.rings..self.rings.len(),
            hull: first.hulls..self.hulls.len(),
            surface,
            rectangle_px: fitter.on_picture(hull),
            rectangle_m: surface.zip(self.camera).map(|seen| fitter.on_plane(hull, &seen)),
        };
        self.planes.push(record);
    }

    /// The plane in metres, if each corner since `first` lies before infinity on it.
    fn surface(&self, plane: &Plane, first: Ends) -> Option<Hessian> {
        let surface = plane.metric.filter(|metric| metric.area_m2.is_some())?.plane;
        let camera = self.camera?;
        let mut corners = self.corners[first.corners..].iter().chain(&self.hulls[first.hulls..]);
        corners.all(|&corner| surface.point_at(outlines::point(corner), &camera).is_some()).then_some(surface)
    }
}

/// Rings are traced counter-clockwise on the picture; where that is mirrored, they turn round, but
/// for their first corner.
fn face_camera(ring: &mut [Corner], camera: Option<Intrinsics>) {
    let mirrored = camera.is_some_and(|camera| camera.fx * camera.fy < 0.0);
    if let (true, [_, others @ ..]) = (mirrored, ring) {
        others.reverse();
    }
}
