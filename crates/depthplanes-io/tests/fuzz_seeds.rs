//! Writes one valid file of every format into the corpora of the fuzz targets; `make fuzz` runs it first.

mod common;

use depthplanes_io::formats::FORMATS;
use std::path::Path;

#[test]
#[ignore = "writes into fuzz/corpus"]
fn seeds_are_written() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus");
    for target in ["decode", "read"] {
        std::fs::create_dir_all(corpus.join(target)).unwrap();
    }
    for (format, kind, bytes) in common::valid_files() {
        let number = FORMATS.iter().position(|row| row.name == format).unwrap() as u8;
        // The first byte picks the format of `decode`, and no encoding of `read`.
        for (target, first) in [("decode", number), ("read", u8::MAX)] {
            let name = format!("valid-{format}-{kind}").replace(' ', "-");
            std::fs::write(corpus.join(target).join(name), [&[first], &bytes[..]].concat()).unwrap();
        }
    }
}
