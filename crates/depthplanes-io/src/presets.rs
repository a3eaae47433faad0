//! Cameras and data sets by name: the encoding, and the nominal intrinsics where makers or data
//! sets publish them.
//!
//! Intrinsics belong to one picture size and are used only for maps of it. They are nominal: a
//! calibrated camera's own are better.

use std::fmt;

use depthplanes::Intrinsics;
use depthplanes::noise::{NoiseTable, SensorNoise};

use crate::error::{Error, Result};

/// One camera or data set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorPreset {
    /// Its name.
    pub name: &'static str,
    /// One line for the table of presets.
    pub about: &'static str,
    /// Name of its encoding.
    pub encoding: &'static str,
    /// Columns, rows and the intrinsics for that size.
    pub camera: Option<(usize, usize, Intrinsics)>,
    /// The value for "missing" beside the encoding's own.
    pub missing: Option<f64>,
    /// How far off a pixel is by itself, where that was published or measured.
    pub noise: Option<PresetNoise>,
    /// The part of the error that neighbouring pixels share over tens of pixels, where that was measured.
    pub smooth_noise: Option<PresetNoise>,
}

/// What is known of the error of a preset's sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PresetNoise {
    /// Of depth z: `base + growth z^2`, metres.
    Depth {
        /// At range 0, metres.
        base: f64,
        /// 1/m.
        growth: f64,
    },
    /// Of the map's value, map units.
    Value {
        /// Map units.
        sigma: f64,
    },
    /// Rows of range and standard deviation, metres.
    Table(&'static [[f64; 2]]),
    /// Of depth from a stereo pair inside the camera: `z^2 sigma / (f T)`, f being the focal length of the map.
    Pair {
        /// Of disparity, pixels.
        sigma_px: f64,
        /// T, metres.
        baseline_m: f64,
    },
}

impl PresetNoise {
    /// The noise of a map that such a camera made; `None` if that takes a camera and it is not known.
    pub fn of(&self, camera: Option<&Intrinsics>) -> Option<SensorNoise> {
        match *self {
            PresetNoise::Depth { base, growth } => Some(SensorNoise::Depth { base, growth }),
            PresetNoise::Value { sigma } => Some(SensorNoise::Value { sigma }),
            PresetNoise::Table(rows) => NoiseTable::new(rows).ok().map(SensorNoise::Table),
            PresetNoise::Pair { sigma_px, baseline_m } => {
                let growth = sigma_px / (camera?.fx.abs() * baseline_m);
                Some(SensorNoise::Depth { base: 0.0, growth })
            }
        }
    }
}

/// A formula in metres and in z, the range in metres, or in map units.
impl fmt::Display for PresetNoise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            PresetNoise::Depth { base, growth: 0.0 } => write!(f, "{base:e} m"),
            PresetNoise::Depth { base: 0.0, growth } => write!(f, "{growth:e} z^2 m"),
            PresetNoise::Depth { base, growth } => write!(f, "{base:e} + {growth:e} z^2 m"),
            PresetNoise::Value { sigma } => write!(f, "{sigma} map units"),
            PresetNoise::Table(rows) => {
                let [low, high] = [rows[0], rows[rows.len() - 1]];
                write!(f, "{:e} m at {} m to {:e} m at {} m", low[1], low[0], high[1], high[0])
            }
            PresetNoise::Pair { sigma_px, baseline_m } => write!(f, "{sigma_px} px / (f {baseline_m} m) z^2"),
        }
    }
}

const fn preset(name: &'static str, encoding: &'static str, about: &'static str) -> SensorPreset {
    SensorPreset { name, about, encoding, camera: None, missing: None, noise: None, smooth_noise: None }
}

impl SensorPreset {
    const fn camera(mut self, width: usize, height: usize, [fx, fy, cx, cy]: [f64; 4]) -> Self {
        self.camera = Some((width, height, Intrinsics { fx, fy, cx, cy }));
        self
    }

    const fn noise(mut self, noise: PresetNoise) -> Self {
        self.noise = Some(noise);
        self
    }

    const fn smooth_noise(mut self, noise: PresetNoise) -> Self {
        self.smooth_noise = Some(noise);
        self
    }

    const fn missing(mut self, value: f64) -> Self {
        self.missing = Some(value);
        self
    }
}

/// Structured light of the PrimeSense kind: half a level of the raw disparity, which is
/// 1.425e-3 z^2 m (Khoshelham and Elberink 2012, "Accuracy and Resolution of Kinect Depth Data").
const KINECT: PresetNoise = PresetNoise::Depth { base: 0.0, growth: 1.425e-3 };

/// Scanners of ABW's kind: about one of the steps of 1.26 to 1.29 mm that its maps show. Between 1.0 and 1.4 mm
/// the share of planes found there changes by 3 in 100.
const SCANNER: PresetNoise = PresetNoise::Depth { base: 1.2e-3, growth: 0.0 };

