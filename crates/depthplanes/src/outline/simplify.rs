//! Which corners of a plane's rings stay, by Douglas and Peucker.
//!
//! In: the rings of one plane, a tolerance. Out: marks on the corners that stay. A ring's extreme corners along the
//! diagonals stay from the beginning, four of any ring, which also keep it from turning inside out. Where rings
//! touch, the corners before and after stay as well, so that the rings leave that point as they did. Chords of the
//! plane that meet, or that pass over another ring, are split until there is none. That ends at the latest with the
//! rings as they were.

use super::chord::{Cycle, Segment};
use super::conflicts::{Chord, Conflicts};
use super::corner::Corner;
use super::trace::TracedRing;

/// Simplifies rings; reuses its memory.
#[derive(Debug)]
pub(super) struct Simplifier {
    tolerance: f64,
    ends: Vec<usize>,
    pending: Vec<[usize; 2]>,
    chords: Vec<Chord>,
    conflicts: Conflicts,
}

impl Simplifier {
    pub(super) fn new(tolerance: f64) -> Self {
        let (ends, pending, chords) = (Vec::new(), Vec::new(), Vec::new());
        Simplifier { tolerance, ends, pending, chords, conflicts: Conflicts::default() }
    }

    /// Marks the corners that stay. On entry `keep` marks those where rings touch.
    pub(super) fn simplify(&mut self, rings: &[TracedRing], corners: &[Corner], keep: &mut [bool]) {
        if self.tolerance == 0.0 {
            rings.iter().for_each(|ring| keep[ring.range()].fill(true));
            return;
        }
        for ring in rings {
            keep_ends(&corners[ring.range()], &mut keep[ring.range()], &mut self.ends);
            chords(&keep[ring.range()], &mut self.ends);
            for at in 1..self.ends.len() {
                self.refine(ring, corners, keep, [self.ends[at - 1], self.ends[at]]);
            }
        }
        while self.find_conflicts(rings, corners, keep) {
            for at in 0..self.conflicts.found.len() {
                let Chord { ring, ends, .. } = self.chords[self.conflicts.found[at]];
                self.split(&rings[ring as usize], corners, keep, ends);
            }
        }
    }

    /// Whether chords of the rings, as they are, have to be split.
    fn find_conflicts(&mut self, rings: &[TracedRing], corners: &[Corner], keep: &[bool]) -> bool {
        self.chords.clear();
        for (number, ring) in (0..).zip(rings) {
            let cycle = Cycle::of(ring, corners);
            chords(&keep[ring.range()], &mut self.ends);
            let chord = |ends: &[usize]| Chord::new(number, [ends[0], ends[1]], &cycle);
            self.chords.extend(self.ends.windows(2).map(chord));
        }
        self.conflicts.find(&mut self.chords, rings, corners, self.tolerance);
        !self.conflicts.found.is_empty()
    }

    /// Keeps corners between the ends of a chord until all are near enough.
    fn refine(&mut self, ring: &TracedRing, corners: &[Corner], keep: &mut [bool], ends: [usize; 2]) {
        let cycle = Cycle::of(ring, corners);
        self.pending.push(ends);
        while let Some([a, b]) = self.pending.pop() {
            match farthest(&cycle, [a, b]) {
                Some((middle, distance)) if distance > self.tolerance => {
                    keep[ring.place(middle)] = true;
                    self.pending.extend([[a, middle], [middle, b]]);
                }
                _ => (),
            }
        }
    }

    /// Keeps the corner that is farthest from a chord, near enough or not.
    fn split(&mut self, ring: &TracedRing, corners: &[Corner], keep: &mut [bool], [a, b]: [usize; 2]) {
        if let Some((middle, _)) = farthest(&Cycle::of(ring, corners), [a, b]) {
            keep[ring.place(middle)] = true;
            self.refine(ring, corners, keep, [a, middle]);
            self.refine(ring, corners, keep, [middle, b]);
        }
    }
}

/// The places of the corners that stay, and at the end the first one again, a round later.
fn chords(keep: &[bool], ends: &mut Vec<usize>) {
    ends.clear();
    ends.extend((0..keep.len()).filter(|&at| keep[at]));
    ends.extend(ends.first().map(|first| first + keep.len()));
}

/// Marks a ring's extreme corners along the diagonals, and the neighbours of those marked.
fn keep_ends(corners: &[Corner], keep: &mut [bool], touching: &mut Vec<usize>) {
    touching.clear();
    touching.extend((0..keep.len()).filter(|&at| keep[at]));
    for &at in &*touching {
        keep[(at + 1) % corners.len()] = true;
        keep[(at + corners.len() - 1) % corners.len()] = true;
    }
    for signs in [[1, 1], [1, -1], [-1, 1], [-1, -1]] {
        let along = |&at: &usize| signs[0] * i32::from(corners[at][0]) + signs[1] * i32::from(corners[at][1]);
        if let Some(extreme) = (0..corners.len()).max_by_key(along) {
            keep[extreme] = true;
        }
    }
}

/// The corner between two places that is farthest from the chord of these, and its distance.
fn farthest(cycle: &Cycle<'_>, [a, b]: [usize; 2]) -> Option<(usize, f64)> {
    let chord = Segment::new(cycle.at(a), cycle.at(b));
    let mut best: Option<(usize, f64)> = None;
    for place in a + 1..b {
        let squared = chord.squared_distance_scaled(cycle.at(place));
        if best.is_none_or(|(_, most)| squared > most) {
            best = Some((place, squared));
        }
    }
    best.map(|(place, squared)| (place, (squared / chord.squared_length).sqrt()))
}
