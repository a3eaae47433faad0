//! Stage "tiles": the map's small squares, each with its own plane, and larger squares made of them.
//!
//! In: rows of the map in q, or of cells. Out: the sums and planes of the tiles, or of the cells of 2 x 2, in them. All cells
//! of a row are computed side by side, so the loops are plain arithmetic that the compiler turns into vectors.

use super::grid::{GridRows, Sums, larger};
use super::layout::{LANES, SIDE};

/// Tiles that are, which rows have more of.
const TILE_LANES: usize = 2 * LANES;

/// The middle of a tile's columns and rows from its own.
const OFF: [f32; SIDE] = [-1.5, -0.5, 0.5, 1.5];

/// Tiles of a row that are summed at a time.
const PIECE: usize = 16 * TILE_LANES;

/// Memory for the pixels of some tiles of a row.
pub(super) struct Pixels {
    /// For each place in a tile the pixels there, side by side.
    by_place: [[[f32; PIECE]; SIDE]; SIDE],
}

impl Pixels {
    pub(super) const NOTHING: Pixels = Pixels { by_place: [[[0.0; PIECE]; SIDE]; SIDE] };

    /// The pixels of the tiles from one on.
    #[inline(always)]
    fn from(&self, at: usize) -> [[&[f32; TILE_LANES]; SIDE]; SIDE] {
        let mut out = [[&[0.0; TILE_LANES]; SIDE]; SIDE];
        for (out, pixels) in out.as_flattened_mut().iter_mut().zip(self.by_place.as_flattened()) {
            *out = pixels[at..].first_chunk().expect("a multiple of so many");
        }
        out
    }
}

/// Sums a row of tiles.
#[inline(always)]
pub(super) fn sum_tiles(q: &[f32], row: usize, pixels: &mut Pixels, halves: &mut Halves, grid: &mut GridRows<'_>) {
    let stride = q.len() / SIDE;
    for first in (0..stride).step_by(SIDE * PIECE) {
        let end = (first + SIDE * PIECE).min(stride);
        for (q, by_column) in q.chunks_exact(stride).zip(&mut pixels.by_place) {
            part_columns(&q[first..end], halves, by_column);
        }
        for at in (0..(end - first) / SIDE).step_by(TILE_LANES) {
            grid.put(row, first / SIDE + at, tiles(pixels.from(at)));
        }
    }
}

/// Memory for the pixels of a row in even columns, and for those in odd ones; by itself, or else the compiler does not see
/// that [`part`] reads and writes different places.
type Halves = [[f32; 2 * PIECE]; 2];
pub(super) const HALVES: Halves = [[0.0; 2 * PIECE]; 2];

/// Puts the first pixels of the tiles of a row side by side, the second ones, and so on: by halves, which processors have
/// instructions for.
#[inline(always)]
fn part_columns(row: &[f32], [even, odd]: &mut Halves, [first, second, third, fourth]: &mut [[f32; PIECE]; SIDE]) {
    let count = row.len() / 2;
    part(row, even, odd);
    part(&even[..count], first, third);
    part(&odd[..count], second, fourth);
}

