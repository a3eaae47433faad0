//! A map in the space where planes are affine, and the plane around each of its pixels.
//!
//! In: a map and what its numbers mean. Out: q for every pixel, disparity or inverse depth, and the least-squares
//! plane `q = a u + b v + c` in a window around it (eq. 5), from running sums of columns: the cost grows with the
//! window's side only.

use crate::map::{DepthView, Pixel};
use crate::methods::rays::Rays;
use crate::noise::Space;
use crate::sensor::Sensor;
use crate::statistics::least_squares::Moments;

/// A map in q, row by row without padding.
#[derive(Debug, Default)]
pub(super) struct Affine {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Disparity in map units, or inverse depth in 1/m; NaN where nothing was measured.
    pub(super) q: Vec<f64>,
    pub(super) valid_pixels: usize,
}

impl Affine {
    /// The rays of its pixels; lengths are metres or median depths.
    pub(super) fn rays(&self, sensor: &Sensor) -> Rays {
        let median = || self.range(0.5).map_or(1.0, |[low, _]| low);
        Rays::scaled(sensor, [self.width, self.height], median)
    }

    /// A map in q.
    pub(super) fn of<T: Pixel>(map: &DepthView<'_, T>, space: Space) -> Self {
        let validity = map.validity();
        let q_of = |&value: &T| {
            let q = space.q(value.into());
            if validity.holds(value) && q.is_finite() { q } else { f64::NAN }
        };
        let q: Vec<f64> = map.rows().flat_map(|row| row.iter().map(q_of)).collect();
        let valid_pixels = q.iter().filter(|q| q.is_finite()).count();
        Affine { width: map.width(), height: map.height(), q, valid_pixels }
    }

    /// Column and row of a pixel, given by its number in raster order.
    pub(super) fn place(&self, at: usize) -> [f64; 2] {
        [at % self.width, at / self.width].map(|place| place as f64)
    }

    /// The four neighbours of a pixel.
    pub(super) fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let (u, v, width) = (at % self.width, at / self.width, self.width);
        let beside = [
            (u > 0).then(|| at - 1),
            (u + 1 < width).then(|| at + 1),
            (v > 0).then(|| at - width),
            (v + 1 < self.height).then(|| at + width),
        ];
        beside.into_iter().flatten()
    }

    /// The q below which a share of the pixels lies, and the q above which as many lie; none if no pixel is valid.
    pub(super) fn range(&self, share: f64) -> Option<[f64; 2]> {
        let mut all: Vec<f64> = self.q.iter().copied().filter(|q| q.is_finite()).collect();
        let few = (all.len() as f64 * share) as usize;
        let last = all.len().checked_sub(few + 1)?;
        Some([few, last].map(|at| *all.select_nth_unstable_by(at, f64::total_cmp).1))
    }

    /// Gives pixels beside a region to it where `takes` accepts the pixel and the region, and so on from there; 0 =
    /// no region.
    pub(super) fn spread(&self, image: &mut [u16], takes: impl Fn(usize, u16) -> bool) {
        let mut queue: Vec<usize> = (0..image.len()).filter(|&at| image[at] > 0).collect();
        let mut next = 0;
        while let Some(&at) = queue.get(next) {
            next += 1;
            for beside in self.neighbours(at) {
                if image[beside] == 0 && takes(beside, image[at]) {
                    image[beside] = image[at];
                    queue.push(beside);
                }
            }
        }
    }

    /// The plane in the window of `2 radius + 1` columns and rows around each valid pixel of which more than half is
    /// measured.
    pub(super) fn planes(&self, radius: usize) -> Vec<Option<Around>> {
        let Affine { width, height, .. } = *self;
        let middle = self.range(0.5).map_or(0.0, |[low, _]| low);
        // Sums over the window's rows of each column, then over its columns, each about the pixel itself.
        let mut columns = vec![Moments::default(); width];
        let mut out = Vec::with_capacity(self.q.len());
        let row = |v: usize| &self.q[v * width..][..width];
        let add = |columns: &mut [Moments], v: usize, sign: f64| {
            for (column, &q) in columns.iter_mut().zip(row(v)).filter(|(_, q)| q.is_finite()) {
                let (v, q) = (v as f64, q - middle);
                column.n += sign;
                column.v += sign * v;
                column.q += sign * q;
                column.vv += sign * v * v;
                column.vq += sign * v * q;
                column.qq += sign * q * q;
            }
        };
        (0..radius.min(height)).for_each(|v| add(&mut columns, v, 1.0));
        let least = ((2 * radius + 1) * (2 * radius + 1)) as f64 / 2.0;
        for v in 0..height {
            if v + radius < height {
                add(&mut columns, v + radius, 1.0);
            }
            if v > radius {
                add(&mut columns, v - radius - 1, -1.0);
            }
            for (u, &q) in row(v).iter().enumerate() {
                out.push(
                    q.is_finite()
                        .then(|| {
                            let window = u.saturating_sub(radius)..(u + radius + 1).min(width);
                            let mut sums = Moments::default();
                            for (column, u) in
                                columns[window.clone()].iter().zip(window.map(|other| other as f64 - u as f64))
                            {
                                let &Moments { n, v, q, vv, vq, qq, .. } = column;
                                sums.merge(&Moments {
                                    n,
                                    u: n * u,
                                    v,
                                    q,
                                    uu: n * u * u,
                                    uv: v * u,
                                    vv,
                                    uq: q * u,
                                    vq,
                                    qq,
                                });
                            }
                            sums
                        })
                        .filter(|sums| sums.n > least)
                        .and_then(|sums| sums.moved([0.0, -(v as f64), 0.0]).fit())
                        .map(|fit| Around { gradient: [fit.abc[0], fit.abc[1]], q: fit.abc[2] + middle, rms: fit.rms }),
                );
            }
        }
        out
    }
}

/// The least-squares plane around a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    /// What q changes by from column to column and from row to row.
    pub(super) gradient: [f64; 2],
    /// Its q at the pixel.
    pub(super) q: f64,
    /// Root mean square residual of the window's pixels.
    pub(super) rms: f64,
}
