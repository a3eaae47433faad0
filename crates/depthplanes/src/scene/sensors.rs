//! What a sensor makes of the exact depth: its noise, its steps, its holes.
//!
//! In: the exact picture of a scene ([`Cast`]) and a seed. Out: the pixels of a map and what they
//! mean. Each model is a statistical one with its formula beside it; none traces light.

mod kinect;
mod tof;

use super::ScenePixels;
use super::cast::{Cast, Caster};
use super::pose::Camera;
use super::surfaces::Scene;
use crate::camera::Measure;
use crate::error::{Error, Result};
use crate::random::Random;

/// A depth camera's behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorModel {
    /// Exact depth, `f32` metres.
    Clean,
    /// Exact depth rounded to `u16` millimetres.
    CleanMm,
    /// Structured light: a Kinect v1, `u16` millimetres.
    KinectV1White,
    /// Time of flight, `u16` millimetres.
    TofWhite,
    /// The true disparity of a rectified pair in `u8` steps of a quarter of a pixel.
    Disparity8,
}

/// One row of [`SENSORS`].
#[derive(Clone, Copy, Debug)]
pub struct SensorInfo {
    /// The name in a [`super::Spec`].
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// The model.
    pub model: SensorModel,
}

/// All sensor models.
pub const SENSORS: &[SensorInfo] = &[
    SensorInfo { name: "clean", about: "exact depth, f32 metres", model: SensorModel::Clean },
    SensorInfo { name: "clean_mm", about: "exact depth in whole millimetres, u16", model: SensorModel::CleanMm },
    SensorInfo {
        name: "kinect_white",
        about: "structured light (Kinect v1), u16 millimetres: disparity noise and steps, shadows, ragged edges, 0.5 to 8 m",
        model: SensorModel::KinectV1White,
    },
    SensorInfo {
        name: "tof_white",
        about: "time of flight, u16 millimetres: noise that grows with range, flying pixels at edges, 0.5 to 5.46 m",
        model: SensorModel::TofWhite,
    },
    SensorInfo {
        name: "disparity",
        about: "true disparity x 4 of a 10 cm stereo pair, u8, occluded pixels 0 (Middlebury's kind)",
        model: SensorModel::Disparity8,
    },
];

/// Distance of the two cameras of [`SensorModel::Disparity8`], metres.
const STEREO_BASELINE_M: f64 = 0.1;
/// Map units per pixel of disparity of [`SensorModel::Disparity8`], as in Middlebury's quarter-size
/// pictures of 2003.
const UNITS_PER_PIXEL: f64 = 4.0;

impl SensorModel {
    /// The sensor of that name.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the names there are.
    pub fn find(name: &str) -> Result<SensorModel> {
        SENSORS.iter().find(|row| row.name == name).map(|row| row.model).ok_or_else(|| Error::Unknown {
            what: "sensor",
            given: name.to_string(),
            accepted: SENSORS.iter().map(|row| row.name).collect::<Vec<_>>().join(", "),
        })
    }

    /// Its row in [`SENSORS`].
    pub fn info(self) -> &'static SensorInfo {
        SENSORS.iter().find(|row| row.model == self).expect("every model has its row")
    }

    /// What the numbers of its maps mean.
    pub fn measure(self, camera: &Camera) -> Measure {
        match self {
            SensorModel::Clean => Measure::Depth { metres: 1.0 },
            SensorModel::CleanMm | SensorModel::KinectV1White | SensorModel::TofWhite => {
                Measure::Depth { metres: 0.001 }
            }
            SensorModel::Disparity8 => {
                let units_m = UNITS_PER_PIXEL * camera.intrinsics.fx.abs() * STEREO_BASELINE_M;
                Measure::InverseDepth { slope: 1.0 / units_m, offset: 0.0 }
            }
        }
    }

    pub(super) fn pixels(self, exposure: &Exposure<'_>, seed: u64) -> ScenePixels {
        let depth_m = &exposure.seen.depth_m;
        // The sensor's draws are not the scene's draws, though they share the seed.
        let mut random = Random::new(seed ^ 0x5E45_0A11_D0DE_CADE);
        match self {
            SensorModel::Clean => ScenePixels::F32(depth_m.iter().map(|&z| z as f32).collect()),
            SensorModel::CleanMm => ScenePixels::U16(depth_m.iter().map(|&z| millimetres(z)).collect()),
            SensorModel::KinectV1White => ScenePixels::U16(kinect::millimetres_of(exposure, &mut random)),
            SensorModel::TofWhite => ScenePixels::U16(tof::millimetres_of(exposure, &mut random)),
            SensorModel::Disparity8 => ScenePixels::U8(disparities(exposure)),
        }
    }
}

/// Metres to whole millimetres; 0 for what 16 bits cannot hold.
fn millimetres(depth_m: f64) -> u16 {
    let mm = (depth_m * 1000.0 + 0.5).floor();
    if (1.0..=65_535.0).contains(&mm) { mm as u16 } else { 0 }
}

/// A quarter of a pixel per unit; 0 for what the other camera does not see, what 8 bits cannot
/// hold (nearer than 0.91 m at 640 columns) and what is further than half a unit.
fn disparities(exposure: &Exposure<'_>) -> Vec<u8> {
    let measure = SensorModel::Disparity8.measure(exposure.camera);
    let hidden = exposure.hidden_from_right(STEREO_BASELINE_M, true);
    let unit = |(&z, hidden): (&f64, bool)| {
        let value = (measure.value(z).unwrap_or(0.0) + 0.5).floor();
        if !hidden && (1.0..=255.0).contains(&value) { value as u8 } else { 0 }
    };
    exposure.seen.depth_m.iter().zip(hidden).map(unit).collect()
}

/// The exact picture, with what a sensor model may ask about it.
pub(super) struct Exposure<'a> {
    pub(super) scene: &'a Scene,
    pub(super) camera: &'a Camera,
    pub(super) seen: &'a Cast,
}

impl Exposure<'_> {
    /// Which pixels show points that an eye `baseline_m` to the right of the camera does not see
    /// because something stands between: shadows of a projector there, occlusions of a second
    /// camera there. They lie to the left of near things. With `bounded`, points left or right of
    /// the other eye's own picture count as hidden too.
    ///
    /// In a rectified pair the ray from the other eye stays in the same row, at column
    /// `u - fx baseline / z`.
    fn hidden_from_right(&self, baseline_m: f64, bounded: bool) -> Vec<bool> {
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
    fn beside(&self, at: usize, step: [isize; 2]) -> Option<usize> {
        let (width, height) = (self.camera.width, self.camera.height);
        let u = (at % width).checked_add_signed(step[0]).filter(|&u| u < width)?;
        let v = (at / width).checked_add_signed(step[1]).filter(|&v| v < height)?;
        Some(v * width + u)
    }

    /// Whether two pixels show different surfaces at depths more than `least_m` apart.
    fn jump(&self, a: usize, b: usize, least_m: f64) -> bool {
        let Cast { depth_m, surfaces, .. } = self.seen;
        surfaces[a] != surfaces[b] && (depth_m[a] - depth_m[b]).abs() > least_m
    }
}
