//! Outlines of planes as rings of points.

use crate::plane::{dp_plane, dp_ring};
use depthplanes::outline::{Outline, Outlines, Ring};
use std::ops::Range;

/// The rings of a detection, and where their points lie.
#[derive(Default)]
pub(crate) struct Rings {
    px: Vec<[f64; 2]>,
    m: Vec<[f64; 3]>,
    places: Vec<Place>,
    rings: Vec<dp_ring>,
}

/// Where the points of a ring lie.
struct Place {
    label: u16,
    px: Range<usize>,
    m: Option<usize>,
    is_hole: bool,
}

impl Rings {
    pub(crate) fn clear(&mut self) {
        self.px.clear();
        self.m.clear();
        self.places.clear();
        self.rings.clear();
    }

    /// Takes the outlines, and tells each plane which rings are its own.
    pub(crate) fn fill(&mut self, outlines: &Outlines, planes: &mut [dp_plane]) {
        for outline in outlines.iter() {
            for part in outline.polygons() {
                self.add(outline, part.outer(), false);
                part.holes().for_each(|hole| self.add(outline, hole, true));
            }
        }
        // Nothing is added any more, so that points and rings stay where they are.
        let Rings { px, m, places, rings } = self;
        rings.extend(places.iter().map(|place| dp_ring {
            points_px: px[place.px.clone()].as_ptr(),
            points_m: place.m.map_or(std::ptr::null(), |at| m[at..].as_ptr()),
            point_count: place.px.len(),
            is_hole: place.is_hole,
        }));
        let mut first = 0;
        for of_plane in places.chunk_by(|a, b| a.label == b.label) {
            let plane = &mut planes[usize::from(of_plane[0].label) - 1];
            (plane.rings, plane.ring_count) = (rings[first..].as_ptr(), of_plane.len());
            first += of_plane.len();
        }
    }

    fn add(&mut self, outline: Outline<'_>, ring: Ring<'_>, is_hole: bool) {
        let (start, start_m) = (self.px.len(), self.m.len());
        self.px.extend(ring.points_px());
        let m = ring.points_m().map(|points| self.m.extend(points)).map(|()| start_m);
        self.places.push(Place { label: outline.label(), px: start..self.px.len(), m, is_hole });
    }
}
