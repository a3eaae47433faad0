//! Values in steps so coarse that they hide how surfaces lie.

use crate::outputs::Report;
use crate::traps::{Probe, is_small, length};

/// Fewest and most values of a map whose planes the steps may have turned or merged. Of rooms in 5 to 13 steps of disparity
/// half had planes merged or turned by more than 4 degrees, of rooms in 16 and more all were right. Fewer may be walls
/// that face the camera.
const FEW: [usize; 2] = [5, 15];
/// Smallest step, as a share of the depth: whole numbers of a small unit are no coarse steps.
const COARSE: f64 = 0.02;

/// A map of depth with few values, far apart.
pub(super) fn coarse(report: &Report<'_>) -> Option<String> {
    let frame = report.frame;
    if is_small(frame) || frame.warnings.iter().any(|warning| warning.contains("label image")) {
        return None;
    }
    let probe = Probe::some(frame)?;
    let levels = probe.levels();
    let mut depths: Vec<f64> = levels.iter().filter_map(|&level| frame.sensor.value_kind.depth_m(level)).collect();
    depths.sort_by(f64::total_cmp);
    let step = |pair: &[f64]| (pair[1] - pair[0]) / pair[1];
    let is_coarse = (FEW[0]..=FEW[1]).contains(&depths.len()) && depths.windows(2).all(|pair| step(pair) > COARSE);
    let widest = depths.windows(2).max_by(|a, b| step(a).total_cmp(&step(b)))?;
    is_coarse.then(|| {
        format!(
            "only {} different values, up to {} apart at {}: surfaces between two steps cannot be told apart, and planes may be \
             turned or merged; a map with finer steps tells more",
            depths.len(),
            length(widest[1] - widest[0]),
            length(widest[1])
        )
    })
}
