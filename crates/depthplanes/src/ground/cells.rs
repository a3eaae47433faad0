//! Cells of 8 x 8 pixels: what many of their pixels are, and how far away.

use super::marks::{DROP, FLOOR, OBSTACLE, UNKNOWN};
use crate::map::{AnyView, with_view};
use crate::sensor::Sensor;
use crate::util::simd::vectorised;

/// Pixels along a cell's side.
pub(super) const CELL: usize = 8;
/// Pixels of a cell that make it an obstacle or a drop, and half of those of floor: a quarter. Fewer are borders of things
/// and single wild pixels.
const ENOUGH: u64 = 16;

/// The cells of a map; what is left over at the right and below has none.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// The mark of each cell.
    pub(super) marks: Vec<u8>,
    /// Depth, metres, of one of the pixels that carry the mark; 0 of cells that are neither obstacle nor drop.
    pub(super) depths: Vec<f32>,
    /// The ray of each cell's middle; `None` where the lens has none.
    pub(super) rays: Vec<Option<[f64; 3]>>,
    /// The sensor and the map's width that the rays are of.
    rays_of: Option<(Sensor, usize)>,
}

impl Cells {
    pub(super) fn fill(&mut self, map: AnyView<'_>, sensor: &Sensor, marks: &[u8]) {
        let width = map.width();
        (self.columns, self.rows) = (width / CELL, map.height() / CELL);
        let cells = self.columns * self.rows;
        self.marks.clear();
        self.marks.resize(cells, UNKNOWN);
        self.depths.clear();
        self.depths.resize(cells, 0.0);
        if cells == 0 {
            return;
        }
        self.cast(sensor, width);
        vectorised(
            // Inlined by order: a closure of its own would be compiled without the vectors.
            #[inline(always)]
            || {
                let rows = self.marks.chunks_exact_mut(self.columns).zip(marks.chunks_exact(CELL * width));
                rows.for_each(|(cells, pixels)| mark_row(pixels, width, cells));
            },
        );
        for at in 0..cells {
            let mark = self.marks[at];
            if mark == OBSTACLE || mark == DROP {
                let corner = [at % self.columns * CELL, at / self.columns * CELL];
                let [u, v] = marked_pixel(marks, width, corner, mark);
                let value = with_view!(map, view => f64::from(view.row(v)[u]));
                self.depths[at] = sensor.value_kind.depth_m(value).unwrap_or(0.0) as f32;
            }
        }
    }

    /// The rays of the cells' middles, which are those of the frame before if the camera is.
    fn cast(&mut self, sensor: &Sensor, width: usize) {
        let cells = self.marks.len();
        if self.rays.len() == cells && self.rays_of == Some((*sensor, width)) {
            return;
        }
        let half = (CELL as f64 - 1.0) / 2.0;
        let middle = |at: usize| (at * CELL) as f64 + half;
        self.rays.clear();
        self.rays.extend((0..cells).map(|at| sensor.ray(middle(at % self.columns), middle(at / self.columns))));
        self.rays_of = Some((*sensor, width));
    }
}

/// A pixel of a cell that carries a mark: the one in its middle, if it does.
fn marked_pixel(marks: &[u8], width: usize, [u, v]: [usize; 2], mark: u8) -> [usize; 2] {
    let is_marked = |&[u, v]: &[usize; 2]| marks[v * width + u] == mark;
    let middle = [u + CELL / 2, v + CELL / 2];
    let all = (v..v + CELL).flat_map(|v| (u..u + CELL).map(move |u| [u, v]));
    std::iter::once(middle).filter(is_marked).chain(all.filter(is_marked)).next().unwrap_or(middle)
}

/// Cells whose pixels are counted at a time.
const CELLS: usize = 16;

/// The marks of a row of cells: obstacle before drop, floor if it is neither.
#[inline(always)]
fn mark_row(pixels: &[u8], width: usize, cells: &mut [u8]) {
    for (part, cells) in cells.chunks_mut(CELLS).enumerate() {
        // Eight bytes of counts for each cell, one of each column of its pixels: of floor in the lower four bits, of obstacles
        // in the upper ones; and of drops.
        let (mut counts, mut drops) = ([0u64; CELLS], [0u64; CELLS]);
        for row in pixels.chunks_exact(width) {
            let (words, _) = row[part * CELLS * CELL..][..cells.len() * CELL].as_chunks::<CELL>();
            for ((count, drop), word) in counts.iter_mut().zip(&mut drops).zip(words) {
                let word = u64::from_le_bytes(*word);
                *count += (word & (ONES * FLOOR as u64)) | ((word & (ONES * OBSTACLE as u64)) << 3);
                *drop += (word >> DROP.trailing_zeros()) & ONES;
            }
        }
        for ((cell, count), drop) in cells.iter_mut().zip(counts).zip(drops) {
            // The sum of a word's bytes is the uppermost one of the product.
            let sum = |bytes: u64| bytes.wrapping_mul(ONES) >> 56;
            let (floor, obstacle, drop) = (sum(count & (ONES * 15)), sum(count >> 4 & (ONES * 15)), sum(drop));
            *cell = match () {
                () if obstacle >= ENOUGH => OBSTACLE,
                () if drop >= ENOUGH => DROP,
                () if floor >= 2 * ENOUGH => FLOOR,
                () => UNKNOWN,
            };
        }
    }
}

/// A one in each byte.
const ONES: u64 = 0x0101_0101_0101_0101;
