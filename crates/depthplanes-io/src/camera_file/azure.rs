//! Azure Kinect: the calibration of the device as JSON, and what the SDK's tools print.

use depthplanes::Intrinsics;
use serde_json::Value;

use super::camera::{CameraFile, pinhole, size, unreadable, with_lens};
use super::form::Document;
use super::lines::{number, pairs};
use super::names::{get, numbers};
use crate::error::Result;

/// A mode: pixels of the calibrated picture after binning, where the mode's picture begins in it, and its size
/// (Azure Kinect Sensor SDK, src/transformation/mode_specific_calibration.c).
struct Mode {
    calibrated: [f64; 2],
    offset: [f64; 2],
    size: (usize, usize),
}

const fn mode(calibrated: [f64; 2], offset: [f64; 2], size: (usize, usize)) -> Mode {
    Mode { calibrated, offset, size }
}

const DEPTH: [Mode; 4] = [
    mode([1024.0, 1024.0], [192.0, 180.0], (640, 576)),
    mode([512.0, 512.0], [96.0, 90.0], (320, 288)),
    mode([1024.0, 1024.0], [0.0, 0.0], (1024, 1024)),
    mode([512.0, 512.0], [0.0, 0.0], (512, 512)),
];

const COLOUR: [Mode; 6] = [
    mode([1280.0, 960.0], [0.0, 120.0], (1280, 720)),
    mode([1920.0, 1440.0], [0.0, 180.0], (1920, 1080)),
    mode([2560.0, 1920.0], [0.0, 240.0], (2560, 1440)),
    mode([2048.0, 1536.0], [0.0, 0.0], (2048, 1536)),
    mode([3840.0, 2880.0], [0.0, 360.0], (3840, 2160)),
    mode([4096.0, 3072.0], [0.0, 0.0], (4096, 3072)),
];

fn cameras<'a>(document: &'a Document<'_>) -> Option<&'a Vec<Value>> {
    let root = document.tree()?.as_object()?;
    let inner = get(root, &["calibrationinformation"]).and_then(Value::as_object).unwrap_or(root);
    get(inner, &["cameras"])?.as_array()
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    cameras(document).is_some_and(|cameras| cameras.iter().any(|camera| parameters(camera).is_some()))
}

fn parameters(camera: &Value) -> Option<Vec<f64>> {
    let intrinsics = get(camera.as_object()?, &["intrinsics"])?.as_object()?;
    numbers(get(intrinsics, &["modelparameters"])?).filter(|numbers| numbers.len() >= 14)
}

/// The depth camera, and the colour camera for maps that were turned into its geometry, in all modes.
pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let empty = Vec::new();
    let cameras = cameras(document).unwrap_or(&empty);
    let mut all = Vec::new();
    for (place, modes, what) in [("D0", &DEPTH[..], "the depth camera"), ("PV0", &COLOUR[..], "the colour camera")] {
        let is_here = |camera: &&Value| {
            let location = camera.as_object().and_then(|camera| get(camera, &["location"])?.as_str());
            location.is_some_and(|location| location.ends_with(place))
        };
        let Some(numbers) = cameras.iter().find(is_here).and_then(parameters) else { continue };
        for mode in modes {
            all.push(
                of_mode(&numbers, mode)?
                    .named(what)
                    .note(format!("{what} in its mode of {} x {} pixels is taken", mode.size.0, mode.size.1)),
            );
        }
    }
    CameraFile::first_of(all)
}

/// Parameters are cx, cy, fx, fy as shares of the calibrated picture, k1 to k6, the centre of distortion, p2, p1.
fn of_mode(numbers: &[f64], mode: &Mode) -> Result<CameraFile> {
    let &[cx, cy, fx, fy, k1, k2, k3, k4, k5, k6, codx, cody, p2, p1, ..] = numbers else {
        return Err(unreadable("ModelParameters has fewer than 14 numbers"));
    };
    let [width, height] = mode.calibrated;
    let Intrinsics { fx, fy, cx, cy } = Intrinsics {
        fx: fx * width,
        fy: fy * height,
        cx: cx * width - mode.offset[0] - 0.5,
        cy: cy * height - mode.offset[1] - 0.5,
    };
    let camera = with_lens(pinhole(fx, fy, cx, cy)?, "", &[k1, k2, p1, p2, k3, k4, k5, k6], false)?;
    let camera = CameraFile { size: Some(mode.size), ..camera };
    let is_off = [codx, cody] != [0.0; 2];
    Ok(if is_off { camera.note("the centre of distortion (codx, cody) is ignored") } else { camera })
}

pub(super) fn recognise_text(document: &Document<'_>) -> bool {
    ["focallengthx", "principalpointx"].iter().all(|name| number(document.text, name).is_some())
}

/// The depth camera is printed before the colour camera.
pub(super) fn parse_text(document: &Document<'_>) -> Result<CameraFile> {
    let of = |name: &str| number(document.text, name).ok_or_else(|| unreadable(format!("it has no `{name}`")));
    let camera = pinhole(of("focallengthx")?, of("focallengthy")?, of("principalpointx")?, of("principalpointy")?)?;
    let names =
        ["k1", "k2", "tangentialdistortioncoefficientx", "tangentialdistortioncoefficienty", "k3", "k4", "k5", "k6"];
    let coefficients = names.map(|name| number(document.text, name).unwrap_or(0.0));
    let side = |name: &str| number(document.text, name).or_else(|| number(document.text, &format!("depth{name}")));
    let camera =
        with_lens(camera, "", &coefficients, false)?.size(size(side("resolutionwidth"), side("resolutionheight")));
    let count = pairs(document.text).filter(|(name, _)| name == "focallengthx").count();
    Ok(if count > 1 { camera.note(format!("of {count} cameras the first is taken")) } else { camera })
}
