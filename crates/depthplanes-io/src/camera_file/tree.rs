//! Cameras in a tree of names and values, from JSON or YAML, whatever their nesting: numbers under names that programs use
//! (`names.rs`).
//!
//! Of several cameras that differ one for depth is taken, or the left one of a
//! pair, and said; others are refused with what was found.

use serde_json::Value;

use super::camera::{CameraFile, matrix, pinhole, refuse_no_pinhole, size, unreadable, with_lens};
use super::names::{
    BOTH_CENTRES, BOTH_FOCALS, BOTH_SIDES, CENTRE, FISHEYE, FOCAL, LENS, MODELS, Object, SIDES, get, is_matrix, number,
    number_of, numbers, plain, words,
};
use super::several::{Found, one_of};
use super::unit::{Entry, unit_m};
use crate::encoding::Stereo;
use crate::error::Result;

/// The camera of a tree.
///
/// # Errors
/// If there is none, or several that differ.
pub(super) fn parse(root: &Value) -> Result<CameraFile> {
    let mut found = Vec::new();
    let mut wrong = None;
    walk(root, "", &mut Vec::new(), &mut found, &mut wrong);
    match (found.is_empty(), wrong) {
        (true, Some(error)) => Err(error),
        (true, None) => Err(unreadable(format!("no camera is stated under a name known here{}", names_of(root)))),
        _ => one_of(found),
    }
}

/// What a tree has at its root, and the camera models that it names, for a message.
fn names_of(root: &Value) -> String {
    let mut text = match root {
        Value::Object(object) if !object.is_empty() => {
            let names: Vec<&str> = object.keys().take(8).map(String::as_str).collect();
            format!("; it states {}", names.join(", "))
        }
        _ => String::new(),
    };
    let mut named = Vec::new();
    models_of(root, &mut named);
    if !named.is_empty() {
        text.push_str(&format!("; its camera models are {}", named.join(", ")));
    }
    text
}

fn models_of(value: &Value, named: &mut Vec<String>) {
    match value {
        Value::Array(items) => items.iter().take(100).for_each(|item| models_of(item, named)),
        Value::Object(object) => {
            for name in models(object).map(|name| format!("`{name}`")) {
                if named.len() < 5 && !named.contains(&name) {
                    named.push(name);
                }
            }
            object.values().for_each(|value| models_of(value, named));
        }
        _ => (),
    }
}

fn walk<'a>(
    value: &'a Value,
    path: &str,
    above: &mut Vec<&'a Object>,
    found: &mut Vec<Found>,
    wrong: &mut Option<crate::error::Error>,
) {
    if found.len() > 10_000 {
        return;
    }
    let below = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match value {
        Value::Array(items) if numbers(value).is_none() => {
            for (at, item) in items.iter().enumerate() {
                walk(item, &below(&at.to_string()), above, found, wrong);
            }
        }
        Value::Object(object) => {
            above.push(object);
            for (key, camera) in cameras_of(object, above) {
                match camera {
                    Ok(camera) => {
                        found.push(Found { path: if key.is_empty() { path.into() } else { below(&key) }, camera })
                    }
                    Err(error) => *wrong = Some(wrong.take().unwrap_or(error)),
                }
            }
            for (key, value) in object {
                walk(value, &below(key), above, found, wrong);
            }
            above.pop();
        }
        _ => (),
    }
}

/// The cameras that an object states by itself: by names of single numbers, or by matrices.
fn cameras_of(object: &Object, above: &[&Object]) -> Vec<(String, Result<CameraFile>)> {
    if let Some(camera) = ros(object) {
        return vec![(String::new(), camera.and_then(|camera| complete(camera, object, above, None)))];
    }
    let mut all = Vec::new();
    if let Some(camera) = by_names(object) {
        all.push((String::new(), camera));
    }
    for (key, value) in object.iter().filter(|(key, _)| is_matrix(key)) {
        let Some(numbers) = numbers(value) else { continue };
        let camera = match numbers[..] {
            [_] | [] => continue,
            [fx, fy, cx, cy] => pinhole(fx, fy, cx, cy),
            [_, _, _, _, _] | [_, _, _, _, _, _] | [_, _, _] | [_, _] => continue, // parameters of another model
            _ => matrix(&numbers),
        };
        all.push((key.clone(), camera));
    }
    all.into_iter()
        .map(|(key, camera)| {
            let camera = camera.and_then(|camera| complete(camera, object, above, Some(&key)));
            (key, camera)
        })
        .collect()
}

