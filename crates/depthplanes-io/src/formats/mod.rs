//! Input formats: bytes in, one [`Image`] out.
//!
//! A format is recognised by its content, never by its extension, and knows nothing of units: what
//! the numbers mean is the encoding's business ([`crate::encoding`]). Every reader checks what a
//! header promises against the bytes that are there before it allocates, so a short file cannot
//! ask for much memory; [`Limits`] bounds the honest giants.
//!
//! A new format is one file here and one row of [`FORMATS`].

mod bmp;
mod bytes;
mod channels;
mod cloud;
mod compressed_depth;
#[cfg(feature = "exr")]
mod exr;
mod format;
mod lzf;
mod npy;
mod npz;
mod orientation;
mod pcd;
mod pclzf;
mod pfm;
mod png;
mod pnm;
mod raw;
pub mod rvl;
mod samples;
mod spread;
#[cfg(feature = "tiff")]
mod tiff;
mod unsupported;

pub use compressed_depth::{inverse_depth_value_kind, quantised_inverse_depth};
pub use format::{DecodeOptions, Format, Image, Limits};
pub(crate) use raw::image_of;
pub use raw::{raw_bytes, raw_types};
pub(crate) use spread::bytes as bytes_of_channels;
pub use unsupported::left_out;

use crate::error::{Error, Result};

/// All input formats, in the order in which they are tried; the weakest signature comes last.
pub const FORMATS: &[Format] = &[
    png::FORMAT,
    compressed_depth::FORMAT,
    bmp::FORMAT,
    pnm::FORMAT,
    pfm::FORMAT,
    npy::FORMAT,
    npz::FORMAT,
    #[cfg(feature = "tiff")]
    tiff::FORMAT,
    #[cfg(feature = "exr")]
    exr::FORMAT,
    pcd::FORMAT,
    pclzf::FORMAT,
    rvl::FORMAT,
    raw::FORMAT,
];

/// The format of some bytes, by their content.
///
/// # Errors
/// [`Error::Unreadable`] that says what the bytes look like and what is accepted.
pub fn sniff(bytes: &[u8]) -> Result<&'static Format> {
    FORMATS.iter().find(|format| (format.sniff)(bytes)).ok_or_else(|| unsupported::explain(bytes))
}

/// Where a map that begins so ends at the latest, of which more may come; none if that cannot be known yet.
///
/// # Errors
/// As [`sniff`], for bytes that no map begins with.
pub(crate) fn ends(first: &[u8], options: &DecodeOptions) -> Result<Option<u64>> {
    if options.raw_size.is_some() {
        return Ok((raw::FORMAT.ends)(first, options));
    }
    if rvl::begins(first) {
        return Ok(None);
    }
    Ok((sniff(first)?.ends)(first, options))
}

/// Reads a map of whatever format, or headerless samples if their size is stated.
///
/// # Errors
/// [`Error::Unreadable`], [`Error::Limit`] or [`Error::Parameter`]; never a panic, whatever the bytes.
pub fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<(Image, &'static Format)> {
    if bytes.len() > options.limits.max_bytes {
        let (given, limit) = (bytes.len() as u64, options.limits.max_bytes as u64);
        return Err(Error::Limit { what: "size of the file in bytes", given, limit });
    }
    let Some((width, height)) = options.raw_size else {
        let format = sniff(bytes)?;
        return Ok(((format.decode)(bytes, options)?, format));
    };
    // RVL has no signature that samples could not have.
    let other = sniff(bytes).ok().filter(|format| format.name != rvl::FORMAT.name);
    match ((raw::FORMAT.decode)(bytes, options), other) {
        (Ok(image), _) => Ok((image, &raw::FORMAT)),
        (Err(_), Some(format)) => {
            let accepted = format!("no size: the file is {}, which states its own; leave --raw-size out", format.name);
            Err(Error::parameter("--raw-size", format_args!("{width}x{height}"), accepted))
        }
        (Err(error), None) => Err(error),
    }
}
