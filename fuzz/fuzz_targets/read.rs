//! The whole way from bytes to a frame: sniffing, every encoding by the first byte, the summary.
#![no_main]

use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::formats::{DecodeOptions, Limits};
use depthplanes_io::{ReadOptions, decode, inspect};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let limits = Limits { max_pixels: 1 << 20, max_bytes: 1 << 24 };
    let encoding = ENCODINGS.get(usize::from(first)).map(|encoding| encoding.name.to_string());
    let decode_options = DecodeOptions { limits, ..Default::default() };
    let options = ReadOptions { decode: decode_options, encoding, ..Default::default() };
    if let Ok(frame) = decode(bytes, "fuzz", &options) {
        inspect::summary(&frame, 16).expect("a frame that was read has a view");
    }
});
