//! Stage "tiles": the map's small squares, each with its own plane, and larger squares made of them.
//!
//! In: rows of the map in q, or of cells. Out: the sums and planes of the tiles, or of the cells of 2 x 2, in them. All cells
//! of a row are computed side by side, so the loops are plain arithmetic that the compiler turns into vectors.

use super::grid::{GridRows, Sums, drift, limit};
use std::array::from_fn;

/// Columns and rows of a tile. The smallest plane has to hold a few; a tile's own plane should still
/// mean something under noise. Of 4, 5, 6 and 8, 4 was the best on ABW and on made-up rooms.
pub(super) const SIDE: usize = 4;
/// Cells that are computed at a time.
pub(super) const LANES: usize = 16;
/// One number of each of them.
type Lanes = [f32; LANES];

/// The middle of a tile's columns and rows from its own.
const OFF: [f32; SIDE] = [-1.5, -0.5, 0.5, 1.5];

/// Sums a row of tiles.
#[inline(always)]
pub(super) fn sum_tiles(q: &[f32], row: usize, grid: &mut GridRows<'_>) {
    let mut rows = q.chunks_exact(q.len() / SIDE);
    let rows: [_; SIDE] = from_fn(|_| rows.next().expect("so many rows").as_chunks::<{ LANES * SIDE }>().0);
    for block in 0..rows[0].len() {
        grid.put(row, block * LANES, tiles(from_fn(|row| &rows[row][block])));
    }
}

/// Sums a row of cells of `side` columns.
#[inline(always)]
pub(super) fn sum_cells(parts: &GridRows<'_>, row: usize, side: usize, grid: &mut GridRows<'_>) {
    let quarter = side as f32 / 4.0;
    for column in (0..grid.columns).step_by(LANES) {
        let first = 2 * row * parts.columns + 2 * column;
        grid.put(row, column, cells(&parts.sums, [first, first + parts.columns], quarter));
    }
}

/// The sums of tiles that lie side by side.
#[inline(always)]
fn tiles(rows: [&[f32; LANES * SIDE]; SIDE]) -> Sums<Lanes> {
    // Where all pixels are valid, half of the sums are known.
    let mut sums = [[0.0; LANES]; SIDE];
    for (sums, row) in sums.iter_mut().zip(rows) {
        row.as_chunks::<LANES>().0.iter().for_each(|part| (0..LANES).for_each(|lane| sums[lane] += part[lane]));
    }
    let is_whole = (0..LANES).fold(true, |all, lane| all & sums.map(|sums| sums[lane]).iter().sum::<f32>().is_finite());
    if is_whole { tiles_of::<true>(rows) } else { tiles_of::<false>(rows) }
}

#[inline(always)]
fn tiles_of<const WHOLE: bool>(rows: [&[f32; LANES * SIDE]; SIDE]) -> Sums<Lanes> {
    let mut out = no_sums();
    for t in 0..LANES {
        let mut q = [[0.0; SIDE]; SIDE];
        let mut w = [[0.0; SIDE]; SIDE];
        let [mut n, mut u, mut v, mut uu, mut uv, mut vv, mut sum] = [0.0; 7];
        for row in 0..SIDE {
            for column in 0..SIDE {
                let value = rows[row][t * SIDE + column];
                let holds = WHOLE || value.is_finite();
                w[row][column] = if holds { 1.0 } else { 0.0 };
                q[row][column] = if holds { value } else { 0.0 };
                let (w, du, dv) = (w[row][column], OFF[column], OFF[row]);
                n += w;
                u += w * du;
                v += w * dv;
                uu += w * (du * du);
                uv += w * (du * dv);
                vv += w * (dv * dv);
                sum += q[row][column];
            }
        }
        let mean = sum / if n > 0.0 { n } else { 1.0 };
        let [mut rest, mut uq, mut vq] = [0.0; 3];
        for row in 0..SIDE {
            for column in 0..SIDE {
                let off = w[row][column] * (q[row][column] - mean);
                rest += off;
                uq += OFF[column] * off;
                vq += OFF[row] * off;
            }
        }
        let fit = plane([n, u, v, uu, uv, vv], [rest, uq, vq]);
        let [a, b, c] = fit.abc;
        let mut squares = 0.0;
        for row in 0..SIDE {
            for column in 0..SIDE {
                let off = q[row][column] - mean - (a * OFF[column] + b * OFF[row] + c);
                squares += w[row][column] * (off * off);
            }
        }
        out.put(t, [n, u, v, uu, uv, vv, a, b, mean + c, squares, 0.0], fit.is_determined);
    }
    out
}

