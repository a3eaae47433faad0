//! What C states of a detector: parameters, the sensor, the unit, the camera, and what is wanted beside planes.

use crate::border::text;
use crate::detector::{dp_detector, state, with};
use crate::error::dp_status;
use depthplanes::outline::Outliner;
use depthplanes::{Coplanar, Intrinsics};
use depthplanes_io::{camera_file, encoding, presets};
use std::ffi::c_char;

/// States a number by name: a parameter of the method (`dp_methods`), or
///
/// - `scale`, `depth-scale`: map units per metre, or metres per map unit
/// - `missing`: a value that means "not measured", beside 0, NaN and infinity
/// - `focal` (pixels), `baseline` (metres), `doffs` (pixels): the stereo rig; the numbers are then disparities
/// - `disparity`, `ray-distance`: 1 if the numbers are disparities, or distances along the rays
/// - `curved`: 1 if curved surfaces are wanted as well
/// - `threads`: 1 and up; the answer is the same for any number
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_set(
    detector: Option<&mut dp_detector>,
    name: *const c_char,
    value: f64,
) -> dp_status {
    // SAFETY: it is null or a text of C.
    state(detector, |settings| settings.set(unsafe { text("name", name) }?, value))
}

/// As `dp_detector_set`, of a number that is written as text, as on a command line.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_set_text(
    detector: Option<&mut dp_detector>,
    name: *const c_char,
    value: *const c_char,
) -> dp_status {
    state(detector, |settings| {
        // SAFETY: they are null or texts of C.
        let [name, value] = [("name", name), ("value", value)].map(|(name, pointer)| unsafe { text(name, pointer) });
        settings.set_text(name?, value?)
    })
}

/// States the sensor by name (`dp_sensors`), such as "kinect1": its unit, its nominal camera and its noise.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_set_sensor(
    detector: Option<&mut dp_detector>,
    sensor: *const c_char,
) -> dp_status {
    state(detector, |settings| {
        // SAFETY: it is null or a text of C.
        let sensor = presets::by_name(unsafe { text("sensor", sensor) }?)?;
        settings.reading.preset = Some(sensor.name.into());
        Ok(())
    })
}

/// States what the numbers mean, by name (`dp_units`): "mm", "m", "tum", "disparity" and others. Without it 16-bit numbers are
/// millimetres, floats are metres, and 8-bit numbers are grey levels without a unit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_set_unit(detector: Option<&mut dp_detector>, unit: *const c_char) -> dp_status {
    state(detector, |settings| {
        // SAFETY: it is null or a text of C.
        let unit = encoding::by_name(unsafe { text("unit", unit) }?)?;
        settings.reading.encoding = Some(unit.name.into());
        Ok(())
    })
}

/// States the camera: focal lengths and principal point in pixels, centres of pixels at whole numbers. Without a camera planes
/// have labels and no metres.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_set_camera(
    detector: Option<&mut dp_detector>,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
) -> dp_status {
    state(detector, |settings| {
        settings.reading.intrinsics = Some(Intrinsics::new(fx, fy, cx, cy)?);
        Ok(())
    })
}

/// States the camera, its lens and its stereo rig by a file of ROS, OpenCV, RealSense, COLMAP, KITTI and many more programs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_set_camera_file(
    detector: Option<&mut dp_detector>,
    path: *const c_char,
) -> dp_status {
    state(detector, |settings| {
        // SAFETY: it is null or a text of C.
        let camera = camera_file::read_camera(unsafe { text("path", path) }?)?;
        settings.reading = std::mem::take(&mut settings.reading).camera(&camera);
        Ok(())
    })
}

/// States that only values from `low` to `high`, in map units, are measurements.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_set_valid_range(detector: Option<&mut dp_detector>, low: f64, high: f64) -> dp_status {
    state(detector, |settings| {
        let range = (low < high).then_some((low, high)).ok_or(depthplanes::Error::ValidRange { low, high })?;
        settings.reading.valid_range = Some(range);
        Ok(())
    })
}

/// Joins pieces of one plane whose normals differ by no more than that and that lie within that distance of one plane. Needs
/// unit and camera.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_set_merge_coplanar(
    detector: Option<&mut dp_detector>,
    angle_deg: f64,
    distance_m: f64,
) -> dp_status {
    state(detector, |settings| {
        settings.coplanar = Some(Coplanar::new(angle_deg, distance_m)?);
        Ok(())
    })
}

/// Makes outlines of all planes from now on, which takes time: rings within `tolerance_px` pixels of the planes' borders (1.5
/// makes lines of the steps along straight edges, 0 keeps every corner), without holes of fewer than `min_hole_px` pixels.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_set_outlines(
    detector: Option<&mut dp_detector>,
    tolerance_px: f64,
    min_hole_px: usize,
) -> dp_status {
    with(detector, |detector| {
        detector.outliner = Some(Outliner::new(tolerance_px)?.min_hole_px(min_hole_px));
        Ok(())
    })
}
