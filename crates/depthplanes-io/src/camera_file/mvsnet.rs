//! MVSNet's cam.txt: `extrinsic` with a 4 x 4 matrix, `intrinsic` with a 3 x 3 one, and the range of depth.

use super::camera::{CameraFile, matrix, unreadable};
use super::form::Document;
use super::names::words;
use crate::error::Result;

fn after<'a>(text: &'a str, title: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines().map(str::trim).skip_while(move |line| !line.eq_ignore_ascii_case(title)).skip(1)
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    ["extrinsic", "intrinsic"].iter().all(|title| after(document.text, title).next().is_some())
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let rows = after(document.text, "intrinsic").filter(|line| !line.is_empty()).take(3);
    let rows: Option<Vec<Vec<f64>>> = rows.map(|row| words(row).filter(|row| row.len() == 3)).collect();
    let rows =
        rows.filter(|rows| rows.len() == 3).ok_or_else(|| unreadable("no 3 x 3 matrix stands below `intrinsic`"))?;
    matrix(&rows.concat())
}
