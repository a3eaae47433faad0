//! Arithmetic that gives the same bits on every platform: random draws, sines, small vectors.
//!
//! Only `+ - * /`, `sqrt`, `floor` and integers are used, which IEEE 754 rounds in one way
//! (and Rust never fuses them). The sines of the platform's own library differ in their last bit,
//! enough to move a rounded millimetre, so they are not used here.

use std::f64::consts::PI;

/// A point or direction.
pub(super) type Vec3 = [f64; 3];

pub(super) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn scale(a: Vec3, s: f64) -> Vec3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
pub(super) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector at length 1; `None` if it has no direction.
pub(super) fn unit(a: Vec3) -> Option<Vec3> {
    let length = dot(a, a).sqrt();
    (length > 1e-12 && length.is_finite()).then(|| scale(a, 1.0 / length))
}

/// Sine and cosine of an angle in degrees, to 2e-16, exact at multiples of 90.
pub(super) fn sin_cos_deg(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    let quadrant = (turn / 90.0 + 0.5).floor();
    let x = (turn - 90.0 * quadrant) * (PI / 180.0);
    // Taylor series; |x| <= pi/4 leaves less than 1e-18 after nine terms.
    let (mut sine, mut cosine, mut term) = (0.0, 0.0, 1.0);
    for k in 0..9 {
        let n = f64::from(2 * k);
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        cosine += sign * term;
        term *= x / (n + 1.0);
        sine += sign * term;
        term *= x / (n + 2.0);
    }
    match quadrant as i64 % 4 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// SplitMix64 (Steele, Lea and Flood, *Fast Splittable Pseudorandom Number Generators*, 2014): one
/// 64-bit word of state, every seed a good one.
///
/// ```
/// use depthplanes::scene::Random;
/// let (mut a, mut b) = (Random::new(7), Random::new(7));
/// assert_eq!(a.next_u64(), b.next_u64());
/// assert!((0.0..1.0).contains(&a.uniform()));
/// ```
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The sequence of that seed.
    pub fn new(seed: u64) -> Self {
        Random { state: seed }
    }

    /// 64 random bits.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in 0..1, 1 excluded.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform between two numbers.
    #[inline]
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A whole number in `low..=high` (`low <= high`), for small ranges: the bias is range / 2^53.
    pub fn whole(&mut self, low: usize, high: usize) -> usize {
        low + (self.uniform() * (high + 1 - low) as f64) as usize
    }

    /// Mean 0, standard deviation 1: the sum of twelve 16-bit uniforms, scaled. Its tails end at 6
    /// standard deviations; in return it needs no logarithm and is exact on every platform.
    #[inline]
    pub fn gaussian(&mut self) -> f64 {
        let mut sum = 0u64;
        for _ in 0..3 {
            let word = self.next_u64();
            sum += (word & 0xFFFF) + ((word >> 16) & 0xFFFF) + ((word >> 32) & 0xFFFF) + (word >> 48);
        }
        (sum as f64 - 12.0 * 32_767.5) / 65_536.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_match_the_library_of_the_platform() {
        for step in -800..800 {
            let degrees = f64::from(step) * 0.7;
            let (sine, cosine) = sin_cos_deg(degrees);
            let (s, c) = degrees.to_radians().sin_cos();
            assert!((sine - s).abs() < 3e-15 && (cosine - c).abs() < 3e-15, "at {degrees}");
        }
        assert_eq!(sin_cos_deg(90.0), (1.0, 0.0));
        assert_eq!(sin_cos_deg(-180.0).1, -1.0);
    }

    #[test]
    fn gaussian_draws_have_mean_0_and_deviation_1() {
        let mut random = Random::new(3);
        let n = 400_000;
        let draws: Vec<f64> = (0..n).map(|_| random.gaussian()).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        let variance = draws.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / f64::from(n);
        assert!(mean.abs() < 0.01 && (variance - 1.0).abs() < 0.01, "{mean} {variance}");
    }
}
