//! Sign "turns": off a region's border the surface goes on and turns gently.
//!
//! In: the tiles along a region's border. Out: how many there are, and beyond how many of them the surface goes on
//! without a step, at a small angle to the region's plane. Meshes of cushions and lamps are made of such facets, each
//! exactly flat, and growth makes them of a ball that is known to within little noise. A box's face ends in steps and
//! right angles.

use super::curved::CellBox;
use super::grid::{Grid, NONE};
use super::grow::Region;
use crate::methods::rays::{Rays, Vec3, dot, sub};

/// Sine of the largest angle at which a surface turns gently, [`super::thresholds::GENTLE`].
const ANGLE: f64 = 0.399;
/// Standard deviations of a pixel by which a tile lies off the plane where the surface does turn: what rounding does, its
/// pixels may share.
const DEVIATIONS: f64 = 3.0;
/// Share of the border beyond which it turns gently: a facet on the rim of a ball has a step on its other side.
const SHARE: f64 = 0.4;
/// Fewest places along a border that say something: those of 2 x 2 tiles.
const FEW: f64 = 8.0;
/// A region of so many times the pixels is no facet of the same surface: a wall beside a bevel.
const LARGER: f64 = 4.0;
/// Pixels that a region counts as having at least, when it is held against larger ones: facets come in all sizes. Of
/// regions that have so many the planes say by how much they turn.
const USUAL: f64 = 240.0;
/// Valid pixels of a tile whose mean says something.
const HALF: f32 = 8.0;
/// Valid pixels of a tile over which a surface goes on: a gap takes a column of four from one tile, or from two.
const WHOLE: f32 = 13.0;

/// n of a region's plane `n . point = 1`.
fn normal_of(rays: &Rays, region: &Region) -> Vec3 {
    let [a, b, _] = region.abc;
    rays.inverse([a, b], |u, v| region.at(u, v))
}

/// Whether two planes differ by a small angle.
fn is_gentle(a: Vec3, b: Vec3) -> bool {
    let (both, squares) = (dot(a, b), dot(a, a) * dot(b, b));
    both > 0.0 && squares - both * both <= ANGLE * ANGLE * squares
}

/// A region and what it is held against.
pub(super) struct Border<'a> {
    pub(super) grid: &'a Grid,
    pub(super) all: &'a [Region],
    pub(super) rays: &'a Rays,
    pub(super) id: u32,
}

impl Border<'_> {
    /// Whether beyond much of the border the surface goes on and turns gently.
    pub(super) fn turns(&self, around: &CellBox) -> bool {
        let grid = self.grid;
        let normal = normal_of(self.rays, &self.all[self.id as usize]);
        let [mut places, mut gentle] = [0.0; 2];
        for row in around.first[1]..=around.last[1] {
            for column in around.first[0]..=around.last[0] {
                let at = row * grid.columns + column;
                if grid.region[at] != self.id || self.is_inside(at) {
                    continue;
                }
                let mut look = |is_there: bool, next: usize, far: [usize; 2], step: [f64; 2]| {
                    if is_there && grid.region[next] != self.id {
                        places += 1.0;
                        let goes_on = grid.pixels(next) >= WHOLE && self.turns_to(normal, [column, row], far, step);
                        gentle += f64::from(u8::from(goes_on));
                    }
                };
                // The next tile may lie on both sides of an edge, the one behind it is clear of it.
                look(column >= 2, at.wrapping_sub(1), [column.wrapping_sub(2), row], [-1.0, 0.0]);
                look(column + 2 < grid.columns, at + 1, [column + 2, row], [1.0, 0.0]);
                look(row >= 2, at.wrapping_sub(grid.columns), [column, row.wrapping_sub(2)], [0.0, -1.0]);
                look(row + 2 < grid.rows, at + grid.columns, [column, row + 2], [0.0, 1.0]);
            }
        }
        places >= FEW && gentle >= SHARE * places
    }

    /// Whether the tiles to all four sides are the region's.
    #[inline(always)]
    fn is_inside(&self, at: usize) -> bool {
        let region = &self.grid.region;
        let is_own = |at: usize| region.get(at) == Some(&self.id);
        is_own(at.wrapping_sub(1))
            & is_own(at + 1)
            & is_own(at.wrapping_sub(self.grid.columns))
            & is_own(at + self.grid.columns)
    }

    /// Whether the surface turns gently between a tile and one two steps off.
    fn turns_to(&self, normal: Vec3, tile: [usize; 2], far: [usize; 2], step: [f64; 2]) -> bool {
        let Border { grid, all, rays, id } = self;
        let region = &all[*id as usize];
        let at = far[1] * grid.columns + far[0];
        let other = grid.region[at];
        let is_larger = || other != NONE && all[other as usize].sums.n > LARGER * region.sums.n.max(USUAL);
        if other == *id || grid.pixels(at) < HALF || is_larger() {
            return false;
        }
        let side = grid.side as f64;
        let middle = |tile: [usize; 2]| tile.map(|place| (place as f64 + 0.5) * side - 0.5);
        let ([u, v], q) = (middle(far), grid.q(at));
        let on_plane = region.at(u, v);
        if (q - on_plane).powi(2) <= DEVIATIONS * DEVIATIONS * f64::from(grid.variance[at]) {
            return false;
        }
        let own = middle(tile);
        if let Some(other) = all.get(other as usize).filter(|other| other.sums.n.min(region.sums.n) >= USUAL) {
            // Growth may have crossed the edge; the planes themselves say where it is.
            let inner = [0, 1].map(|i| own[i] - 0.5 * side * step[i]);
            let [before, behind] = [inner, [u, v]].map(|[u, v]| other.at(u, v) - region.at(u, v));
            return before * behind < 0.0 && is_gentle(normal, normal_of(rays, other));
        }
        let edge = [0, 1].map(|i| own[i] + 0.5 * side * step[i]);
        let from = rays.at(edge, region.at(edge[0], edge[1]));
        let (to, straight) = (rays.at([u, v], q), rays.at([u, v], on_plane));
        let [to, straight] = [to, straight].map(|point| sub(point, from));
        // What lies far behind an edge is many times as far off as the plane itself is there, or the other way round; what
        // folds back lies on the edge's other side.
        let apart = dot(normal, to);
        let way = dot(to, to).min(dot(straight, straight));
        dot(to, straight) > 0.0 && apart * apart <= ANGLE * ANGLE * dot(normal, normal) * way
    }
}
