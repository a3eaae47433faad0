//! Pinhole cameras from the files that describe them.
//!
//! In: `fx,fy,cx,cy`; Open3D `PinholeCameraIntrinsic` JSON (nine numbers, column by column); BOP
//! `camera.json`; ROS `CameraInfo` as YAML or JSON and `camera_calibration` YAML; a 3 x 3 matrix as
//! text; Middlebury and ETH3D `calib.txt`, which states the stereo rig as well. Told apart by
//! content. Out: a [`CameraFile`]. Lens distortion is not read: maps are taken to be rectified, and
//! of a ROS camera the rectified `P` is preferred to `K`, as image_geometry does.

use std::path::Path;

use depthplanes::Intrinsics;
use serde_json::Value;

use crate::encoding::Stereo;
use crate::error::{Error, Result};
use crate::file_bytes::read_bytes;

/// What a camera file states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFile {
    /// The pinhole camera.
    pub intrinsics: Intrinsics,
    /// The stereo rig, if stated.
    pub stereo: Option<Stereo>,
    /// Columns and rows that the intrinsics are for, if stated.
    pub size: Option<(usize, usize)>,
}

const MAX_BYTES: usize = 1 << 20;

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "fx,fy,cx,cy; an Open3D, BOP or ROS camera in JSON; a ROS camera in YAML; a 3 x 3 matrix; \
         or a Middlebury calib.txt";
    Error::Unreadable { format: "camera file", wrong: wrong.into(), accepted }
}

/// Reads a camera file.
///
/// # Errors
/// [`Error::Io`], [`Error::Limit`] above 1 MiB, and those of [`parse`].
pub fn read_camera(path: impl AsRef<Path>) -> Result<CameraFile> {
    let bytes = read_bytes(path.as_ref(), MAX_BYTES)?;
    let text = std::str::from_utf8(&bytes).map_err(|_| unreadable("it is not text"));
    text.and_then(parse).map_err(|error| error.in_file(&path.as_ref().display().to_string()))
}

/// `fx,fy,cx,cy` in pixels; a focal length may be negative.
///
/// # Errors
/// [`Error::Parameter`] unless these are four numbers; [`Error::Library`] for a focal length of 0.
pub fn parse_intrinsics(text: &str) -> Result<Intrinsics> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[fx, fy, cx, cy]) => Ok(Intrinsics::new(fx, fy, cx, cy)?),
        _ => Err(Error::parameter("--intrinsics", text, "fx,fy,cx,cy in pixels, such as 525,525,319.5,239.5")),
    }
}

/// Reads the text of a camera file.
///
/// # Errors
/// [`Error::Unreadable`] with what is missing; [`Error::Library`] for a camera that cannot be.
pub fn parse(text: &str) -> Result<CameraFile> {
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.starts_with('{') {
        return json(text);
    }
    if text.lines().any(|line| line.trim_start().starts_with("cam0")) {
        return middlebury(text);
    }
    if let Some(numbers) = only_numbers(text) {
        return match numbers[..] {
            [fx, fy, cx, cy] => Ok(plain(Intrinsics::new(fx, fy, cx, cy)?)),
            [..] if numbers.len() == 9 => Ok(plain(row_major(&numbers)?)),
            _ => Err(unreadable(format!("{} numbers, 4 or 9 are expected", numbers.len()))),
        };
    }
    yaml(text)
}

fn plain(intrinsics: Intrinsics) -> CameraFile {
    CameraFile { intrinsics, stereo: None, size: None }
}

/// The numbers of a text that holds nothing else; `#` starts a comment.
fn only_numbers(text: &str) -> Option<Vec<f64>> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or(""));
    let words = lines.flat_map(|line| line.split([' ', '\t', ',', ';', '[', ']']).map(str::trim));
    words.filter(|word| !word.is_empty()).map(|word| word.parse().ok()).collect()
}

/// `fx 0 cx; 0 fy cy; 0 0 1`, row by row.
fn row_major(m: &[f64]) -> Result<Intrinsics> {
    let &[fx, skew, cx, a, fy, cy, b, c, one] = m else {
        return Err(unreadable(format!("a matrix of {} numbers instead of 9", m.len())));
    };
    if [skew, a, b, c] != [0.0; 4] || one != 1.0 {
        return Err(unreadable(format!("the matrix {m:?} is not fx 0 cx; 0 fy cy; 0 0 1")));
    }
    Ok(Intrinsics::new(fx, fy, cx, cy)?)
}