/// Parts numbers into those at even and those at odd places.
#[inline(always)]
fn part(numbers: &[f32], even: &mut [f32], odd: &mut [f32]) {
    for ((pair, even), odd) in numbers.as_chunks::<2>().0.iter().zip(even).zip(odd) {
        [*even, *odd] = *pair;
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

/// The sums of tiles that lie side by side, from each of their pixels.
#[inline(always)]
fn tiles(pixels: [[&[f32; TILE_LANES]; SIDE]; SIDE]) -> Sums<[f32; TILE_LANES]> {
    // Where all pixels are valid, half of the sums are known.
    let mut sums = [0.0; TILE_LANES];
    for pixels in pixels.as_flattened() {
        (0..TILE_LANES).for_each(|t| sums[t] += pixels[t]);
    }
    let is_whole = sums.iter().fold(true, |all, sum| all & sum.is_finite());
    if is_whole { tiles_of::<true>(pixels) } else { tiles_of::<false>(pixels) }
}

#[inline(always)]
fn tiles_of<const WHOLE: bool>(pixels: [[&[f32; TILE_LANES]; SIDE]; SIDE]) -> Sums<[f32; TILE_LANES]> {
    let mut out = no_sums();
    for t in 0..TILE_LANES {
        let mut q = [[0.0; SIDE]; SIDE];
        let mut w = [[0.0; SIDE]; SIDE];
        for row in 0..SIDE {
            for column in 0..SIDE {
                let value = pixels[row][column][t];
                let holds = WHOLE || value.is_finite();
                w[row][column] = if holds { 1.0 } else { 0.0 };
                q[row][column] = if holds { value } else { 0.0 };
            }
        }
        let places = places_of(&w);
        let mean = total(&sums_of_rows(&q)) / if places[0] > 0.0 { places[0] } else { 1.0 };
        for row in 0..SIDE {
            for column in 0..SIDE {
                q[row][column] = w[row][column] * (q[row][column] - mean);
            }
        }
        let (of_rows, of_columns) = (sums_of_rows(&q), sums_of_rows(&turned(&q)));
        let fit = plane(places, [total(&of_rows), along(&of_columns), along(&of_rows)]);
        let [a, b, c] = fit.abc;
        for row in 0..SIDE {
            for column in 0..SIDE {
                let off = q[row][column] - w[row][column] * (a * OFF[column] + c + b * OFF[row]);
                q[row][column] = off * off;
            }
        }
        let squares = total(&sums_of_rows(&q));
        let [n, u, v, uu, uv, vv] = places;
        out.put(t, [n, u, v, uu, uv, vv, a, b, mean + c, squares, 0.0], fit.is_determined);
    }
    out
}

/// One number of each pixel of a tile.
type Tile = [[f32; SIDE]; SIDE];

/// Pixels of a tile, and sums over them of du, dv, du^2, du dv, dv^2, from 1 for each pixel and 0 for each that is missing.
#[inline(always)]
fn places_of(w: &Tile) -> [f32; 6] {
    let (of_rows, of_columns) = (sums_of_rows(w), sums_of_rows(&turned(w)));
    let mut across = [0.0; SIDE];
    (0..SIDE).for_each(|row| across[row] = along(&w[row]));
    [total(&of_rows), along(&of_columns), along(&of_rows), spread(&of_columns), along(&across), spread(&of_rows)]
}

#[inline(always)]
fn turned(tile: &Tile) -> Tile {
    let mut out = [[0.0; SIDE]; SIDE];
    for row in 0..SIDE {
        (0..SIDE).for_each(|column| out[column][row] = tile[row][column]);
    }
    out
}

#[inline(always)]
fn sums_of_rows(tile: &Tile) -> [f32; SIDE] {
    let mut out = [0.0; SIDE];
    (0..SIDE).for_each(|row| out[row] = total(&tile[row]));
    out
}

#[inline(always)]
fn total([a, b, c, d]: &[f32; SIDE]) -> f32 {
    (a + b) + (c + d)
}

/// Sum of four numbers times their places ([`OFF`]).
#[inline(always)]
fn along([a, b, c, d]: &[f32; SIDE]) -> f32 {
    1.5 * (d - a) + 0.5 * (c - b)
}

/// Sum of four numbers times the squares of their places.
#[inline(always)]
fn spread([a, b, c, d]: &[f32; SIDE]) -> f32 {
    2.25 * (a + d) + 0.25 * (b + c)
}

/// The sums of cells that lie side by side, from their parts in two rows.
#[inline(always)]
fn cells(parts: &Sums<&mut [f32]>, rows: [usize; 2], half: f32) -> Sums<[f32; LANES]> {
    let part = |numbers| rows.map(|first| pairs(numbers, first));
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
        let [mut squares, mut child_misfit] = [0.0; 2];
        for row in 0..2 {
            for column in 0..2 {
                let i = 2 * t + column;
                let (du, dv) = (half * (2 * column) as f32 - half, half * (2 * row) as f32 - half);
                let (da, db) = (pa[row][i] - a, pb[row][i] - b);
                let dc = pc[row][i] - mean - (a * du + b * dv + c);
                let more = da * (da * puu[row][i] + 2.0 * (db * puv[row][i] + dc * pu[row][i]))
                    + db * (db * pvv[row][i] + 2.0 * dc * pv[row][i])
                    + dc * dc * pn[row][i];
                squares += own(psquares[row][i]) + more;
                child_misfit = larger(child_misfit, more);
            }
        }
        out.put(t, [n, u, v, uu, uv, vv, a, b, mean + c, squares, child_misfit], fit.is_determined);
    }
    out
}

/// The numbers of two parts for each cell.
#[inline(always)]
fn pairs(numbers: &[f32], first: usize) -> &[f32; 2 * LANES] {
    numbers[first..].first_chunk().expect("rows of so many parts")
}

/// The squares of a part, nothing for one without a plane, which has no pixels either.
#[inline(always)]
fn own(squares: f32) -> f32 {
    if squares.is_finite() { squares } else { 0.0 }
}

#[inline(always)]
fn no_sums<const N: usize>() -> Sums<[f32; N]> {
    Sums::of([[0.0; N]; 11])
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::layout::LEVELS;
    use crate::methods::planar::testing::{
        Made, Stages, are_on_a_line, noise, patchy, pixels_that_count, plane_of, squares_about,
    };
    use crate::util::random::Random;

    /// Fails unless the cells of all sizes have the sums, the planes and the squares of their pixels.
    fn check(made: &Made) {
        let stages = Stages::tiles(made, noise(0.0));
        for grid in &stages.run.pyramid.grids {
            let [mut with, mut without] = [0; 2];
            for at in 0..grid.len() {
                let place = [at % grid.columns, at / grid.columns];
                let [u0, v0] = place.map(|place| place as f64 * grid.side as f64 + (grid.side - 1) as f64 / 2.0);
                let pixels = pixels_that_count(made, grid.side, place);
                let Sums { n, u, v, uu, uv, vv, a, b, c, squares, child_misfit } = &grid.sums;
                let number = |numbers: &[f32]| f64::from(numbers[at]);
                if pixels.is_empty() {
                    without += 1;
                    assert_eq!([n, u, v, uu, uv, vv, a, b, c].map(|numbers| number(numbers)), [0.0; 9]);
                    assert!(grid.side > SIDE || squares[at] == f32::INFINITY);
                    continue;
                }
                with += 1;
                let sum = |of: fn(f64, f64) -> f64| pixels.iter().map(|[u, v, _]| of(u - u0, v - v0)).sum::<f64>();
                let places = [sum(|_, _| 1.0), sum(|u, _| u), sum(|_, v| v)];
                let products = [sum(|u, _| u * u), sum(|u, v| u * v), sum(|_, v| v * v)];
                assert_eq!([n, u, v].map(|numbers| number(numbers)), places, "at {place:?} of side {}", grid.side);
                assert_eq!([uu, uv, vv].map(|numbers| number(numbers)), products, "at {place:?} of {}", grid.side);
                let (plane, left) = plane_of(&pixels, [u0, v0]);
                let found = [a, b, c].map(|numbers| number(numbers));
                // A plane's error is single precision's of q, more where few pixels tell.
                let off: f64 = pixels
                    .iter()
                    .map(|[u, v, _]| (0..3).map(|i| (found[i] - plane[i]) * [u - u0, v - v0, 1.0][i]).sum::<f64>())
                    .fold(0.0, |most, off| most.max(off.abs()));
                assert!(off < 2e-4, "{found:?} for {plane:?} of {} pixels, side {}", pixels.len(), grid.side);
                let tolerance = 1e-3 * left + 1e-6 * pixels.len() as f64;
                assert!((number(squares) - left).abs() <= tolerance, "{} squares for {left}", number(squares));
                if grid.side > SIDE {
                    let misfits = (0..4).map(|part| {
                        let part = [2 * place[0] + part % 2, 2 * place[1] + part / 2];
                        let pixels = pixels_that_count(made, grid.side / 2, part);
                        if pixels.is_empty() {
                            0.0
                        } else {
                            squares_about(&pixels, plane, [u0, v0]) - plane_of(&pixels, [u0, v0]).1
                        }
                    });
                    let most = misfits.fold(0.0, f64::max);
                    let found = number(child_misfit);
                    assert!((found - most).abs() <= 2e-3 * left + 1e-5 * pixels.len() as f64, "{found} for {most}");
                }
            }
            assert!(with > 0 && without > 0, "{with}, {without} of side {}", grid.side);
        }
        assert_eq!(stages.run.pyramid.grids.len(), LEVELS);
    }

    #[test]
    fn cells_of_every_size_have_the_sums_and_the_plane_of_their_pixels() {
        (1..5).for_each(|seed| check(&patchy(seed)));
    }

    #[test]
    fn tiles_of_lone_pixels_and_of_pixels_on_a_line_have_no_plane_and_every_other_has_one() {
        let mut random = Random::new(3);
        // Each tile has few pixels, on a row, a column, a diagonal or anywhere.
        let shapes: Vec<[bool; 16]> = (0..32 * 8)
            .map(|_| {
                let (kind, place) = (random.whole(0, 7), random.whole(0, 3));
                std::array::from_fn(|at| {
                    let [u, v] = [at % 4, at / 4];
                    let here = [u == place, v == place, u == v, 2 * u == v].get(kind).copied();
                    random.uniform()
                        < if here == Some(true) {
                            0.8
                        } else if here.is_none() {
                            0.2
                        } else {
                            0.0
                        }
                })
            })
            .collect();
        let made = Made::exact([128, 32], |u, v| {
            let is_there = shapes[v / 4 * 32 + u / 4][v % 4 * 4 + u % 4];
            if is_there { 30.0 + random.uniform() } else { f64::NAN }
        });
        let stages = Stages::tiles(&made, noise(0.0));
        let grid = stages.grid();
        let [mut with, mut without] = [0; 2];
        for (row, column) in (0..8).flat_map(|row| (0..32).map(move |column| (row, column))) {
            let (at, pixels) =
                (row * grid.columns + column, made.pixels(4 * column..4 * column + 4, 4 * row..4 * row + 4));
            let expected = if are_on_a_line(&pixels) { 0 } else { pixels.len() };
            assert_eq!(grid.sums.n[at] as usize, expected, "{pixels:?}");
            assert_eq!(grid.sums.squares[at].is_finite(), expected > 0, "{pixels:?}");
            [with, without] = [with + usize::from(expected > 0), without + usize::from(expected == 0)];
        }
        assert!(with > 20 && without > 20, "{with} with a plane, {without} without");
    }
}
