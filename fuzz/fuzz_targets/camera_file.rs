//! Camera files of any text.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = depthplanes_io::camera_file::parse(text);
    let _ = depthplanes_io::camera_file::parse_intrinsics(text);
});
