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
    /// About how far it sees, metres, where that is known: its nominal range with much to spare.
    pub far_m: Option<f64>,
    /// From how many metres on it sees, where that is known: its nominal range with some to spare.
    pub near_m: Option<f64>,
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
    SensorPreset {
        name,
        about,
        encoding,
        camera: None,
        far_m: None,
        near_m: None,
        missing: None,
        noise: None,
        smooth_noise: None,
    }
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

    const fn far(mut self, metres: f64) -> Self {
        self.far_m = Some(metres);
        self
    }

    const fn near(mut self, metres: f64) -> Self {
        self.near_m = Some(metres);
        self
    }

    /// Structured light of the PrimeSense kind: 11 bits end behind 9.76 m. Nearer than 0.4 m nothing is matched.
    const fn kinect(self) -> Self {
        self.smooth_noise(KINECT_SMOOTH).far(10.0).near(0.3)
    }

    const fn missing(mut self, value: f64) -> Self {
        self.missing = Some(value);
        self
    }
}

/// The smooth part of structured light of the PrimeSense kind: 0.039 px of disparity with f T of 575 px 0.075 m. The median
/// over 102 frames of Kinect v1 and Xtion from seven collections, 2026-11-28, of what `depthplanes noise` finds of each: 1.8
/// to 10 mm at 2 m, median 3.55. (Residuals of 85 labelled planes of such frames scatter by 0.060 px in means over 16 x 16 pixels:
/// about a whole plane bows count as well.) The white part is 3.1 mm at 2 m there, 0.034 px, which is no more than rounding to 1/8 px makes: it is
/// found with the steps of each map and not stated. (Half a level of the raw disparity is 1.425e-3 z^2 m: Khoshelham and
/// Elberink 2012.)
const KINECT_SMOOTH: PresetNoise = PresetNoise::Depth { base: 0.0, growth: 8.9e-4 };

/// Scanners of ABW's kind, beside the steps of 1.26 to 1.29 mm that its maps show: the one of the values
/// tried with which most regions of the ten test images are correct, 2026-11-28: 16.8 of 19.2, beside 16.7 by the estimate
/// and 15.9 with 1.2 mm. The smooth part is estimated; stated, it is no better.
const SCANNER: PresetNoise = PresetNoise::Depth { base: 5.0e-4, growth: 0.0 };

/// Kinect v2: the mean of what `depthplanes noise` finds of two frames of stairs at 1 to 3 m, 2026-11-28, 0.50 and 0.72 mm at
/// range 0 and 0.63 mm (z / 1 m)^2 both: 1.2 mm at 1 m, 3.1 mm at 2 m. Fankhauser et al. 2015 ("Kinect v2 for Mobile Robot Navigation:
/// Evaluation and Modeling") have 1.7 and 2.8 mm for a surface seen at 60 degrees, 1.3 and 1.7 mm head-on.
const KINECT2: PresetNoise = PresetNoise::Depth { base: 6.1e-4, growth: 6.3e-4 };

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
        .smooth_noise(PresetNoise::Value { sigma: 0.31 }), // 0.039 px
    preset("kinect1-sdk", "kinect-sdk", "Kinect v1: Microsoft SDK 1 depth with player bits")
        .camera(640, 480, [571.26, 571.26, 320.0, 240.0])
        .kinect(),
    preset("kinect2", "millimetre", "Kinect v2, time of flight, kinect2_bridge's nominal camera")
        .camera(512, 424, [365.456, 365.456, 254.878, 205.395])
        .noise(KINECT2)
        .far(20.0)
        .near(0.3), // nominally 0.5 m
    preset("azure-kinect", "millimetre", "Azure Kinect; each camera has its own calibration, state it")
        .far(20.0)
        .near(0.2), // nominally 0.25 m
    preset("realsense-d4xx", "realsense", "RealSense D400 series; read intrinsics and depth scale from the camera")
        .far(30.0),
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
