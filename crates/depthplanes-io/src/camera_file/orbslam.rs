//! ORB-SLAM 2 and 3: settings in OpenCV's YAML under `Camera.fx` or `Camera1.fx`.

use serde_json::{Map, Value};

use super::camera::{CameraFile, pinhole, size, unreadable, with_lens};
use super::form::Document;
use super::names::number;
use crate::encoding::Stereo;
use crate::error::Result;

fn settings<'a>(document: &'a Document<'_>) -> Option<&'a Map<String, Value>> {
    document.tree()?.as_object()
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    let has = |root: &Map<String, Value>| ["Camera.fx", "Camera1.fx"].iter().any(|name| root.contains_key(*name));
    settings(document).is_some_and(has)
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let root = settings(document).ok_or_else(|| unreadable("it is no list of settings"))?;
    let prefix = if root.contains_key("Camera1.fx") { "Camera1" } else { "Camera" };
    let any = |name: &str| root.get(name).and_then(number);
    let of = |name: &str| any(&format!("{prefix}.{name}"));
    let need = |name: &str| of(name).ok_or_else(|| unreadable(format!("it has {prefix}.fx but no {prefix}.{name}")));
    let camera = pinhole(need("fx")?, need("fy")?, need("cx")?, need("cy")?)?;
    let model = root.get("Camera.type").or(root.get("Camera.model")).and_then(Value::as_str).unwrap_or("");
    let is_rectified = model.eq_ignore_ascii_case("rectified");
    let lens = |name: &str| of(name).unwrap_or(0.0);
    let is_fisheye = super::camera::model(model) == Some(depthplanes::DistortionModel::KannalaBrandt);
    let names: &[&str] =
        if is_fisheye { &["k1", "k2", "k3", "k4"] } else { &["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"] };
    let coefficients: Vec<f64> = names.iter().map(|name| lens(name)).collect();
    let mut camera = if is_rectified { camera } else { with_lens(camera, model, &coefficients, false)? };
    let side = |name: &str| any(&format!("Camera.{name}")).or_else(|| of(name));
    camera.size = size(side("width"), side("height"));
    let factor = any("DepthMapFactor").or_else(|| any("RGBD.DepthMapFactor"));
    camera.unit_m = factor.filter(|&units| units > 0.0).map(f64::recip);
    if factor.is_none() {
        // With depth maps, bf belongs to a rig that is imagined.
        let baseline_m = any("Stereo.b").or_else(|| any("Camera.bf").map(|bf| bf / camera.intrinsics.fx));
        let focal_px = camera.intrinsics.fx;
        let rig = |baseline_m| Stereo { focal_px, baseline_m, doffs_px: 0.0 };
        camera.stereo = baseline_m.filter(|&b| b > 0.0 && b.is_finite()).map(rig);
    }
    if root.contains_key("Camera2.fx") {
        camera.notes.push("of Camera1 and Camera2 Camera1 is taken".into());
    }
    Ok(camera)
}
