//! A label image from a file: 0 where there is no plane, otherwise the plane's label.
//!
//! Any input format will do, since a label image is a map of whole numbers; there is no encoding,
//! for labels have no unit.

use std::path::Path;

use crate::error::{Error, Result};
use crate::file_bytes::read_known;
use crate::formats::{self, DecodeOptions};
use crate::frame::Pixels;

/// A label image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` labels, row by row, top row first; 0 = no plane.
    pub labels: Vec<u16>,
    /// What a person should know of this file: channels dropped, negative labels taken as 0.
    pub warnings: Vec<String>,
}

const ACCEPTED: &str = "a label image: one channel of whole numbers from 0 (no plane) to 65535, such as a PNG of 8 or 16 \
     bits, a NumPy array of integers, or what `detect --labels` writes";

/// Reads a label image from a file.
///
/// # Errors
/// [`Error::Io`], and those of [`decode_labels`].
pub fn read_labels(path: impl AsRef<Path>, options: &DecodeOptions) -> Result<LabelImage> {
    let path = path.as_ref();
    let bytes = read_known(path, options.limits.max_bytes, &|first| formats::ends(first, options))?;
    decode_labels(&bytes, &path.display().to_string(), options)
}

/// Reads a label image from bytes; `name` is for messages only.
///
/// # Errors
/// [`Error::In`] around [`Error::Unreadable`] (also for floating-point numbers and for labels above
/// 65535), [`Error::Limit`] or [`Error::Parameter`]; never a panic, whatever the bytes.
///
/// ```
/// use depthplanes_io::labels::decode_labels;
/// let image = decode_labels(b"P2 3 1 255 0 7 1", "doc.pgm", &Default::default())?;
/// assert_eq!((image.width, image.labels), (3, vec![0, 7, 1]));
/// # Ok::<(), depthplanes_io::Error>(())
/// ```
pub fn decode_labels(bytes: &[u8], name: &str, options: &DecodeOptions) -> Result<LabelImage> {
    decode_unnamed(bytes, options).map_err(|error| error.in_file(name))
}

fn decode_unnamed(bytes: &[u8], options: &DecodeOptions) -> Result<LabelImage> {
    let (image, format) = formats::decode(bytes, options).map_err(as_labels)?;
    let labels = match image.pixels {
        Pixels::U8(labels) => labels.into_iter().map(u16::from).collect(),
        Pixels::U16(labels) => labels,
        Pixels::F32(_) => {
            let what = if image.sample.starts_with("float") { "floating-point numbers" } else { "labels above 65535" };
            let wrong = format!("it holds {what} ({})", image.sample);
            return Err(Error::Unreadable { format: format.name, wrong, accepted: ACCEPTED });
        }
    };
    Ok(LabelImage { width: image.width, height: image.height, labels, warnings: image.warnings })
}

/// The readers' advice is on depth maps.
fn as_labels(error: Error) -> Error {
    match error {
        Error::Unreadable { format, wrong, .. } => Error::Unreadable { format, wrong, accepted: ACCEPTED },
        error => error,
    }
}
