//! Pictures that are stored turned or mirrored, as a tag of theirs says (TIFF 6.0, tag 274 "Orientation"; Exif has the same).
//!
//! In: an [`Image`] as stored. Out: the same as it is to be seen, with a note.

use super::format::Image;
use crate::error::{Error, Result};
use crate::frame::Pixels;

/// What is done with the stored picture, by the tag's number from 1.
const SEEN: [&str; 8] = [
    "as it is stored",
    "mirrored left to right",
    "turned by 180 degrees",
    "mirrored top to bottom",
    "seen with rows and columns exchanged",
    "turned by 90 degrees clockwise",
    "turned by 180 degrees, and rows and columns are exchanged",
    "turned by 90 degrees counterclockwise",
];

/// Turns an image as its tag says; 0 and 1 are as stored.
///
/// # Errors
/// [`Error::Unreadable`] for a number that the standard does not have.
pub(super) fn orient(format: &'static str, image: &mut Image, tag: u16) -> Result<()> {
    if tag < 2 {
        return Ok(());
    }
    let Some(seen) = SEEN.get(usize::from(tag) - 1) else {
        let accepted = "an orientation (tag 274) of 1 to 8; remove the tag if the rows are stored from the top";
        return Err(Error::Unreadable { format, wrong: format!("its orientation is {tag}"), accepted });
    };
    let (width, height) = (image.width, image.height);
    let (columns, rows) = if tag >= 5 { (height, width) } else { (width, height) };
    // The place in the file of a pixel that is seen.
    let source = |at: usize| {
        let (u, v) = (at % columns, at / columns);
        let (u, v) = match tag {
            2 => (width - 1 - u, v),
            3 => (width - 1 - u, height - 1 - v),
            4 => (u, height - 1 - v),
            5 => (v, u),
            6 => (v, height - 1 - u),
            7 => (width - 1 - v, height - 1 - u),
            _ => (width - 1 - v, u),
        };
        v * width + u
    };
    let channels = image.channels;
    match &mut image.pixels {
        Pixels::U8(values) => *values = moved(values, channels, source),
        Pixels::U16(values) => *values = moved(values, channels, source),
        Pixels::F32(values) => *values = moved(values, channels, source),
    }
    (image.width, image.height) = (columns, rows);
    image.warnings.push(format!(
        "the picture is {seen}, as its orientation says ({tag}); a camera has to be that of the picture as it is seen, \
         {columns} x {rows}"
    ));
    Ok(())
}

fn moved<T: Copy>(values: &[T], channels: usize, source: impl Fn(usize) -> usize) -> Vec<T> {
    (0..values.len() / channels).flat_map(|at| &values[source(at) * channels..][..channels]).copied().collect()
}

/// The orientation in Exif data, which are a TIFF file without pictures; 1 if there is none.
pub(super) fn of_exif(exif: &[u8]) -> u16 {
    let find = || {
        let little = match exif.get(..2)? {
            b"II" => true,
            b"MM" => false,
            _ => return None,
        };
        let two = |at: usize| {
            let bytes = exif.get(at..at.checked_add(2)?)?.try_into().ok()?;
            Some(if little { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) })
        };
        let (first, second) = (usize::from(two(4)?), usize::from(two(6)?));
        let at = if little { second << 16 | first } else { first << 16 | second };
        let mut entries = (0..usize::from(two(at)?)).map(|entry| at + 2 + 12 * entry);
        entries.find(|&entry| two(entry) == Some(274)).and_then(|entry| two(entry + 8))
    };
    find().unwrap_or(1)
}
