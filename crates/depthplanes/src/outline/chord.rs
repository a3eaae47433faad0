//! Rings as cycles of corners, and distances from chords.

use super::corner::Corner;
use super::trace::TracedRing;

/// A ring as a cycle of corners: places count on past its end.
#[derive(Clone, Copy)]
pub(super) struct Cycle<'a>(&'a [Corner]);

impl<'a> Cycle<'a> {
    pub(super) fn of(ring: &TracedRing, corners: &'a [Corner]) -> Self {
        Cycle(&corners[ring.range()])
    }

    #[inline]
    pub(super) fn at(&self, place: usize) -> Corner {
        let n = self.0.len();
        self.0[if place < n { place } else { place - n }]
    }
}

/// A chord, for distances from it.
pub(super) struct Segment {
    start: [f64; 2],
    way: [f64; 2],
    pub(super) squared_length: f64,
}

impl Segment {
    /// The two corners must differ.
    pub(super) fn new(a: Corner, b: Corner) -> Self {
        let (start, end) = (a.map(f64::from), b.map(f64::from));
        let way = [end[0] - start[0], end[1] - start[1]];
        Segment { start, way, squared_length: way[0] * way[0] + way[1] * way[1] }
    }

    /// Distance of a corner, pixels.
    pub(super) fn distance(&self, corner: Corner) -> f64 {
        (self.squared_distance_scaled(corner) / self.squared_length).sqrt()
    }

    /// The squared distance of a corner, times the squared length.
    #[inline]
    pub(super) fn squared_distance_scaled(&self, corner: Corner) -> f64 {
        let [x, y] = [f64::from(corner[0]) - self.start[0], f64::from(corner[1]) - self.start[1]];
        let along = x * self.way[0] + y * self.way[1];
        if (0.0..=self.squared_length).contains(&along) {
            return (x * self.way[1] - y * self.way[0]).powi(2);
        }
        let end = if along < 0.0 { [0.0; 2] } else { self.way };
        ((x - end[0]).powi(2) + (y - end[1]).powi(2)) * self.squared_length
    }
}
