//! Small valid files of every format, written by code that shares nothing with the readers, and
//! the way to the real data.
#![allow(dead_code, unreachable_pub)] // Each test binary uses its part.

use std::io::Write;
use std::path::PathBuf;

/// Columns and rows of all the maps here.
pub const WIDTH: usize = 7;
pub const HEIGHT: usize = 5;

/// A 16-bit map: 0, small, large and middling values.
pub fn depth() -> Vec<u16> {
    (0..WIDTH * HEIGHT).map(|i| if i % 9 == 4 { 0 } else { (i * 1873 % 65_521) as u16 }).collect()
}

pub fn bytes_be(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}

pub fn bytes_le(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

pub fn floats_le(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| f32::from(*value).to_le_bytes()).collect()
}

pub fn png(width: usize, height: usize, color: png::ColorType, depth: png::BitDepth, samples: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(samples).unwrap();
    writer.finish().unwrap();
    file
}

/// A bitmap of `bits` a pixel; `rows` are stored rows, first stored first, unpadded.
pub fn bmp(width: i32, height: i32, bits: u16, palette: &[[u8; 4]], rows: &[Vec<u8>]) -> Vec<u8> {
    let pixels_at = 54 + 4 * palette.len() as u32;
    let mut file = b"BM\0\0\0\0\0\0\0\0".to_vec();
    file.extend(pixels_at.to_le_bytes());
    file.extend(40u32.to_le_bytes());
    file.extend(width.to_le_bytes());
    file.extend(height.to_le_bytes());
    file.extend(1u16.to_le_bytes());
    file.extend(bits.to_le_bytes());
    file.extend([0; 16]);
    file.extend((palette.len() as u32).to_le_bytes());
    file.extend([0; 4]);
    file.extend(palette.iter().flatten());
    for row in rows {
        file.extend(row);
        file.extend(vec![0; row.len().div_ceil(4) * 4 - row.len()]);
    }
    file
}

pub fn grey_palette() -> Vec<[u8; 4]> {
    (0..=255u8).map(|i| [255 - i, 255 - i, 255 - i, 0]).collect()
}

pub fn npy(descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(data);
    file
}

/// A ZIP archive; stored, or deflated.
pub fn zip(members: &[(&str, Vec<u8>)], deflated: bool) -> Vec<u8> {
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for (name, data) in members {
        let mut crc = flate2::Crc::new();
        crc.update(data);
        let packed = if deflated { deflate(data) } else { data.clone() };
        let mut common = vec![20, 0, 0, 0, if deflated { 8 } else { 0 }, 0, 0, 0, 0, 0];
        common.extend(crc.sum().to_le_bytes());
        common.extend((packed.len() as u32).to_le_bytes());
        common.extend((data.len() as u32).to_le_bytes());
        common.extend((name.len() as u16).to_le_bytes());
        common.extend(0u16.to_le_bytes());
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        directory.extend([0; 10]);
        directory.extend((file.len() as u32).to_le_bytes());
        directory.extend(name.as_bytes());
        file.extend(b"PK\x03\x04");
        file.extend(&common);
        file.extend(name.as_bytes());
        file.extend(packed);
    }
    let start = file.len() as u32;
    file.extend(&directory);
    file.extend(b"PK\x05\x06\0\0\0\0");
    file.extend((members.len() as u16).to_le_bytes());
    file.extend((members.len() as u16).to_le_bytes());
    file.extend((directory.len() as u32).to_le_bytes());
    file.extend(start.to_le_bytes());
    file.extend([0, 0]);
    file
}

pub fn deflate(data: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::DeflateEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(data).unwrap();
    encoder.finish().unwrap()
}

/// LZF of literals only.
pub fn lzf(data: &[u8]) -> Vec<u8> {
    data.chunks(32).flat_map(|run| std::iter::once(run.len() as u8 - 1).chain(run.iter().copied())).collect()
}

pub fn pclzf(width: u32, height: u32, kind: &str, packed: &[u8], unpacked: u32) -> Vec<u8> {
    let mut file = b"PCLZF".to_vec();
    file.extend(width.to_le_bytes());
    file.extend(height.to_le_bytes());
    file.extend(format!("{kind:16}").as_bytes());
    file.extend((packed.len() as u32).to_le_bytes());
    file.extend(unpacked.to_le_bytes());
    file.extend(packed);
    file
}

pub fn pcd(width: usize, height: usize, data: &str, body: &[u8]) -> Vec<u8> {
    let mut file = format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\n\
         COUNT 1 1 1 1\nWIDTH {width}\nHEIGHT {height}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {data}\n",
        width * height
    )
    .into_bytes();
    file.extend(body);
    file
}

