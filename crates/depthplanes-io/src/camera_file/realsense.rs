//! RealSense: what its viewer writes beside a picture (CSV), and what `rs-enumerate-devices -c` prints.

use super::camera::{CameraFile, pinhole, size, unreadable, with_lens};
use super::form::Document;
use super::lines::{number, numbers, pairs};
use super::names::words;
use crate::error::Result;

pub(super) fn recognise(document: &Document<'_>) -> bool {
    ["fx", "fy", "ppx", "ppy"].iter().all(|name| number(document.text, name).is_some())
}

/// One block of lines, or a block for each stream and size: those of depth are taken.
pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let blocks = blocks(document.text);
    let depth: Vec<&String> = blocks.iter().filter(|block| is_depth(block)).collect();
    if blocks.len() == 1 {
        return camera(&blocks[0]);
    }
    if depth.is_empty() {
        return Err(unreadable(format!(
            "of {} cameras none is of depth; give that of the map with --intrinsics",
            blocks.len()
        )));
    }
    CameraFile::first_of(depth.into_iter().map(|block| camera(block)).collect::<Result<Vec<_>>>()?)
}

fn is_depth(block: &str) -> bool {
    block.lines().next().is_some_and(|title| title.to_lowercase().contains("\"depth\""))
}

/// The text from one `Intrinsic of "Depth" / 640x480 / {Z16}` to the next; all of it if there is none.
fn blocks(text: &str) -> Vec<String> {
    let is_title = |line: &str| line.trim_start().to_lowercase().starts_with("intrinsic of");
    let mut all: Vec<String> = Vec::new();
    for line in text.lines() {
        if is_title(line) {
            all.push(String::new());
        }
        if let Some(last) = all.last_mut() {
            last.push_str(line);
            last.push('\n');
        }
    }
    all.retain(|block| number(block, "fx").is_some());
    if all.is_empty() { vec![text.to_string()] } else { all }
}

fn camera(block: &str) -> Result<CameraFile> {
    let of = |name: &str| number(block, name).ok_or_else(|| unreadable(format!("it has no {name}")));
    let camera = pinhole(of("fx")?, of("fy")?, of("ppx")?, of("ppy")?)?;
    let side = |names: [&str; 2]| names.iter().find_map(|name| number(block, name));
    let camera = camera.size(size(side(["width", "resolutionx"]), side(["height", "resolutiony"])));
    let text = |name: &str| pairs(block).find(|(key, _)| key == name).map(|(_, value)| value);
    let model = text("distorsion").or(text("distortion")).or(text("model")).unwrap_or("");
    let coefficients = numbers(block, "coeffs").or(numbers(block, "coefficients")).unwrap_or_default();
    with_lens(camera, model, &coefficients, false)
}

/// What Python prints of intrinsics: `[ 640x480  p[319.5 239.5]  f[525 525]  Brown Conrady [0 0 0 0 0] ]`: the
/// numbers before the model, the model, and its coefficients.
fn printed(text: &str) -> Option<(Vec<f64>, &str, Vec<f64>)> {
    let start = text.find("[ ")?;
    let (sides, rest) = text[start + 2..].trim_start().split_once("p[")?;
    let (centre, rest) = rest.split_once(']')?;
    let (focals, rest) = rest.trim_start().strip_prefix("f[")?.split_once(']')?;
    let (model, rest) = rest.split_once('[')?;
    let (coefficients, _) = rest.split_once(']')?;
    let numbers = words(&format!("{} {centre} {focals}", sides.replace('x', " ")))?;
    Some((numbers, model.trim(), words(coefficients)?))
}

pub(super) fn recognise_printed(document: &Document<'_>) -> bool {
    printed(document.text).is_some()
}

pub(super) fn parse_printed(document: &Document<'_>) -> Result<CameraFile> {
    let Some((numbers, model, coefficients)) = printed(document.text) else {
        return Err(unreadable("it is not what Python prints of RealSense's intrinsics"));
    };
    let &[width, height, cx, cy, fx, fy] = &numbers[..] else {
        return Err(unreadable("size, p[] and f[] are not two numbers each"));
    };
    let camera = pinhole(fx, fy, cx, cy)?.size(size(Some(width), Some(height)));
    with_lens(camera, model, &coefficients, false)
}
