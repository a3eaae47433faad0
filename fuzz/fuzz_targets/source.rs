//! Every source of frames that has files: the first byte picks which, the rest is the file that says the most of it.
#![no_main]

use depthplanes_io::formats::{DecodeOptions, Limits};
use depthplanes_io::outputs::grey16_png;
use depthplanes_video::{SourceOptions, open};
use libfuzzer_sys::fuzz_target;
use std::path::{Path, PathBuf};

/// The folder in memory, and the file in it.
const FILES: [(&str, &str); 6] = [
    ("mcap", "walk.mcap"),
    ("rosbag2", "metadata.yaml"),
    ("tum", "depth.txt"),
    ("poses", "groundtruth.txt"),
    ("seven", "0.pose.txt"),
    ("folder", "0.pgm"),
];

/// A folder of this process, with the other files that a source needs.
fn made(name: &str) -> PathBuf {
    let memory = Path::new("/dev/shm");
    let above = if memory.is_dir() { memory.to_path_buf() } else { std::env::temp_dir() };
    let folder = above.join(format!("depthplanes-fuzz-{}", std::process::id())).join(name);
    if !folder.exists() {
        std::fs::create_dir_all(&folder).unwrap();
        let map = grey16_png(16, 12, &[1000; 16 * 12]);
        match name {
            "poses" => std::fs::write(folder.join("depth.txt"), "0.0 0.png\n1.0 0.png\n").unwrap(),
            "rosbag2" => std::fs::write(folder.join("0.mcap"), "no recording").unwrap(),
            "seven" => std::fs::write(folder.join("0.depth.png"), &map).unwrap(),
            _ => (),
        }
        std::fs::write(folder.join("0.png"), map).unwrap();
    }
    folder
}

fuzz_target!(|data: &[u8]| {
    let Some((&first, bytes)) = data.split_first() else { return };
    let (name, file) = FILES[usize::from(first) % FILES.len()];
    let folder = made(name);
    std::fs::write(folder.join(file), bytes).unwrap();
    let limits = Limits { max_pixels: 1 << 20, max_bytes: 1 << 24 };
    let mut options = SourceOptions::default();
    options.read.decode = DecodeOptions { limits, ..Default::default() };
    let word = if name == "mcap" { folder.join(file) } else { folder };
    let Ok(mut source) = open(word.to_str().unwrap(), &options) else { return };
    let mut frames = 0;
    while let Some(frame) = source.next_frame() {
        if let Ok(frame) = frame {
            assert!(frame.frame.width * frame.frame.height <= limits.max_pixels);
        }
        frames += 1;
        if frames > 100 {
            break;
        }
    }
    if source.seek(1) {
        let _ = source.next_frame();
    }
});