/// The points of an organised cloud whose z are `values`: x, y, z, rgb.
pub fn points(values: &[u16]) -> Vec<[f32; 4]> {
    values.iter().map(|&z| [1.5, -2.5, f32::from(z), 3.5]).collect()
}

pub fn rvl(width: u32, height: u32, values: &[u16]) -> Vec<u8> {
    let mut file = width.to_le_bytes().to_vec();
    file.extend(height.to_le_bytes());
    file.extend(depthplanes_io::formats::rvl::pack(values));
    file
}

/// The header of a compressedDepth payload: format, A, B.
pub fn config_header(a: f32, b: f32) -> Vec<u8> {
    [0i32.to_le_bytes(), a.to_le_bytes(), b.to_le_bytes()].concat()
}

pub fn pgm(values: &[u16]) -> Vec<u8> {
    [format!("P5\n# made up\n{WIDTH} {HEIGHT}\n65535\n").into_bytes(), bytes_be(values)].concat()
}

/// Rows bottom-up, little-endian.
pub fn pfm(values: &[u16]) -> Vec<u8> {
    pfm_of([WIDTH, HEIGHT], &values.iter().map(|&value| f32::from(value)).collect::<Vec<_>>())
}

pub fn pfm_of([width, height]: [usize; 2], values: &[f32]) -> Vec<u8> {
    let rows = values.chunks(width).rev().flatten().flat_map(|value| value.to_le_bytes());
    [format!("Pf\n{width} {height}\n-1.0\n").into_bytes(), rows.collect()].concat()
}

#[cfg(feature = "tiff")]
pub fn tiff(values: &[u16]) -> Vec<u8> {
    let mut file = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut file).unwrap();
    encoder.write_image::<tiff::encoder::colortype::Gray16>(WIDTH as u32, HEIGHT as u32, values).unwrap();
    file.into_inner()
}

/// A page of a TIFF file written by hand, one strip a plane, uncompressed.
#[derive(Clone)]
pub struct TiffPage {
    pub width: u16,
    pub height: u16,
    /// Bits a sample, and what they are: 1 = unsigned, 2 = signed, 3 = float.
    pub sample: (u16, u16),
    pub channels: u16,
    /// Further tags, each with one number.
    pub tags: Vec<(u16, u16)>,
    /// Text of GDAL_NODATA.
    pub no_data: Option<&'static str>,
    /// Samples in the file's byte order; plane by plane if tag 284 is 2.
    pub data: Vec<u8>,
}

/// A TIFF file of these pages; photometric interpretation (262) is among the tags of each.
pub fn tiff_by_hand(pages: &[TiffPage], big_endian: bool) -> Vec<u8> {
    let two = |value: u16| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    let four = |value: u32| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    let mut file = if big_endian { b"MM\0*".to_vec() } else { b"II*\0".to_vec() };
    let mut link = file.len();
    file.extend([0; 4]);
    for page in pages {
        let planes = if page.tags.contains(&(284, 2)) { usize::from(page.channels) } else { 1 };
        let data_at = file.len();
        file.extend(&page.data);
        let mut long_values = |values: Vec<Vec<u8>>| {
            let bytes = values.concat();
            if bytes.len() <= 4 {
                return [bytes.clone(), vec![0; 4 - bytes.len()]].concat();
            }
            let at = file.len() as u32;
            file.extend(bytes);
            four(at).to_vec()
        };
        let strip = page.data.len() / planes;
        let places = (0..planes).map(|plane| four((data_at + plane * strip) as u32).to_vec()).collect();
        let lengths = (0..planes).map(|_| four(strip as u32).to_vec()).collect();
        let each = |value: u16| vec![two(value).to_vec(); usize::from(page.channels)];
        let mut entries = vec![
            (256, 3, 1, long_values(vec![two(page.width).to_vec()])),
            (257, 3, 1, long_values(vec![two(page.height).to_vec()])),
            (258, 3, u32::from(page.channels), long_values(each(page.sample.0))),
            (259, 3, 1, long_values(vec![two(1).to_vec()])),
            (273, 4, planes as u32, long_values(places)),
            (277, 3, 1, long_values(vec![two(page.channels).to_vec()])),
            (278, 3, 1, long_values(vec![two(page.height).to_vec()])),
            (279, 4, planes as u32, long_values(lengths)),
            (339, 3, u32::from(page.channels), long_values(each(page.sample.1))),
        ];
        for (tag, value) in &page.tags {
            entries.push((*tag, 3, 1, long_values(vec![two(*value).to_vec()])));
        }
        if let Some(text) = page.no_data {
            let text = [text.as_bytes(), b"\0"].concat();
            entries.push((42_113, 2, text.len() as u32, long_values(vec![text])));
        }
        entries.sort_by_key(|(tag, ..)| *tag);
        file.resize(file.len().next_multiple_of(2), 0);
        let directory = file.len();
        file[link..link + 4].copy_from_slice(&four(directory as u32));
        file.extend(two(entries.len() as u16));
        for (tag, kind, count, value) in entries {
            file.extend([two(tag), two(kind)].concat());
            file.extend(four(count));
            file.extend(value);
        }
        link = file.len();
        file.extend([0; 4]);
    }
    file
}

