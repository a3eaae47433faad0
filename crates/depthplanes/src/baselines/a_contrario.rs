//! A contrario validation: a region is a plane if chance would hardly make it (Desolneux, Moisan and Morel, *Meaningful
//! Alignments*, 2000).
//!
//! In: a map in q and its noise. Out: connected regions of pixels aligned with a plane, with their number of false
//! alarms (NFA): how many regions as good a map of noise would show. Shared by `ppdfdm` and `fpdidm`; what the papers leave
//! open is our choice and marked so. docs/a-contrario.md has the model.

use super::affine::Affine;
use super::work::Work;
use crate::limits::MAX_PLANES;
use crate::methods::parameter::{Param, ParamKind};
use crate::noise::NoiseModel;
use crate::statistics::least_squares::Moments;
use std::f64::consts::{LN_10, PI};

pub(super) const EPS: Param = Param {
    name: "eps",
    alias: None,
    default: 1.0,
    min: 0.0,
    max: f64::MAX,
    kind: ParamKind::Real,
    unit: "planes",
    meaning: "Planes expected by chance: a region is a plane if its number of false alarms is at most this.",
    source: Some("Bughin and Almansa 2010"),
};

pub(super) const DELTA: Param = Param {
    name: "delta",
    alias: None,
    default: 2.5,
    min: 0.1,
    max: 1e6,
    kind: ParamKind::Real,
    unit: "standard deviations",
    meaning: "Largest distance of a pixel from its plane, in standard deviations of the noise, which is the preset's, or else estimated from the map.",
    source: Some("Bughin and Almansa 2010"),
};

/// Precisions that a region is tested at: delta, delta / sqrt(2), .. (our choice).
const PRECISIONS: usize = 6;
/// Share of the pixels at either end that the range leaves out, so that single wild ones do not decide it (our choice).
const WILD: f64 = 0.005;
/// Most fits of a region until it is stable.
const ROUNDS: usize = 20;

/// `q = a u + b v + c`.
pub(super) type Abc = [f64; 3];

/// The map as the background model sees it: q of each pixel is independent of others and uniform over the map's range.
pub(super) struct Background<'a> {
    pub(super) affine: &'a Affine,
    /// For each pixel how far from a plane it may lie; at most a quarter of the range.
    pub(super) delta: Vec<f64>,
    range: f64,
    log10_tests: f64,
    /// For each pixel the last flood that saw it.
    seen: Vec<u32>,
    floods: u32,
    /// What the whole search may still do.
    pub(super) work: Work,
}

/// Connected pixels and the plane fitted to them.
#[derive(Debug)]
pub(super) struct Region {
    pub(super) plane: Abc,
    pub(super) pixels: Vec<u32>,
    /// Pixels beside them that are not aligned.
    pub(super) rim: usize,
    pub(super) log10_nfa: f64,
}

impl<'a> Background<'a> {
    /// The background model of a map; `delta` is in standard deviations of its noise.
    pub(super) fn of(affine: &'a Affine, noise: &NoiseModel, delta: f64) -> Self {
        let [low, high] = affine.range(WILD).unwrap_or_default();
        let range = high - low + noise.step((low + high) / 2.0);
        // Beyond that, the probability of an aligned pixel would be above 1/2, and chance would explain everything.
        let most = if range > 0.0 { range / 4.0 } else { f64::INFINITY };
        let delta = affine.q.iter().map(|&q| (delta * noise.variance(q).sqrt()).min(most)).collect();
        let pixels = affine.valid_pixels.max(1) as f64;
        // The count of shapes as in LSD (Grompone von Gioi et al., 2010), the cheap version.
        let log10_tests = 2.5 * pixels.log10() + (PRECISIONS as f64).log10();
        let work = Work::new(affine.q.len());
        Background { affine, delta, range, log10_tests, seen: vec![0; affine.q.len()], floods: 0, work }
    }

    /// How far a pixel is off a plane, in its deltas; NaN where nothing was measured.
    #[inline(always)]
    pub(super) fn off(&self, [a, b, c]: &Abc, at: usize) -> f64 {
        let [u, v] = self.affine.place(at);
        (self.affine.q[at] - (a * u + b * v + c)).abs() / self.delta[at]
    }

