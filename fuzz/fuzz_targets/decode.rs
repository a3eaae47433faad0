//! Every reader of the table: the first byte picks the format, the rest is the file.
#![no_main]

use depthplanes_io::formats::{DecodeOptions, FORMATS, Limits};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let format = &FORMATS[usize::from(first) % FORMATS.len()];
    let limits = Limits { max_pixels: 1 << 22, max_bytes: 1 << 26 };
    let raw_size = Some((bytes.len() / [1, 2, 4, 8][usize::from(first) % 4], 1));
    let options = DecodeOptions { limits, raw_size, channels: first >= 128, ..Default::default() };
    if let Ok(image) = (format.decode)(bytes, &options) {
        assert!(image.width * image.height <= limits.max_pixels);
    }
});