/// `fx, fy, cx, cy` under any of their names.
fn by_names(object: &Object) -> Option<Result<CameraFile>> {
    let pair = |names: &[&str]| {
        let value = get(object, names)?;
        match numbers(value).as_deref() {
            Some(&[x, y]) => Some([x, y]),
            _ => match value {
                Value::Object(inner) => Some([number_of(inner, &["x", "u"])?, number_of(inner, &["y", "v"])?]),
                value => number(value).map(|number| [number; 2]),
            },
        }
    };
    let each = |names: &[&[&str]; 2]| Some([number_of(object, names[0])?, number_of(object, names[1])?]);
    let only_x = || number_of(object, FOCAL[0]).map(|focal| [focal; 2]);
    let [fx, fy] = each(&FOCAL).or_else(|| pair(BOTH_FOCALS)).or_else(only_x)?;
    let [cx, cy] = each(&CENTRE).or_else(|| pair(BOTH_CENTRES))?;
    Some(pinhole(fx, fy, cx, cy))
}

/// A ROS camera: `K` (3 x 3) of the raw picture with `D`, `P` (3 x 4) of the rectified one unless it is all 0, with
/// binning and region of interest applied as image_geometry does. `P[3]` is `-fx * baseline` for the right camera of a
/// rig.
fn ros(object: &Object) -> Option<Result<CameraFile>> {
    let p =
        numbers(get(object, &["p", "projectionmatrix"])?).filter(|p| p.len() == 12 && p.iter().any(|&x| x != 0.0))?;
    let k =
        get(object, &["k", "cameramatrix"]).and_then(numbers).filter(|k| k.len() == 9 && k.iter().any(|&x| x != 0.0));
    Some(ros_camera(object, &p, k.as_deref()))
}

fn ros_camera(object: &Object, p: &[f64], k: Option<&[f64]>) -> Result<CameraFile> {
    let mut rectified = matrix(p)?;
    let baseline_m = -p[3] / p[0];
    if baseline_m > 0.0 && baseline_m.is_finite() {
        rectified.stereo = Some(Stereo { focal_px: p[0], baseline_m, doffs_px: 0.0 });
    }
    let Some(k) = k else { return Ok(rectified) };
    let raw = matrix(k)?;
    let coefficients = lens(object, &model_of(&[object])).unwrap_or_default();
    let is_bent = coefficients.iter().any(|&k| k != 0.0);
    let [a, b] = [raw.intrinsics, rectified.intrinsics].map(|c| [c.fx, c.fy, c.cx, c.cy]);
    if a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.01) {
        let stereo = rectified.stereo;
        return Ok(CameraFile { stereo, ..with_lens(raw, &model_of(&[object]), &coefficients, false)? });
    }
    // P is that of the rectified picture, as image_geometry takes it.
    let bent = with_lens(raw, &model_of(&[object]), &coefficients, false)?;
    rectified.otherwise = Some((bent.intrinsics, bent.distortion));
    rectified.rectified = true;
    let what = if is_bent { "P differs from K" } else { "P differs from K, without distortion" };
    Ok(rectified.note(format!(
        "{what}: the map is taken to be of the rectified picture, whose camera is P; --rectified=no takes K and D, for maps of the \
         raw picture"
    )))
}

/// Binning and region of interest, as image_geometry applies them to K and P.
fn binned(camera: &mut CameraFile, object: &Object) {
    let binning =
        [["binningx"], ["binningy"]].map(|names| number_of(object, &names).filter(|&b| b > 1.0).unwrap_or(1.0));
    let roi = get(object, &["roi"]).and_then(Value::as_object);
    let of_roi = |name: &str| roi.and_then(|roi| number_of(roi, &[name])).filter(|&n| n > 0.0);
    let offset = [of_roi("xoffset").unwrap_or(0.0), of_roi("yoffset").unwrap_or(0.0)];
    let (width, height) = (of_roi("width"), of_roi("height"));
    if binning == [1.0; 2] && offset == [0.0; 2] && width.is_none() {
        return;
    }
    let full = camera.size;
    let apply = |camera: &mut depthplanes::Intrinsics| {
        camera.cx = (camera.cx - offset[0]) / binning[0];
        camera.cy = (camera.cy - offset[1]) / binning[1];
        camera.fx /= binning[0];
        camera.fy /= binning[1];
    };
    apply(&mut camera.intrinsics);
    if let Some((other, _)) = &mut camera.otherwise {
        apply(other);
    }
    if let Some(rig) = &mut camera.stereo {
        rig.focal_px /= binning[0];
    }
    let side =
        |roi: Option<f64>, full: Option<usize>, binning: f64| Some((roi.or(full.map(|n| n as f64))? / binning).floor());
    camera.size =
        size(side(width, full.map(|size| size.0), binning[0]), side(height, full.map(|size| size.1), binning[1]));
    if camera.size != full {
        camera.notes.push("binning and region of interest (roi) are applied".into());
    }
}

