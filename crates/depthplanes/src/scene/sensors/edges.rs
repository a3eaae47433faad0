//! What sensors do at the edges of things: matching windows move them, light from both sides mixes.
//!
//! In: the exact picture and random draws. Out: for each pixel the depth that it takes for its own,
//! before any other error.

use super::exposure::Exposure;
use crate::scene::pose::KINECT_FOCAL_PX;
use crate::util::random::Random;

/// Standard deviation of the shift of edges, in pixels of the sensor's own picture (the lateral
/// noise of Nguyen, Izadi and Lovell 2012).
const SHIFT_PX: f64 = 0.8;
/// Side of the cells that share a shift, pixels (our choice).
const CELL: usize = 3;
/// Edges with a smaller step in depth are left in place, metres.
const RAGGED_STEP_M: f64 = 0.02;
/// Least jump in depth at which pixels mix, metres.
const FLYING_STEP_M: f64 = 0.05;

/// What a kind of sensor does at edges.
#[derive(Clone, Copy, Debug)]
pub(super) enum Edges {
    /// A matching window moves them by about 0.8 px, alike over small cells, so that edges are ragged
    /// rather than dusty.
    Ragged,
    /// Next to a jump in depth half of the pixels, drawn at random, gather light from both sides and report a depth
    /// between the two.
    Flying,
}

/// The edges of one frame.
pub(super) struct FrameEdges {
    kind: Edges,
    /// One shift (columns, rows) for each cell; none for flying pixels.
    shifts: Vec<[isize; 2]>,
}

impl Edges {
    /// The draws that a frame needs before its first pixel.
    pub(super) fn drawn(self, exposure: &Exposure<'_>, random: &mut Random) -> FrameEdges {
        let camera = exposure.camera;
        let shifts = match self {
            Edges::Flying => Vec::new(),
            Edges::Ragged => {
                let sigma = SHIFT_PX * (camera.intrinsics.fx.abs() / KINECT_FOCAL_PX).min(10.0);
                let cells = camera.width.div_ceil(CELL) * camera.height.div_ceil(CELL);
                let mut whole = || (sigma * random.gaussian() + 0.5).floor() as isize;
                (0..cells).map(|_| [whole(), whole()]).collect()
            }
        };
        FrameEdges { kind: self, shifts }
    }
}

impl FrameEdges {
    /// The depth that pixel `at` takes for its own, metres, and the pixel whose surface decides
    /// whether it is seen at all.
    pub(super) fn depth_m(&self, exposure: &Exposure<'_>, at: usize, random: &mut Random) -> (f64, usize) {
        let depth_m = &exposure.seen.depth_m;
        match self.kind {
            Edges::Ragged => {
                let (u, v) = (at % exposure.camera.width, at / exposure.camera.width);
                let shift = self.shifts[v / CELL * exposure.camera.width.div_ceil(CELL) + u / CELL];
                let other = exposure.beside(at, shift);
                let source = other.filter(|&other| exposure.jump(at, other, RAGGED_STEP_M)).unwrap_or(at);
                (depth_m[source], source)
            }
            Edges::Flying => {
                let exact = depth_m[at];
                // Drawn for every pixel, so that an edge does not change the noise elsewhere.
                let (mixing, part) = (random.uniform() < 0.5, random.uniform());
                let across = [[1, 0], [-1, 0], [0, 1], [0, -1]]
                    .into_iter()
                    .filter_map(|step| exposure.beside(at, step))
                    .find(|&other| depth_m[other] > 0.0 && exposure.jump(at, other, FLYING_STEP_M));
                match across {
                    Some(other) if mixing => (exact + part * (depth_m[other] - exact), at),
                    _ => (exact, at),
                }
            }
        }
    }
}
