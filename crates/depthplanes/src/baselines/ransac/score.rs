//! How many points a plane has, found out on as few of them as necessary (section 4.5 of Schnabel et al.).
//!
//! In: a plane, points in random order. Out: bounds of the number of all points on it, from those of the first 512, 1024
//! and so on, until its connected piece is no larger than what was looked at.

use crate::baselines::cloud::Cloud;
use crate::baselines::pieces::{Pieces, Tolerance};
use crate::methods::rays::Plane3;
use crate::util::random::Random;
use crate::util::vec3::Vec3;

/// Points of the first subset.
pub(super) const FIRST: usize = 512;

/// A point that belongs to no piece.
#[derive(Clone, Copy, Debug)]
struct Oriented {
    point: Vec3,
    normal: Vec3,
    at: u32,
}

/// The points that belong to no piece, in random order: the first so many are a random subset.
#[derive(Debug)]
pub(super) struct Free {
    points: Vec<Oriented>,
}

impl Free {
    pub(super) fn new(cloud: &Cloud, random: &mut Random) -> Self {
        let oriented =
            |&at: &u32| Oriented { point: cloud.points[at as usize], normal: cloud.normals[at as usize], at };
        let mut points: Vec<_> = cloud.known.iter().map(oriented).collect();
        (1..points.len()).for_each(|last| points.swap(last, random.whole(0, last)));
        Free { points }
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// The pixel of one of them.
    pub(super) fn any(&self, random: &mut Random) -> usize {
        self.points[random.whole(0, self.points.len() - 1)].at as usize
    }

    /// Forgets those that a piece has taken.
    pub(super) fn retain(&mut self, pieces: &Pieces<'_>) {
        self.points.retain(|point| pieces.is_free(point.at as usize));
    }
}

/// A plane through three points.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) plane: Plane3,
    /// Pixels of the three points.
    pub(super) samples: [u32; 3],
    /// Points it has been tested on, and how many of them lie on it.
    tried: usize,
    hits: usize,
    /// Most points its piece can have, two standard deviations above the estimate; once the piece is known, its points.
    pub(super) most: f64,
    pub(super) is_known: bool,
}

impl Candidate {
    pub(super) fn new(plane: Plane3, samples: [u32; 3], free: &Free, tolerance: &Tolerance) -> Self {
        let mut candidate = Candidate { plane, samples, tried: 0, hits: 0, most: f64::MAX, is_known: false };
        candidate.score(free, tolerance);
        candidate
    }

    /// Begins anew after some points were taken: it may have as many as before, but not more.
    pub(super) fn restart(&mut self) {
        (self.tried, self.hits, self.is_known) = (0, 0, false);
    }

    /// Tests it on as many points again, and looks for its piece among as many.
    pub(super) fn refine(&mut self, free: &Free, pieces: &mut Pieces<'_>) {
        let tried = self.tried;
        self.score(free, &pieces.tolerance);
        pieces.work.count(self.tried - tried);
        if let Some(piece) = pieces.largest(&self.plane, &self.samples, self.tried) {
            self.most = piece.len() as f64;
            self.is_known = true;
        }
    }

    fn score(&mut self, free: &Free, tolerance: &Tolerance) {
        let upto = (2 * self.tried).clamp(FIRST, FIRST.max(free.len())).min(free.len());
        let is_on = |point: &&Oriented| tolerance.holds(&self.plane, point.point, point.normal);
        self.hits += free.points[self.tried..upto].iter().filter(is_on).count();
        self.tried = upto;
        self.most = self.most.min(self.bounds(free.len()).1);
    }

    /// The estimate of how many of all points are on it, and that plus two standard deviations: hypergeometric, as `hits` of
    /// `tried` are (eq. 10 of Schnabel et al.).
    fn bounds(&self, all: usize) -> (f64, f64) {
        let [all, tried, hits] = [all, self.tried, self.hits].map(|count| count as f64);
        let estimate = (all + 2.0) * (hits + 1.0) / (tried + 2.0) - 1.0;
        let spread = (all + 2.0) * (hits + 1.0) * (all - tried) * (tried - hits + 1.0) / (tried + 3.0);
        (estimate, estimate + 2.0 * spread.max(0.0).sqrt() / (tried + 2.0))
    }

    /// The estimate of how many of all points are on it.
    pub(super) fn estimate(&self, free: &Free) -> f64 {
        self.bounds(free.len()).0
    }
}
