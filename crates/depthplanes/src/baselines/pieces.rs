//! From planes in space to connected pieces of the image: the steps that RANSAC and the Hough transform share.
//!
//! In: a map's points, and planes that some of them suggest. Out: the region of every pixel. A piece is a connected
//! part of the points on a plane that no earlier piece has; its plane is fitted to it in q, where the sensor's noise
//! is even. Points near edges, whose normals are those of neither side, are only lent to the piece beside them: they
//! start no plane, and a later piece whose normal they share takes them.

use super::affine::Affine;
use super::cloud::Cloud;
use super::work::Work;
use crate::methods::parameter::{Param, ParamKind};
use crate::methods::rays::Plane3;
use crate::statistics::least_squares::Moments;
use crate::util::vec3::{Vec3, dot};

/// How often a plane is fitted to its piece; the piece is then sought anew.
const FITS: usize = 3;

/// The parameter that both methods have.
pub(super) const EPSILON: Param = Param {
    name: "epsilon",
    alias: None,
    default: 0.0,
    min: 0.0,
    max: f64::MAX,
    kind: ParamKind::Real,
    unit: "m or median depths",
    meaning: "How far a point may lie from its plane, in median depths where unit or camera is unknown; 0 for 1 % of the diagonal of the box around all points.",
    source: Some("Schnabel et al. 2007"),
};

/// Which points are on a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// Their largest distance.
    pub(super) epsilon: f64,
    /// Cosine of the largest angle of their normals, -1 for any.
    pub(super) cosine: f64,
}

impl Tolerance {
    /// With [`EPSILON`] as given.
    pub(super) fn new(epsilon: f64, cosine: f64, cloud: &Cloud) -> Self {
        Tolerance { epsilon: if epsilon > 0.0 { epsilon } else { 0.01 * cloud.diagonal() }, cosine }
    }

    #[inline(always)]
    pub(super) fn holds(&self, plane: &Plane3, point: Vec3, normal: Vec3) -> bool {
        plane.off(point).abs() <= self.epsilon && dot(plane.normal, normal).abs() >= self.cosine
    }
}

/// The pieces found so far.
#[derive(Debug)]
pub(super) struct Pieces<'a> {
    affine: &'a Affine,
    pub(super) cloud: &'a Cloud,
    pub(super) tolerance: Tolerance,
    /// How far the windows reach that normals are computed from, pixels.
    reach: usize,
    planes: Vec<Plane3>,
    /// For each pixel the number of its piece; 0 for none.
    image: Vec<u16>,
    /// For each pixel the last piece that it was lent to; 0 for none.
    lent: Vec<u16>,
    /// For each pixel the last search that reached it.
    reached: Vec<u32>,
    search: u32,
    /// What the whole search may still do.
    pub(super) work: Work,
}

impl<'a> Pieces<'a> {
    /// No pieces yet. Normals are from windows that reach so many pixels.
    pub(super) fn new(affine: &'a Affine, cloud: &'a Cloud, tolerance: Tolerance, reach: usize) -> Self {
        let pixels = affine.q.len();
        let (image, lent, reached) = (vec![0; pixels], vec![0; pixels], vec![0; pixels]);
        let work = Work::new(pixels);
        Pieces { affine, cloud, tolerance, reach, planes: Vec::new(), image, lent, reached, search: 0, work }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.planes.len()
    }

    /// Whether a pixel has a point that belongs to no piece and is lent to none.
    pub(super) fn is_free(&self, at: usize) -> bool {
        self.lent[at] == 0 && self.is_open(at)
    }

    /// Whether a pixel has a point that belongs to no piece; it may be lent to one.
    fn is_open(&self, at: usize) -> bool {
        // A comparison with NaN is false.
        self.image[at] == 0 && self.cloud.points[at][2] > 0.0 && self.cloud.normals[at][2] >= -1.0
    }

    /// The largest connected piece of free points on the plane that holds one of these; none if a piece has more than
    /// `most` points.
    pub(super) fn largest(&mut self, plane: &Plane3, from: &[u32], most: usize) -> Option<Vec<u32>> {
        self.largest_among(Self::is_free, plane, from, most)
    }

