//! What a sensor makes of the exact depth: its noise, its steps, its holes.
//!
//! In: the exact picture of a scene ([`Cast`]) and a seed. Out: the pixels of a map and what they
//! mean. Each model is a statistical one with its formula beside it; none traces light. Sensors that
//! err are rows of numbers (`rows.rs`) of one mechanism (`depth_camera.rs`).

mod depth_camera;
mod edges;
mod error;
pub(super) mod exposure;
mod field;
mod rows;

pub use error::SensorError;

use super::frame::ScenePixels;
use super::pose::{Camera, KINECT_FOCAL_PX};
use crate::camera::ValueKind;
use crate::error::{Error, Result};
use crate::util::random::Random;
use depth_camera::{DepthCamera, Output};
use exposure::{Exposure, millimetres};

/// A depth camera's behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SensorModel {
    /// Exact depth, `f32` metres.
    Clean,
    /// Exact depth rounded to `u16` millimetres.
    CleanMm,
    /// Structured light: a Kinect v1, `u16` millimetres, most of its error smooth.
    KinectV1,
    /// Time of flight: a Kinect v2, `u16` millimetres, most of its error smooth.
    KinectV2,
    /// Time of flight: an Azure Kinect, `u16` millimetres, nearly all of its error smooth.
    AzureKinect,
    /// Infrared stereo: a RealSense D4xx, `u16` millimetres, most of its error smooth.
    RealSense,
    /// The disparity of a stereo pair in `u16` steps of 1/256 px, nearly all of its error smooth.
    Stereo,
    /// Structured light: a Kinect v1 with white noise alone, `u16` millimetres.
    KinectV1White,
    /// Time of flight with white noise alone, `u16` millimetres.
    TofWhite,
    /// The true disparity of a rectified pair in `u8` steps of a quarter of a pixel.
    Disparity8,
}

/// One row of [`SENSORS`].
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
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
        name: "kinect",
        about: "structured light (Kinect v1), u16 millimetres: smooth error, bow and seams, steps of 1/8 px, shadows, ragged edges, 0.5 to 8 m",
        model: SensorModel::KinectV1,
    },
    SensorInfo {
        name: "kinect2",
        about: "time of flight (Kinect v2), u16 millimetres: white and smooth error, flying pixels at edges, 0.5 to 4.5 m",
        model: SensorModel::KinectV2,
    },
    SensorInfo {
        name: "azure",
        about: "time of flight (Azure Kinect), u16 millimetres: smooth error, flying pixels at edges, 0.5 to 5.46 m",
        model: SensorModel::AzureKinect,
    },
    SensorInfo {
        name: "realsense",
        about: "infrared stereo (RealSense D4xx), u16 millimetres: smooth error, steps of 1/32 px, occlusions, ragged edges, 0.3 to 10 m",
        model: SensorModel::RealSense,
    },
    SensorInfo {
        name: "stereo",
        about: "disparity x 256 of a 9 cm stereo pair, u16: smooth error, occlusions, ragged edges, 0.5 to 20 m",
        model: SensorModel::Stereo,
    },
    SensorInfo {
        name: "kinect_white",
        about: "as kinect, its error white noise in disparity and steps alone",
        model: SensorModel::KinectV1White,
    },
    SensorInfo {
        name: "tof_white",
        about: "time of flight, u16 millimetres: white noise that grows with range, flying pixels at edges, 0.5 to 5.46 m",
        model: SensorModel::TofWhite,
    },
    SensorInfo {
        name: "disparity",
        about: "true disparity x 4 of a 10 cm stereo pair, u8, occluded pixels 0 (Middlebury's kind)",
        model: SensorModel::Disparity8,
    },
];

