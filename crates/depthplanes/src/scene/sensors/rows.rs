//! The sensors that err, a row each.
//!
//! The five sensors of real structure are set so that synthetic rooms have the table of [`super::error`];
//! `tests/sensors.rs` measures it. Where no source is given, a number is fitted to that table. Lengths are pixels of
//! a picture of 640 x 480; a row's error is in pixels of the sensor's own disparity, or in 1/m for time of flight.
//!
//! Not modelled: reflectivity, sunlight, multipath by geometry, wiggling, error in time.

use super::depth_camera::{DepthCamera, Output, Shadow};
use super::edges::Edges;
use super::error::{Correlated, ErrorModel, Part, SensorError};
use crate::scene::pose::KINECT_FOCAL_PX;

/// Distance of a Kinect v1's projector, metres.
const KINECT_BASELINE_M: f64 = 0.075;
/// Raw number of an infinite depth (OpenKinect's fit of 1/z against the 11-bit number).
const DOFF: f64 = 1090.9;
/// 1/8 px steps per 1/m.
const KINECT_STEPS_M: f64 = 8.0 * KINECT_FOCAL_PX * KINECT_BASELINE_M;
/// cos 78 degrees: the dots get too thin to match (our choice).
const GRAZING_DOTS: f32 = 0.2;
/// cos 80 degrees (our choice).
const GRAZING_LIGHT: f32 = 0.17;
/// Baseline that gives pictures of 640 columns the f b = 52.2 px m of the recorded stereo rig
/// (402.8 px, 0.1295 m), metres.
pub(super) const STEREO_BASELINE_M: f64 = 0.09;
/// Map units per pixel of disparity, as in the recorded frames (and KITTI's).
pub(super) const STEREO_UNITS: f64 = 256.0;

/// Kinect v1: a pattern projected from 7.5 cm to the right, matched in a window, in steps of 1/8 px:
/// `z = 8 f b / (doff - kd)` for a whole number `kd` (ROS kinect_calibration/technical).
///
/// - White part: 0.042 px together with the steps, what neighbouring pixels differ by on 75 recorded planes.
/// - Growth: 0.0025 to 0.0020 1/m at 1.2 to 2.6 m, 0.0036 at 0.7 m on the same planes.
/// - Bow: fitted to ten planes of 7-Scenes' camera; other cameras have it as strong or half as
///   strong, with either sign.
/// - Seams: 0.1 px along column 320, found in 7-Scenes and in frames of another camera; the others occur in one of
///   them.
/// - Holes: the projector's shadow, cast geometrically; outside of 0.5 to 8 m; grazing angles.
pub(super) const KINECT: DepthCamera = DepthCamera {
    error: ErrorModel::Correlated(Correlated {
        units_m: KINECT_FOCAL_PX * KINECT_BASELINE_M,
        white: Part { far: 0.021, relative: 0.0 },
        short: Part { far: 0.034, relative: 0.0 },
        long: Part { far: 0.076, relative: 0.002 },
        bow: [0.51, 0.40, -0.20],
        seams: &[(193.0, 0.03), (320.0, -0.1), (439.0, 0.04), (600.0, 0.035)],
        fixed: 0.02,
        step: 0.125,
    }),
    ..KINECT_WHITE
};

/// Kinect v1 with white noise alone: Gaussian in disparity, standard deviation 1/16 px before the
/// rounding to 1/8 px. With that sigma_z = z^2 / (16 f b) = 1.44e-3 z^2 m; Khoshelham and Elberink
/// 2012 measured 1.425e-3. Both together leave an error of 0.072 px.
pub(super) const KINECT_WHITE: DepthCamera = DepthCamera {
    range_m: [0.5, 8.0],
    shadow: Some(Shadow { baseline_m: KINECT_BASELINE_M, bounded: false }),
    edges: Edges::Ragged,
    grazing_cosine: GRAZING_DOTS,
    error: ErrorModel::White {
        depth_m: |z, noise| {
            let raw = (DOFF - KINECT_STEPS_M / z + 0.5 * noise + 0.5).floor();
            KINECT_STEPS_M / (DOFF - raw)
        },
        stated: |_| SensorError { white: 0.5 / KINECT_STEPS_M, step: 1.0 / KINECT_STEPS_M, ..SensorError::NONE },
    },
    output: Output::Millimetres,
};

