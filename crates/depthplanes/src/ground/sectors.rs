//! How far the floor is free in each direction.

use super::cells::Cells;
use super::marks::FLOOR;
use super::standing::Standing;

/// A range of bearings, and how far the floor is free in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Sector {
    /// Its left end, degrees to the right of the direction of view.
    pub from_deg: f64,
    /// Its right end.
    pub to_deg: f64,
    /// Metres along the floor from the point below the camera to the nearest obstacle or drop, or to the farthest floor that
    /// is seen; 0 where no floor is.
    pub free_m: f64,
    /// Whether an obstacle or a drop ends it. Otherwise nothing is known of what comes after `free_m`.
    pub is_blocked: bool,
}

/// Degrees of a sector, at most: the width of a small robot at 6 m.
const SECTOR_DEG: f64 = 5.0;
/// Most sectors, those of a camera that sees half of the horizon.
const MOST: usize = 36;

/// The sectors across the picture, from left to right. `distances_m` are those of cells with an obstacle, 0 elsewhere.
pub(super) fn find(cells: &Cells, distances_m: &[f32], standing: &Standing, sectors: &mut Vec<Sector>) {
    sectors.clear();
    sectors.reserve(MOST);
    let Some([left, right]) = bearings(cells, standing) else { return };
    let count = (((right - left) / SECTOR_DEG).ceil().max(1.0) as usize).min(MOST);
    let end = |at: usize| left + (right - left) * at as f64 / count as f64;
    let sector = |at| Sector { from_deg: end(at), to_deg: end(at + 1), free_m: 0.0, is_blocked: false };
    sectors.extend((0..count).map(sector));
    // Tangents of the ends, so that a point takes no arc tangent.
    let mut tangents = [0.0; MOST];
    tangents.iter_mut().zip(1..count).for_each(|(tangent, at)| *tangent = end(at).to_radians().tan());
    let tangents = &tangents[..count - 1];
    for at in 0..cells.marks.len() {
        let blocked_m = f64::from(distances_m[at]);
        if blocked_m == 0.0 && cells.marks[at] != FLOOR {
            continue;
        }
        let Some(ray) = cells.rays[at] else { continue };
        let direction = standing.direction(ray);
        if direction[1] <= 0.0 {
            continue;
        }
        let tangent = direction[0] / direction[1];
        let sector = &mut sectors[tangents.iter().filter(|&&end| end <= tangent).count()];
        if blocked_m > 0.0 {
            sector.free_m = if sector.is_blocked { sector.free_m.min(blocked_m) } else { blocked_m };
            sector.is_blocked = true;
        } else if !sector.is_blocked
            && let Some(spot) = standing.on_floor(ray)
        {
            sector.free_m = sector.free_m.max(spot.distance_m());
        }
    }
}

/// Bearings of the leftmost and rightmost rays along the middle row.
fn bearings(cells: &Cells, standing: &Standing) -> Option<[f64; 2]> {
    let (columns, rows) = (cells.columns, cells.rows);
    if columns == 0 || rows == 0 {
        return None;
    }
    let bearing = |at: usize| {
        let [right, ahead] = standing.direction(cells.rays[at]?);
        Some(right.atan2(ahead).to_degrees().clamp(-89.0, 89.0))
    };
    let row = rows / 2 * columns;
    let (a, b) = (bearing(row)?, bearing(row + columns - 1)?);
    Some([a.min(b), a.max(b)])
}
