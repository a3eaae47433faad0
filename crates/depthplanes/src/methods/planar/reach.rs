//! Stage "assign", third part: planes reach on along strips that are too thin for a tile.
//!
//! In: the map in q and its region image. Out: the image, in which a pixel that has no region but a neighbour on a plane
//! goes to that plane if it lies on it, and so do its own neighbours: neighbour grouping (section 3c) on the distance
//! from the plane instead of on the value. Blocks ask only the planes of tiles nearby; the floor below a ball at the
//! map's edge has none there.

use super::contact::Touching;
use super::field::Field;
use super::planes::{BENT, Planes};
use super::seams::Seams;
use crate::group::reserve_to;

/// Lets planes reach on; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Reach {
    /// Pixels that were just reached, whose neighbours are still to be asked.
    queue: Vec<u32>,
}

/// The map's pixels and what they are held against.
struct Around<'a> {
    field: &'a Field,
    planes: &'a Planes<'a>,
}

impl Reach {
    /// Lets planes reach on, though not into curved regions, and lists the regions that they touch there.
    pub(super) fn reach(
        &mut self,
        field: &Field,
        planes: &Planes<'_>,
        seams: &Seams,
        image: &mut [u16],
        touching: &mut Touching,
    ) {
        reserve_to(&mut self.queue, field.width * field.height);
        let around = Around { field, planes };
        seams.each_open(|place| {
            self.ask(&around, place, image, touching);
            while let Some(at) = self.queue.pop() {
                let place = [at as usize % field.stride, at as usize / field.stride];
                around.neighbours(place).into_iter().for_each(|place| self.ask(&around, place, image, touching));
            }
        });
    }

    /// Gives a pixel without a region the nearest of the planes of its neighbours that it lies on, if any.
    #[inline(always)]
    fn ask(&mut self, around: &Around<'_>, place: [usize; 2], image: &mut [u16], touching: &mut Touching) {
        let Around { field, planes } = *around;
        let at = place[1] * field.stride + place[0];
        if image[at] > 0 || !field.q[at].is_finite() {
            return;
        }
        let (q, [u, v]) = (f64::from(field.q[at]), place.map(|place| place as f64));
        let (mut own, mut best) = (0, f64::INFINITY);
        for [x, y] in around.neighbours(place) {
            let label = image[y * field.stride + x];
            if label > 0 && label != BENT && label != own {
                let region = planes.region(u32::from(label) - 1);
                let on_plane = region.at(u, v);
                let off = (q - on_plane).powi(2);
                if off < best && off <= planes.reach(region, on_plane) {
                    (own, best) = (label, off);
                }
            }
        }
        if own > 0 {
            image[at] = own;
            self.queue.push(at as u32);
            let labels = around.neighbours(place).map(|[x, y]| image[y * field.stride + x]);
            labels.into_iter().for_each(|label| touching.touch(own, label));
        }
    }
}

impl Around<'_> {
    /// The four neighbours of a pixel; at the map's edge itself in place of those that are missing.
    #[inline(always)]
    fn neighbours(&self, [u, v]: [usize; 2]) -> [[usize; 2]; 4] {
        let [right, below] = [(u + 1).min(self.field.width - 1), (v + 1).min(self.field.height - 1)];
        [[u.saturating_sub(1), v], [right, v], [u, v.saturating_sub(1)], [u, below]]
    }
}