/// The sums of cells that lie side by side, from their parts in two rows.
#[inline(always)]
fn cells(parts: &Sums<&mut [f32]>, rows: [usize; 2], half: f32) -> Sums<Lanes> {
    let part = |numbers: &[f32]| [some(&numbers[rows[0]..]), some(&numbers[rows[1]..])];
    let (pn, pu, pv, puu, puv, pvv) =
        (part(parts.n), part(parts.u), part(parts.v), part(parts.uu), part(parts.uv), part(parts.vv));
    let (pa, pb, pc, psquares) = (part(parts.a), part(parts.b), part(parts.c), part(parts.squares));
    let mut out = no_sums();
    for t in 0..LANES {
        let [mut n, mut u, mut v, mut uu, mut uv, mut vv, mut sum] = [0.0; 7];
        for row in 0..2 {
            for column in 0..2 {
                let i = 2 * t + column;
                let (du, dv) = (half * (2 * column) as f32 - half, half * (2 * row) as f32 - half);
                let (m, mu, mv) = (pn[row][i], pu[row][i], pv[row][i]);
                n += m;
                u += mu + m * du;
                v += mv + m * dv;
                uu += puu[row][i] + du * (2.0 * mu + m * du);
                uv += puv[row][i] + du * mv + dv * mu + m * (du * dv);
                vv += pvv[row][i] + dv * (2.0 * mv + m * dv);
                sum += m * pc[row][i];
            }
        }
        let mean = sum / if n > 0.0 { n } else { 1.0 };
        let [mut q, mut uq, mut vq] = [0.0; 3];
        for row in 0..2 {
            for column in 0..2 {
                let i = 2 * t + column;
                let (du, dv) = (half * (2 * column) as f32 - half, half * (2 * row) as f32 - half);
                let (a, b, c) = (pa[row][i], pb[row][i], pc[row][i] - mean);
                let sum = pn[row][i] * c + pu[row][i] * a + pv[row][i] * b;
                q += sum;
                uq += c * pu[row][i] + a * puu[row][i] + b * puv[row][i] + du * sum;
                vq += c * pv[row][i] + a * puv[row][i] + b * pvv[row][i] + dv * sum;
            }
        }
        let fit = plane([n, u, v, uu, uv, vv], [q, uq, vq]);
        let [a, b, c] = fit.abc;
        let [mut squares, mut strain] = [0.0; 2];
        for row in 0..2 {
            for column in 0..2 {
                let i = 2 * t + column;
                let (du, dv) = (half * (2 * column) as f32 - half, half * (2 * row) as f32 - half);
                let (da, db) = (pa[row][i] - a, pb[row][i] - b);
                let dc = pc[row][i] - mean - (a * du + b * dv + c);
                let added = da * (da * puu[row][i] + 2.0 * (db * puv[row][i] + dc * pu[row][i]))
                    + db * (db * pvv[row][i] + 2.0 * dc * pv[row][i])
                    + dc * dc * pn[row][i];
                squares += own(psquares[row][i]) + added;
                strain = larger(strain, added / drift(pn[row][i]));
            }
        }
        out.put(t, [n, u, v, uu, uv, vv, a, b, mean + c, squares, strain], fit.is_determined);
    }
    out
}

