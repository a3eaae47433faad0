//! Planes through three points near each other (section 4.3 of Schnabel et al.).
//!
//! In: the points that are left. Out: candidates. The first point is any; the others are drawn from the cell of the
//! quadtree over pixels that holds it, at a level that has served well. A plane is dropped if its three points have
//! other normals than it.

use super::score::{Candidate, Free};
use crate::baselines::affine::Affine;
use crate::baselines::pieces::Pieces;
use crate::methods::rays::Plane3;
use crate::util::random::Random;
use crate::util::vec3::dot;

/// Columns and rows of the smallest cells.
const SMALLEST: usize = 16;
/// Most tries to find a free point in a cell.
const TRIES: usize = 16;
/// Share of the draws that are spread evenly over the levels (section 4.3).
const EVEN: f64 = 0.1;

/// Makes draws and counts them.
#[derive(Debug)]
pub(super) struct Draws {
    width: usize,
    height: usize,
    /// For each level the points of the candidates that it gave, smallest cells first.
    merits: Vec<f64>,
    made: f64,
}

impl Draws {
    pub(super) fn new(affine: &Affine) -> Self {
        let &Affine { width, height, .. } = affine;
        let halvings = width.max(height).div_ceil(SMALLEST).next_power_of_two().ilog2();
        Draws { width, height, merits: vec![1.0; halvings as usize + 1], made: 0.0 }
    }

    /// A plane through three points, if they agree on one.
    pub(super) fn draw(&mut self, free: &Free, pieces: &Pieces<'_>, random: &mut Random) -> Option<Candidate> {
        self.made += 1.0;
        let level = self.level(random);
        let first = free.any(random);
        let samples = [first, self.beside(first, level, pieces, random)?, self.beside(first, level, pieces, random)?];
        let plane = Plane3::through(samples.map(|at| pieces.cloud.points[at]))?;
        let agrees = |&at: &usize| dot(plane.normal, pieces.cloud.normals[at]).abs() >= pieces.tolerance.cosine;
        if !samples.iter().all(agrees) {
            return None;
        }
        let candidate = Candidate::new(plane, samples.map(|at| at as u32), free, &pieces.tolerance);
        self.merits[level] += candidate.estimate(free);
        Some(candidate)
    }

    /// Draws a level, those of more merit more often.
    fn level(&self, random: &mut Random) -> usize {
        let last = self.merits.len() - 1;
        if random.uniform() < EVEN {
            return random.whole(0, last);
        }
        let mut left = random.uniform() * self.merits.iter().sum::<f64>();
        let is_it = |merit: &f64| {
            left -= merit;
            left < 0.0
        };
        self.merits.iter().position(is_it).unwrap_or(last)
    }

    /// A free point in the cell of a pixel.
    fn beside(&self, at: usize, level: usize, pieces: &Pieces<'_>, random: &mut Random) -> Option<usize> {
        let side = SMALLEST << level;
        let mut within = |place: usize, end: usize| {
            let low = place / side * side;
            random.whole(low, (low + side).min(end) - 1)
        };
        let (u, v) = (at % self.width, at / self.width);
        let mut anywhere = || within(v, self.height) * self.width + within(u, self.width);
        (0..TRIES).map(|_| anywhere()).find(|&other| pieces.is_free(other))
    }

    /// The probability that a plane of `size` points was missed by all draws (eq. 7): one draw gives it with
    /// probability `size / (all levels 2^(k-1))`, k being 3 points.
    pub(super) fn missed(&self, size: f64, all: usize) -> f64 {
        let drawn = size / (all as f64 * self.merits.len() as f64 * 4.0);
        (1.0 - drawn.min(1.0)).powf(self.made)
    }

    /// Forgets draws when a share of the points is taken: those with one of these among their three.
    pub(super) fn forget(&mut self, share: f64) {
        self.made *= (1.0 - share).powi(3);
    }
}