#[cfg(feature = "exr")]
pub fn exr(values: &[u16]) -> Vec<u8> {
    exr_of([WIDTH, HEIGHT], &values.iter().map(|&value| f32::from(value)).collect::<Vec<_>>())
}

#[cfg(feature = "exr")]
pub fn exr_of([width, height]: [usize; 2], values: &[f32]) -> Vec<u8> {
    use exr::prelude::*;
    let samples = FlatSamples::F32(values.to_vec());
    let channels = AnyChannels::sort(SmallVec::from_vec(vec![AnyChannel::new("Z", samples)]));
    let layer = Layer::new((width, height), LayerAttributes::named("depth"), Encoding::SMALL_LOSSLESS, channels);
    let mut file = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut file).unwrap();
    file.into_inner()
}

/// One valid file of every sniffed format with the same map in it: format, what kind, bytes.
pub fn valid_files() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    let depth = depth();
    let grey = png(WIDTH, HEIGHT, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes_be(&depth));
    let shape = format!("({HEIGHT}, {WIDTH})");
    let array = npy("<u2", false, &shape, &bytes_le(&depth));
    let numbers: Vec<String> = depth.iter().map(u16::to_string).collect();
    let cloud = points(&depth);
    let ascii: String = cloud.iter().map(|[x, y, z, c]| format!("{x} {y} {z} {c}\n")).collect();
    let binary: Vec<u8> = cloud.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let fields: Vec<u8> = (0..4).flat_map(|f| cloud.iter().flat_map(move |p| p[f].to_le_bytes())).collect();
    let packed = lzf(&fields);
    let sizes = [(packed.len() as u32).to_le_bytes(), (fields.len() as u32).to_le_bytes()].concat();
    let mut files = vec![
        ("png", "16-bit", grey.clone()),
        ("pnm", "binary", pgm(&depth)),
        ("pnm", "ASCII", format!("P2\n{WIDTH} {HEIGHT} # size\n65535\n{}\n", numbers.join("\n")).into_bytes()),
        ("pfm", "little-endian", pfm(&depth)),
        ("npy", "C order", array.clone()),
        ("npz", "stored", zip(&[("depth.npy", array.clone())], false)),
        ("npz", "deflated", zip(&[("depth.npy", array)], true)),
        ("pcd", "ASCII", pcd(WIDTH, HEIGHT, "ascii", ascii.as_bytes())),
        ("pcd", "binary", pcd(WIDTH, HEIGHT, "binary", &binary)),
        ("pcd", "compressed", pcd(WIDTH, HEIGHT, "binary_compressed", &[sizes, packed].concat())),
        ("pclzf", "depth16", pclzf(7, 5, "depth16", &lzf(&bytes_le(&depth)), 70)),
        ("rvl", "bare", rvl(7, 5, &depth)),
        ("compressed-depth", "PNG", [config_header(0.0, 0.0), grey].concat()),
        ("compressed-depth", "RVL", [config_header(0.0, 0.0), rvl(7, 5, &depth)].concat()),
    ];
    #[cfg(feature = "tiff")]
    files.push(("tiff", "16-bit", tiff(&depth)));
    #[cfg(feature = "exr")]
    files.push(("exr", "float", exr(&depth)));
    files
}

/// The folder of real files: `DEPTHPLANES_DATA`, or `shared/data` beside a folder above this crate.
/// Without it the calling test is skipped, but for CI, where it fails.
pub fn data() -> Option<PathBuf> {
    let beside = || {
        let mut above = PathBuf::from(env!("CARGO_MANIFEST_DIR")).canonicalize().ok()?;
        while above.pop() {
            let data = above.join("shared/data");
            if data.join("MANIFEST.tsv").is_file() {
                return Some(data);
            }
        }
        None
    };
    let found = std::env::var_os("DEPTHPLANES_DATA").map(PathBuf::from).or_else(beside);
    if found.is_none() {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "there is no data: set DEPTHPLANES_DATA");
        println!("skipped: there is no data, set DEPTHPLANES_DATA");
    }
    found
}
