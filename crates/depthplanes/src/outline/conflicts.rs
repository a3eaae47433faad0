//! Chords of a plane's rings that may not stay: those that meet others, and those that pass over a whole ring.
//!
//! In: the chords. Out: which of those that stand for more than one crack have to be split. Two chords may share an
//! end and nothing else. As long as no chords meet, a ring can change sides of another only if a chord passed over
//! it: the winding numbers of a ring's point can change only if the point lies between a chord and the corners that
//! it stands for.

use super::chord::{Cycle, Segment};
use super::corner::{Corner, turn};
use super::trace::TracedRing;

/// A straight piece of a simplified ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    /// Number of the ring.
    pub(super) ring: u32,
    /// Places of both ends in the ring.
    pub(super) ends: [usize; 2],
    corners: [Corner; 2],
    found: bool,
}

/// Finds conflicts; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Conflicts {
    /// Indices of the chords that have to be split.
    pub(super) found: Vec<usize>,
    /// For each band that a chord passes through: the band, the chord's first column, its index.
    passages: Vec<(u16, u16, u32)>,
    /// A corner of each ring, one that stays: its band, the corner, the number of its ring.
    witnesses: Vec<(u16, Corner, u32)>,
}

/// Rows of a band: within one, chords are told apart by their columns.
const BAND: u16 = 8;

impl Chord {
    pub(super) fn new(ring: u32, ends: [usize; 2], cycle: &Cycle<'_>) -> Self {
        Chord { ring, ends, corners: ends.map(|place| cycle.at(place)), found: false }
    }

    /// Whether it stands for one crack, or several in a row, and lies on them.
    fn is_exact(&self) -> bool {
        self.ends[1] == self.ends[0] + 1
    }

    /// Its first and last coordinate along an axis.
    fn extent(&self, axis: usize) -> [u16; 2] {
        let [a, b] = self.corners.map(|corner| corner[axis]);
        [a.min(b), a.max(b)]
    }

    /// Whether the two have a point in common that is not an end of both.
    fn meets(&self, other: &Chord) -> bool {
        let ([a, b], [c, d]) = (self.corners, other.corners);
        match [(a, b, c, d), (a, b, d, c), (b, a, c, d), (b, a, d, c)].into_iter().find(|(p, _, q, _)| p == q) {
            Some((shared, p, _, q)) => p == q || (turn(shared, p, q) == 0 && is_ahead(shared, p, q)),
            None => {
                let parted = |a, b, c, d| turn(a, b, c).signum() * turn(a, b, d).signum() > 0;
                !parted(a, b, c, d) && !parted(c, d, a, b) // their boxes overlap, which decides for collinear ones
            }
        }
    }

    /// Whether a corner of another ring lies between it and the corners that it stands for.
    fn passes_over(&self, corner: Corner, cycle: &Cycle<'_>) -> bool {
        let mut winding = 0;
        let mut add = |a: Corner, b: Corner| {
            let side = turn(a, b, corner).signum();
            match (a[1] <= corner[1], b[1] <= corner[1]) {
                (true, false) if side > 0 => winding += 1,
                (false, true) if side < 0 => winding -= 1,
                _ => (),
            }
        };
        (self.ends[0]..self.ends[1]).for_each(|place| add(cycle.at(place), cycle.at(place + 1)));
        add(self.corners[1], self.corners[0]);
        winding != 0
    }
}

/// Whether p and q, collinear with a corner, lie on the same side of it.
fn is_ahead(from: Corner, p: Corner, q: Corner) -> bool {
    let way = |to: Corner, axis: usize| i64::from(to[axis]) - i64::from(from[axis]);
    way(p, 0) * way(q, 0) + way(p, 1) * way(q, 1) > 0
}

impl Conflicts {
    /// Fills `found`. The chords come ring by ring.
    pub(super) fn find(&mut self, chords: &mut [Chord], rings: &[TracedRing], corners: &[Corner], tolerance: f64) {
        self.found.clear();
        if chords.iter().all(Chord::is_exact) {
            return;
        }
        self.mark_meeting(chords);
        if rings.len() > 1 {
            self.mark_passing_over(chords, rings, corners, tolerance);
        }
        self.found.extend((0..chords.len()).filter(|&at| chords[at].found));
    }

    fn mark_meeting(&mut self, chords: &mut [Chord]) {
        self.passages.clear();
        for (index, chord) in (0..).zip(&*chords) {
            let ([left, _], [top, bottom]) = (chord.extent(0), chord.extent(1));
            self.passages.extend((top / BAND..=bottom / BAND).map(|band| (band, left, index)));
        }
        self.passages.sort_unstable();
        for (at, &(band, _, index)) in self.passages.iter().enumerate() {
            let chord = chords[index as usize];
            let ([_, right], [top, bottom]) = (chord.extent(0), chord.extent(1));
            let near = self.passages[at + 1..].iter().take_while(|(other, left, _)| *other == band && *left <= right);
            for &(_, _, other_index) in near {
                let other = chords[other_index as usize];
                let [other_top, other_bottom] = other.extent(1);
                let both_exact = chord.is_exact() && other.is_exact();
                if !both_exact && other_top <= bottom && top <= other_bottom && chord.meets(&other) {
                    chords[index as usize].found |= !chord.is_exact();
                    chords[other_index as usize].found |= !other.is_exact();
                }
            }
        }
    }

    fn mark_passing_over(&mut self, chords: &mut [Chord], rings: &[TracedRing], corners: &[Corner], tolerance: f64) {
        self.witnesses.clear();
        let witness = |ring: &[Chord]| (ring[0].corners[0][1] / BAND, ring[0].corners[0], ring[0].ring);
        self.witnesses.extend(chords.chunk_by(|a, b| a.ring == b.ring).map(witness));
        self.witnesses.sort_unstable();
        let reach = tolerance.min(f64::from(u16::MAX)).ceil() as u16;
        for chord in chords.iter_mut().filter(|chord| !chord.is_exact()) {
            let cycle = Cycle::of(&rings[chord.ring as usize], corners);
            let segment = Segment::new(chord.corners[0], chord.corners[1]);
            let [[left, right], [top, bottom]] =
                [0, 1].map(|axis| chord.extent(axis)).map(|[a, b]| [a.saturating_sub(reach), b.saturating_add(reach)]);
            for band in top / BAND..=bottom / BAND {
                let from = self.witnesses.partition_point(|(other, corner, _)| (*other, corner[0]) < (band, left));
                let near = &self.witnesses[from..];
                chord.found |= near
                    .iter()
                    .take_while(|(other, corner, _)| *other == band && corner[0] <= right)
                    .filter(|(_, corner, ring)| *ring != chord.ring && segment.distance(*corner) <= tolerance)
                    .any(|&(_, corner, _)| chord.passes_over(corner, &cycle));
            }
        }
    }
}
