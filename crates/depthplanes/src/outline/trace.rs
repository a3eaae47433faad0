//! Rings of cracks around the pixels of each plane.
//!
//! In: a label image. Out: rings of corners, counter-clockwise on the picture around the plane's
//! pixels and clockwise around holes in them, grouped by plane, each outer ring followed by its holes.
//!
//! A ring is followed from the first crack, in raster order, that no ring has passed. Pixels that touch at a corner
//! only are not neighbours, so that the path turns to the pixel it came along. A ring that comes to a point for the
//! second time encloses background in between; that part is cut off as a ring of its own, so that every ring is a
//! simple polygon.

use super::corner::Corner;
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::limits::{MAX_PIXELS, MAX_SIDE};
use std::ops::Range;

/// A ring: where its corners lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct TracedRing {
    pub(super) label: u16,
    /// The polygon that it belongs to, counted by first pixel.
    pub(super) polygon: u32,
    pub(super) is_hole: bool,
    pub(super) first: usize,
    pub(super) end: usize,
}

impl TracedRing {
    pub(super) fn range(&self) -> Range<usize> {
        self.first..self.end
    }

    /// Where the corner of a place of the ring lies; places count on past its end.
    pub(super) fn place(&self, place: usize) -> usize {
        let n = self.end - self.first;
        self.first + if place < n { place } else { place - n }
    }
}

/// Traces rings; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Tracer {
    pub(super) rings: Vec<TracedRing>,
    pub(super) corners: Vec<Corner>,
    /// Which corners must stay: those where rings of a plane touch, for now.
    pub(super) keep: Vec<bool>,
    /// For each pixel, the polygon whose ring passed the crack at its left, from 1; 0 for none.
    polygon_at: Vec<u32>,
    /// For each label, the polygon of its last crack that the scan met.
    last_polygon: Vec<u32>,
    polygons: u32,
    path: Path,
}

/// The ring being followed.
#[derive(Debug, Default)]
struct Path {
    corners: Vec<Corner>,
    touches: Vec<bool>,
    /// For each corner of the map, its place in `corners` plus 1 if the path may come here again.
    place: Vec<u32>,
    width: usize,
}

/// Down, right, up, left: each is a quarter turn counter-clockwise from the one before.
const STEPS: [[u16; 2]; 4] = [[0, 1], [1, 0], [0, u16::MAX], [u16::MAX, 0]];
const DOWN: usize = 0;
/// From a corner to the pixels ahead of a step, at its left and at its right hand.
const AHEAD: [[[u16; 2]; 2]; 4] = [
    [[0, 0], [u16::MAX, 0]],
    [[0, u16::MAX], [0, 0]],
    [[u16::MAX, u16::MAX], [0, u16::MAX]],
    [[u16::MAX, 0], [u16::MAX, u16::MAX]],
];

fn moved([x, y]: Corner, [dx, dy]: [u16; 2]) -> Corner {
    [x.wrapping_add(dx), y.wrapping_add(dy)]
}

/// A label image.
#[derive(Clone, Copy)]
struct Labels<'a> {
    width: usize,
    height: usize,
    labels: &'a [u16],
}

impl<'a> Labels<'a> {
    fn of(detection: &Detection, labels: &'a [u16]) -> Result<Self> {
        let Detection { width, height, .. } = *detection;
        let fits = |side| (1..=MAX_SIDE).contains(&side);
        if !fits(width) || !fits(height) || width * height > MAX_PIXELS {
            return Err(Error::Size { width, height });
        }
        if labels.len() != width * height {
            return Err(Error::Length { given: labels.len(), least: width * height, most: width * height });
        }
        Ok(Labels { width, height, labels })
    }

    /// Whether a pixel carries the label. Coordinates before the first wrap round to beyond the last.
    #[inline]
    fn holds(&self, [u, v]: [u16; 2], label: u16) -> bool {
        let (u, v) = (usize::from(u), usize::from(v));
        u < self.width && v < self.height && self.labels[v * self.width + u] == label
    }
}

impl Tracer {
    /// Traces all rings; labels without a plane are background.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::Length`].
    pub(super) fn trace(&mut self, detection: &Detection, labels: &[u16]) -> Result<()> {
        let map = Labels::of(detection, labels)?;
        self.start(&map, detection.planes.len());
        for (v, row) in map.labels.chunks_exact(map.width).enumerate() {
            let mut left = 0;
            for (u, &label) in row.iter().enumerate() {
                if label != left && label != 0 && usize::from(label) < self.last_polygon.len() {
                    self.meet(&map, [u as u16, v as u16], label);
                }
                left = label;
            }
        }
        // Cut-off holes may stand before their outer ring.
        self.rings.sort_unstable_by_key(|ring| (ring.label, ring.polygon, ring.is_hole, ring.first));
        Ok(())
    }

