//! What to say of files that are not read: the common ones by name, with the way out.

use crate::error::Error;

/// Where some bytes stand, which they are, what the file is, what to do.
type Kind = (usize, &'static [u8], &'static str, &'static str);

const SAVE: &str = "a depth map; save it as 16-bit PNG, NPY or PFM";
const LOSSY: &str = "a depth map; lossy pictures do not hold depth: save the map as 16-bit PNG, NPY or PFM";
const UNPACK: &str = "a depth map; unpack the file first";
const EXTRACT: &str = "a depth map; extract the depth frames first, as 16-bit PNG, NPY or PFM";
const ARRAY: &str = "a depth map; save the array with numpy.save as .npy";
const ORGANISED: &str = "a depth map, or an organised cloud as .pcd";
const WRONG_FILE: &str = "a depth map; download the file itself";

const KNOWN: &[Kind] = &[
    (0, b"\xff\xd8\xff", "a JPEG picture", LOSSY),
    (8, b"WEBP", "a WebP picture", LOSSY),
    (4, b"ftypheic", "a HEIC picture", LOSSY),
    (4, b"ftypheix", "a HEIC picture", LOSSY),
    (4, b"ftypmif1", "a HEIF picture", LOSSY),
    (4, b"ftypavif", "an AVIF picture", LOSSY),
    (4, b"ftyp", "a video (MP4)", EXTRACT),
    (0, b"\xff\x0a", "a JPEG XL picture", LOSSY),
    (0, b"\0\0\0\x0cJXL ", "a JPEG XL picture", LOSSY),
    (0, b"\0\0\0\x0cjP  ", "a JPEG 2000 picture", SAVE),
    (0, b"GIF8", "a GIF picture", SAVE),
    (0, b"#?RADIANCE", "a Radiance picture", SAVE),
    (0, b"DDS ", "a DDS texture", SAVE),
    (8, b"AVI ", "a video (AVI)", EXTRACT),
    (0, b"\x1a\x45\xdf\xa3", "a Matroska recording", EXTRACT),
    (0, b"#ROSBAG", "a ROS 1 bag", EXTRACT),
    (0, b"SQLite format 3", "a database (SQLite), as ROS 2 bags (.db3) are", EXTRACT),
    (0, b"\x89MCAP", "an MCAP recording, as ROS 2 bags are", EXTRACT),
    (0, b"MATLAB", "a MATLAB file", ARRAY),
    (0, b"\x89HDF", "an HDF5 file", ARRAY),
    (0, b"CDF\x01", "a NetCDF file", ARRAY),
    (0, b"\x80\x02", "a Python pickle", ARRAY),
    (0, b"\x80\x03", "a Python pickle", ARRAY),
    (0, b"\x80\x04", "a Python pickle", ARRAY),
    (0, b"\x80\x05", "a Python pickle", ARRAY),
    (0, b"\x1f\x8b", "compressed with gzip", UNPACK),
    (0, b"\x28\xb5\x2f\xfd", "compressed with zstd", UNPACK),
    (0, b"\xfd7zXZ\0", "compressed with xz", UNPACK),
    (0, b"BZh", "compressed with bzip2", UNPACK),
    (0, b"\x04\x22\x4d\x18", "compressed with lz4", UNPACK),
    (0, b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", UNPACK),
    (0, b"Rar!", "a RAR archive", UNPACK),
    (257, b"ustar", "a tar archive", UNPACK),
    (0, b"ply", "a PLY cloud", ORGANISED),
    (0, b"LASF", "a LAS cloud", ORGANISED),
    (0, b"ASTM-E57", "an E57 cloud", ORGANISED),
    (0, b"glTF", "a glTF mesh", ORGANISED),
    (0, b"%PDF", "a PDF document", SAVE),
    (0, b"version https://git-lfs", "a Git LFS pointer, not the file", "a depth map; fetch the file with git lfs pull"),
    (0, b"P1", "a bitmap of black and white (PBM)", SAVE),
    (0, b"P4", "a bitmap of black and white (PBM)", SAVE),
    (0, b"P7", "a PAM picture", "a depth map; save it as PGM, 16-bit PNG, NPY or PFM"),
    (0, b"II*\0", "a TIFF picture", NO_TIFF),
    (0, b"MM\0*", "a TIFF picture", NO_TIFF),
    (0, b"\x76\x2f\x31\x01", "an OpenEXR picture", NO_EXR),
];

/// What to do about files of that extension (small letters), if they are of a format that this build leaves out.
pub fn left_out(extension: &str) -> Option<&'static str> {
    match extension {
        "exr" if cfg!(not(feature = "exr")) => Some(NO_EXR),
        "tif" | "tiff" if cfg!(not(feature = "tiff")) => Some(NO_TIFF),
        _ => None,
    }
}

/// How texts begin, after white space, in small letters.
const TEXTS: &[(&str, &str, &str)] = &[
    ("<!doctype html", "a web page, perhaps one that reports an error", WRONG_FILE),
    ("<html", "a web page, perhaps one that reports an error", WRONG_FILE),
    ("<svg", "an SVG picture", SAVE),
    ("<?xml", "an XML text", SAVE),
    ("{", "a JSON text", "a depth map; a camera file is stated with --camera"),
    ("%yaml", "a YAML text", "a depth map; a camera file is stated with --camera"),
];

/// The formats that this build reads, and what to do about samples that have none.
macro_rules! accepted {
    ($($feature:literal)*) => {
        concat!(
            "PNG, BMP, PGM/PPM, PFM, NPY, NPZ, ",
            $($feature, ", ",)*
            "organised PCD, PCLZF, RVL and compressedDepth; for headerless samples state the size with --raw-size WIDTHxHEIGHT"
        )
    };
}

const ACCEPTED: &str = match (cfg!(feature = "tiff"), cfg!(feature = "exr")) {
    (true, true) => accepted!("TIFF" "EXR"),
    (true, false) => accepted!("TIFF"),
    (false, true) => accepted!("EXR"),
    (false, false) => accepted!(),
};

const NO_TIFF: &str = "a depth map that this build reads; it has no TIFF reader, which the feature `tiff` adds (cargo install ... \
     --features tiff)";
const NO_EXR: &str = "a depth map that this build reads; OpenEXR is read by the packages, and by builds with the feature `exr` \
     (cargo install ... --features exr)";

/// The error for bytes that no format claims.
pub(super) fn explain(bytes: &[u8]) -> Error {
    if bytes.is_empty() {
        return Error::Unreadable { format: "map", wrong: "there are no bytes".into(), accepted: ACCEPTED };
    }
    let is_there = |(at, magic, ..): &&Kind| bytes.get(*at..).is_some_and(|rest| rest.starts_with(magic));
    let known = KNOWN.iter().find(is_there).map(|(_, _, what, accepted)| (*what, *accepted));
    if let Some((what, accepted)) = known.or_else(|| text(bytes)) {
        return Error::Unreadable { format: "map", wrong: format!("this is {what}"), accepted };
    }
    let start: String = bytes.iter().take(8).map(|byte| format!("{byte:02x} ")).collect();
    let wrong = format!("{} bytes that start with {} match no format", bytes.len(), start.trim_end());
    Error::Unreadable { format: "map", wrong, accepted: ACCEPTED }
}

/// What a text is: known by its start, or numbers.
fn text(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let start = &bytes[..bytes.len().min(256)];
    let start = String::from_utf8_lossy(start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start)).to_lowercase();
    let start = start.trim_start();
    if let Some((_, what, accepted)) = TEXTS.iter().find(|(prefix, ..)| start.starts_with(prefix)) {
        return Some((*what, *accepted));
    }
    // numpy.savetxt writes a header behind `#`, and `nan` for what is missing.
    let lines = start.lines().filter(|line| !line.trim_start().starts_with('#'));
    let table = lines.map(|line| line.replace("nan", "0").replace("inf", "0")).collect::<Vec<_>>().join("\n");
    let is_number = |c: char| c.is_ascii_digit() || c.is_ascii_whitespace() || ".,;+-e".contains(c);
    let numbers = table.len() > 8 && table.chars().all(is_number) && table.contains(|c: char| c.is_ascii_digit());
    let accepted = match table.chars().find(|c| ",;".contains(*c)) {
        Some(',') => "a depth map: numpy.save('map.npy', numpy.loadtxt(FILE, delimiter=',')) makes it one",
        Some(_) => "a depth map: numpy.save('map.npy', numpy.loadtxt(FILE, delimiter=';')) makes it one",
        None => "a depth map: numpy.save('map.npy', numpy.loadtxt(FILE)) makes it one",
    };
    numbers.then_some(("a text of numbers", accepted))
}