/// Kinect v2: `1.5 - 0.5 z + 0.3 z^2 + 0.1 z^1.5 t^2 / (pi/2 - t)^2` mm for a surface seen at the angle t (Fankhauser et
/// al. 2015, "Kinect v2 for Mobile Robot Navigation: Evaluation and Modeling"), here for 60 degrees, where the last
/// term is 0.4 z^1.5: a surface seen head-on has less, 1.7 instead of 2.83 mm at 2 m.
const KINECT2: PresetNoise = PresetNoise::Table(&[
    [0.5, 1.47e-3],
    [1.0, 1.70e-3],
    [1.5, 2.16e-3],
    [2.0, 2.83e-3],
    [2.5, 3.71e-3],
    [3.0, 4.78e-3],
    [3.5, 6.04e-3],
    [4.0, 7.50e-3],
    [4.5, 9.14e-3],
]);

/// RealSense D400: 0.08 px of disparity, the maker's advice for a well calibrated camera before a textured wall
/// (librealsense issue 3904). The baseline is that of a D435; that of a D415 is 0.055 m, of a D455 0.095 m. Most of
/// this error is smooth over tens of pixels, and an estimate from a map sees but a third to a fifth of it.
const REALSENSE: PresetNoise = PresetNoise::Pair { sigma_px: 0.08, baseline_m: 0.05 };

/// Rendered depth has no noise, but ICL-NUIM's frames come in steps of 1 mm and scatter by 0.29 mm beyond what that
/// rounding does, as if they were rounded twice (ten frames, docs/noise.md).
const RENDERED: PresetNoise = PresetNoise::Depth { base: 2.9e-4, growth: 0.0 };

/// All presets.
///
/// Of the others no figure is known that could be relied on, and the noise is estimated from the map. Azure Kinect: the
/// maker states a bound, 17 mm, not a value (confirmed by Tolgyessy et al. 2021). `tof`, `stereo`: any camera, any
/// program. `middlebury`: from maps without noise to matched ones, by year and size.
pub const SENSOR_PRESETS: &[SensorPreset] = &[
    preset("kinect1", "millimetre", "Kinect v1, Xtion: OpenNI depth, PrimeSense nominal camera")
        .camera(640, 480, [525.0, 525.0, 319.5, 239.5])
        .noise(KINECT),
    preset("kinect1-raw", "kinect-raw", "Kinect v1: raw 11-bit disparity, S. Burrus' calibration")
        .camera(640, 480, [594.21, 591.04, 339.31, 242.74])
        .noise(PresetNoise::Value { sigma: 0.5 }),
    preset("kinect1-sdk", "kinect-sdk", "Kinect v1: Microsoft SDK 1 depth with player bits")
        .camera(640, 480, [571.26, 571.26, 320.0, 240.0])
        .noise(KINECT),
    preset("kinect2", "millimetre", "Kinect v2, time of flight, kinect2_bridge's nominal camera")
        .camera(512, 424, [365.456, 365.456, 254.878, 205.395])
        .noise(KINECT2),
    preset("azure-kinect", "millimetre", "Azure Kinect; each camera has its own calibration, state it"),
    preset("realsense-d4xx", "realsense", "RealSense D400 series; read intrinsics and depth scale from the camera")
        .noise(REALSENSE),
    preset("structure", "millimetre", "Structure Sensor, ScanNet's nominal depth camera")
        .camera(640, 480, [577.87, 577.87, 319.5, 239.5])
        .noise(KINECT),
    preset("tof", "millimetre", "any time-of-flight camera in millimetres"),
    preset("structured-light", "millimetre", "structured-light scanners that err by about a millimetre (ABW)")
        .noise(SCANNER),
    preset("stereo", "kitti", "any stereo program that writes 1/256 pixel"),
    preset("middlebury", "middlebury", "Middlebury and ETH3D disparity; state calib.txt"),
    preset("synthetic", "tum", "ICL-NUIM rendered depth; its image y axis points up")
        .camera(640, 480, [481.2, -480.0, 319.5, 239.5])
        .noise(RENDERED),
    preset("tum-fr1", "tum", "TUM RGB-D freiburg1").camera(640, 480, [517.3, 516.5, 318.6, 255.3]).noise(KINECT),
    preset("tum-fr2", "tum", "TUM RGB-D freiburg2").camera(640, 480, [520.9, 521.0, 325.1, 249.7]).noise(KINECT),
    preset("tum-fr3", "tum", "TUM RGB-D freiburg3").camera(640, 480, [535.4, 539.2, 320.1, 247.6]).noise(KINECT),
    preset("7-scenes", "millimetre", "Microsoft 7-Scenes; 65535 = missing")
        .camera(640, 480, [585.0, 585.0, 320.0, 240.0])
        .missing(65_535.0)
        .noise(KINECT),
];

/// The preset of that name.
///
/// # Errors
/// [`Error::Parameter`] with the names there are.
pub fn by_name(name: &str) -> Result<&'static SensorPreset> {
    SENSOR_PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| {
        let names: Vec<_> = SENSOR_PRESETS.iter().map(|preset| preset.name).collect();
        Error::parameter("--preset", name, names.join(", "))
    })
}
