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
        vectorised(|| {
            for (of_row, pixels) in self.marks.chunks_exact_mut(self.columns).zip(marks.chunks_exact(CELL * width)) {
                for (column, mark) in of_row.iter_mut().enumerate() {
                    *mark = cell_mark(pixels, column * CELL, width);
                }
            }
        });
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

    /// Middle of a cell, pixels.
    pub(super) fn middle(&self, at: usize) -> [f64; 2] {
        let half = (CELL as f64 - 1.0) / 2.0;
        [(at % self.columns * CELL) as f64 + half, (at / self.columns * CELL) as f64 + half]
    }
}

/// A pixel of a cell that carries a mark: the one in its middle, if it does.
fn marked_pixel(marks: &[u8], width: usize, [u, v]: [usize; 2], mark: u8) -> [usize; 2] {
    let is_marked = |&[u, v]: &[usize; 2]| marks[v * width + u] == mark;
    let middle = [u + CELL / 2, v + CELL / 2];
    let all = (v..v + CELL).flat_map(|v| (u..u + CELL).map(move |u| [u, v]));
    std::iter::once(middle).filter(is_marked).chain(all.filter(is_marked)).next().unwrap_or(middle)
}

/// The mark of a cell: obstacle before drop, floor if it is neither.
#[inline(always)]
fn cell_mark(pixels: &[u8], column: usize, width: usize) -> u8 {
    let words: [u64; CELL] = std::array::from_fn(|row| {
        let start = row * width + column;
        u64::from_le_bytes(pixels[start..start + CELL].try_into().expect("eight pixels"))
    });
    // A mark is one bit of a byte: bytes are added up, then those of the word.
    let count = |mark: u8| {
        let bytes: u64 = words.iter().map(|word| (word >> mark.trailing_zeros()) & ONES).sum();
        bytes.wrapping_mul(ONES) >> 56
    };
    let [floor, obstacle, drop] = [FLOOR, OBSTACLE, DROP].map(count);
    match () {
        () if obstacle >= ENOUGH => OBSTACLE,
        () if drop >= ENOUGH => DROP,
        () if floor >= 2 * ENOUGH => FLOOR,
        () => UNKNOWN,
    }
}

/// A one in each byte.
const ONES: u64 = 0x0101_0101_0101_0101;
