//! What an outline is: rings of corners, and the points they stand for in pixels and in metres.
//!
//! Corners are kept as whole numbers; points are worked out where they are asked for.

use super::corner::{Corner, point};
use super::hull::Huller;
use super::rectangle::{Fitter, Rectangle};
use super::trace::TracedRing;
use crate::camera::HessianNormalForm;
use crate::detection::Plane;
use crate::sensor::Sensor;
use std::ops::Range;

/// The outlines of a detection's planes. An [`super::Outliner`] owns one and reuses its memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outlines {
    pub(super) tolerance_px: f64,
    pub(super) min_hole_px: usize,
    /// The sensor, if its camera is known.
    pub(super) camera: Option<Sensor>,
    pub(super) corners: Vec<Corner>,
    pub(super) hulls: Vec<Corner>,
    pub(super) rings: Vec<RingRecord>,
    pub(super) planes: Vec<PlaneRecord>,
}

/// A ring: where its corners lie in [`Outlines::corners`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RingRecord {
    pub(super) corners: Range<usize>,
    pub(super) is_hole: bool,
}

/// A plane: where its rings and its hull lie, each outer ring followed by its holes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlaneRecord {
    pub(super) label: u16,
    pub(super) rings: Range<usize>,
    pub(super) hull: Range<usize>,
    pub(super) surface: Option<HessianNormalForm>,
    pub(super) rectangle_px: Rectangle<2>,
    pub(super) rectangle_m: Option<Rectangle<3>>,
}

/// How many rings, corners and corners of hulls there are.
#[derive(Clone, Copy)]
pub(super) struct Ends {
    rings: usize,
    corners: usize,
    hulls: usize,
}

impl Outlines {
    pub(super) fn clear(&mut self, sensor: &Sensor) {
        self.camera = sensor.intrinsics.map(|_| *sensor);
        self.corners.clear();
        self.hulls.clear();
        self.rings.clear();
        self.planes.clear();
    }

    pub(super) fn ends(&self) -> Ends {
        Ends { rings: self.rings.len(), corners: self.corners.len(), hulls: self.hulls.len() }
    }

    /// Adds rings of those corners that are kept.
    pub(super) fn add_rings(&mut self, rings: &[TracedRing], corners: &[Corner], keep: &[bool]) {
        for ring in rings {
            let start = self.corners.len();
            self.corners.extend(ring.range().filter(|&at| keep[at]).map(|at| corners[at]));
            face_camera(&mut self.corners[start..], self.camera);
            self.rings.push(RingRecord { corners: start..self.corners.len(), is_hole: ring.is_hole });
        }
    }

    /// Adds the hull of the outer rings.
    pub(super) fn add_hull(&mut self, huller: &mut Huller, rings: &[TracedRing], corners: &[Corner]) {
        let start = self.hulls.len();
        let outer = rings.iter().filter(|ring| !ring.is_hole);
        huller.hull(outer.flat_map(|ring| &corners[ring.range()]), &mut self.hulls);
        face_camera(&mut self.hulls[start..], self.camera);
    }

    /// Adds the plane of the rings and the hull since `first`.
    pub(super) fn add_plane(&mut self, fitter: &mut Fitter, plane: &Plane, first: Ends) {
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

    /// The plane in metres, if each corner since `first` lies at a finite distance on it.
    fn surface(&self, plane: &Plane, first: Ends) -> Option<HessianNormalForm> {
        let surface = plane.metric.filter(|metric| metric.area_m2.is_some())?.plane;
        let camera = self.camera?;
        let mut corners = self.corners[first.corners..].iter().chain(&self.hulls[first.hulls..]);
        corners.all(|&corner| surface.point_seen_by(point(corner), &camera).is_some()).then_some(surface)
    }

    /// How far rings may deviate from the pixels' cracks, pixels.
    pub fn tolerance_px(&self) -> f64 {
        self.tolerance_px
    }

    /// Holes of fewer pixels were left out; 0 if none were ([`super::Outliner::min_hole_px`]).
    pub fn min_hole_px(&self) -> usize {
        self.min_hole_px
    }

    /// The outlines in order of label; planes without a pixel have none.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Outline<'_>> {
        self.planes.iter().map(|plane| Outline { all: self, plane })
    }