/// Row by row or column by column: the principal point stands where the zeros do not.
fn either_order(m: &[f64]) -> Result<Intrinsics> {
    match *m {
        [fx, a, b, c, fy, d, cx, cy, one] if [b, d] == [0.0; 2] => row_major(&[fx, c, cx, a, fy, cy, b, d, one]),
        _ => row_major(m),
    }
}

fn size(width: Option<f64>, height: Option<f64>) -> Option<(usize, usize)> {
    let side = |side: f64| (side >= 1.0 && side.fract() == 0.0 && side < 1e6).then_some(side as usize);
    Some((side(width?)?, side(height?)?))
}

fn json(text: &str) -> Result<CameraFile> {
    let root: Value = serde_json::from_str(text).map_err(|error| unreadable(error.to_string()))?;
    let root = root.get("intrinsic").unwrap_or(&root);
    let number = |key: &str| root.get(key).and_then(Value::as_f64);
    let numbers = |key: &str| -> Option<Vec<f64>> { root.get(key)?.as_array()?.iter().map(Value::as_f64).collect() };
    let size = size(number("width"), number("height"));
    if let Some(matrix) = numbers("intrinsic_matrix") {
        return Ok(CameraFile { size, ..plain(either_order(&matrix)?) });
    }
    if let Some(matrix) = numbers("cam_K") {
        return Ok(CameraFile { size, ..plain(row_major(&matrix)?) });
    }
    if let (Some(fx), Some(fy), Some(cx), Some(cy)) = (number("fx"), number("fy"), number("cx"), number("cy")) {
        return Ok(CameraFile { size, ..plain(Intrinsics::new(fx, fy, cx, cy)?) });
    }
    let either = |upper: &str, lower: &str| numbers(upper).or_else(|| numbers(lower));
    ros(either("K", "k"), either("P", "p"), size)
}

/// A ROS camera: `P` (3 x 4, rectified) unless it is absent or all 0, else `K` (3 x 3). `P[3]` is
/// `-fx * baseline` for the right camera of a rig.
fn ros(k: Option<Vec<f64>>, p: Option<Vec<f64>>, size: Option<(usize, usize)>) -> Result<CameraFile> {
    if let Some(p) = p.filter(|p| p.len() == 12 && p[0] != 0.0) {
        let intrinsics = row_major(&[p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]])?;
        let baseline_m = -p[3] / p[0];
        let rig = Stereo { focal_px: p[0], baseline_m, doffs_px: 0.0 };
        return Ok(CameraFile { intrinsics, stereo: (baseline_m > 0.0).then_some(rig), size });
    }
    let k = k.ok_or_else(|| unreadable("no camera matrix is stated in a form known here"))?;
    Ok(CameraFile { size, ..plain(row_major(&k)?) })
}

fn yaml(text: &str) -> Result<CameraFile> {
    let matrix = |keys: [&str; 3]| keys.iter().find_map(|key| yaml_numbers(text, key));
    let first = |keys: [&str; 2]| keys.iter().find_map(|key| yaml_numbers(text, key)?.first().copied());
    let size = size(first(["image_width", "width"]), first(["image_height", "height"]));
    ros(matrix(["camera_matrix", "K", "k"]), matrix(["projection_matrix", "P", "p"]), size)
}

/// The numbers behind `key:`, or behind the `data:` below it: `[1, 2]` on one line or several, or
/// a list of `- 1` lines. Not YAML in general, only what ROS writes.
fn yaml_numbers(text: &str, key: &str) -> Option<Vec<f64>> {
    let starts =
        |line: &str| line.trim_start().strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with(':'));
    let lines: Vec<&str> = text.lines().map(|line| line.split('#').next().unwrap_or("")).collect();
    let mut at = lines.iter().position(|line| starts(line))?;
    let mut rest = lines[at].split_once(':')?.1;
    while rest.trim().is_empty() || rest.trim_start().starts_with("!!") {
        at += 1;
        let line = lines.get(at)?.trim();
        if line.starts_with('-') {
            rest = line;
            break;
        }
        let (name, value) = line.split_once(':')?;
        rest = if name == "data" { value } else { "" };
    }
    let mut numbers = Vec::new();
    loop {
        for word in rest.split([' ', '\t', ',', '[', ']']).filter(|word| !word.is_empty() && *word != "-") {
            match word.parse() {
                Ok(number) => numbers.push(number),
                Err(_) => return Some(numbers).filter(|numbers| !numbers.is_empty()),
            }
        }
        at += 1;
        match lines.get(at) {
            Some(line) if !rest.contains(']') => rest = line,
            _ => return Some(numbers).filter(|numbers| !numbers.is_empty()),
        }
    }
}

