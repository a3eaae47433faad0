//! Kinect v1: a pattern projected from 7.5 cm to the right, matched in a window, in steps of 1/8 px.
//!
//! - Depth from an 11-bit number `kd`: `z = 8 f b / (doff - kd)` (ROS kinect_calibration/technical)
//!   with doff = 1090.9 (OpenKinect's fit of 1/z against kd).
//! - Noise: Gaussian in disparity, sd 1/16 px, before the rounding to 1/8 px. With that
//!   sigma_z = z^2 / (16 f b) = 1.44e-3 z^2 m; Khoshelham & Elberink 2012 measured 1.425e-3. Both
//!   together leave an error of 0.072 px.
//! - The step and the noise are pixels of the sensor's own 640 x 480 picture: a smaller picture of
//!   the same view has the same error in depth.
//! - Edges: the matching window moves them by about 0.8 px (the lateral noise of Nguyen, Izadi and
//!   Lovell 2012), alike over small cells, so that edges are ragged rather than dusty (our choice:
//!   cells of 3 x 3 px).
//! - Holes: the projector's shadow, cast geometrically; beyond 0.5 to 8 m; and at random where the
//!   surface is seen at more than 78 degrees (our choice; the dots get too thin to match).

use super::{Exposure, millimetres};
use crate::random::Random;
use crate::scene::pose::KINECT_FOCAL_PX;

const BASELINE_M: f64 = 0.075;
/// Raw number of an infinite depth.
const DOFF: f64 = 1090.9;
/// 1/8 px steps per 1/m.
const STEPS_M: f64 = 8.0 * KINECT_FOCAL_PX * BASELINE_M;
/// Standard deviation in steps: 1/16 px.
const SIGMA_STEPS: f64 = 0.5;
const RANGE_M: std::ops::RangeInclusive<f64> = 0.5..=8.0;
/// cos 78 degrees: below it pixels drop out with a probability that reaches 1 at 90 degrees.
const GRAZING_COSINE: f32 = 0.2;
/// Standard deviation of the shift of edges, in pixels of the sensor's own picture.
const EDGE_PX: f64 = 0.8;
/// Side of the cells that share a shift, pixels.
const CELL: usize = 3;
/// Edges with a smaller step in depth are left in place, metres.
const EDGE_STEP_M: f64 = 0.02;

pub(super) fn millimetres_of(exposure: &Exposure<'_>, random: &mut Random) -> Vec<u16> {
    let shadow = exposure.hidden_from_right(BASELINE_M, false);
    let shifts = edge_shifts(exposure, random);
    let columns = exposure.camera.width.div_ceil(CELL);
    let mut pixels = Vec::with_capacity(shadow.len());
    for at in 0..shadow.len() {
        let (u, v) = (at % exposure.camera.width, at / exposure.camera.width);
        let shift = shifts[v / CELL * columns + u / CELL];
        let source = exposure.beside(at, shift).filter(|&other| exposure.jump(at, other, EDGE_STEP_M)).unwrap_or(at);
        // Drawn for every pixel, so that a hole does not change the noise elsewhere.
        let (noise, chance) = (random.gaussian(), random.uniform());
        let z = exposure.seen.depth_m[source];
        let dropped = chance < f64::from(1.0 - exposure.seen.cosines[source] / GRAZING_COSINE);
        let measured = RANGE_M.contains(&z) && !shadow[source] && !dropped;
        pixels.push(if measured { millimetres(through_raw(z, noise)) } else { 0 });
    }
    pixels
}

/// Depth in metres as it comes back from the raw number, with `noise` standard deviations.
fn through_raw(z: f64, noise: f64) -> f64 {
    let raw = (DOFF - STEPS_M / z + SIGMA_STEPS * noise + 0.5).floor();
    STEPS_M / (DOFF - raw)
}

/// One shift (columns, rows) for each cell.
fn edge_shifts(exposure: &Exposure<'_>, random: &mut Random) -> Vec<[isize; 2]> {
    let camera = exposure.camera;
    let sigma = EDGE_PX * (camera.intrinsics.fx.abs() / KINECT_FOCAL_PX).min(10.0);
    let cells = camera.width.div_ceil(CELL) * camera.height.div_ceil(CELL);
    let mut whole = || (sigma * random.gaussian() + 0.5).floor() as isize;
    (0..cells).map(|_| [whole(), whole()]).collect()
}
