//! Separate pieces of one geometric plane, joined: a wall on both sides of a column, table tops of one height.
//!
//! In: planes in metres and the runs of their pixels. Out: which of them are one plane (`Joiner::labels`), and the
//! planes as they were ([`Part`]). The union is fitted anew from its pixels by the caller.
//!
//! Two planes are coplanar if their normals differ by at most an angle and each one's centroid lies within a distance
//! of the other's plane. That is symmetric, and stricter the further apart they are: an angle between them lifts
//! either centroid off the other plane by its sine times their separation.
//!
//! Any two parts of a union are coplanar (complete linkage). Chains would let planes drift: in a floor that curves by
//! a degree from piece to piece, each piece is coplanar with the next, but the last with none of the first. Joining
//! by the plane fitted to the union so far would drift more slowly, and depend on the order. Planes are taken in
//! order of size, as the equations of large ones are known best, and each goes to the union it lies nearest to.
//!
//! Not for small and noisy pieces far from each other: their normals are off by degrees, and they stay as they are.

use crate::components::selection::LabelledRun;
use crate::detection::{MetricPlane, Part, Plane};
use crate::error::{Error, Result};
use crate::limits::MAX_PLANES;
use crate::util::memory::reserve_to;
use crate::util::vec3::{cross, dot};

/// How far two planes may be from one plane and still be joined.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Coplanar {
    /// Largest angle between their normals, degrees, 0..=90.
    pub angle_deg: f64,
    /// Largest distance of either one's centroid from the other's plane, metres, 0 and up.
    pub distance_m: f64,
}

impl Default for Coplanar {
    /// 3 degrees and 3 centimetres: what a depth camera's error leaves between pieces of a wall a few metres away, where
    /// normals of a thousand pixels are off by a degree or two and depth by a per cent. Things thinner than that, a book
    /// or a board, are joined with what they lie on; where these matter, take less.
    fn default() -> Self {
        Coplanar { angle_deg: 3.0, distance_m: 0.03 }
    }
}

impl Coplanar {
    /// Checked limits.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless the angle is a number from 0 to 90 and the distance a finite one from 0 up.
    pub fn new(angle_deg: f64, distance_m: f64) -> Result<Self> {
        let wrong = |name, given, accepted: &str| Error::Parameter { name, given, accepted: accepted.to_string() };
        if !(0.0..=90.0).contains(&angle_deg) {
            return Err(wrong("merge-coplanar: angle", angle_deg, "a number of degrees from 0 to 90"));
        }
        if !(distance_m >= 0.0 && distance_m.is_finite()) {
            return Err(wrong("merge-coplanar: distance", distance_m, "a number of metres from 0 up"));
        }
        Ok(Coplanar { angle_deg, distance_m })
    }

    /// Whether two planes are coplanar; the same for `(b, a)`.
    pub fn holds(&self, a: &MetricPlane, b: &MetricPlane) -> bool {
        self.limits().distance(a, b).is_some()
    }

    fn limits(&self) -> Limits {
        Limits { sine: self.angle_deg.to_radians().sin(), distance_m: self.distance_m }
    }
}

/// [`Coplanar`], made ready for many pairs.
#[derive(Clone, Copy, Debug)]
struct Limits {
    sine: f64,
    distance_m: f64,
}

impl Limits {
    /// How far two planes are apart, metres, if they are coplanar: the larger distance of a centroid from the other
    /// plane.
    fn distance(&self, a: &MetricPlane, b: &MetricPlane) -> Option<f64> {
        let off = |plane: &MetricPlane, point| (dot(plane.plane.normal, point) + plane.plane.distance).abs();
        let distance = off(a, b.centroid_m).max(off(b, a.centroid_m));
        (distance <= self.distance_m && self.is_parallel(a.plane.normal, b.plane.normal)).then_some(distance)
    }

    /// Compares the sine, which tells small angles apart where the cosine is 1 to the last digit.
    fn is_parallel(&self, a: [f64; 3], b: [f64; 3]) -> bool {
        let across = cross(a, b);
        dot(a, b) >= 0.0 && dot(across, across) <= self.sine * self.sine
    }
}

/// Finds the planes that are one; reuses its memory from map to map. The time grows with the number of planes times
/// that of unions.
#[derive(Debug)]
pub(crate) struct Joiner {
    limits: Limits,
    unions: Vec<Union>,
    /// For each plane its union, and the next plane in it.
    members: Vec<Member>,
    order: Vec<usize>,
    labels: Vec<u16>,
    /// The pixels of the planes as they were, where somebody will ask for them.
    pieces: Option<Vec<LabelledRun>>,
}

/// Planes that are one. The first is the largest.
#[derive(Clone, Copy, Debug)]
struct Union {
    first: usize,
    last: usize,
    pixel_count: usize,
    /// Its first run in raster order.
    first_run: usize,
}

#[derive(Clone, Copy, Debug)]
struct Member {
    union: usize,
    next: Option<usize>,
}