/// Kinect v2: time of flight.
///
/// - White part: shot noise (light falls with z^2), 0.0014 1/m, as neighbouring pixels differ on
///   recorded stairs; at short range 0.5 mm at 1 m (our choice).
/// - Holes: outside of 0.5 to 4.5 m (the maker's range); grazing angles.
pub(super) const KINECT2: DepthCamera = DepthCamera {
    range_m: [0.5, 4.5],
    error: ErrorModel::Correlated(Correlated {
        units_m: 1.0,
        white: Part { far: 0.0014, relative: 0.0005 },
        short: Part { far: 0.0003, relative: 0.0 },
        long: Part { far: 0.0037, relative: 0.001 },
        bow: [0.01, -0.008, 0.004],
        seams: &[],
        fixed: 0.0003,
        step: 0.0,
    }),
    ..TOF_WHITE
};

/// Azure Kinect, narrow field, binned: time of flight, nearly all of its error smooth.
///
/// - Holes: outside of 0.5 to 5.46 m (the maker's range); grazing angles.
pub(super) const AZURE: DepthCamera = DepthCamera {
    error: ErrorModel::Correlated(Correlated {
        units_m: 1.0,
        white: Part { far: 0.00028, relative: 0.0003 },
        short: Part { far: 0.0001, relative: 0.0 },
        long: Part { far: 0.0018, relative: 0.0003 },
        bow: [-0.012, 0.010, 0.005],
        seams: &[],
        fixed: 0.0004,
        step: 0.0,
    }),
    ..TOF_WHITE
};

/// Time of flight with white noise alone: Gaussian in depth, sd = 1 mm + 1.3 mm (z / 1 m)^2. The
/// shape is shot noise; the constants are our choice, so that 3.5 m gives the 17 mm that Azure
/// Kinect's maker states there (Tolgyessy et al. 2021).
pub(super) const TOF_WHITE: DepthCamera = DepthCamera {
    range_m: [0.5, 5.46],
    shadow: None,
    edges: Edges::Flying,
    grazing_cosine: GRAZING_LIGHT,
    error: ErrorModel::White {
        depth_m: |z, noise| z + tof_sigma_m(z) * noise,
        stated: |z| SensorError { white: tof_sigma_m(z) / (z * z), ..SensorError::NONE },
    },
    output: Output::Millimetres,
};

/// RealSense D4xx: two infrared cameras 50 mm apart, matched in a window, disparity in steps of
/// 1/32 px (the maker's), f = 385 px at 640 x 480: recorded frames have the steps that follow.
///
/// - Holes: what the right camera does not see; outside of 0.3 to 10 m (the maker's range, our choice of its ends);
///   grazing angles.
pub(super) const REALSENSE: DepthCamera = DepthCamera {
    range_m: [0.3, 10.0],
    shadow: Some(Shadow { baseline_m: 0.05, bounded: true }),
    edges: Edges::Ragged,
    grazing_cosine: GRAZING_DOTS,
    error: ErrorModel::Correlated(Correlated {
        units_m: 385.0 * 0.05,
        white: Part { far: 0.016, relative: 0.0 },
        short: Part { far: 0.039, relative: 0.0 },
        long: Part { far: 0.046, relative: 0.001 },
        bow: [0.1, 0.08, -0.04],
        seams: &[],
        fixed: 0.003,
        step: 1.0 / 32.0,
    }),
    output: Output::Millimetres,
};

/// A stereo pair that is carried about, 1/256 px in 16 bits; hardly any white part, for the matcher
/// smooths. The recorded frames have no coarser step than that of their file.
///
/// - Holes: what the right camera does not see; outside of 0.5 to 20 m (our choice); grazing angles.
pub(super) const STEREO: DepthCamera = DepthCamera {
    range_m: [0.5, 20.0],
    shadow: Some(Shadow { baseline_m: STEREO_BASELINE_M, bounded: true }),
    edges: Edges::Ragged,
    grazing_cosine: GRAZING_DOTS,
    error: ErrorModel::Correlated(Correlated {
        units_m: KINECT_FOCAL_PX * STEREO_BASELINE_M,
        white: Part { far: 0.01, relative: 0.0 },
        short: Part { far: 0.15, relative: 0.0 },
        long: Part { far: 0.15, relative: 0.005 },
        bow: [0.26, 0.21, -0.1],
        seams: &[],
        fixed: 0.008,
        step: 0.0,
    }),
    output: Output::Disparity { units: STEREO_UNITS, baseline_m: STEREO_BASELINE_M },
};

fn tof_sigma_m(z: f64) -> f64 {
    0.001 + 0.0013 * z * z
}
