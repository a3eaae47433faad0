//! A time-of-flight camera: noise that grows with the squared range, and mixed pixels at edges.
//!
//! - Noise: Gaussian in depth, sd = 1 mm + 1.3 mm (z / 1 m)^2. The shape is shot noise (light
//!   falls with z^2); the constants are our choice, so that 3.5 m gives the 17 mm that Azure
//!   Kinect's maker states there (Tolgyessy et al. 2021).
//! - Flying pixels: next to a jump in depth every second pixel gathers light from both sides and
//!   reports a depth between the two.
//! - Holes: beyond 0.5 to 5.46 m (Azure Kinect, narrow field, binned); and at random where the
//!   surface is seen at more than 80 degrees (our choice).
//! - Not modelled: multipath, reflectivity, wiggling.

use super::{Exposure, millimetres};
use crate::random::Random;

const RANGE_M: std::ops::RangeInclusive<f64> = 0.5..=5.46;
/// cos 80 degrees.
const GRAZING_COSINE: f32 = 0.17;
/// Least jump in depth at which pixels mix, metres.
const JUMP_M: f64 = 0.05;

/// Standard deviation of the depth, metres.
fn sigma_m(z: f64) -> f64 {
    0.001 + 0.0013 * z * z
}

pub(super) fn millimetres_of(exposure: &Exposure<'_>, random: &mut Random) -> Vec<u16> {
    let depth_m = &exposure.seen.depth_m;
    let mut pixels = Vec::with_capacity(depth_m.len());
    for (at, &exact) in depth_m.iter().enumerate() {
        // Drawn for every pixel, so that a hole does not change the noise elsewhere.
        let (noise, chance) = (random.gaussian(), random.uniform());
        let (mixing, part) = (random.uniform() < 0.5, random.uniform());
        let across = [[1, 0], [-1, 0], [0, 1], [0, -1]]
            .into_iter()
            .filter_map(|step| exposure.beside(at, step))
            .find(|&other| depth_m[other] > 0.0 && exposure.jump(at, other, JUMP_M));
        let z = match across {
            Some(other) if mixing => exact + part * (depth_m[other] - exact),
            _ => exact,
        };
        let dropped = chance < f64::from(1.0 - exposure.seen.cosines[at] / GRAZING_COSINE);
        let measured = RANGE_M.contains(&z) && !dropped;
        pixels.push(if measured { millimetres(z + sigma_m(z) * noise) } else { 0 });
    }
    pixels
}