/// `cam0=[fx 0 cx; 0 fy cy; 0 0 1]`, `doffs` in pixels, `baseline` in millimetres.
fn middlebury(text: &str) -> Result<CameraFile> {
    let value = |key: &str| {
        text.lines().find_map(|line| line.trim().strip_prefix(key)?.trim_start().strip_prefix('=').map(str::trim))
    };
    let number = |key: &str| value(key).and_then(|value| value.parse::<f64>().ok());
    let matrix = value("cam0").and_then(only_numbers).ok_or_else(|| unreadable("cam0 is not a matrix of numbers"))?;
    let intrinsics = row_major(&matrix)?;
    let stereo = number("baseline").map(|baseline_mm| Stereo {
        focal_px: intrinsics.fx,
        baseline_m: baseline_mm / 1000.0,
        doffs_px: number("doffs").unwrap_or(0.0),
    });
    Ok(CameraFile { intrinsics, stereo, size: size(number("width"), number("height")) })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ICL: Intrinsics = Intrinsics { fx: 481.2, fy: -480.0, cx: 319.5, cy: 239.5 };

    #[test]
    fn every_form_gives_the_same_camera() {
        let forms = [
            "481.2,-480,319.5,239.5",
            "481.2 0 319.5\n0 -480 239.5\n0 0 1\n",
            r#"{"width":640,"height":480,"intrinsic_matrix":[481.2,0,0,0,-480,0,319.5,239.5,1]}"#,
            r#"{"intrinsic_matrix":[481.2,0,319.5,0,-480,239.5,0,0,1]}"#,
            r#"{"cam_K":[481.2,0,319.5,0,-480,239.5,0,0,1],"depth_scale":0.2}"#,
            r#"{"fx":481.2,"fy":-480,"cx":319.5,"cy":239.5}"#,
            "header:\n  seq: 0\nheight: 480\nwidth: 640\nD: [0.0]\nK: [481.2, 0.0, 319.5, 0.0, -480.0, 239.5, 0.0, 0.0, 1.0]\n",
            "k:\n- 481.2\n- 0.0\n- 319.5\n- 0.0\n- -480.0\n- 239.5\n- 0.0\n- 0.0\n- 1.0\nr:\n- 1.0\n",
            "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [481.2, 0, 319.5,\n    0, -480, 239.5, 0, 0, 1]\ndistortion_model: plumb_bob\n",
            "cam0=[481.2 0 319.5; 0 -480 239.5; 0 0 1]\n",
        ];
        for form in forms {
            assert_eq!(parse(form).unwrap().intrinsics, ICL, "{form}");
        }
        assert_eq!(parse_intrinsics(forms[0]).unwrap(), ICL);
        assert_eq!(parse(forms[2]).unwrap().size, Some((640, 480)));
        assert_eq!(parse(forms[6]).unwrap().size, Some((640, 480)));
        assert_eq!(parse(forms[8]).unwrap().size, Some((640, 480)));
    }

    #[test]
    fn the_rectified_matrix_of_a_right_camera_gives_its_baseline() {
        let text = "K: [500, 0, 300, 0, 500, 200, 0, 0, 1]\nP: [400, 0, 310, -40, 0, 400, 210, 0, 0, 0, 1, 0]\n";
        let camera = parse(text).unwrap();
        assert_eq!(camera.intrinsics, Intrinsics { fx: 400.0, fy: 400.0, cx: 310.0, cy: 210.0 });
        assert_eq!(camera.stereo, Some(Stereo { focal_px: 400.0, baseline_m: 0.1, doffs_px: 0.0 }));
    }

    #[test]
    fn middlebury_gives_the_rig() {
        let text = "cam0=[1000 0 300; 0 1000 200; 0 0 1]\ndoffs=31.5\nbaseline=193\nwidth=741\nheight=500\n";
        let camera = parse(text).unwrap();
        assert_eq!(camera.stereo, Some(Stereo { focal_px: 1000.0, baseline_m: 0.193, doffs_px: 31.5 }));
        assert_eq!(camera.size, Some((741, 500)));
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        let wrong = [
            "",
            "hello",
            "1,2,3",
            "0,1,2,3",
            "nan,1,2,3",
            "{",
            "{}",
            "[1,2]",
            "K: [1, 2]",
            "K:",
            "cam0=",
            "cam0=[1 2]",
            "1 2 3 4 5 6 7 8 9",
            r#"{"intrinsic_matrix":[1,2,3]}"#,
            r#"{"cam_K":"x"}"#,
            "camera_matrix:\n  data:",
            "500 1 300 0 500 200 0 0 1",
            "P: [1,0,0,0,0,0,0,0,0,0,1,0]",
        ];
        for text in wrong {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
