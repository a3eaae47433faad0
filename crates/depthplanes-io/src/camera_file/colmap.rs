//! COLMAP's cameras.txt: a line for each camera. Its pixel centres are at 0.5.

use super::camera::{CameraFile, pinhole, size, unreadable, with_lens};
use super::form::Document;
use crate::error::Result;

fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    let rows = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    rows.map(|line| line.split_whitespace().collect())
}

fn is_row(row: &[&str]) -> bool {
    let is_model = |name: &str| name.len() > 2 && name.chars().all(|c| c.is_ascii_uppercase() || c == '_');
    row.len() >= 7
        && row[0].parse::<u64>().is_ok()
        && is_model(row[1])
        && row[2..].iter().all(|word| word.parse::<f64>().is_ok())
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    rows(document.text).next().is_some_and(|row| is_row(&row))
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let cameras = rows(document.text).map(|row| camera(&row)).collect::<Result<Vec<_>>>()?;
    let mut distinct: Vec<CameraFile> = Vec::new();
    for camera in cameras {
        let is_known = |other: &CameraFile| other.intrinsics == camera.intrinsics && other.size == camera.size;
        if distinct.len() < 1000 && !distinct.iter().any(is_known) {
            distinct.push(camera);
        }
    }
    if distinct.len() > 1 {
        let all: Vec<String> = distinct.iter().map(|camera| camera.name.clone()).collect();
        for camera in &mut distinct {
            let same_size = all.len();
            camera.notes.push(format!("of {same_size} cameras that differ, {} is taken", camera.name));
        }
    }
    CameraFile::first_of(distinct)
}

fn camera(row: &[&str]) -> Result<CameraFile> {
    if !is_row(row) {
        return Err(unreadable(format!("the line `{}` is no camera of COLMAP", row.join(" "))));
    }
    let numbers: Vec<f64> = row[2..].iter().filter_map(|word| word.parse().ok()).collect();
    let (model, params) = (row[1], &numbers[2..]);
    // Parameters, of which the first are f or fx and fy, then cx and cy, then those of the lens in OpenCV's order.
    let (focals, name, lens): (usize, &str, &[usize]) = match model {
        "SIMPLE_PINHOLE" => (1, "", &[]),
        "PINHOLE" => (2, "", &[]),
        "SIMPLE_RADIAL" => (1, "", &[0]),
        "RADIAL" => (1, "", &[0, 1]),
        "OPENCV" => (2, "", &[0, 1, 2, 3]),
        "FULL_OPENCV" => (2, "", &[0, 1, 2, 3, 4, 5, 6, 7]),
        "OPENCV_FISHEYE" => (2, "fisheye", &[0, 1, 2, 3]),
        "SIMPLE_RADIAL_FISHEYE" => (1, "fisheye", &[0]),
        "RADIAL_FISHEYE" => (1, "fisheye", &[0, 1]),
        _ => {
            return Err(unreadable(format!(
                "the camera model {model} of COLMAP is not known here; undistort the pictures"
            )));
        }
    };
    if params.len() != focals + 2 + lens.len() {
        let right = focals + 2 + lens.len();
        return Err(unreadable(format!("{} parameters of {model}, {right} are expected", params.len())));
    }
    let (fx, fy, centre) = (params[0], params[focals - 1], &params[focals..]);
    let camera = pinhole(fx, fy, centre[0] - 0.5, centre[1] - 0.5)?;
    let coefficients: Vec<f64> = lens.iter().map(|&at| centre[2 + at]).collect();
    let camera = with_lens(camera, name, &coefficients, false)?;
    Ok(camera.named(format!("camera {}", row[0])).size(size(Some(numbers[0]), Some(numbers[1]))))
}
