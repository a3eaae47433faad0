//! DepthAI (OAK): the calibration of the device as JSON, a matrix for each socket.

use serde_json::{Map, Value};

use super::camera::{CameraFile, matrix, size, unreadable, with_lens};
use super::form::Document;
use super::names::{get, number, numbers};
use crate::encoding::Stereo;
use crate::error::Result;

/// Sockets and cameras, in an order of preference: depth is that of the right camera unless it was aligned to another.
fn cameras<'a>(document: &'a Document<'_>) -> Option<Vec<(String, &'a Map<String, Value>)>> {
    let data = document.tree()?.as_object()?.get("cameraData")?;
    let mut all: Vec<(String, &Map<String, Value>)> = match data {
        Value::Array(items) => {
            items.iter().filter_map(|item| Some((item.get(0)?.to_string(), item.get(1)?.as_object()?))).collect()
        }
        Value::Object(object) => {
            object.iter().filter_map(|(key, value)| Some((key.clone(), value.as_object()?))).collect()
        }
        _ => return None,
    };
    let socket = |name: &str| name.trim_matches('"').parse::<f64>().ok().map(|socket| socket as i64);
    all.iter_mut().for_each(|(name, _)| *name = socket(name).map_or(name.clone(), |socket| socket.to_string()));
    all.sort_by_key(|(name, _)| match socket(name) {
        Some(2) => 0,
        Some(1) => 1,
        Some(socket) => 2 + socket.max(0),
        None => i64::MAX,
    });
    Some(all)
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    cameras(document).is_some()
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let sockets = cameras(document).unwrap_or_default();
    let mut found = Vec::new();
    for (socket, object) in &sockets {
        let Some(m) = get(object, &["intrinsicmatrix"]).and_then(numbers) else { continue };
        if m.iter().all(|&x| x == 0.0) {
            continue; // a socket without a camera
        }
        let of = |name: &str| get(object, &[name]).and_then(number);
        let mut coefficients = get(object, &["distortioncoeff"]).and_then(numbers).unwrap_or_default();
        let model = if of("cameratype") == Some(1.0) { "fisheye" } else { "perspective" };
        if model == "fisheye" {
            coefficients.truncate(4);
        }
        let camera = with_lens(matrix(&m)?, model, &coefficients, true)?;
        let mut camera = camera.size(size(of("width"), of("height"))).named(format!("socket {socket}"));
        camera.stereo = (socket == "2").then(|| rig(object, &camera)).flatten();
        if sockets.len() > 1 {
            camera.notes.push(format!("of {} cameras that of socket {socket} is taken", sockets.len()));
        }
        found.push(camera);
    }
    if found.is_empty() {
        return Err(unreadable("no socket of cameraData has an intrinsicMatrix"));
    }
    CameraFile::first_of(found)
}

/// The rig of left and right camera, whose translation is stated in centimetres.
fn rig(object: &Map<String, Value>, camera: &CameraFile) -> Option<Stereo> {
    let extrinsics = get(object, &["extrinsics"])?.as_object()?;
    let x_cm = number(get(get(extrinsics, &["translation"])?.as_object()?, &["x"])?)?;
    let baseline_m = x_cm.abs() / 100.0;
    (baseline_m > 0.005).then_some(Stereo { focal_px: camera.intrinsics.fx, baseline_m, doffs_px: 0.0 })
}