/// With size, lens, unit, baseline and binning, each as near above the camera as it is stated. `key`: the name of the
/// matrix, beside which that of the lens stands; none if the lens is known.
fn complete(camera: CameraFile, object: &Object, above: &[&Object], key: Option<&str>) -> Result<CameraFile> {
    let centre = [camera.intrinsics.cx, camera.intrinsics.cy];
    let mut camera = camera.size(above.iter().rev().find_map(|object| size_of(object, centre)));
    let near: Vec<&Object> = above.iter().rev().copied().collect();
    for name in near.iter().take(2).flat_map(|object| models(object)) {
        refuse_no_pinhole(name)?;
    }
    if let Some(key) = key {
        let model = model_of(&near);
        let above = || near.get(1).and_then(|object| lens(object, &model));
        let coefficients = lens_beside(object, key, &model).or_else(above).unwrap_or_default();
        camera = with_lens(camera, &model, &coefficients, false)?;
    }
    binned(&mut camera, object);
    match near.iter().find_map(|object| unit_m(&entries(object))) {
        Some(Ok(unit_m)) => camera.unit_m = Some(unit_m),
        Some(Err(note)) => camera.notes.push(note),
        None => (),
    }
    if camera.stereo.is_none() {
        let baseline = number_of(object, &["baseline", "baselinem", "stereob"]).filter(|&b| b > 0.0 && b < 5.0);
        let focal_px = camera.intrinsics.fx.abs();
        camera.stereo = baseline.map(|baseline_m| Stereo { focal_px, baseline_m, doffs_px: 0.0 });
    }
    Ok(for_depth_size(camera, object))
}

/// The numbers of an object, for [`unit_m`].
fn entries(object: &Object) -> Vec<Entry<'_>> {
    object.iter().map(|(key, value)| (plain(key), key.as_str(), number(value))).collect()
}

/// Record3D states the size of the depth map, dw x dh, beside that of the picture, which the camera is for.
fn for_depth_size(camera: CameraFile, object: &Object) -> CameraFile {
    let depth = size(number_of(object, &["dw"]), number_of(object, &["dh"]));
    let (Some(own), Some(depth)) = (camera.size, depth) else { return camera };
    let scale = [depth.0 as f64 / own.0 as f64, depth.1 as f64 / own.1 as f64];
    if own == depth || (scale[0] / scale[1] - 1.0).abs() > 0.03 {
        return camera;
    }
    let note = format!(
        "the camera, stated for {} x {} pixels, is scaled to the depth map's {} x {} (dw, dh)",
        own.0, own.1, depth.0, depth.1
    );
    let mut scaled = CameraFile { size: Some(depth), ..camera.clone() }.note(note);
    let apply = |camera: &mut depthplanes::Intrinsics| {
        camera.fx *= scale[0];
        camera.fy *= scale[1];
        camera.cx = (camera.cx + 0.5) * scale[0] - 0.5;
        camera.cy = (camera.cy + 0.5) * scale[1] - 0.5;
    };
    apply(&mut scaled.intrinsics);
    if let Some((other, _)) = &mut scaled.otherwise {
        apply(other);
    }
    if let Some(rig) = &mut scaled.stereo {
        rig.focal_px *= scale[0];
    }
    CameraFile { choices: vec![camera.clone(), scaled], ..camera }
}

