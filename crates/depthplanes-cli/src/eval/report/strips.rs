//! Picture strips of a report: the map, the truth and each method's planes side by side.

use super::super::datasets::Item;
use super::super::rows::Row;
use super::found;
use crate::failure::Outcome;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::outputs::tinted_png;
use depthplanes_io::read_labels;
use std::path::Path;

/// Columns of a picture.
const WIDTH: usize = 240;
/// Strips of a set.
const MOST: usize = 4;

/// A map's pictures.
pub(in super::super) struct Strip {
    pub(super) title: String,
    pub(super) pictures: Vec<Picture>,
}

/// A picture, as PNG.
pub(super) struct Picture {
    pub(super) caption: String,
    pub(super) png: Vec<u8>,
}

/// The strips of the first maps of a set.
///
/// # Errors
/// A map or a label image that cannot be read any more.
pub(in super::super) fn of_maps(folder: &Path, rows: &[&Row], items: &[&Item]) -> Outcome<Vec<Strip>> {
    let with = |has_truth: bool| items.iter().filter(move |item| item.truth.is_some() == has_truth);
    // Those with a truth say more.
    with(true).chain(with(false)).take(MOST).map(|item| strip(folder, rows, item)).collect()
}

fn strip(folder: &Path, rows: &[&Row], item: &Item) -> Outcome<Strip> {
    let frame = (item.frame)()?;
    let none = vec![0; frame.width * frame.height];
    let mut pictures = vec![Picture { caption: "map".into(), png: tinted_png(&frame, &none, WIDTH)? }];
    if let Some(truth) = &item.truth {
        let truth = truth()?;
        let planes: Vec<u16> =
            truth.labels.labels.iter().map(|&label| if label < truth.from { 0 } else { label }).collect();
        pictures.push(Picture { caption: "truth".into(), png: tinted_png(&frame, &planes, WIDTH)? });
    }
    for row in rows.iter().filter(|row| row.key.dataset == item.dataset && row.key.map == item.name) {
        let Some(found) = found(row) else { continue };
        let labels = read_labels(folder.join(&found.labels), &DecodeOptions::default())?;
        let caption = format!("{}: {} planes", row.key.label, found.planes);
        pictures.push(Picture { caption, png: tinted_png(&frame, &labels.labels, WIDTH)? });
    }
    Ok(Strip { title: item.name.clone(), pictures })
}