/// Distance of the two cameras of [`SensorModel::Disparity8`], metres.
const PAIR_BASELINE_M: f64 = 0.1;
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

    /// The kind of the numbers of its maps.
    pub fn value_kind(self, camera: &Camera) -> ValueKind {
        let disparity = |units: f64, baseline_m: f64| {
            let units_m = units * camera.intrinsics.fx.abs() * baseline_m;
            ValueKind::InverseDepth { slope: 1.0 / units_m, offset: 0.0 }
        };
        match self {
            SensorModel::Clean => ValueKind::Depth { metres: 1.0 },
            SensorModel::Disparity8 => disparity(UNITS_PER_PIXEL, PAIR_BASELINE_M),
            _ => match self.depth_camera().map(|row| row.output) {
                Some(Output::Disparity { units, baseline_m }) => disparity(units, baseline_m),
                Some(Output::Millimetres) | None => ValueKind::Depth { metres: 0.001 },
            },
        }
    }

    /// How far off its pixels are at a depth in metres (more than 0), inside surfaces and within its range, as the
    /// model states it; for tests of noise estimates. Steps of disparity maps are those of a picture of 640 x 480.
    ///
    /// ```
    /// use depthplanes::scene::SensorModel;
    /// let error = SensorModel::KinectV1.error_at(2.0);
    /// let px = 580.0 * 0.075; // f b
    /// assert!((px * error.pixel() - 0.042).abs() < 0.002 && (px * error.smooth - 0.06).abs() < 0.01);
    /// ```
    pub fn error_at(self, depth_m: f64) -> SensorError {
        // What is rounded to a millimetre is rounded to 0.001 / z^2 in inverse depth.
        let millimetre = 0.001 / (depth_m * depth_m);
        match self {
            SensorModel::Clean => SensorError::NONE,
            SensorModel::Disparity8 => {
                SensorError { step: 1.0 / (UNITS_PER_PIXEL * KINECT_FOCAL_PX * PAIR_BASELINE_M), ..SensorError::NONE }
            }
            _ => self.depth_camera().map_or(SensorError { step: millimetre, ..SensorError::NONE }, |row| {
                let error = row.error.at(depth_m);
                let map = match row.output {
                    Output::Millimetres => millimetre,
                    Output::Disparity { units, baseline_m } => 1.0 / (units * KINECT_FOCAL_PX * baseline_m),
                };
                SensorError { step: (error.step * error.step + map * map).sqrt(), ..error }
            }),
        }
    }

    /// The row of a sensor that errs.
    fn depth_camera(self) -> Option<&'static DepthCamera> {
        match self {
            SensorModel::Clean | SensorModel::CleanMm | SensorModel::Disparity8 => None,
            SensorModel::KinectV1 => Some(&rows::KINECT),
            SensorModel::KinectV2 => Some(&rows::KINECT2),
            SensorModel::AzureKinect => Some(&rows::AZURE),
            SensorModel::RealSense => Some(&rows::REALSENSE),
            SensorModel::Stereo => Some(&rows::STEREO),
            SensorModel::KinectV1White => Some(&rows::KINECT_WHITE),
            SensorModel::TofWhite => Some(&rows::TOF_WHITE),
        }
    }

    /// What the sensor makes of a picture. The smooth part of its error is drawn from `lasting`, if that is given, so that
    /// frames can share it, all else from `seed`.
    pub(super) fn pixels(self, exposure: &Exposure<'_>, seed: u64, lasting: Option<u64>) -> ScenePixels {
        let depth_m = &exposure.seen.depth_m;
        // The sensor's draws are not the scene's draws, though they share the seed.
        let mut random = Random::new(seed ^ 0x5E45_0A11_D0DE_CADE);
        match self {
            SensorModel::Clean => ScenePixels::F32(depth_m.iter().map(|&z| z as f32).collect()),
            SensorModel::Disparity8 => ScenePixels::U8(disparities(exposure)),
            _ => ScenePixels::U16(match self.depth_camera() {
                Some(row) => row.pixels(exposure, &mut random, lasting.map(Random::new)),
                None => depth_m.iter().map(|&z| millimetres(z)).collect(),
            }),
        }
    }
}

/// A quarter of a pixel per unit; 0 for what the other camera does not see, what 8 bits cannot hold (nearer than 0.91
/// m at 640 columns) and disparities below half a unit.
fn disparities(exposure: &Exposure<'_>) -> Vec<u8> {
    let value_kind = SensorModel::Disparity8.value_kind(exposure.camera);
    let hidden = exposure.hidden_from_right(PAIR_BASELINE_M, true);
    let unit = |(&z, hidden): (&f64, bool)| {
        let value = (value_kind.value(z).unwrap_or(0.0) + 0.5).floor();
        if !hidden && (1.0..=255.0).contains(&value) { value as u8 } else { 0 }
    };
    exposure.seen.depth_m.iter().zip(hidden).map(unit).collect()
}
