//! Chords of a plane's rings that may not stay: those that meet others, and those that pass over a
//! whole ring.
//!
//! In: the chords. Out: which of those that stand for more than one crack have to be split. Two
//! chords may share an end and nothing else. Where no chords meet, rings can lie differently to each
//! other only if a chord passed over one of them: the winding numbers of a ring's point can change
//! only if the point lies between a chord and the corners that it stands for.

use super::simplify::{Cycle, Segment};
use super::trace::TracedRing;
use super::{Corner, turn};

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
    /// A corner of each ring, one that stays, by column.
    witnesses: Vec<(Corner, u32)>,
}

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
                !parted(a, b, c, d) && !parted(c, d, a, b) // their boxes overlap, which settles those in line
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

/// Whether p and q, in line with a corner, lie on the same side of it.
fn is_ahead(from: Corner, p: Corner, q: Corner) -> bool {
    let way = |to: Corner, axis: usize| i64::from(to[axis]) - i64::from(from[axis]);
    way(p, 0) * way(q, 0) + way(p, 1) * way(q, 1) > 0
}

impl Conflicts {
    /// Fills `found`; sorts the chords, which come ring by ring.
    pub(super) fn find(&mut self, chords: &mut [Chord], rings: &[TracedRing], corners: &[Corner], tolerance: f64) {
        self.choose_witnesses(chords);
        chords.sort_unstable_by_key(|chord| (chord.extent(0), chord.extent(1), chord.ring, chord.ends));
        mark_meeting(chords);
        self.mark_passing_over(chords, rings, corners, tolerance);
        self.found.clear();
        self.found.extend((0..chords.len()).filter(|&at| chords[at].found));
    }

    /// The chords come ring by ring.
    fn choose_witnesses(&mut self, chords: &[Chord]) {
        self.witnesses.clear();
        let first = |ring: &[Chord]| (ring[0].corners[0], ring[0].ring);
        self.witnesses.extend(chords.chunk_by(|a, b| a.ring == b.ring).map(first));
        self.witnesses.sort_unstable();
    }

    fn mark_passing_over(&mut self, chords: &mut [Chord], rings: &[TracedRing], corners: &[Corner], tolerance: f64) {
        if rings.len() < 2 {
            return;
        }
        for chord in chords.iter_mut().filter(|chord| !chord.is_exact()) {
            let cycle = Cycle::of(&rings[chord.ring as usize], corners);
            let segment = Segment::new(chord.corners[0], chord.corners[1]);
            let ([left, right], [top, bottom]) = (chord.extent(0), chord.extent(1));
            let reach = tolerance.min(f64::from(u16::MAX)).ceil() as u16;
            let rows = top.saturating_sub(reach)..=bottom.saturating_add(reach);
            let from = self.witnesses.partition_point(|(corner, _)| corner[0] < left.saturating_sub(reach));
            let near = self.witnesses[from..].iter().take_while(|(corner, _)| corner[0] <= right.saturating_add(reach));
            chord.found |= near
                .filter(|(corner, ring)| *ring != chord.ring && rows.contains(&corner[1]))
                .any(|&(corner, _)| segment.distance(corner) <= tolerance && chord.passes_over(corner, &cycle));
        }
    }
}

/// Marks the chords that meet others; they are sorted by their first column.
fn mark_meeting(chords: &mut [Chord]) {
    for at in 0..chords.len() {
        let chord = chords[at];
        let ([_, right], [top, bottom]) = (chord.extent(0), chord.extent(1));
        for next in at + 1..chords.len() {
            let other = chords[next];
            let ([left, _], [other_top, other_bottom]) = (other.extent(0), other.extent(1));
            if left > right {
                break;
            }
            let both_exact = chord.is_exact() && other.is_exact();
            if other_top <= bottom && top <= other_bottom && !both_exact && chord.meets(&other) {
                chords[at].found |= !chord.is_exact();
                chords[next].found |= !other.is_exact();
            }
        }
    }
}
