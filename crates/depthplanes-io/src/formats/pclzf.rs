//! PCLZF depth frames of the Point Cloud Library's grabbers.
//!
//! In: `PCLZF`, `u32` columns and rows, a 16-byte type name, `u32` packed and unpacked bytes, then
//! LZF. Out: `u16` values, millimetres by PCL's custom (the `.xml` beside the file states the
//! factor). Only the type `depth16` is a map; `rgb24` and the others are refused.

use super::bytes::Cursor;
use super::format::{DecodeOptions, Format, Image};
use super::lzf;
use super::samples::{Sample, pixels};
use crate::error::{Error, Result};

pub(super) const FORMAT: Format = Format {
    name: "pclzf",
    about: "PCLZF depth frame (Point Cloud Library)",
    extensions: &["pclzf"],
    sniff: |bytes| bytes.starts_with(b"PCLZF"),
    ends: |_, _| None,
    decode,
};

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "a PCLZF file of type `depth16`";
    Error::Unreadable { format: "pclzf", wrong: wrong.into(), accepted }
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let short = || unreadable(format!("cut off after {} bytes", bytes.len()));
    let mut cursor = Cursor::new(bytes, 5);
    let (width, height) = (cursor.u32().ok_or_else(short)?, cursor.u32().ok_or_else(short)?);
    let kind = String::from_utf8_lossy(cursor.take(16).ok_or_else(short)?).trim_end_matches(['\0', ' ']).to_string();
    if kind != "depth16" {
        return Err(unreadable(format!("its type is `{}`", kind.escape_default())));
    }
    let (packed, unpacked) = (cursor.u32().ok_or_else(short)? as usize, cursor.u32().ok_or_else(short)? as usize);
    let area = options.limits.area("pclzf", width.into(), height.into(), 2)?;
    if unpacked != 2 * area {
        return Err(unreadable(format!("{width} x {height} pixels need {} bytes, {unpacked} are packed", 2 * area)));
    }
    let data = cursor.take(packed).ok_or_else(short)?;
    let samples = lzf::decompress(data, unpacked).ok_or_else(|| unreadable("the packed data are damaged"))?;
    let pixels = pixels(&samples, Sample::U16, false, &mut Vec::new());
    Ok(Image::new(width as usize, height as usize, pixels, "uint16", Vec::new()))
}
