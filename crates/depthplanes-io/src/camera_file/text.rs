//! Numbers alone: `fx,fy,cx,cy`, matrices as text, FoundationStereo's K.txt, and matrices with a name, as in Matlab.

use super::camera::{CameraFile, matrix, pinhole, size, unreadable, with_lens};
use super::form::Document;
use super::names::words;
use crate::encoding::Stereo;
use crate::error::Result;

/// The lines that hold numbers, without comments, names (`K = `) and NumPy's `array`.
fn lines(text: &str) -> Option<Vec<Vec<f64>>> {
    let mut all = Vec::new();
    let plain = text.replace("array", " ").replace("np.", " ").replace("...", " ");
    for line in plain.lines() {
        let line = line.split(['#', '%']).next().unwrap_or("").split("//").next().unwrap_or("");
        let line = match line.split_once(['=', ':']) {
            Some((name, rest)) if is_name(name) => rest,
            _ => line,
        };
        let numbers = words(line)?;
        if !numbers.is_empty() {
            all.push(numbers);
        }
    }
    (!all.is_empty()).then_some(all)
}

fn is_name(text: &str) -> bool {
    let text = text.trim();
    !text.is_empty()
        && text.len() < 40
        && text.chars().all(|c| c.is_alphanumeric() || "_.-".contains(c))
        && words(text).is_none()
}

/// One line of names in front of a matrix is no form of its own: at most one line may have a name.
pub(super) fn recognise(document: &Document<'_>) -> bool {
    let named = document.text.lines().filter(|line| line.split_once(['=', ':']).is_some_and(|(name, _)| is_name(name)));
    named.count() <= 1 && lines(document.text).is_some()
}

pub(super) fn parse(document: &Document<'_>) -> Result<CameraFile> {
    let lines = lines(document.text).unwrap_or_default();
    let all: Vec<f64> = lines.concat();
    match all[..] {
        [fx, fy, cx, cy] if lines.len() == 1 || lines.len() == 4 => pinhole(fx, fy, cx, cy),
        [.., baseline_m] if all.len() == 10 && lines.last().is_some_and(|last| last.len() == 1) => {
            let camera = matrix(&all[..9])?;
            if !(baseline_m > 0.0 && baseline_m < 10.0) {
                return Err(unreadable(format!("the baseline below the matrix is {baseline_m} m")));
            }
            let stereo = Some(Stereo { focal_px: camera.intrinsics.fx, baseline_m, doffs_px: 0.0 });
            Ok(CameraFile { stereo, ..camera })
        }
        // ARKitScenes' .pincam: width height fx fy cx cy.
        [width, height, fx, fy, cx, cy] if lines.len() == 1 => {
            let is_middle = |c: f64, side: f64| (0.25..0.75).contains(&(c / side));
            match size(Some(width), Some(height)) {
                Some(size) if is_middle(cx, width) && is_middle(cy, height) => {
                    Ok(pinhole(fx, fy, cx, cy)?.size(Some(size)))
                }
                _ => Err(unreadable("six numbers that are not width, height, fx, fy, cx, cy")),
            }
        }
        // TUM: fx fy cx cy and coefficients on one line.
        [fx, fy, cx, cy, ..] if lines.len() == 1 && (8..=9).contains(&all.len()) && is_pinhole_with_lens(&all) => {
            with_lens(pinhole(fx, fy, cx, cy)?, "", &all[4..], false)
        }
        _ if matches!(all.len(), 9 | 12 | 16) => {
            let camera = matrix(&all)?;
            match all[..] {
                [_, _, _, x, ..] if all.len() == 12 && x < 0.0 => {
                    let focal_px = camera.intrinsics.fx;
                    Ok(CameraFile {
                        stereo: Some(Stereo { focal_px, baseline_m: -x / focal_px, doffs_px: 0.0 }),
                        ..camera
                    })
                }
                _ => Ok(camera),
            }
        }
        _ if lines.len() > 2 && lines.iter().all(|line| line.len() == lines[0].len()) => Err(unreadable(format!(
            "{} lines of {} numbers: a list of poses, points or time stamps",
            lines.len(),
            lines[0].len()
        ))),
        _ => {
            Err(unreadable(format!("{} numbers; 4 (fx,fy,cx,cy), or 9, 12 or 16 of a matrix are expected", all.len())))
        }
    }
}

fn is_pinhole_with_lens(all: &[f64]) -> bool {
    all[..4].iter().all(|x| x.abs() > 10.0) && all[4..].iter().all(|x| x.abs() < 20.0)
}
