//! Middlebury and ETH3D calib.txt: `cam0=[fx 0 cx; 0 fy cy; 0 0 1]`, `doffs` in pixels, `baseline` in millimetres, one to a line
//! or several.

use super::camera::{CameraFile, matrix, size, unreadable};
use super::form::Document;
use super::names::words;
use crate::encoding::Stereo;
use crate::error::Result;

/// What stands behind `key=`: a matrix in brackets, or a word.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let starts =
        text.match_indices(key).filter(|(at, _)| !text[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_'));
    starts.filter_map(|(at, _)| text[at + key.len()..].trim_start().strip_prefix('=')).map(str::trim_start).find_map(
        |rest| match rest.strip_prefix('[') {
            Some(inner) => inner.split(']').next(),
            None => rest.split_whitespace().next(),
        },
    )
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    value(document.text, "cam0").is_some()
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let number =
        |key: &str| value(document.text, key).and_then(|value| value.trim_end_matches([',', ';']).parse::<f64>().ok());
    let numbers = value(document.text, "cam0").and_then(words).filter(|numbers| numbers.len() == 9);
    let camera = matrix(&numbers.ok_or_else(|| unreadable("cam0 is not a matrix of 9 numbers"))?)?;
    let focal_px = camera.intrinsics.fx;
    let doffs_px = number("doffs").unwrap_or(0.0);
    let stereo = number("baseline").map(|baseline_mm| Stereo { focal_px, baseline_m: baseline_mm / 1000.0, doffs_px });
    let disparity = stereo.is_some();
    Ok(CameraFile { stereo, disparity, ..camera }.size(size(number("width"), number("height"))))
}
