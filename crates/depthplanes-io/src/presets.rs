//! Cameras and data sets by name: the encoding, and the nominal intrinsics where makers or data
//! sets publish them.
//!
//! Intrinsics belong to one picture size and are used only for maps of it. They are nominal: a
//! calibrated camera's own are better.

use depthplanes::Intrinsics;
use depthplanes::noise::SensorNoise;

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
    /// How far off a pixel is, where that was published or measured.
    pub noise: Option<SensorNoise>,
}

const fn preset(name: &'static str, encoding: &'static str, about: &'static str) -> SensorPreset {
    SensorPreset { name, about, encoding, camera: None, missing: None, noise: None }
}

impl SensorPreset {
    const fn camera(mut self, width: usize, height: usize, [fx, fy, cx, cy]: [f64; 4]) -> Self {
        self.camera = Some((width, height, Intrinsics { fx, fy, cx, cy }));
        self
    }

    const fn noise(mut self, noise: SensorNoise) -> Self {
        self.noise = Some(noise);
        self
    }

    const fn missing(mut self, value: f64) -> Self {
        self.missing = Some(value);
        self
    }
}

/// Structured light of the PrimeSense kind: half a level of the raw disparity, which is
/// 1.425e-3 z^2 m (Khoshelham and Elberink 2012, "Accuracy and Resolution of Kinect Depth Data").
const KINECT: SensorNoise = SensorNoise::Depth { base: 0.0, growth: 1.425e-3 };

/// Scanners of ABW's kind: about one of the steps of 1.26 to 1.29 mm that its maps show. Between 1.0 and 1.4 mm
/// the share of planes found there changes by 3 in 100.
const SCANNER: SensorNoise = SensorNoise::Depth { base: 1.2e-3, growth: 0.0 };

/// All presets.
pub const SENSOR_PRESETS: &[SensorPreset] = &[
    preset("kinect1", "millimetre", "Kinect v1, Xtion: OpenNI depth, PrimeSense nominal camera")
        .camera(640, 480, [525.0, 525.0, 319.5, 239.5])
        .noise(KINECT),
    preset("kinect1-raw", "kinect-raw", "Kinect v1: raw 11-bit disparity, S. Burrus' calibration")
        .camera(640, 480, [594.21, 591.04, 339.31, 242.74])
        .noise(SensorNoise::Value { sigma: 0.5 }),
    preset("kinect1-sdk", "kinect-sdk", "Kinect v1: Microsoft SDK 1 depth with player bits")
        .camera(640, 480, [571.26, 571.26, 320.0, 240.0])
        .noise(KINECT),
    preset("kinect2", "millimetre", "Kinect v2, time of flight, kinect2_bridge's nominal camera").camera(
        512,
        424,
        [365.456, 365.456, 254.878, 205.395],
    ),
    preset("azure-kinect", "millimetre", "Azure Kinect; each camera has its own calibration, state it"),
    preset("realsense-d4xx", "realsense", "RealSense D400 series; read intrinsics and depth scale from the camera"),
    preset("structure", "millimetre", "Structure Sensor, ScanNet's nominal depth camera")
        .camera(640, 480, [577.87, 577.87, 319.5, 239.5])
        .noise(KINECT),
    preset("tof", "millimetre", "any time-of-flight camera in millimetres"),
    preset("structured-light", "millimetre", "structured-light scanners that err by about a millimetre (ABW)")
        .noise(SCANNER),
    preset("stereo", "kitti", "any stereo program that writes 1/256 pixel"),
    preset("middlebury", "middlebury", "Middlebury and ETH3D disparity; state calib.txt"),
    preset("synthetic", "tum", "ICL-NUIM rendered depth; its image y axis points up").camera(
        640,
        480,
        [481.2, -480.0, 319.5, 239.5],
    ),
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