/// Columns and rows. Of a pair, of which programs write either first, the order that the principal point suits better.
fn size_of(object: &Object, [cx, cy]: [f64; 2]) -> Option<(usize, usize)> {
    let own = size(number_of(object, SIDES[0]), number_of(object, SIDES[1]));
    own.or_else(|| match get(object, BOTH_SIDES)? {
        Value::Object(inner) => size(number_of(inner, SIDES[0]), number_of(inner, SIDES[1])),
        value => {
            let pair = numbers(value)?;
            let [a, b] = [*pair.first()?, *pair.get(1)?];
            let off = |width: f64, height: f64| (2.0 * cx - width).abs() + (2.0 * cy - height).abs();
            if off(b, a) < off(a, b) { size(Some(b), Some(a)) } else { size(Some(a), Some(b)) }
        }
    })
}

/// The coefficients that belong to the matrix of a name: of several the ones whose name begins or ends as the matrix's.
fn lens_beside(object: &Object, key: &str, model: &str) -> Option<Vec<f64>> {
    let key = plain(key);
    let is_lens = |name: &str| {
        (name.contains("dist") && !name.contains("model")) || ["d", "d1", "d2", "dl", "dr"].contains(&name)
    };
    let all: Vec<(String, Vec<f64>)> = object
        .iter()
        .filter_map(|(name, value)| Some((plain(name), numbers(value)?)))
        .filter(|(name, numbers)| is_lens(name) && numbers.len() > 1)
        .collect();
    if all.len() < 2 {
        return all.into_iter().next().map(|(_, numbers)| numbers).or_else(|| lens(object, model));
    }
    let tail = |name: &str| name.chars().last().filter(|c| "12lrt".contains(*c));
    let same_end = all.iter().find(|(name, _)| tail(name).is_some() && tail(name) == tail(&key));
    let same_start = || all.iter().find(|(name, _)| name.get(..2) == key.get(..2));
    same_end.or_else(same_start).map(|(_, numbers)| numbers.clone())
}

/// The coefficients of a lens in OpenCV's order.
fn lens(object: &Object, model: &str) -> Option<Vec<f64>> {
    if let Some(numbers) = LENS.iter().find_map(|name| numbers(get(object, &[name])?)) {
        return Some(numbers);
    }
    if let Some(Value::Object(inner)) = get(object, LENS) {
        return lens(inner, model);
    }
    let names = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];
    let values = names.map(|name| number_of(object, &[name]));
    if values.iter().all(Option::is_none) {
        return None;
    }
    if super::camera::model(model) == Some(depthplanes::DistortionModel::KannalaBrandt) {
        // camodocal counts from k2, beside its `mu` and `mv`.
        if get(object, &["mu"]).is_some() {
            return Some([1, 4, 5, 6].map(|at| values[at].unwrap_or(0.0)).to_vec());
        }
        return Some([0, 1, 4, 5].map(|at| values[at].unwrap_or(0.0)).to_vec());
    }
    Some(values.map(|value| value.unwrap_or(0.0)).to_vec())
}

/// The names of models that an object states.
fn models(object: &Object) -> impl Iterator<Item = &str> {
    let is_model = |key: &str| MODELS.contains(&plain(key).as_str());
    let is_word = |text: &&str| !text.is_empty() && text.len() < 60 && words(text).is_none();
    object.iter().filter(move |(key, _)| is_model(key)).filter_map(|(_, value)| value.as_str()).filter(is_word)
}

/// The name of the model, as near as it is stated; empty if it is not.
fn model_of(near: &[&Object]) -> String {
    let is_on = |value: &Value| value.as_bool().unwrap_or_else(|| number(value) == Some(1.0));
    let is_fisheye = |object: &&Object| get(object, FISHEYE).is_some_and(is_on);
    if near.iter().take(2).any(is_fisheye) {
        return "fisheye".into();
    }
    let named = |object: &&Object| {
        MODELS.iter().find_map(|name| match get(object, &[name])? {
            Value::String(name) if words(name).is_none() && !name.is_empty() => Some(name.clone()),
            // RealSense's numbers of its models.
            Value::Number(number) if *name == "model" => Some(
                (*[
                    "none",
                    "modified brown conrady",
                    "inverse brown conrady",
                    "ftheta",
                    "brown conrady",
                    "kannala brandt",
                ]
                .get(number.as_f64()? as usize)?)
                .to_string(),
            ),
            _ => None,
        })
    };
    near.iter().take(2).find_map(named).unwrap_or_default()
}