impl Joiner {
    /// Joins planes within these limits.
    ///
    /// # Errors
    /// As [`Coplanar::new`].
    pub fn new(coplanar: Coplanar) -> Result<Self> {
        let limits = Coplanar::new(coplanar.angle_deg, coplanar.distance_m)?.limits();
        Ok(Joiner {
            limits,
            unions: Vec::new(),
            members: Vec::new(),
            order: Vec::new(),
            labels: Vec::new(),
            pieces: None,
        })
    }

    /// Finds which planes are one; returns whether any are. `planes` are those of the labels 1, 2, .. in `runs`, by
    /// decreasing pixel count.
    pub fn join(&mut self, planes: &[Plane], runs: &[LabelledRun]) -> bool {
        self.clear();
        for at in 0..planes.len() {
            match self.nearest(planes, at) {
                Some(union) => self.add(union, planes, at),
                None => self.begin(planes, at),
            }
        }
        self.number(runs);
        if let Some(pieces) = &mut self.pieces {
            pieces.clear();
            pieces.extend_from_slice(runs);
        }
        self.unions.len() < planes.len()
    }

    /// Keeps the pixels of the planes for [`Joiner::paint_pieces`].
    pub fn keep_pieces(&mut self) {
        self.pieces.get_or_insert_default();
    }

    /// The label image before joining.
    pub fn paint_pieces(&self, pixels: usize, width: usize, image: &mut Vec<u16>) {
        image.clear();
        image.resize(pixels, 0);
        for run in self.pieces.iter().flatten() {
            let row = run.v as usize * width;
            image[row + run.u_first as usize..=row + run.u_last as usize].fill(run.label);
        }
    }

    /// For each label from 1 the one after joining: by decreasing pixel count of the unions, equal counts by first pixel
    /// in raster order.
    pub fn labels(&self) -> &[u16] {
        &self.labels
    }

    /// The planes that were joined with others, by label of the union, then by their own.
    pub fn parts(&self, planes: &[Plane], parts: &mut Vec<Part>) {
        reserve_to(parts, MAX_PLANES);
        for (&union, of) in self.order.iter().zip(1..) {
            let first = self.unions[union].first;
            let is_joined = self.members[first].next.is_some();
            let part = |at: usize| Part { of, plane: planes[at].clone() };
            parts.extend(self.chain(first).filter(|_| is_joined).map(part));
        }
    }

    /// Empties all, with room for the most planes there can be, so that no later map needs more.
    fn clear(&mut self) {
        reserve_to(&mut self.unions, MAX_PLANES);
        reserve_to(&mut self.members, MAX_PLANES);
        reserve_to(&mut self.order, MAX_PLANES);
        reserve_to(&mut self.labels, MAX_PLANES);
    }

    /// The union all of whose members are coplanar with a plane. If there are several, the one whose furthest member
    /// is nearest.
    fn nearest(&self, planes: &[Plane], at: usize) -> Option<usize> {
        let mine = planes[at].metric.as_ref()?;
        let mut best = None;
        for (index, union) in self.unions.iter().enumerate() {
            let to = |member: usize| self.limits.distance(planes[member].metric.as_ref()?, mine);
            let furthest = self.chain(union.first).try_fold(0.0, |most: f64, member| Some(most.max(to(member)?)));
            if let Some(distance) = furthest.filter(|&distance| best.is_none_or(|(least, _)| distance < least)) {
                best = Some((distance, index));
            }
        }
        best.map(|(_, index)| index)
    }

    /// The planes of a union, from its first.
    fn chain(&self, first: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(first), |&at| self.members[at].next)
    }

    fn begin(&mut self, planes: &[Plane], at: usize) {
        let pixel_count = planes[at].pixel_count;
        self.members.push(Member { union: self.unions.len(), next: None });
        self.unions.push(Union { first: at, last: at, pixel_count, first_run: usize::MAX });
    }

    fn add(&mut self, union: usize, planes: &[Plane], at: usize) {
        self.members.push(Member { union, next: None });
        let union = &mut self.unions[union];
        self.members[union.last].next = Some(at);
        union.last = at;
        union.pixel_count += planes[at].pixel_count;
    }

    /// Puts the unions into order and labels the planes by it.
    fn number(&mut self, runs: &[LabelledRun]) {
        let Joiner { unions, members, order, labels, .. } = self;
        for (at, run) in runs.iter().enumerate() {
            let union = &mut unions[members[usize::from(run.label) - 1].union];
            union.first_run = union.first_run.min(at);
        }
        order.extend(0..unions.len());
        order.sort_unstable_by_key(|&union| (std::cmp::Reverse(unions[union].pixel_count), unions[union].first_run));
        labels.resize(members.len(), 0);
        for (&union, label) in order.iter().zip(1..) {
            let mut at = Some(unions[union].first);
            while let Some(member) = at {
                labels[member] = label;
                at = members[member].next;
            }
        }
    }
}
