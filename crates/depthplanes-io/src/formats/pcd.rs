//! Organised point clouds of the Point Cloud Library (`.pcd`): ASCII, binary, binary_compressed.
//!
//! In: a cloud whose HEIGHT is above 1, one point a pixel, in the camera's optical frame (x right,
//! y down, z forward). Out: z as `f32`, metres by PCL's custom, and the camera if the points say it. An unorganised cloud (HEIGHT 1) has
//! no image to find planes in and is refused.

use super::bytes::{Cursor, line};
use super::cloud::find_camera;
use super::format::{DecodeOptions, Format, Image};
use super::lzf;
use super::samples::{Sample, pixels};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "pcd",
    about: "organised point cloud (PCD): its z as metres",
    extensions: &["pcd"],
    sniff: |bytes| bytes.starts_with(b"# .PCD") || bytes.starts_with(b"VERSION") || commented(bytes),
    ends: |_, _| None,
    decode,
};

/// Some writers put comments before `# .PCD`.
fn commented(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#") && bytes[..bytes.len().min(1024)].windows(6).any(|window| window == b"# .PCD")
}

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "an organised cloud (HEIGHT above 1) with a float field z; an unorganised one has no pixels, save \
         the organised cloud or the depth map that it came from";
    Error::Unreadable { format: "pcd", wrong: wrong.into(), accepted }
}

#[derive(Debug, Default)]
struct Header {
    fields: Vec<String>,
    sizes: Vec<usize>,
    types: Vec<String>,
    counts: Vec<usize>,
    width: u64,
    height: u64,
    data: String,
}

/// Where a field stands in a point.
struct Layout {
    /// Numbers before it, for ASCII.
    column: usize,
    columns: usize,
    /// Bytes before it, for binary.
    offset: usize,
    stride: usize,
    sample: Sample,
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let (header, data) = header(bytes)?;
    let layout = layout(&header, "z")?;
    if header.height == 1 {
        return Err(unreadable(format!("the cloud is unorganised: {} points in one row", header.width)));
    }
    let area = options.limits.area("pcd", header.width, header.height, layout.sample.bytes())?;
    let mut warnings = Vec::new();
    let pixels = field(&header, data, area, &layout, options, &mut warnings)?;
    if let Pixels::F32(z) = &pixels {
        let behind = z.iter().filter(|z| **z < 0.0).count();
        if behind > 0 {
            warnings.push(format!("z is negative at {behind} points: is the cloud in the optical frame (z forward)?"));
        }
    }
    let other = |name: &str| field(&header, data, area, &self::layout(&header, name)?, options, &mut Vec::new());
    let camera_of = [other("x"), other("y"), Ok(pixels.clone())];
    let (width, height) = (header.width as usize, header.height as usize);
    let mut image = Image::new(width, height, pixels, layout.sample.name(), warnings);
    if let [Ok(x), Ok(y), Ok(z)] = &camera_of {
        find_camera(&mut image, [x, y, z]);
    }
    Ok(image)
}

/// The numbers of one field, a point after the other.
fn field(
    header: &Header,
    data: &[u8],
    area: usize,
    layout: &Layout,
    options: &DecodeOptions,
    warnings: &mut Vec<String>,
) -> Result<Pixels> {
    let bytes = match header.data.as_str() {
        "ascii" => return Ok(Pixels::F32(ascii(data, area, layout)?)),
        "binary" => {
            let points = area.checked_mul(layout.stride).and_then(|needed| data.get(..needed)).ok_or_else(|| {
                unreadable(format!("{area} points of {} bytes in {} bytes", layout.stride, data.len()))
            })?;
            let (from, to) = (layout.offset, layout.offset + layout.sample.bytes());
            points.chunks_exact(layout.stride).flat_map(|point| &point[from..to]).copied().collect()
        }
        "binary_compressed" => compressed(data, area, layout, options)?,
        other => return Err(unreadable(format!("DATA {}", other.escape_default()))),
    };
    Ok(pixels(&bytes, layout.sample, false, warnings))
}