    /// Forgets which pixels the last flood has seen.
    pub(super) fn start_flood(&mut self) {
        if self.floods == u32::MAX {
            self.seen.fill(0);
            self.floods = 0;
        }
        self.floods += 1;
    }

    /// Marks a pixel as seen by this flood; false if it is already.
    #[inline(always)]
    pub(super) fn see(&mut self, at: usize) -> bool {
        std::mem::replace(&mut self.seen[at], self.floods) != self.floods
    }

    /// The plane of least squares; none for pixels on a line.
    pub(super) fn fit(&self, pixels: &[u32]) -> Option<Abc> {
        let first = *pixels.first()? as usize;
        let ([u, v], q) = (self.affine.place(first), self.affine.q[first]);
        let mut sums = Moments::default();
        for &at in pixels {
            let [x, y] = self.affine.place(at as usize);
            sums.add(x - u, y - v, self.affine.q[at as usize] - q);
        }
        Some(sums.fit()?.moved([u, v, q]).abc)
    }

    /// The free pixels connected with the seed that lie within `scale` deltas of a plane, as a region; none if no
    /// plane can be fitted to them.
    pub(super) fn region(&mut self, seed: usize, plane: &Abc, scale: f64, is_free: &[bool]) -> Option<Region> {
        let affine = self.affine;
        self.start_flood();
        let (mut pixels, mut rim, mut next) = (Vec::new(), 0, 0);
        let mut visit = |at: usize, pixels: &mut Vec<u32>| {
            let off = if is_free[at] && self.see(at) { self.off(plane, at) } else { f64::NAN };
            if off <= scale {
                pixels.push(at as u32);
            }
            rim += usize::from(off > scale);
        };
        visit(seed, &mut pixels);
        while let Some(&at) = pixels.get(next) {
            next += 1;
            affine.neighbours(at as usize).for_each(|beside| visit(beside, &mut pixels));
        }
        self.work.count(PRECISIONS * (pixels.len() + 1));
        let plane = self.fit(&pixels)?;
        let log10_nfa = self.log10_nfa(&pixels, rim, &plane);
        Some(Region { plane, pixels, rim, log10_nfa })
    }

    /// The region of a seed, fitted and flooded again until it is stable; of all these, the one with the fewest false
    /// alarms.
    pub(super) fn settle(&mut self, seed: usize, plane: &Abc, is_free: &[bool]) -> Option<Region> {
        let mut best = self.region(seed, plane, 1.0, is_free)?;
        let (mut plane, mut pixels) = (best.plane, best.pixels.len());
        for _ in 1..ROUNDS {
            let Some(next) = self.region(seed, &plane, 1.0, is_free) else { break };
            if next.pixels.len() == pixels {
                break;
            }
            (plane, pixels) = (next.plane, next.pixels.len());
            if next.log10_nfa < best.log10_nfa {
                best = next;
            }
        }
        Some(best)
    }

    /// log10 of the number of false alarms at the best of the precisions.
    ///
    /// The rim counts as tried and not aligned (our choice): it is where chance stopped the region. Without it every region
    /// would be all aligned, and large ones would arise wherever half of the pixels are.
    pub(super) fn log10_nfa(&self, pixels: &[u32], rim: usize, plane: &Abc) -> f64 {
        let mut aligned = [0; PRECISIONS];
        let mut delta = 0.0;
        for &at in pixels {
            let off = self.off(plane, at as usize);
            delta += self.delta[at as usize];
            for (count, scale) in aligned.iter_mut().zip(scales()) {
                *count += usize::from(off <= scale);
            }
        }
        // Where delta varies, the tail is not above that of the mean (Hoeffding 1956).
        let chance = (2.0 * delta / pixels.len() as f64 / self.range).min(0.5);
        let tails = aligned.iter().zip(scales()).map(|(&k, scale)| log10_tail(pixels.len() + rim, k, scale * chance));
        self.log10_tests + tails.fold(0.0, f64::min)
    }
}

/// The precisions, in deltas.
fn scales() -> impl Iterator<Item = f64> {
    (0..PRECISIONS as i32).map(|j| 0.5f64.powi(j / 2) * if j % 2 == 1 { std::f64::consts::FRAC_1_SQRT_2 } else { 1.0 })
}

