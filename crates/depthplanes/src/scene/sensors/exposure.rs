//! What a sensor looks at.

use crate::scene::cast::{Cast, Caster};
use crate::scene::pose::Camera;
use crate::scene::surfaces::Scene;

/// The exact picture, with what a sensor model may ask about it.
pub(in crate::scene) struct Exposure<'a> {
    pub(in crate::scene) scene: &'a Scene,
    pub(in crate::scene) camera: &'a Camera,
    pub(in crate::scene) seen: &'a Cast,
}

impl Exposure<'_> {
    /// Which pixels show points that an eye `baseline_m` to the right of the camera does not see because something
    /// stands between: shadows if a projector is there, occlusions if a second camera is there. They lie to the left
    /// of near things. With `bounded`, points left or right of the other eye's own picture count as hidden too.
    ///
    /// In a rectified pair the ray from the other eye stays in the same row, at column
    /// `u - fx baseline / z`.
    pub(super) fn hidden_from_right(&self, baseline_m: f64, bounded: bool) -> Vec<bool> {
        let Camera { intrinsics, width, height, .. } = *self.camera;
        let other = Caster::new(self.scene, intrinsics, &self.camera.extrinsics().shifted_right(baseline_m));
        let mut hidden = Vec::with_capacity(width * height);
        for (v, depths) in self.seen.depth_m.chunks(width).enumerate() {
            let row = other.row(v as f64);
            for (u, &z) in depths.iter().enumerate() {
                let column = u as f64 - intrinsics.fx * baseline_m / z;
                let outside = bounded && !(-0.5..width as f64 - 0.5).contains(&column);
                hidden.push(z > 0.0 && (outside || other.blocked([column, v as f64], 1.0 / z, &row)));
            }
        }
        hidden
    }

    /// The pixel `step` = (columns, rows) away from pixel `at`, if it is in the picture.
    pub(super) fn beside(&self, at: usize, step: [isize; 2]) -> Option<usize> {
        let (width, height) = (self.camera.width, self.camera.height);
        let u = (at % width).checked_add_signed(step[0]).filter(|&u| u < width)?;
        let v = (at / width).checked_add_signed(step[1]).filter(|&v| v < height)?;
        Some(v * width + u)
    }

    /// Whether two pixels show different surfaces at depths more than `least_m` apart.
    pub(super) fn jump(&self, a: usize, b: usize, least_m: f64) -> bool {
        let Cast { depth_m, surfaces, .. } = self.seen;
        surfaces[a] != surfaces[b] && (depth_m[a] - depth_m[b]).abs() > least_m
    }
}

/// Metres to whole millimetres; 0 for what 16 bits cannot hold.
pub(super) fn millimetres(depth_m: f64) -> u16 {
    let mm = (depth_m * 1000.0 + 0.5).floor();
    if (1.0..=65_535.0).contains(&mm) { mm as u16 } else { 0 }
}