    fn largest_among(
        &mut self,
        is_among: fn(&Self, usize) -> bool,
        plane: &Plane3,
        from: &[u32],
        most: usize,
    ) -> Option<Vec<u32>> {
        if self.search == u32::MAX {
            self.reached.fill(0);
            self.search = 0;
        }
        self.search += 1;
        let (mut best, mut piece) = (Vec::new(), Vec::new());
        for &start in from {
            piece.clear();
            self.reach(is_among, plane, start as usize, &mut piece);
            let mut next = 0;
            while let Some(&at) = piece.get(next) {
                next += 1;
                for beside in self.affine.neighbours(at as usize) {
                    self.reach(is_among, plane, beside, &mut piece);
                }
                if piece.len() > most {
                    self.work.count(piece.len());
                    return None;
                }
            }
            self.work.count(piece.len() + 1);
            if piece.len() > best.len() {
                std::mem::swap(&mut best, &mut piece);
            }
        }
        Some(best)
    }

    /// Adds a pixel to a piece, if it is on the plane and was not reached before.
    fn reach(&mut self, is_among: fn(&Self, usize) -> bool, plane: &Plane3, at: usize, piece: &mut Vec<u32>) {
        let (point, normal) = (self.cloud.points[at], self.cloud.normals[at]);
        if self.reached[at] != self.search && is_among(self, at) && self.tolerance.holds(plane, point, normal) {
            self.reached[at] = self.search;
            piece.push(at as u32);
        }
    }

    /// Takes the piece around these points, its plane fitted to it, unless it has `min-pixels` points or fewer. Returns how
    /// many points are no longer free.
    pub(super) fn take(&mut self, plane: &Plane3, from: &[u32], min_pixels: usize) -> Option<usize> {
        let (mut plane, mut piece) = (*plane, self.largest_among(Self::is_open, plane, from, usize::MAX)?);
        for _ in 0..FITS {
            let fitted = self.fit(&piece)?;
            let larger = self.largest_among(Self::is_open, &fitted, &piece, usize::MAX)?;
            if larger.len() < piece.len() {
                break;
            }
            (plane, piece) = (fitted, larger);
        }
        if piece.len() <= min_pixels || piece.is_empty() {
            return None;
        }
        self.planes.push(plane);
        let taken = piece.iter().filter(|&&at| self.is_free(at as usize)).count();
        piece.iter().for_each(|&at| self.image[at as usize] = self.planes.len() as u16);
        Some(taken + self.lend(&plane, piece))
    }

    /// Lends a piece the free points beside it that lie on its plane, as far as the windows of normals reach. Returns
    /// how many.
    fn lend(&mut self, plane: &Plane3, piece: Vec<u32>) -> usize {
        let (number, mut rim, mut count) = (self.planes.len() as u16, piece, 0);
        // Corners of windows are twice as many steps away.
        for _ in 0..2 * self.reach {
            let mut next = Vec::new();
            for beside in rim.iter().flat_map(|&at| self.affine.neighbours(at as usize)) {
                let is_near = || plane.off(self.cloud.points[beside]).abs() <= self.tolerance.epsilon;
                if self.is_free(beside) && is_near() {
                    self.lent[beside] = number;
                    next.push(beside as u32);
                }
            }
            count += next.len();
            rim = next;
        }
        count
    }

    /// The least-squares plane of some points.
    fn fit(&self, piece: &[u32]) -> Option<Plane3> {
        let origin = *piece.first()? as usize;
        let ([u0, v0], q0) = (self.affine.place(origin), self.affine.q[origin]);
        let mut sums = Moments::default();
        for &at in piece {
            let [u, v] = self.affine.place(at as usize);
            sums.add(u - u0, v - v0, self.affine.q[at as usize] - q0);
        }
        let [a, b, c] = sums.fit()?.abc;
        self.cloud.rays.plane([a, b, c + q0 - a * u0 - b * v0])
    }

    /// The region of every pixel. What is lent now belongs; points beside a piece that lie on its plane and are in no
    /// other are given to it.
    pub(super) fn finish(self) -> Vec<u16> {
        let Pieces { affine, cloud, tolerance, planes, mut image, lent, .. } = self;
        image.iter_mut().zip(lent).filter(|(piece, _)| **piece == 0).for_each(|(piece, lent)| *piece = lent);
        affine.spread(&mut image, |at, piece| {
            planes[usize::from(piece) - 1].off(cloud.points[at]).abs() <= tolerance.epsilon
        });
        image
    }
}
