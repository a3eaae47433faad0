//! A small picture of a label image over its map, for reports.

use super::colour::palette;
use super::overlay::COLOUR_SHARE;
use super::picture::{Picture, blend};
use super::{OutputError, shade};
use crate::Frame;

/// A PNG of at most `width` columns: the map in grey, each label (1 and up) in a colour of its own. `labels` has an entry
/// for each pixel of the map, row by row.
///
/// # Errors
/// [`OutputError`] for a map that the library does not accept.
///
/// # Panics
/// If there are fewer labels than pixels.
pub fn tinted_png(frame: &Frame, labels: &[u16], width: usize) -> Result<Vec<u8>, OutputError> {
    let greys = shade::greys(frame)?;
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
    Ok(picture.png())
}
