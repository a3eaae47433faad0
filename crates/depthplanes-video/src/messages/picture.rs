//! A picture of a message becomes a frame.

use super::content::Content;
use crate::error::{Error, Result, short};
use depthplanes_io::{Frame, ReadOptions, decode};
use std::borrow::Cow;

/// How pixels of an encoding are read.
struct Form {
    /// Its name in ROS and Foxglove.
    name: &'static str,
    /// Types of samples, little-endian and big-endian.
    samples: [&'static str; 2],
    bytes: u32,
    /// What the numbers mean, if the encoding says it.
    encoding: Option<&'static str>,
    /// Whether it is taken for depth without being asked for.
    is_depth: bool,
}

const U16: Form =
    Form { name: "16UC1", samples: ["uint16", "uint16-be"], bytes: 2, encoding: Some("millimetre"), is_depth: true };

/// Encodings of raw pictures (REP 118 for the first and the third).
const FORMS: [Form; 5] = [
    U16,
    Form { name: "mono16", ..U16 },
    Form { name: "32FC1", samples: ["float32", "float32-be"], bytes: 4, encoding: Some("metre"), ..U16 },
    Form { name: "8UC1", samples: ["uint8"; 2], bytes: 1, encoding: None, is_depth: false },
    Form { name: "mono8", samples: ["uint8"; 2], bytes: 1, encoding: None, is_depth: false },
];

/// What a picture is called where its pixels may be depth; none for colours.
pub(crate) fn depth_form(content: &Content<'_>) -> Option<String> {
    match content {
        Content::Raw { encoding, .. } => {
            FORMS.iter().find(|form| form.is_depth && form.name == encoding).map(|form| form.name.into())
        }
        Content::Packed { format, .. } if is_packed_depth(format) => Some(format.clone()),
        _ => None,
    }
}

/// `16UC1; compressedDepth png` and the like, and `16UC1; png compressed`.
fn is_packed_depth(format: &str) -> bool {
    let is_depth = format.contains("16UC1") || format.contains("32FC1") || format.contains("mono16");
    format.contains("compressedDepth") || is_depth && format.contains("png")
}

/// The frame of a picture; `name` is for messages only. What the user states counts before what the message says.
pub(crate) fn frame(content: &Content<'_>, name: &str, options: &ReadOptions) -> Result<Frame> {
    let mut options = options.clone();
    let stated = options.encoding.is_some() || options.preset.is_some();
    let mut state = |encoding: Option<&str>| {
        if !stated {
            options.encoding = encoding.map(str::to_string);
        }
    };
    let bytes = match content {
        Content::Raw { width, height, step, encoding, is_big_endian, data } => {
            let form = FORMS.iter().find(|form| form.name == encoding).ok_or_else(|| {
                let names: Vec<_> = FORMS.iter().map(|form| form.name).collect();
                Error::source(name, format!("a picture in `{}`", short(encoding)), names.join(", "))
            })?;
            state(form.encoding);
            options.decode.raw_size = Some((*width as usize, *height as usize));
            options.decode.raw_type = Some(form.samples[usize::from(*is_big_endian)].into());
            rows(data, *width, *height, *step, form.bytes).map_err(|wrong| {
                let accepted = "rows of `step` bytes, as many as the height says";
                Error::source(name, wrong, accepted)
            })?
        }
        Content::Packed { format, data } => {
            state(match () {
                () if format.contains("16UC1") => Some("millimetre"),
                // Quantised as the payload's header says.
                () if format.contains("32FC1") && format.contains("compressedDepth") => Some("compressed-depth"),
                () => None,
            });
            (options.decode.raw_size, options.decode.raw_type) = (None, None);
            Cow::Borrowed(&data[..])
        }
        Content::Camera(_) | Content::Imu(_) | Content::Transforms(_) => {
            return Err(Error::source(name, "no picture", "a picture"));
        }
    };
    Ok(decode(&bytes, name, &options)?)
}

/// The rows without what stands between them.
fn rows(data: &[u8], width: u32, height: u32, step: u32, bytes: u32) -> std::result::Result<Cow<'_, [u8]>, String> {
    let [row, step, height] = [u64::from(width) * u64::from(bytes), step.into(), height.into()];
    let wrong = || {
        let there = data.len();
        format!("{width} x {height} pixels of {bytes} bytes in rows of {step} bytes, and {there} bytes")
    };
    if row == 0 || height == 0 || step < row || (height - 1) * step + row > data.len() as u64 {
        return Err(wrong());
    }
    if step == row {
        return Ok(data[..(row * height) as usize].into());
    }
    let rows: Vec<&[u8]> =
        data.chunks(step as usize).take(height as usize).map(|bytes| &bytes[..row as usize]).collect();
    Ok(rows.concat().into())
}