fn header(bytes: &[u8]) -> Result<(Header, &[u8])> {
    let mut header = Header::default();
    let mut rest = bytes;
    loop {
        let (text, after) = line(rest, 4096).ok_or_else(|| unreadable("the header ends without DATA"))?;
        rest = after;
        let mut words = text.split_ascii_whitespace();
        let key = words.next().unwrap_or("#");
        let numbers = |words: std::str::SplitAsciiWhitespace| -> Result<Vec<usize>> {
            words.map(|w| w.parse().map_err(|_| unreadable(format!("{key} {}", w.escape_default())))).collect()
        };
        match key {
            "FIELDS" | "COLUMNS" => header.fields = words.map(str::to_string).collect(),
            "TYPE" => header.types = words.map(str::to_string).collect(),
            "SIZE" => header.sizes = numbers(words)?,
            "COUNT" => header.counts = numbers(words)?,
            "WIDTH" => header.width = numbers(words)?.first().copied().unwrap_or(0) as u64,
            "HEIGHT" => header.height = numbers(words)?.first().copied().unwrap_or(0) as u64,
            "DATA" => {
                header.data = words.next().unwrap_or("").to_string();
                return Ok((header, rest));
            }
            _ => {}
        }
    }
}

fn layout(header: &Header, name: &str) -> Result<Layout> {
    let fields = header.fields.len();
    let counts = if header.counts.is_empty() { vec![1; fields] } else { header.counts.clone() };
    if header.sizes.len() != fields || header.types.len() != fields || counts.len() != fields {
        let (sizes, types) = (header.sizes.len(), header.types.len());
        return Err(unreadable(format!("{fields} FIELDS, {sizes} SIZEs, {types} TYPEs, {} COUNTs", counts.len())));
    }
    if header.sizes.iter().chain(&counts).any(|&number| number > 4096) {
        return Err(unreadable("a SIZE or COUNT above 4096"));
    }
    let z = header.fields.iter().position(|field| field == name);
    let z = z.ok_or_else(|| unreadable(format!("there is no field {name}")))?;
    let sample = match (header.types[z].as_str(), header.sizes[z], counts[z]) {
        ("F", 4, 1) => Sample::F32,
        ("F", 8, 1) => Sample::F64,
        (kind, size, count) => return Err(unreadable(format!("{name} is of TYPE {kind}, SIZE {size}, COUNT {count}"))),
    };
    let bytes = |fields: usize| (0..fields).map(|field| header.sizes[field] * counts[field]).sum();
    Ok(Layout {
        column: counts[..z].iter().sum(),
        columns: counts.iter().sum(),
        offset: bytes(z),
        stride: bytes(fields),
        sample,
    })
}

fn ascii(data: &[u8], area: usize, layout: &Layout) -> Result<Vec<f32>> {
    if data.len() < area.saturating_mul(2 * layout.columns) - 1 {
        return Err(unreadable(format!("{area} points cannot stand in {} bytes", data.len())));
    }
    let text = std::str::from_utf8(data).map_err(|_| unreadable("the points are not text"))?;
    let mut z = Vec::with_capacity(area);
    for point in text.lines().filter(|point| !point.trim().is_empty()).take(area) {
        let word = point.split_ascii_whitespace().nth(layout.column);
        let value = word.and_then(|word| word.parse().ok());
        z.push(value.ok_or_else(|| unreadable(format!("point {} has no number z", z.len())))?);
    }
    if z.len() < area {
        return Err(unreadable(format!("{area} points are stated, {} are there", z.len())));
    }
    Ok(z)
}

/// The bytes of all z; a compressed cloud stores field after field.
fn compressed(data: &[u8], area: usize, layout: &Layout, options: &DecodeOptions) -> Result<Vec<u8>> {
    let cut = || unreadable("the packed data are cut off");
    let mut cursor = Cursor::new(data, 0);
    let (packed, unpacked) = (cursor.u32().ok_or_else(cut)? as usize, cursor.u32().ok_or_else(cut)? as usize);
    if Some(unpacked) != area.checked_mul(layout.stride) {
        return Err(unreadable(format!("{area} points of {} bytes, {unpacked} bytes are packed", layout.stride)));
    }
    if unpacked > options.limits.max_bytes {
        let (given, limit) = (unpacked as u64, options.limits.max_bytes as u64);
        return Err(Error::Limit { what: "size of the cloud in bytes", given, limit });
    }
    let packed = cursor.take(packed).ok_or_else(cut)?;
    let cloud = lzf::decompress(packed, unpacked).ok_or_else(|| unreadable("the packed data are damaged"))?;
    Ok(cloud[layout.offset * area..][..layout.sample.bytes() * area].to_vec())
}
