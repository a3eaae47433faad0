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
}

impl PresetNoise {
    /// The noise of a map that such a camera made; `None` for a table that is none.
    pub fn of(&self) -> Option<SensorNoise> {
        match *self {
            PresetNoise::Depth { base, growth } => Some(SensorNoise::Depth { base, growth }),
            PresetNoise::Value { sigma } => Some(SensorNoise::Value { sigma }),
            PresetNoise::Table(rows) => NoiseTable::new(rows).ok().map(SensorNoise::Table),
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

    const fn kinect(self) -> Self {
        self.noise(KINECT).smooth_noise(KINECT_SMOOTH)
    }

    const fn missing(mut self, value: f64) -> Self {
        self.missing = Some(value);
        self
    }
}

/// Structured light of the PrimeSense kind: 0.042 px of disparity by pixel and 0.060 px that neighbours share, with f T of
/// 575 px 0.075 m. Residuals of 85 labelled planes of Kinect v1 and Xtion about their own planes, 2026-11-28: 0.092 px by
/// pixel, of which 0.042 vary from pixel to pixel, and means over 16 x 16 pixels scatter by 0.059. The white part has the
/// rounding to 1/8 px in it; without it 0.022 px are left, 0.17 of the raw steps. (Half a level of the raw disparity is 1.425e-3 z^2 m: Khoshelham and Elberink 2012.)
const KINECT: PresetNoise = PresetNoise::Depth { base: 0.0, growth: 9.7e-4 };
const KINECT_SMOOTH: PresetNoise = PresetNoise::Depth { base: 0.0, growth: 1.4e-3 };

/// Scanners of ABW's kind, beside the steps of 1.26 to 1.29 mm that its maps show: the one of the values
/// tried with which most regions of the ten test images are correct, 2026-11-28: 16.8 of 19.2, beside 16.7 by the estimate
/// and 15.9 with 1.2 mm. The smooth part is estimated; stated, it is no better.
const SCANNER: PresetNoise = PresetNoise::Depth { base: 5.0e-4, growth: 0.0 };

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

/// Rendered depth has no noise, but ICL-NUIM's frames come in steps of 1 mm and scatter by 0.29 mm beyond what that
/// rounding does, as if they were rounded twice (ten frames, docs/noise.md).
const RENDERED: PresetNoise = PresetNoise::Depth { base: 2.9e-4, growth: 0.0 };

/// All presets.
///
/// Of the others no figure is known with which more surfaces are found than by the estimate from each map. Azure Kinect: the
/// maker states a bound, 17 mm, not a value (confirmed by Tolgyessy et al. 2021). RealSense: its smooth part is 0.02 to
/// 0.08 px in eight maps, and the maker's 0.08 px (librealsense issue 3904) as noise of every pixel joins a floor, a wall
/// and a box. `tof`, `stereo`: any camera, any program. `middlebury`: from maps without noise to matched ones, by year and size.
pub const SENSOR_PRESETS: &[SensorPreset] = &[
    preset("kinect1", "millimetre", "Kinect v1, Xtion: OpenNI depth, PrimeSense nominal camera")
        .camera(640, 480, [525.0, 525.0, 319.5, 239.5])
        .kinect(),
    preset("kinect1-raw", "kinect-raw", "Kinect v1: raw 11-bit disparity, S. Burrus' calibration")
        .camera(640, 480, [594.21, 591.04, 339.31, 242.74])
        .noise(PresetNoise::Value { sigma: 0.17 })
        .smooth_noise(PresetNoise::Value { sigma: 0.48 }),
    preset("kinect1-sdk", "kinect-sdk", "Kinect v1: Microsoft SDK 1 depth with player bits")
        .camera(640, 480, [571.26, 571.26, 320.0, 240.0])
        .kinect(),
    preset("kinect2", "millimetre", "Kinect v2, time of flight, kinect2_bridge's nominal camera")
        .camera(512, 424, [365.456, 365.456, 254.878, 205.395])
        .noise(KINECT2),
    preset("azure-kinect", "millimetre", "Azure Kinect; each camera has its own calibration, state it"),
    preset("realsense-d4xx", "realsense", "RealSense D400 series; read intrinsics and depth scale from the camera"),
    preset("structure", "millimetre", "Structure Sensor, ScanNet's nominal depth camera")
        .camera(640, 480, [577.87, 577.87, 319.5, 239.5])
        .kinect(),
    preset("tof", "millimetre", "any time-of-flight camera in millimetres"),
    preset("structured-light", "millimetre", "structured-light scanners that err by about a millimetre (ABW)")
        .noise(SCANNER),
    preset("stereo", "kitti", "any stereo program that writes 1/256 pixel"),
    preset("middlebury", "middlebury", "Middlebury and ETH3D disparity; state calib.txt"),
    preset("synthetic", "tum", "ICL-NUIM rendered depth; its image y axis points up")
        .camera(640, 480, [481.2, -480.0, 319.5, 239.5])
        .noise(RENDERED),
    preset("tum-fr1", "tum", "TUM RGB-D freiburg1").camera(640, 480, [517.3, 516.5, 318.6, 255.3]).kinect(),
    preset("tum-fr2", "tum", "TUM RGB-D freiburg2").camera(640, 480, [520.9, 521.0, 325.1, 249.7]).kinect(),
    preset("tum-fr3", "tum", "TUM RGB-D freiburg3").camera(640, 480, [535.4, 539.2, 320.1, 247.6]).kinect(),
    preset("7-scenes", "millimetre", "Microsoft 7-Scenes; 65535 = missing")
        .camera(640, 480, [585.0, 585.0, 320.0, 240.0])
        .missing(65_535.0)
        .kinect(),
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
