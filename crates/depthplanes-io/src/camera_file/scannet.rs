//! ScanNet: scene*.txt, and `_info.txt` of its reader of .sens files. The depth camera.

use super::camera::{CameraFile, matrix, pinhole, size, unreadable};
use super::form::Document;
use super::lines::{number, numbers};
use crate::error::Result;

pub(super) fn recognise(document: &Document<'_>) -> bool {
    number(document.text, "fxdepth").is_some() || numbers(document.text, "mcalibrationdepthintrinsic").is_some()
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let of = |name: &str| number(document.text, name);
    let need = |name: &str| of(name).ok_or_else(|| unreadable(format!("it has fx_depth but no `{name}`")));
    let mut camera = match numbers(document.text, "mcalibrationdepthintrinsic") {
        Some(numbers) => matrix(&numbers)?,
        None => pinhole(need("fxdepth")?, need("fydepth")?, need("mxdepth")?, need("mydepth")?)?,
    };
    camera.unit_m = of("mdepthshift").filter(|&units| units > 0.0).map(f64::recip);
    let side = |name: &str| of(name).or_else(|| of(&format!("m{name}")));
    Ok(camera.size(size(side("depthwidth"), side("depthheight"))))
}
