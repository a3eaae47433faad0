//! Matlab: what its `cameraParameters` and `cameraIntrinsics` show, whose pixel centres begin at 1; and the Calib_Results.m of
//! Bouguet's toolbox, whose pixel centres begin at 0.

use serde_json::{Map, Value};

use super::camera::{CameraFile, matrix, pinhole, size, unreadable, with_lens};
use super::form::Document;
use super::lines;
use super::names::{get, numbers, plain, words};
use crate::error::Result;

const COUNTS_FROM_1: &str = "pixels of Matlab are counted from 1: 1 is taken off the principal point";

fn shown(value: &Value) -> Option<&Map<String, Value>> {
    let object = value.as_object()?;
    let has = |name: &str| get(object, &[name]).and_then(numbers).is_some();
    let is_shown = has("focallength") && has("principalpoint") && (has("radialdistortion") || has("imagesize"));
    // Matlab's names have capitals.
    let has_capitals = object.contains_key("FocalLength");
    if is_shown && has_capitals { Some(object) } else { object.values().find_map(shown) }
}

/// The rows below or behind `IntrinsicMatrix`, which Matlab keeps turned.
fn turned(text: &str) -> Option<Vec<f64>> {
    let at = text.find("IntrinsicMatrix")?;
    let rest = &text[at + "IntrinsicMatrix".len()..];
    let rest = rest.replace("ans", " ").replace(['=', ':', '"', '\''], " ");
    let mut all = Vec::new();
    for line in rest.lines() {
        all.extend(words(line)?);
        if all.len() >= 9 {
            break;
        }
    }
    let m = <[f64; 9]>::try_from(all).ok()?;
    ([m[2], m[5]] == [0.0; 2] && m[8] == 1.0).then(|| m.to_vec())
}

/// What Matlab shows has its names at the right, so that it is no YAML.
fn is_printed(text: &str) -> bool {
    let has = |name: &str| lines::numbers(text, name).is_some_and(|numbers| numbers.len() == 2);
    text.contains("FocalLength:") && has("focallength") && has("principalpoint")
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    turned(document.text).is_some() || is_printed(document.text) || document.tree().and_then(shown).is_some()
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let object = document.tree().and_then(shown);
    let of = |name: &str| {
        let stated = object.and_then(|object| get(object, &[name])).and_then(numbers);
        stated.or_else(|| lines::numbers(document.text, name)).unwrap_or_default()
    };
    let mut camera = match (turned(document.text), &of("focallength")[..], &of("principalpoint")[..]) {
        (Some(m), ..) => matrix(&m)?,
        (None, &[fx, fy], &[cx, cy]) => pinhole(fx, fy, cx, cy)?,
        _ => return Err(unreadable("FocalLength and PrincipalPoint are not two numbers each")),
    };
    camera.intrinsics.cx -= 1.0;
    camera.intrinsics.cy -= 1.0;
    if let [rows, columns] = of("imagesize")[..] {
        camera.size = size(Some(columns), Some(rows));
    }
    let (radial, tangential) = (of("radialdistortion"), of("tangentialdistortion"));
    let at = |all: &[f64], at: usize| all.get(at).copied().unwrap_or(0.0);
    let coefficients = [at(&radial, 0), at(&radial, 1), at(&tangential, 0), at(&tangential, 1), at(&radial, 2)];
    Ok(with_lens(camera, "", &coefficients, false)?.note(COUNTS_FROM_1))
}

fn bouguet(document: &Document<'_>, name: &str) -> Option<Vec<f64>> {
    let of = |line: &str| {
        let (key, value) = line.split_once('=')?;
        (plain(key) == name).then(|| words(value.split('%').next().unwrap_or("")))?
    };
    document.text.lines().find_map(of)
}

pub(super) fn recognise_bouguet(document: &Document<'_>) -> bool {
    ["fc", "cc"].iter().all(|name| bouguet(document, name).is_some_and(|numbers| numbers.len() == 2))
}

pub(super) fn parse_bouguet(document: &Document<'_>) -> Result<CameraFile> {
    let of = |name: &str| bouguet(document, name).unwrap_or_default();
    let (&[fx, fy], &[cx, cy]) = (&of("fc")[..], &of("cc")[..]) else { return Err(unreadable("it has no fc and cc")) };
    let camera = with_lens(pinhole(fx, fy, cx, cy)?, "", &of("kc"), false)?;
    let side = |name: &str| lines::number(document.text, name).or_else(|| of(name).first().copied());
    Ok(camera.size(size(side("nx"), side("ny"))))
}
