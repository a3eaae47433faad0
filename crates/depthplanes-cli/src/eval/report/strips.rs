//! Picture strips of a report: the map, the truth and each method's planes side by side.

use super::super::datasets::Item;
use super::super::rows::Row;
use super::numbers::found;
use crate::failure::Outcome;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::outputs::tinted_png;
use depthplanes_io::read_labels;
use std::path::Path;

/// Columns of a picture.
const WIDTH: usize = 240;

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

/// A strip for each map; `rest` is the colour of what has a value but no plane, the map's grey if there is none.
///
/// # Errors
/// A map or a label image that cannot be read any more.
pub(in super::super) fn of_maps<'a>(
    folder: &Path,
    rows: &[&Row],
    items: impl Iterator<Item = &'a Item>,
    rest: Option<[u8; 3]>,
) -> Outcome<Vec<Strip>> {
    items.map(|item| strip(folder, rows, item, rest)).collect()
}

fn strip(folder: &Path, rows: &[&Row], item: &Item, rest: Option<[u8; 3]>) -> Outcome<Strip> {
    let frame = (item.frame)()?;
    let none = vec![0; frame.width * frame.height];
    let mut pictures = vec![Picture { caption: "map".into(), png: tinted_png(&frame, &none, None, WIDTH)? }];
    if let Some(truth) = &item.truth {
        let truth = truth()?;
        let planes: Vec<u16> =
            truth.labels.labels.iter().map(|&label| if label < truth.from { 0 } else { label }).collect();
        pictures.push(Picture { caption: "truth".into(), png: tinted_png(&frame, &planes, rest, WIDTH)? });
    }
    for row in rows.iter().filter(|row| row.key.dataset == item.dataset && row.key.map == item.name) {
        let Some(found) = found(row) else { continue };
        let labels = read_labels(folder.join(&found.labels), &DecodeOptions::default())?;
        let planes = if found.planes == 1 { "plane" } else { "planes" };
        let caption = format!("{}: {} {planes}", row.key.label, found.planes);
        pictures.push(Picture { caption, png: tinted_png(&frame, &labels.labels, rest, WIDTH)? });
    }
    Ok(Strip { title: item.name.clone(), pictures })
}
