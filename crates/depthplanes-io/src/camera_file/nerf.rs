//! transforms.json of NeRF programs (instant-ngp, nerfstudio): `fl_x`, or `camera_angle_x` with the width.

use serde_json::{Map, Value};

use super::camera::{CameraFile, pinhole, size, unreadable};
use super::form::Document;
use super::names::{get, number};
use super::tree;
use crate::error::Result;

fn root<'a>(document: &'a Document<'_>) -> Option<&'a Map<String, Value>> {
    document.tree()?.as_object()
}

/// Only those without `fl_x` and without intrinsics in the frames: the others are trees as any.
pub(super) fn recognise(document: &Document<'_>) -> bool {
    let is_angle_alone = |root: &Map<String, Value>| root.contains_key("camera_angle_x") && !root.contains_key("fl_x");
    root(document).is_some_and(is_angle_alone)
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let (Some(root), Some(whole)) = (root(document), document.tree()) else { return Err(unreadable("it is no JSON")) };
    let of = |name: &str| get(root, &[name]).and_then(number);
    let Some(width) = of("w") else {
        return tree::parse(whole).map_err(|_| {
            unreadable("camera_angle_x is stated without the width w; fx = 0.5 w / tan(0.5 camera_angle_x): give it with --intrinsics")
        });
    };
    let focal = |side: f64, angle: f64| 0.5 * side / (0.5 * angle).tan();
    let angle = of("cameraanglex").filter(|&angle| angle > 0.0 && angle < 3.1);
    let fx = focal(width, angle.ok_or_else(|| unreadable("camera_angle_x is no angle in radians"))?);
    let height = of("h");
    let fy = match (of("cameraangley"), height) {
        (Some(angle), Some(height)) if angle > 0.0 && angle < 3.1 => focal(height, angle),
        _ => fx,
    };
    let middle = |side: f64| 0.5 * (side - 1.0);
    let cy = of("cy").or(height.map(middle)).ok_or_else(|| unreadable("neither cy nor the height h is stated"))?;
    Ok(pinhole(fx, fy, of("cx").unwrap_or_else(|| middle(width)), cy)?.size(size(Some(width), height)))
}
