//! camera_calibration's ost.txt, as the tree of the ost.yaml beside it.

use serde_json::{Map, Value};

use super::camera::{CameraFile, unreadable};
use super::form::Document;
use super::names::{plain, words};
use super::tree;
use crate::error::Result;

/// Its titles, and the names of ROS.
const TITLES: [(&str, &str); 5] = [
    ("width", "image_width"),
    ("height", "image_height"),
    ("cameramatrix", "camera_matrix"),
    ("distortion", "distortion_coefficients"),
    ("projection", "projection_matrix"),
];

/// The first camera: a title alone on its line, and numbers below.
fn fields(text: &str) -> Map<String, Value> {
    let mut all = Map::new();
    let mut title = String::new();
    let mut numbers: Vec<f64> = Vec::new();
    let mut put = |title: &str, numbers: &[f64]| {
        if let (Some((_, name)), false) = (TITLES.iter().find(|(known, _)| *known == title), numbers.is_empty()) {
            let value = if let [one] = numbers { Value::from(*one) } else { Value::from(numbers.to_vec()) };
            all.entry(name.to_string()).or_insert(value);
        }
    };
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
        match words(line) {
            Some(row) if !line.starts_with('[') => numbers.extend(row),
            _ => {
                put(&title, &numbers);
                title = plain(line);
                numbers.clear();
            }
        }
    }
    put(&title, &numbers);
    all
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    let has = |title: &str| document.text.lines().any(|line| line.trim().eq_ignore_ascii_case(title));
    has("camera matrix") && (has("[image]") || has("distortion"))
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let fields = fields(document.text);
    if !fields.contains_key("camera_matrix") {
        return Err(unreadable("there are no numbers below `camera matrix`"));
    }
    tree::parse(&Value::Object(fields))
}