/// The first numbers; anything for those that are missing, which belong to no cell.
#[inline(always)]
fn some(numbers: &[f32]) -> [f32; 2 * LANES] {
    let mut out = [0.0; 2 * LANES];
    match numbers.first_chunk::<{ 2 * LANES }>() {
        Some(all) => out = *all,
        None => out[..numbers.len()].copy_from_slice(numbers),
    }
    out
}

/// The squares of a part, nothing for one without a plane, which has no pixels either.
#[inline(always)]
fn own(squares: f32) -> f32 {
    if squares.is_finite() { squares } else { 0.0 }
}

impl Sums<Lanes> {
    /// Sets a cell's numbers; one without a plane has no pixels.
    #[inline(always)]
    fn put(&mut self, t: usize, numbers: [f32; 11], is_determined: bool) {
        for (i, (place, number)) in self.each().into_iter().zip(numbers).enumerate() {
            let nothing = if i == 9 { f32::INFINITY } else { 0.0 };
            place[t] = if is_determined { number } else { nothing };
        }
    }
}

impl GridRows<'_> {
    /// Writes the numbers of cells that lie side by side, as many as the row has.
    #[inline(always)]
    fn put(&mut self, row: usize, column: usize, mut sums: Sums<Lanes>) {
        let (at, count) = (row * self.columns + column, (self.columns - column).min(LANES));
        for (numbers, lanes) in self.sums.each().into_iter().zip(sums.each()) {
            let numbers = &mut numbers[at..at + count];
            match numbers.first_chunk_mut() {
                Some(all) => *all = *lanes,
                None => numbers.copy_from_slice(&lanes[..count]),
            }
        }
    }

    /// Roughness from each cell's own residuals, and from those of its parts.
    #[inline(always)]
    pub(super) fn hold_against_noise(&mut self, parts: Option<&GridRows<'_>>, confidence: f32) {
        let GridRows { sums: Sums { n, squares, strain, .. }, variance, roughness, columns, .. } = self;
        let numbers = n.iter().zip(&**squares).zip(&**strain).zip(&**variance);
        for ((((&n, &squares), &strain), &variance), roughness) in numbers.zip(&mut **roughness) {
            let free = larger(n - 3.0, 1.0);
            let own = squares * n / (free * limit(n, confidence));
            *roughness = larger(own, strain) / variance;
        }
        if let Some(parts) = parts {
            for (row, roughness) in roughness.chunks_exact_mut(*columns).enumerate() {
                let above = parts.roughness[2 * row * parts.columns..].as_chunks::<2>().0;
                let below = parts.roughness[(2 * row + 1) * parts.columns..].as_chunks::<2>().0;
                for ((roughness, above), below) in roughness.iter_mut().zip(above).zip(below) {
                    *roughness = larger(*roughness, larger(larger(above[0], above[1]), larger(below[0], below[1])));
                }
            }
        }
    }
}

/// The larger; `b` if `a` is not a number.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn no_sums() -> Sums<Lanes> {
    Sums::of([[0.0; LANES]; 11])
}

/// A least-squares plane about a cell's middle.
struct Fit {
    abc: [f32; 3],
    /// Whether the points determine it.
    is_determined: bool,
}

/// Least squares of `q = a u + b v + c` from sums.
#[inline(always)]
fn plane([n, u, v, uu, uv, vv]: [f32; 6], [q, uq, vq]: [f32; 3]) -> Fit {
    let per_n = 1.0 / n;
    let (mu, mv) = (u * per_n, v * per_n);
    let (uu, uv, vv) = (uu - u * mu, uv - u * mv, vv - v * mv);
    let (uq, vq) = (uq - q * mu, vq - q * mv);
    let det = uu * vv - uv * uv;
    let per_det = 1.0 / det;
    let (a, b) = ((vv * uq - uv * vq) * per_det, (uu * vq - uv * uq) * per_det);
    // Three pixels that are not on a line span a determinant of 1/3 and more.
    Fit { abc: [a, b, q * per_n - a * mu - b * mv], is_determined: det > 0.1 }
}
