//! Small holes, which outlines may leave out.
//!
//! In: traced rings, grouped by plane, polygons in the order of their first pixels. Out: the same without the holes of
//! fewer pixels than wanted, and without the polygons of the same plane that stood in one of these, since they are now
//! in its filled area. Other planes' rings stay as they are.

use super::corner::Corner;
use super::trace::{TracedRing, doubled_area};

/// Leaves out small holes; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct HoleFilter {
    /// Pixels of the smallest hole that stays.
    pub(super) min_px: usize,
    /// The plane's outer rings, by their places.
    outers: Vec<usize>,
    /// Polygons that stood in a hole that is gone.
    covered: Vec<u32>,
}

impl HoleFilter {
    pub(super) fn filter(&mut self, rings: &mut Vec<TracedRing>, corners: &[Corner]) {
        if self.min_px <= 1 {
            return;
        }
        let min_px = self.min_px as u64;
        let is_small = |ring: &TracedRing| {
            ring.is_hole && doubled_area(&corners[ring.range()]).unsigned_abs() < min_px.saturating_mul(2)
        };
        self.covered.clear();
        for plane in rings.chunk_by(|a, b| a.label == b.label) {
            self.cover(plane, corners, is_small);
        }
        self.covered.sort_unstable();
        rings.retain(|ring| !is_small(ring) && self.covered.binary_search(&ring.polygon).is_err());
    }

    /// Finds the polygons of a plane that stand in its small holes.
    fn cover(&mut self, plane: &[TracedRing], corners: &[Corner], is_small: impl Fn(&TracedRing) -> bool) {
        self.outers.clear();
        self.outers.extend((0..plane.len()).filter(|&at| !plane[at].is_hole));
        if self.outers.len() < 2 {
            return;
        }
        let start = |at: usize| corners[plane[at].first];
        for hole in plane.iter().filter(|ring| is_small(ring)) {
            let ring = &corners[hole.range()];
            let (low, high) = ring.iter().fold((u16::MAX, 0), |(low, high), c| (low.min(c[1]), high.max(c[1])));
            let first = self.outers.partition_point(|&at| start(at)[1] < low);
            let near = self.outers[first..].iter().take_while(|&&at| start(at)[1] < high);
            self.covered.extend(near.filter(|&&at| encloses(ring, start(at))).map(|&at| plane[at].polygon));
        }
    }
}

/// Whether a ring encloses the pixel with that upper left corner.
fn encloses(ring: &[Corner], [x, y]: Corner) -> bool {
    let mut inside = false;
    let mut last = ring[ring.len() - 1];
    for &corner in ring {
        let crosses = last[0] == corner[0] && corner[0] <= x;
        inside ^= crosses && last[1].min(corner[1]) <= y && y < last[1].max(corner[1]);
        last = corner;
    }
    inside
}
