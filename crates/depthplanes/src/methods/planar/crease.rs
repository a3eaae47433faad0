//! Part of stage "assign": which of two planes gets the pixels of a block that both explain.
//!
//! In: the squared distances of the block's pixels from either plane. Out: for each plane, the pixels where the other
//! takes precedence. Two planes that meet at a crease both explain the pixels near it; the line where they meet
//! decides, unless the pixels themselves say otherwise.

use super::block::{DU, DV, Local, PIXELS, Pixels};
use super::region::Region;
use crate::util::switches::is_on;

/// A block's pixels are not parted by a line if they lie nearer to one of the planes by so much, squares in units of
/// `Local::most`: by as much, all together, as one pixel may lie off. The line is known no better than the planes,
/// and beyond the end of a crease it means nothing.
const REJECTED: f32 = 1.0;

/// Pixels that are looked at together.
const LANES: usize = 16;

/// Which of two planes within reach gets a pixel: the first where the line is positive, or else the nearer.
pub(super) struct CreaseRule {
    by_line: bool,
    a: f32,
    b: f32,
    c: f32,
}

impl CreaseRule {
    /// A plane goes before a facet of a curved surface; the line where two planes meet, if it parts them, goes
    /// before the distances. Either holds unless the block's pixels reject it ([`REJECTED`]).
    #[inline(always)]
    pub(super) fn between(first: &Region, second: &Region, plane: &Local, other: &Local) -> CreaseRule {
        if first.is_curved != second.is_curved {
            return CreaseRule { by_line: true, a: 0.0, b: 0.0, c: if second.is_curved { 1.0 } else { -1.0 } };
        }
        let above = |[u, v]: [f64; 2]| first.at(u, v) - second.at(u, v);
        let (ours, theirs) = (above(first.middle), above(second.middle));
        let sign = if ours > 0.0 { 1.0 } else { -1.0 };
        CreaseRule {
            by_line: is_on("line") && ours * theirs < 0.0,
            a: sign * (plane.a - other.a),
            b: sign * (plane.b - other.b),
            c: sign * (plane.c - other.c),
        }
    }

    /// Counts for each of two planes the pixels where the other goes before it.
    #[inline(always)]
    pub(super) fn apply(
        &self,
        [one, other]: [&Pixels<f32>; 2],
        one_beaten: &mut Pixels<f32>,
        other_beaten: &mut Pixels<f32>,
    ) {
        let rejected = if self.by_line && is_on("rejected") { self.rejected([one, other]) } else { 0.0 };
        for at in 0..PIXELS {
            let both = if is_near_both(one[at], other[at]) { 1.0 } else { 0.0 };
            let by_line = if rejected == 0.0 { self.line(at) } else { rejected };
            let difference = if self.by_line { by_line } else { other[at] - one[at] };
            let wins = if difference > 0.0 { both } else { 0.0 };
            one_beaten[at] += both - wins;
            other_beaten[at] += wins;
        }
    }

    #[inline(always)]
    fn line(&self, at: usize) -> f32 {
        self.a * DU[at] + self.b * DV[at] + self.c
    }

    /// Whether the block's pixels contradict the line: positive if they all should go to the first, negative if to the second.
    #[inline(always)]
    fn rejected(&self, [one, other]: [&Pixels<f32>; 2]) -> f32 {
        // What it adds to the squares if one of them gets all.
        let [mut by_one, mut by_other] = [[0.0; LANES]; 2];
        for first in (0..PIXELS).step_by(LANES) {
            for lane in 0..LANES {
                let at = first + lane;
                let more = if is_near_both(one[at], other[at]) { one[at] - other[at] } else { 0.0 };
                let is_one = self.line(at) > 0.0;
                by_one[lane] += if is_one { 0.0 } else { more };
                by_other[lane] += if is_one { -more } else { 0.0 };
            }
        }
        let [by_one, by_other] = [by_one, by_other].map(|sums| sums.iter().sum::<f32>());
        match by_one.min(by_other) {
            least if least > -REJECTED => 0.0,
            _ => by_other - by_one,
        }
    }
}

/// Whether a pixel is within reach of two planes.
#[inline(always)]
pub(super) fn is_near_both(one: f32, other: f32) -> bool {
    (one <= 1.0) & (other <= 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line down the middle of the block, the first plane to its right.
    const RULE: CreaseRule = CreaseRule { by_line: true, a: 1.0, b: 0.0, c: 0.0 };

    /// Pixels that each plane loses.
    fn lost(one: Pixels<f32>, other: Pixels<f32>) -> [f32; 2] {
        let [mut first, mut second] = [[0.0; PIXELS]; 2];
        RULE.apply([&one, &other], &mut first, &mut second);
        [first, second].map(|beaten| beaten.iter().sum())
    }

    #[test]
    fn a_line_parts_pixels_that_both_planes_explain_until_they_belie_it() {
        let half = PIXELS as f32 / 2.0;
        assert_eq!(lost([0.2; PIXELS], [0.2; PIXELS]), [half, half]);
        // Half of the pixels are nearer to the other plane, each by so little that all together it is no evidence ..
        let enough = REJECTED / half;
        assert_eq!(lost([0.2; PIXELS], [0.2 + 0.9 * enough; PIXELS]), [half, half]);
        // .. or it is.
        assert_eq!(lost([0.2; PIXELS], [0.2 + 1.1 * enough; PIXELS]), [0.0, 2.0 * half]);
        assert_eq!(lost([0.2 + 1.1 * enough; PIXELS], [0.2; PIXELS]), [2.0 * half, 0.0]);
        // Where one of them is out of reach there is nothing to decide.
        assert_eq!(lost([0.2; PIXELS], [f32::INFINITY; PIXELS]), [0.0, 0.0]);
    }
}
