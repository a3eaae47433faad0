//! Stage "assign", third part: planes reach on along strips that are too thin for a tile.
//!
//! In: the map in q and its region image. Out: the image, in which a pixel that has no region but a neighbour on a plane
//! goes to that plane if it lies on it, and so do its own neighbours: neighbour grouping (section 3c) on the distance
//! from the plane instead of on the value. Blocks ask only the planes of tiles nearby; the floor below a ball at the
//! map's edge has none there.

use super::bands::{finer, in_bands};
use super::contact::Touching;
use super::field::{Field, ROWS};
use super::planes::{BENT, Planes};
use super::seams::Seams;
use crate::group::reserve_to;
use std::ops::Range;

/// Lets planes reach on; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Reach {
    /// For each band.
    works: Vec<Work>,
}

/// Memory of a band.
#[derive(Debug, Default)]
struct Work {
    /// Pixels that were just reached, whose neighbours are still to be asked.
    queue: Vec<[usize; 2]>,
    touching: Touching,
}

impl Reach {
    /// Lets planes reach on, though not into curved regions, and lists the regions that they touch there: band by band on as
    /// many threads, and then over the bands' edges.
    pub(super) fn reach(
        &mut self,
        field: &Field,
        planes: &Planes<'_>,
        seams: &Seams,
        bands: &[Range<usize>],
        image: &mut [u16],
        threads: usize,
    ) {
        let &Field { width, height, stride, .. } = field;
        self.works.resize_with(bands.len(), Work::default);
        in_bands(bands, &mut self.works, [(&mut *image, ROWS * stride)], threads, |band, work, [image]| {
            reserve_to(&mut work.queue, image.len());
            work.touching.prepare(4 * image.len());
            let rows = finer(band, ROWS);
            let rows = rows.start..rows.end.min(height);
            let mut area = Area { field, planes, rows: rows.clone(), image, work };
            seams.each_open(rows, |place| area.ask_around(place));
        });
        for (band, work) in bands.iter().zip(&mut self.works).skip(1) {
            let edge = finer(band, ROWS).start;
            let mut area = Area { field, planes, rows: 0..height, image, work };
            (edge - 1..edge + 1).for_each(|v| (0..width).for_each(|u| area.ask_around([u, v])));
        }
    }

    /// The regions that touch where planes reached on.
    pub(super) fn touching(&self) -> impl Iterator<Item = &Touching> {
        self.works.iter().map(|work| &work.touching)
    }
}

/// Rows over which planes reach on; there is nothing beyond them.
struct Area<'a> {
    field: &'a Field,
    planes: &'a Planes<'a>,
    rows: Range<usize>,
    image: &'a mut [u16],
    work: &'a mut Work,
}

impl Area<'_> {
    /// Asks a pixel, and its neighbours if it is reached, and so on.
    #[inline(always)]
    fn ask_around(&mut self, place: [usize; 2]) {
        self.ask(place);
        while let Some(place) = self.work.queue.pop() {
            self.neighbours(place).into_iter().for_each(|place| self.ask(place));
        }
    }

    /// Gives a pixel without a region the nearest of the planes of its neighbours that it lies on, if any.
    #[inline(always)]
    fn ask(&mut self, place: [usize; 2]) {
        let at = self.at(place);
        let q = self.field.q[place[1] * self.field.stride + place[0]];
        if self.image[at] > 0 || !q.is_finite() {
            return;
        }
        let (q, [u, v]) = (f64::from(q), place.map(|place| place as f64));
        let labels = self.neighbours(place).map(|place| self.image[self.at(place)]);
        let (mut own, mut best) = (0, f64::INFINITY);
        for label in labels {
            if label > 0 && label != BENT && label != own {
                let region = self.planes.region(u32::from(label) - 1);
                let on_plane = region.at(u, v);
                let off = (q - on_plane).powi(2);
                if off < best && off <= self.planes.reach(region, on_plane) {
                    (own, best) = (label, off);
                }
            }
        }
        if own > 0 {
            self.image[at] = own;
            self.work.queue.push(place);
            labels.into_iter().for_each(|label| self.work.touching.touch(own, label));
        }
    }

    /// Where a pixel stands in the image.
    #[inline(always)]
    fn at(&self, [u, v]: [usize; 2]) -> usize {
        (v - self.rows.start) * self.field.stride + u
    }

    /// The four neighbours of a pixel; at the edge itself in place of those that are missing.
    #[inline(always)]
    fn neighbours(&self, [u, v]: [usize; 2]) -> [[usize; 2]; 4] {
        let [right, below] = [(u + 1).min(self.field.width - 1), (v + 1).min(self.rows.end - 1)];
        [[u.saturating_sub(1), v], [right, v], [u, v.saturating_sub(1).max(self.rows.start)], [u, below]]
    }
}