    fn start(&mut self, map: &Labels<'_>, planes: usize) {
        self.rings.clear();
        self.corners.clear();
        self.keep.clear();
        self.polygons = 0;
        self.polygon_at.clear();
        self.polygon_at.resize(map.labels.len(), 0);
        self.last_polygon.clear();
        self.last_polygon.resize(planes.min(u16::MAX.into()) + 1, 0);
        self.path.width = map.width + 1;
        self.path.place.clear();
        self.path.place.resize(self.path.width * (map.height + 1), 0);
    }

    /// The scan has come to a pixel whose left neighbour has another label.
    fn meet(&mut self, map: &Labels<'_>, pixel: [u16; 2], label: u16) {
        let at = usize::from(pixel[1]) * map.width + usize::from(pixel[0]);
        if self.polygon_at[at] == 0 {
            // A hole is met at the end of its first row, where the pixel above is the plane's; the
            // plane's crack before that, in the same row, stands left of the hole.
            let in_hole = map.holds(moved(pixel, [0, u16::MAX]), label);
            if !in_hole {
                self.polygons += 1;
            }
            let polygon = if in_hole { self.last_polygon[usize::from(label)] } else { self.polygons };
            self.follow(map, pixel, label, polygon);
        }
        self.last_polygon[usize::from(label)] = self.polygon_at[at];
    }

    /// Follows the ring that goes down the left side of a pixel, the plane at its left hand.
    fn follow(&mut self, map: &Labels<'_>, start: Corner, label: u16, polygon: u32) {
        let (mut at, mut direction, mut touches) = (start, DOWN, false);
        loop {
            if let (true, Some(place)) = (touches, self.path.place_of(at)) {
                self.finish(label, polygon, place);
            } else {
                self.path.push(at, touches);
            }
            loop {
                if direction == DOWN {
                    self.polygon_at[usize::from(at[1]) * map.width + usize::from(at[0])] = polygon;
                }
                at = moved(at, STEPS[direction]);
                let [left, right] = AHEAD[direction].map(|step| map.holds(moved(at, step), label));
                if !left {
                    (direction, touches) = ((direction + 1) % 4, right);
                    break;
                }
                if right {
                    (direction, touches) = ((direction + 3) % 4, false);
                    break;
                }
            }
            if at == start && direction == DOWN {
                break;
            }
        }
        self.finish(label, polygon, 0);
        self.path.corners.clear();
        self.path.touches.clear();
    }

    /// Takes the path since a place as a ring; its first corner stays on the path.
    fn finish(&mut self, label: u16, polygon: u32, place: usize) {
        let first = self.corners.len();
        self.corners.extend_from_slice(&self.path.corners[place..]);
        self.keep.extend_from_slice(&self.path.touches[place..]);
        let is_hole = doubled_area(&self.corners[first..]) > 0;
        self.rings.push(TracedRing { label, polygon, is_hole, first, end: self.corners.len() });
        self.path.forget(place);
    }
}

impl Path {
    fn push(&mut self, corner: Corner, touches: bool) {
        self.corners.push(corner);
        self.touches.push(touches);
        if touches {
            let index = self.index(corner);
            self.place[index] = self.corners.len() as u32;
        }
    }

    fn place_of(&self, corner: Corner) -> Option<usize> {
        (self.place[self.index(corner)] as usize).checked_sub(1)
    }

    /// Drops the path after a place; the place itself will not be reached again.
    fn forget(&mut self, place: usize) {
        for at in place..self.corners.len() {
            if self.touches[at] {
                let index = self.index(self.corners[at]);
                self.place[index] = 0;
            }
        }
        self.corners.truncate(place + 1);
        self.touches.truncate(place + 1);
    }

    fn index(&self, [x, y]: Corner) -> usize {
        usize::from(y) * self.width + usize::from(x)
    }
}

/// Twice the area of a ring; below 0 if it runs counter-clockwise on the picture.
pub(super) fn doubled_area(corners: &[Corner]) -> i64 {
    let (Some(&first), Some(&last)) = (corners.first(), corners.last()) else { return 0 };
    let cross = |[ax, ay]: Corner, [bx, by]: Corner| i64::from(ax) * i64::from(by) - i64::from(bx) * i64::from(ay);
    corners.windows(2).map(|pair| cross(pair[0], pair[1])).sum::<i64>() + cross(last, first)
}
