//! A depth map as a muted grey picture: near is bright, missing is nearly black.
//!
//! Shades are linear in inverse depth, where near detail shows and where the error of stereo and
//! structured light is even. The range runs from the 2nd to the 98th percentile, so that a few
//! wild pixels do not flatten the rest.

use depthplanes::{AnyView, ValueKind, with_view};

/// Missing pixels: darker than any depth, and slightly blue so as to differ from far.
pub(super) const MISSING: [u8; 3] = [14, 14, 24];
/// Shades of the farthest and the nearest pixels; white and black stay free for text and outlines.
const FAR: f32 = 52.0;
const NEAR: f32 = 208.0;

/// The shade of each pixel of a map whose numbers mean that, row by row.
pub(super) fn greys(map: AnyView<'_>, value_kind: ValueKind) -> Vec<[u8; 3]> {
    let nearness = nearness(map, value_kind);
    let (low, high) = robust_range(&nearness);
    let scale = if high > low { (NEAR - FAR) / (high - low) } else { 0.0 };
    let middle = if high > low { 0.0 } else { (NEAR - FAR) / 2.0 };
    let shade = |&near: &f32| {
        if near.is_nan() {
            return MISSING;
        }
        [(FAR + middle + (near.clamp(low, high) - low) * scale).round() as u8; 3]
    };
    nearness.iter().map(shade).collect()
}

/// A number for each pixel that grows with inverse depth; NaN where the pixel is missing.
fn nearness(map: AnyView<'_>, value_kind: ValueKind) -> Vec<f32> {
    let near = |value: f64| match value_kind {
        ValueKind::Disparity => value as f32,
        _ => value_kind.inverse_depth(value).map_or(f32::NAN, |inverse| inverse as f32),
    };
    with_view!(map, view => {
        let valid = view.validity();
        let pixel = |&value| if valid.holds(value) { near(f64::from(value)) } else { f32::NAN };
        view.rows().flat_map(|row| row.iter().map(pixel)).collect()
    })
}

/// The 2nd and 98th percentile of what is not NaN; (0, 0) if nothing is.
fn robust_range(nearness: &[f32]) -> (f32, f32) {
    let mut known: Vec<f32> = nearness.iter().copied().filter(|near| !near.is_nan()).collect();
    if known.is_empty() {
        return (0.0, 0.0);
    }
    let last = known.len() - 1;
    let mut percentile = |percent: usize| *known.select_nth_unstable_by(last * percent / 100, f32::total_cmp).1;
    (percentile(2), percentile(98))
}
