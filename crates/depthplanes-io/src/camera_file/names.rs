//! The names that programs give to focal lengths, principal points, matrices, sizes and distortion coefficients, and the
//! numbers behind them.
//!
//! Names are compared without case and signs.

use serde_json::{Map, Value};

pub(super) type Object = Map<String, Value>;

pub(super) const FOCAL: [&[&str]; 2] = [
    &["fx", "flx", "focalx", "focallengthx", "alphax", "ffx", "mu"],
    &["fy", "fly", "focaly", "focallengthy", "alphay", "ffy", "mv"],
];
pub(super) const BOTH_FOCALS: &[&str] = &["f", "focal", "focallength", "focallengths", "fl"];
pub(super) const CENTRE: [&[&str]; 2] = [
    &["cx", "ppx", "principalx", "principalpointx", "centerx", "u0", "ox", "px"],
    &["cy", "ppy", "principaly", "principalpointy", "centery", "v0", "oy", "py"],
];
pub(super) const BOTH_CENTRES: &[&str] = &["principalpoint", "pp", "center", "opticalcenter", "principal"];
pub(super) const MATRIX: &[&str] = &[
    "k", "mtx", "m1", "m2", "k1", "k2", "kl", "kr", "kdepth", "depthk", "kir", "krgb", "kcolor", "camk", "cammat", "a",
];
pub(super) const SIDES: [&[&str]; 2] = [
    &["width", "w", "imagewidth", "imgwidth", "resolutionwidth", "resx", "sizex", "dw"],
    &["height", "h", "imageheight", "imgheight", "resolutionheight", "resy", "sizey", "dh"],
];
pub(super) const BOTH_SIDES: &[&str] = &[
    "resolution",
    "imageresolution",
    "imagesize",
    "imgsize",
    "size",
    "imageshape",
    "shape",
    "imagedimensions",
    "dimensions",
    "dims",
    "videosize",
];
pub(super) const LENS: &[&str] = &[
    "d",
    "distortioncoefficients",
    "distortioncoeffs",
    "distortioncoeff",
    "distcoeffs",
    "distcoeff",
    "coeffs",
    "coefficients",
    "distortion",
    "dist",
    "distortionparams",
    "distortionparameters",
    "distortionvector",
    "distcoefs",
    "distcoef",
    "distortions",
    "d1",
    "dl",
];
pub(super) const MODELS: &[&str] = &[
    "distortionmodel",
    "distortiontype",
    "lensmodel",
    "distortion",
    "model",
    "cameramodel",
    "cameratype",
    "projectionmodel",
    "modeltype",
    "projectiontype",
];

/// Flags that the coefficients are those of OpenCV's fisheye.
pub(super) const FISHEYE: &[&str] = &["isfisheye", "fisheyemodel", "fisheye", "usefisheyemodel"];

/// A name without case and signs.
pub(super) fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase()
}

/// The value under one of some names, the first of them first.
pub(super) fn get<'a>(object: &'a Object, names: &[&str]) -> Option<&'a Value> {
    names.iter().find_map(|&name| object.iter().find(|(key, _)| plain(key) == name).map(|(_, value)| value))
}

/// A number, or a text that is one.
pub(super) fn number(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_str()?.trim().parse().ok().filter(|number: &f64| number.is_finite()))
}

pub(super) fn number_of(object: &Object, names: &[&str]) -> Option<f64> {
    number(get(object, names)?)
}

/// The numbers of a text of numbers alone, with blanks, commas, semicolons or brackets between.
pub(super) fn words(text: &str) -> Option<Vec<f64>> {
    let is_gap = |c: char| c.is_whitespace() || ",;[](){}".contains(c);
    let words = text.split(is_gap).filter(|word| !word.is_empty());
    words.map(|word| word.parse().ok().filter(|number: &f64| number.is_finite())).collect()
}

/// All numbers of a list of whatever nesting, of a text of numbers, or of OpenCV's and ROS's `data`.
pub(super) fn numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Array(items) => {
            let mut all = Vec::new();
            for item in items {
                match item {
                    Value::Array(_) => all.extend(numbers(item)?),
                    _ => all.push(number(item)?),
                }
            }
            (all.len() <= 64).then_some(all)
        }
        Value::String(text) => words(text).filter(|numbers| numbers.len() > 1),
        Value::Object(object) => numbers(get(object, &["data"])?),
        _ => None,
    }
}

/// Whether a name is that of a camera matrix.
pub(super) fn is_matrix(name: &str) -> bool {
    let name = plain(name);
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    (has(&["intrinsic", "cameramatrix", "cammatrix", "cameramat", "calibrationmatrix", "kmatrix"])
        || MATRIX.contains(&name.as_str()))
        && !has(&["extrinsic", "inv"])
}
