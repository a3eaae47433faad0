//! Stage "assign", second part: planes reach on along strips that are too thin for a tile.
//!
//! In: the map in q and its region image. Out: the image, in which a pixel that has no region but a neighbour on a plane
//! goes to that plane if it lies on it, and so do its own neighbours: neighbour grouping (section 3c) on the distance
//! from the plane instead of on the value. Blocks ask only the planes of tiles nearby; the floor below a ball at the
//! map's edge has none there.

use super::field::Field;
use super::planes::{BENT, Planes};
use crate::group::{reserve_to, vectorised};

/// Pixels of a row that are looked at together.
const ABREAST: usize = 16;

/// Lets planes reach on; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Reach {
    /// Pixels that were just reached, whose neighbours are still to be asked.
    queue: Vec<u32>,
    /// For each group of pixels of a row, whether one may be reached.
    any: Vec<bool>,
}

/// The map's pixels and what they are held against.
struct Around<'a> {
    field: &'a Field,
    planes: &'a Planes<'a>,
}

impl Reach {
    /// Lets planes reach on, though not into curved regions, whose label goes.
    pub(super) fn reach(&mut self, field: &Field, planes: &Planes<'_>, image: &mut [u16]) {
        reserve_to(&mut self.queue, field.width * field.height);
        let around = Around { field, planes };
        let mut any = std::mem::take(&mut self.any);
        any.resize(field.stride / ABREAST, false);
        for v in 0..field.height {
            let row = v * field.stride;
            vectorised(
                #[inline(always)]
                || any_beside(field, image, row, &mut any),
            );
            for (first, _) in (0..field.width).step_by(ABREAST).zip(&any).filter(|(_, any)| **any) {
                for u in first..(first + ABREAST).min(field.width) {
                    if image[row + u] == 0 && field.q[row + u].is_finite() {
                        self.reach_from(&around, [u, v], image);
                    }
                }
            }
        }
        self.any = any;
        image.iter_mut().for_each(|label| *label = if *label == BENT { 0 } else { *label });
    }

    /// Asks a pixel, and if it goes to a plane, those around it.
    fn reach_from(&mut self, around: &Around<'_>, place: [usize; 2], image: &mut [u16]) {
        self.ask(around, place, image);
        let stride = around.field.stride;
        while let Some(at) = self.queue.pop() {
            let [u, v] = [at as usize % stride, at as usize / stride];
            for [u, v] in around.neighbours([u, v]) {
                let at = v * stride + u;
                if image[at] == 0 && around.field.q[at].is_finite() {
                    self.ask(around, [u, v], image);
                }
            }
        }
    }

    /// Gives a pixel the nearest of the planes of its neighbours that it lies on, if any.
    fn ask(&mut self, around: &Around<'_>, place: [usize; 2], image: &mut [u16]) {
        let Around { field, planes } = *around;
        let at = place[1] * field.stride + place[0];
        let (q, [u, v]) = (f64::from(field.q[at]), place.map(|place| place as f64));
        let mut best = f64::INFINITY;
        for [x, y] in around.neighbours(place) {
            let label = image[y * field.stride + x];
            if label > 0 && label != BENT && label != image[at] {
                let region = planes.region(u32::from(label) - 1);
                let on_plane = region.at(u, v);
                let off = (q - on_plane).powi(2);
                if off < best && off <= planes.reach(region, on_plane) {
                    best = off;
                    image[at] = label;
                }
            }
        }
        if image[at] > 0 {
            self.queue.push(at as u32);
        }
    }
}

impl Around<'_> {
    /// The four neighbours of a pixel.
    #[inline(always)]
    fn neighbours(&self, [u, v]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> + use<> {
        let (width, height) = (self.field.width, self.field.height);
        let beside = [
            (u > 0).then(|| [u - 1, v]),
            (u + 1 < width).then(|| [u + 1, v]),
            (v > 0).then(|| [u, v - 1]),
            (v + 1 < height).then(|| [u, v + 1]),
        ];
        beside.into_iter().flatten()
    }
}

/// For each [`ABREAST`] pixels of the row that begins at `row`, whether one of them is measured, has no region, and is
/// beside one that has; may say so at the ends of a row.
#[inline(always)]
fn any_beside(field: &Field, image: &[u16], row: usize, any: &mut [bool]) {
    for (group, any) in any.iter_mut().enumerate() {
        let at = row + group * ABREAST;
        let some = |first: usize| image.get(first..).and_then(|from| from.first_chunk::<ABREAST>());
        let here = some(at).expect("rows of whole groups");
        let (left, right) = (some(at.wrapping_sub(1)), some(at + 1));
        let above = some(at.wrapping_sub(field.stride)).unwrap_or(here);
        let below = some(at + field.stride).unwrap_or(here);
        let q = &field.q[at..at + ABREAST];
        *any = left.zip(right).is_none_or(|(left, right)| {
            let mut any = 0u16;
            for i in 0..ABREAST {
                let around = left[i] | right[i] | above[i] | below[i];
                any |= u16::from((here[i] == 0) & (around > 0) & q[i].is_finite());
            }
            any > 0
        });
    }
}
