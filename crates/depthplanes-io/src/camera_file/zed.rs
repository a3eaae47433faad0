//! ZED's factory calibration, SN*.conf: a section for each camera and resolution.

use super::camera::{CameraFile, pinhole, unreadable, with_lens};
use super::form::Document;
use super::lines::number;
use crate::encoding::Stereo;
use crate::error::Result;

/// Sections and the sizes of their pictures (Stereolabs, video modes of ZED cameras).
const SIZES: [(&str, (usize, usize)); 9] = [
    ("4K", (3840, 2160)),
    ("QHDPLUS", (3200, 1800)),
    ("2K", (2208, 1242)),
    ("FHD1200", (1920, 1200)),
    ("FHD", (1920, 1080)),
    ("HD1200", (1920, 1200)),
    ("HD", (1280, 720)),
    ("SVGA", (960, 600)),
    ("VGA", (672, 376)),
];

/// Sections: their names in capitals and their lines.
fn sections(text: &str) -> Vec<(String, String)> {
    let mut all: Vec<(String, String)> = Vec::new();
    for line in text.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.split(']').next()) {
            all.push((name.trim().to_uppercase(), String::new()));
        } else if let Some((_, lines)) = all.last_mut() {
            lines.push_str(line);
            lines.push('\n');
        }
    }
    all
}

pub(super) fn recognise(document: &Document<'_>) -> bool {
    document.text.lines().any(|line| line.trim().to_uppercase().starts_with("[LEFT_CAM_"))
}

/// The left camera at each resolution. Depth of ZED's programs is of the rectified picture.
pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let sections = sections(document.text);
    let stereo = sections.iter().find(|(name, _)| name == "STEREO").map(|(_, lines)| lines.as_str());
    let baseline_m =
        stereo.and_then(|lines| number(lines, "baseline")).map(f64::abs).filter(|&mm| mm > 1.0).map(|mm| mm / 1000.0);
    let mut cameras = Vec::new();
    for (name, lines) in &sections {
        let Some(mode) = name.strip_prefix("LEFT_CAM_") else { continue };
        let of = |key: &str| number(lines, key).ok_or_else(|| unreadable(format!("[{name}] has no {key}")));
        let camera = pinhole(of("fx")?, of("fy")?, of("cx")?, of("cy")?)?;
        let coefficients = ["k1", "k2", "p1", "p2", "k3"].map(|key| number(lines, key).unwrap_or(0.0));
        let focal_px = camera.intrinsics.fx;
        let mut camera = with_lens(camera, "", &coefficients, true)?.named(format!("[{name}]"));
        camera.size = SIZES.iter().find(|(known, _)| *known == mode).map(|(_, size)| *size);
        camera.stereo = baseline_m.map(|baseline_m| Stereo { focal_px, baseline_m, doffs_px: 0.0 });
        cameras.push(
            camera.note(format!(
                "[{name}] is taken; the rectified camera of ZED's depth differs from it by a few pixels"
            )),
        );
    }
    CameraFile::first_of(cameras)
}
