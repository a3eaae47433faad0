//! What to say of files that are not read: the common ones by name, with the way out.

use crate::error::Error;

/// First bytes, what they are, what to do.
const KNOWN: &[(&[u8], &str, &str)] = &[
    (b"\xff\xd8\xff", "a JPEG picture", "lossy pictures do not hold depth; save the map as 16-bit PNG, NPY or PFM"),
    (b"GIF8", "a GIF picture", "save the map as 16-bit PNG, NPY or PFM"),
    (b"\x1a\x45\xdf\xa3", "a Matroska recording", "extract its depth frames to 16-bit PNG first"),
    (b"MATLAB", "a MATLAB file", "save the map with numpy as .npy"),
    (b"\x89HDF", "an HDF5 file", "save the map with numpy as .npy"),
    (b"\x1f\x8b", "gzip-compressed", "unpack it first"),
    (b"\x28\xb5\x2f\xfd", "zstd-compressed", "unpack it first"),
    (b"ply", "a PLY cloud", "a depth map, or an organised cloud as .pcd"),
    (b"II*\0", "a TIFF picture", "this build has no TIFF reader; build with the feature `tiff`"),
    (b"MM\0*", "a TIFF picture", "this build has no TIFF reader; build with the feature `tiff`"),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture", "this build has no EXR reader; build with the feature `exr`"),
];

const ACCEPTED: &str = "PNG, BMP, PGM/PPM, PFM, NPY, NPZ, TIFF, EXR, organised PCD, PCLZF, RVL and compressedDepth; \
     for headerless 16-bit samples state the size with --raw-size WIDTHxHEIGHT";

/// The error for bytes that no format claims.
pub(super) fn explain(bytes: &[u8]) -> Error {
    if bytes.is_empty() {
        return Error::Unreadable { format: "map", wrong: "there are no bytes".into(), accepted: ACCEPTED };
    }
    for (magic, what, accepted) in KNOWN {
        if bytes.starts_with(magic) {
            return Error::Unreadable { format: "map", wrong: format!("this is {what}"), accepted };
        }
    }
    let start: String = bytes.iter().take(8).map(|byte| format!("{byte:02x} ")).collect();
    let wrong = format!("{} bytes that start with {} match no format", bytes.len(), start.trim_end());
    Error::Unreadable { format: "map", wrong, accepted: ACCEPTED }
}