    /// The outline of the plane with that label.
    pub fn get(&self, label: u16) -> Option<Outline<'_>> {
        let at = self.planes.binary_search_by_key(&label, |plane| plane.label).ok()?;
        Some(Outline { all: self, plane: &self.planes[at] })
    }
}

/// The outline of one plane.
#[derive(Clone, Copy, Debug)]
pub struct Outline<'a> {
    all: &'a Outlines,
    plane: &'a PlaneRecord,
}

impl<'a> Outline<'a> {
    /// The plane's label.
    pub fn label(&self) -> u16 {
        self.plane.label
    }

    /// Whether it is known in metres: the camera and the plane are, and no part of it reaches
    /// infinity.
    pub fn is_metric(&self) -> bool {
        self.plane.surface.is_some()
    }

    /// The plane's parts, one for each of its 4-connected groups of pixels.
    pub fn polygons(&self) -> impl Iterator<Item = Polygon<'a>> + use<'a> {
        let outline = *self;
        let rings = &outline.all.rings[outline.plane.rings.clone()];
        rings.chunk_by(|_, next| next.is_hole).map(move |rings| Polygon { outline, rings })
    }

    /// The convex hull of its pixels' squares, counter-clockwise seen from the camera.
    pub fn hull(&self) -> Ring<'a> {
        Ring { corners: &self.all.hulls[self.plane.hull.clone()], surface: self.surface() }
    }

    /// The rectangle of least area around its pixels' squares on the picture, pixels.
    pub fn rectangle_px(&self) -> Rectangle<2> {
        self.plane.rectangle_px
    }

    /// The rectangle of least area around it on the fitted plane, metres.
    pub fn rectangle_m(&self) -> Option<Rectangle<3>> {
        self.plane.rectangle_m
    }

    fn surface(&self) -> Option<(HessianNormalForm, Sensor)> {
        self.plane.surface.zip(self.all.camera)
    }
}

/// A part of a plane: an outer ring and the holes in it.
#[derive(Clone, Copy, Debug)]
pub struct Polygon<'a> {
    outline: Outline<'a>,
    rings: &'a [RingRecord],
}

impl<'a> Polygon<'a> {
    /// The outer ring, counter-clockwise seen from the camera.
    pub fn outer(&self) -> Ring<'a> {
        self.ring(&self.rings[0])
    }

    /// The holes, clockwise seen from the camera, in raster order of their first corners.
    pub fn holes(&self) -> impl ExactSizeIterator<Item = Ring<'a>> + use<'a> {
        let polygon = *self;
        self.rings[1..].iter().map(move |ring| polygon.ring(ring))
    }

    fn ring(&self, ring: &RingRecord) -> Ring<'a> {
        Ring { corners: &self.outline.all.corners[ring.corners.clone()], surface: self.outline.surface() }
    }
}

/// A closed ring of at least three points; the last is joined to the first.
#[derive(Clone, Copy, Debug)]
pub struct Ring<'a> {
    corners: &'a [Corner],
    surface: Option<(HessianNormalForm, Sensor)>,
}

impl<'a> Ring<'a> {
    /// Its points (u, v), pixel centres at whole numbers.
    pub fn points_px(&self) -> impl ExactSizeIterator<Item = [f64; 2]> + use<'a> {
        self.corners.iter().map(|&corner| point(corner))
    }

    /// The same points on the fitted plane, metres in camera coordinates; `None` unless
    /// [`Outline::is_metric`].
    pub fn points_m(&self) -> Option<impl ExactSizeIterator<Item = [f64; 3]> + use<'a>> {
        let (plane, camera) = self.surface?;
        let on_plane = move |&corner| plane.point_seen_by(point(corner), &camera).expect("checked when it was made");
        Some(self.corners.iter().map(on_plane))
    }
}

/// Rings are traced counter-clockwise on the picture; where the picture is mirrored, they are reversed, but for their
/// first corner.
fn face_camera(ring: &mut [Corner], camera: Option<Sensor>) {
    let mirrored = camera.and_then(|sensor| sensor.intrinsics).is_some_and(|camera| camera.fx * camera.fy < 0.0);
    if let (true, [_, others @ ..]) = (mirrored, ring) {
        others.reverse();
    }
}