/// Regions as an image: 0 for none, then 1, 2, ..
pub(super) fn paint<'r>(regions: impl Iterator<Item = &'r Region>, area: usize) -> Vec<u16> {
    let mut image = vec![0; area];
    for (label, region) in (1..).zip(regions.take(MAX_PLANES)) {
        region.pixels.iter().for_each(|&at| image[at as usize] = label);
    }
    image
}

/// log10 of the probability that at least k of n independent events occur, each with probability p; 0 where k is not above
/// the mean, for nothing there is unlikely.
fn log10_tail(n: usize, k: usize, p: f64) -> f64 {
    let [n, k] = [n, k].map(|count| count as f64);
    if k <= n * p {
        return 0.0;
    }
    let first = ln_factorial(n) - ln_factorial(k) - ln_factorial(n - k) + k * p.ln() + (n - k) * (-p).ln_1p();
    // The other terms by recurrence; their ratios fall, so that the rest is below a geometric series.
    let (mut term, mut sum, mut i) = (1.0, 1.0, k);
    while i < n {
        let ratio = (n - i) / (i + 1.0) * p / (1.0 - p);
        if term * ratio < 1e-3 * sum * (1.0 - ratio) {
            break;
        }
        term *= ratio;
        sum += term;
        i += 1.0;
    }
    ((first + f64::ln(sum)) / LN_10).min(0.0)
}

/// ln n!, by Stirling's series for large n.
fn ln_factorial(n: f64) -> f64 {
    if n < 16.0 {
        return (2..=n as u32).map(f64::from).product::<f64>().ln();
    }
    let square = n * n;
    n * n.ln() - n + 0.5 * (2.0 * PI * n).ln() + (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / (1260.0 * square)) / square) / n
}

#[cfg(test)]
mod tests {
    use super::{ln_factorial, log10_tail};

    /// Pascal's triangle, no logarithm.
    fn exact(n: usize, k: usize, p: f64) -> f64 {
        let mut row = vec![1.0f64];
        for _ in 0..n {
            row = (0..=row.len())
                .map(|i| {
                    let [one, other] = [i.checked_sub(1), Some(i)].map(|i| i.and_then(|i| row.get(i)).unwrap_or(&0.0));
                    one * p + other * (1.0 - p)
                })
                .collect();
        }
        row[k..].iter().sum()
    }

    #[test]
    fn the_tail_is_the_exact_sum() {
        for n in 1..=40 {
            for k in 0..=n {
                for p in [1e-4, 0.03, 0.2, 0.5] {
                    let (tail, exact) = (log10_tail(n, k, p), exact(n, k, p).log10());
                    if k as f64 > n as f64 * p {
                        assert!((tail - exact).abs() < 5e-4, "n {n} k {k} p {p}: {tail} {exact}");
                    } else {
                        assert!(tail == 0.0, "n {n} k {k} p {p}: {tail}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_tail_is_within_hoeffdings_bound() {
        for n in [10, 1_000, 300_000] {
            for share in [0.1, 0.4, 0.7, 1.0] {
                for p in [1e-6, 0.01, 0.3, 0.5] {
                    let k = (share * f64::from(n)) as usize;
                    let (r, n) = (k as f64 / f64::from(n), n as usize);
                    let rest = if r < 1.0 { (1.0 - r) * ((1.0 - r) / (1.0 - p)).ln() } else { 0.0 };
                    let bound = -(n as f64) * (r * (r / p).ln() + rest) / 10f64.ln();
                    let tail = log10_tail(n, k, p);
                    assert!(r <= p || tail <= bound + 1e-3 + 1e-9 * bound.abs(), "n {n} k {k} p {p}: {tail} {bound}");
                    assert!(r <= p || tail >= bound - 0.5 * (n as f64).log10() - 1.0, "it is tight to a power of n");
                }
            }
        }
    }

    #[test]
    fn factorials_are_continuous_where_the_series_starts() {
        let step = ln_factorial(16.0) - ln_factorial(15.0);
        assert!((step - 16f64.ln()).abs() < 1e-11, "{step}");
    }
}
