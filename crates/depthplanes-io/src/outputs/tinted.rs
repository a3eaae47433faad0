//! Small pictures of label images over their map, one or several side by side, for reports.

use super::colour::{COLOUR_SHARE, palette};
use super::error::OutputError;
use super::picture::{Picture, blend};
use super::{font, shade};
use crate::frame::Frame;

/// A PNG of at most `width` columns: the map in grey, each label (1 and up) in a colour of its own. `labels` has an entry
/// for each pixel of the map, row by row. Pixels with a value and without a label are in the colour `rest`, if there is one.
///
/// # Errors
/// [`OutputError`] for a map that the library does not accept.
///
/// # Panics
/// If there are fewer labels than pixels.
pub fn tinted_png(frame: &Frame, labels: &[u16], rest: Option<[u8; 3]>, width: usize) -> Result<Vec<u8>, OutputError> {
    let mut greys = shade::greys(frame.view()?, frame.sensor.value_kind);
    if let Some(rest) = rest {
        let is_rest = |(grey, label): &(&mut [u8; 3], &u16)| **label == 0 && **grey != shade::MISSING;
        greys.iter_mut().zip(labels).filter(is_rest).for_each(|(grey, _)| *grey = rest);
    }
    Ok(tinted(frame, &greys, labels, width).png())
}

/// A picture of [`side_by_side`].
#[derive(Clone, Copy, Debug)]
pub struct Tile<'a> {
    /// What is written under it; digits and most small letters.
    pub caption: &'a str,
    /// A label for each pixel of the map, row by row; 0 stays grey.
    pub labels: &'a [u16],
}

/// Space between pictures, pixels.
const GAP: usize = 8;
/// Pictures in a row.
const IN_A_ROW: usize = 4;
/// Pixels of a font pixel's side.
const LETTER: usize = 2;

/// A PNG of several label images over one map, four to a row, each of at most `width` columns with its caption under it.
///
/// # Errors
/// [`OutputError`] for a map that the library does not accept.
///
/// # Panics
/// If a tile has fewer labels than the map has pixels.
pub fn side_by_side(frame: &Frame, tiles: &[Tile<'_>], width: usize) -> Result<Vec<u8>, OutputError> {
    let greys = shade::greys(frame.view()?, frame.sensor.value_kind);
    let pictures: Vec<Picture> = tiles.iter().map(|tile| tinted(frame, &greys, tile.labels, width)).collect();
    let (columns, rows) = pictures.first().map_or((0, 0), |picture| (picture.width, picture.height));
    let (step_u, step_v) = (columns + GAP, rows + GAP + (font::HEIGHT + 4) * LETTER);
    let size = [tiles.len().min(IN_A_ROW) * step_u + GAP, tiles.len().div_ceil(IN_A_ROW) * step_v + GAP];
    let mut whole = Picture::filled(size[0], size[1], [255; 3]);
    for (at, (picture, tile)) in pictures.iter().zip(tiles).enumerate() {
        let (u, v) = (GAP + at % IN_A_ROW * step_u, GAP + at / IN_A_ROW * step_v);
        whole.paste(picture, [u, v]);
        font::write(&mut whole, [u, v + rows + 2 * LETTER], LETTER, [0; 3], tile.caption);
    }
    Ok(whole.png())
}

fn tinted(frame: &Frame, greys: &[[u8; 3]], labels: &[u16], width: usize) -> Picture {
    let most = labels.iter().copied().max().unwrap_or(0);
    let palette = palette(usize::from(most));
    let step = frame.width.div_ceil(width.max(1)).max(1);
    let (columns, rows) = (frame.width.div_ceil(step), frame.height.div_ceil(step));
    let mut picture = Picture::filled(columns, rows, [0; 3]);
    for (at, pixel) in picture.pixels.iter_mut().enumerate() {
        let from = at / columns * step * frame.width + at % columns * step;
        *pixel = match labels[from] {
            0 => greys[from],
            label => blend(greys[from], palette[usize::from(label)], COLOUR_SHARE),
        };
    }
    picture
}
