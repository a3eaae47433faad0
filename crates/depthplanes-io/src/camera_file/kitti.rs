//! KITTI: calibration of odometry and object detection (`P0:` to `P3:`), and of raw sequences (`P_rect_02:`).

use super::camera::{CameraFile, matrix, size, unreadable, with_lens};
use super::form::Document;
use super::lines::numbers;
use crate::encoding::Stereo;
use crate::error::Result;

pub(super) fn recognise(document: &Document<'_>) -> bool {
    numbers(document.text, "p0").is_some_and(|p| p.len() == 12)
        || numbers(document.text, "p2").is_some_and(|p| p.len() == 12)
}

/// The left colour camera, P2, whose maps are those of the data set.
pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let p = |name: &str| numbers(document.text, name).filter(|p| p.len() == 12);
    let (left, right) = if p("p2").is_some() { ("p2", "p3") } else { ("p0", "p1") };
    let taken = p(left).ok_or_else(|| unreadable("P0 or P2 does not have 12 numbers"))?;
    let camera = matrix(&taken)?;
    let stereo = p(right).and_then(|other| rig(&taken, &other));
    let name = left.to_uppercase();
    Ok(CameraFile { stereo, ..camera }.named(&name).note(format!("of the cameras P0 to P3 {name} is taken")))
}

pub(super) fn recognise_raw(document: &Document<'_>) -> bool {
    (0..4).any(|camera| numbers(document.text, &format!("prect0{camera}")).is_some_and(|p| p.len() == 12))
}

/// The left colour camera, 02, as rectified; its raw picture's where the flag asks for it.
pub(super) fn parse_raw(document: &Document<'_>) -> Result<CameraFile> {
    let of = |name: &str, camera: u32, count: usize| {
        numbers(document.text, &format!("{name}0{camera}")).filter(|numbers| numbers.len() == count)
    };
    let order = [2, 0, 1, 3];
    let taken = order.into_iter().find(|&camera| of("prect", camera, 12).is_some());
    let taken = taken.ok_or_else(|| unreadable("no P_rect has 12 numbers"))?;
    let p = of("prect", taken, 12).unwrap_or_default();
    let rectified = matrix(&p)?;
    let side = |name: &str| of(name, taken, 2).and_then(|s| size(Some(s[0]), Some(s[1])));
    let raw = match (of("k", taken, 9), of("d", taken, 5)) {
        (Some(k), Some(d)) => {
            let raw = with_lens(matrix(&k)?, "", &d, false)?;
            Some((raw.intrinsics, raw.distortion))
        }
        _ => None,
    };
    let stereo = if taken % 2 == 0 { of("prect", taken + 1, 12).and_then(|other| rig(&p, &other)) } else { None };
    let camera = CameraFile { stereo, otherwise: raw, rectified: true, ..rectified }.size(side("srect"));
    let name = format!("P_rect_0{taken}");
    Ok(camera.named(&name).note(format!("{name} is taken, the camera of rectified pictures")))
}

/// The rig of two rectified cameras.
fn rig(left: &[f64], right: &[f64]) -> Option<Stereo> {
    let baseline_m = (left[3] - right[3]) / left[0];
    (baseline_m > 0.0 && baseline_m.is_finite()).then_some(Stereo { focal_px: left[0], baseline_m, doffs_px: 0.0 })
}
