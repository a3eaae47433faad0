//! How much a search may do.
//!
//! In: the pixels of a map, and what a search has looked at. Out: whether it is time to stop. The papers state no end but
//! that nothing is left to find: with a tolerance of nothing, planes of a few pixels, or a precision as small as can be
//! asked for, a search looks at every pixel for each of them. The searches of recorded frames at defaults stay below the
//! bound: their labels are those of searches without it.

/// Pixels that may be looked at for each pixel of a map.
const LOOKS: u64 = 4096;
/// The most pixels that may be looked at, some five seconds, however large the map.
const MOST: u64 = 800_000_000;
/// The smallest maps count as this many pixels: a search draws some thousand times whatever the map's size.
const FEWEST: u64 = 4096;

/// What a search may still do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work {
    left: u64,
}

impl Work {
    /// Nothing is done yet.
    pub(super) fn new(pixels: usize) -> Self {
        Work { left: (LOOKS * FEWEST.max(pixels as u64)).min(MOST) }
    }

    /// Counts pixels that were looked at.
    #[inline(always)]
    pub(super) fn count(&mut self, looks: usize) {
        self.left = self.left.saturating_sub(looks as u64);
    }

    /// Whether the search has to stop with what it has found.
    pub(super) fn is_spent(&self) -> bool {
        self.left == 0
    }
}
