//! What a pixel and a plane cost, in bits (section 3 of Yang and Förstner).
//!
//! In: a map in q and its noise. A pixel without a plane costs the bits of a value between 0 and the largest; one on
//! a plane costs those of its distance, which is Gaussian. Values are coded to the median noise: finer differences
//! are not the scene's.

use crate::baselines::affine::Affine;
use crate::noise::{NoiseModel, Patch};
use crate::statistics::least_squares::Moments;
use std::f64::consts::{LN_2, TAU};

/// The costs of a map's pixels. q is stored relative to its median, places relative to the middle of the map.
#[derive(Debug)]
pub(super) struct Code {
    noise: NoiseModel,
    median: f64,
    pub(super) q: Vec<f64>,
    middle: [f64; 2],
    /// For each pixel its precision, (median noise / noise)^2; 0 for one that is not measured or has no meaning.
    pub(super) weights: Vec<f64>,
    /// The median noise.
    resolution: f64,
    /// Bits of a value.
    value: f64,
}

impl Code {
    pub(super) fn new(affine: &Affine, noise: &NoiseModel) -> Self {
        let [low, high] = affine.range(0.01).unwrap_or([0.0; 2]);
        let median = affine.range(0.5).map_or(0.0, |[low, _]| low);
        // From infinity to the nearest pixel.
        let range = low.abs().max(high.abs());
        let least = 1e-9 * range;
        let sigma = |q: f64| noise.variance(q).sqrt().max(least);
        let resolution = sigma(median);
        let weight = |&q: &f64| Some((resolution / sigma(q)).powi(2)).filter(|w| w.is_finite() && *w > 0.0);
        let weights = affine.q.iter().map(|q| weight(q).unwrap_or(0.0)).collect();
        let value = Some((range / resolution).log2()).filter(|bits| bits.is_finite()).unwrap_or(0.0);
        let middle = [affine.width as f64 / 2.0, affine.height as f64 / 2.0];
        let q = affine.q.iter().map(|q| q - median).collect();
        Code { noise: *noise, median, q, middle, weights, resolution, value }
    }

    /// A place relative to the middle of the map.
    pub(super) fn about(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [u - self.middle[0], v - self.middle[1]]
    }

    /// Bits of a pixel without a plane.
    pub(super) fn free(&self) -> f64 {
        self.value
    }

    /// Bits of a plane.
    pub(super) fn plane(&self) -> f64 {
        3.0 * self.value
    }

    /// Bits that say which of so many planes, or none, each of some pixels is on.
    pub(super) fn mask(&self, pixels: usize, planes: usize) -> f64 {
        pixels as f64 * ((planes + 1) as f64).log2()
    }

    /// Bits of a pixel on a plane: `e^2 / (2 ln 2 sigma^2) + log2(sigma / resolution) + log2(2 pi) / 2`.
    pub(super) fn on_plane(&self, at: usize, off: f64) -> f64 {
        let weight = self.weights[at];
        self.bits(off * off * weight) - 0.5 * weight.log2() + 0.5 * TAU.log2()
    }

    /// Whether a pixel costs less on a plane.
    pub(super) fn is_shorter(&self, at: usize, off: f64) -> bool {
        self.weights[at] > 0.0 && self.on_plane(at, off) < self.free()
    }

    /// The largest squared distance, times the weight, at which a pixel of the median noise costs less on a plane.
    pub(super) fn near(&self) -> f64 {
        (self.free() - 0.5 * TAU.log2()) * 2.0 * LN_2 * self.resolution * self.resolution
    }

    /// Bits of a sum of weighted squares.
    pub(super) fn bits(&self, squares: f64) -> f64 {
        squares / (2.0 * LN_2 * self.resolution * self.resolution)
    }

    /// How many pixels of a patch at q count as one, since rounding makes them err alike; 1 at least.
    pub(super) fn shared(&self, patch: &Patch, q: f64) -> f64 {
        let q = q + self.median;
        (self.noise.variance_in(patch, q) / self.noise.variance(q)).max(1.0)
    }

    /// A pixel as sums, with its weight.
    pub(super) fn sums(&self, at: usize, [u, v]: [f64; 2]) -> Moments {
        let (q, n) = (self.q[at], self.weights[at]);
        Moments {
            n,
            u: n * u,
            v: n * v,
            q: n * q,
            uu: n * u * u,
            uv: n * u * v,
            vv: n * v * v,
            uq: n * u * q,
            vq: n * v * q,
            qq: n * q * q,
        }
    }
}
