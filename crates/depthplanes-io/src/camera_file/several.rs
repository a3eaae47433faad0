//! Which of several cameras of a file is taken: one for depth, or the left one of a pair; others that differ are refused.

use super::camera::{CameraFile, unreadable};
use crate::error::Result;

/// A camera and the way to it.
pub(super) struct Found {
    pub(super) path: String,
    pub(super) camera: CameraFile,
}

/// The one camera of those found.
pub(super) fn one_of(mut found: Vec<Found>) -> Result<CameraFile> {
    let same = |a: &CameraFile, b: &CameraFile| {
        a.intrinsics == b.intrinsics && a.distortion == b.distortion && a.size == b.size
    };
    let mut distinct: Vec<usize> = Vec::new();
    for at in 0..found.len() {
        if !distinct.iter().any(|&other| same(&found[other].camera, &found[at].camera)) {
            distinct.push(at);
        }
        if distinct.len() > 100 {
            break;
        }
    }
    let taken = match distinct[..] {
        [only] => only,
        _ => {
            let lower = |at: usize| found[at].path.to_lowercase();
            let with = |word: &str| distinct.iter().copied().filter(|&at| lower(at).contains(word)).collect::<Vec<_>>();
            let pair = |left: &str, right: &str| {
                let [left, right] = [with(left), with(right)];
                (distinct.len() == 2 && left.len() == 1 && right.len() == 1 && left != right).then(|| left[0])
            };
            let depth: Vec<usize> = distinct.iter().copied().filter(|&at| is_depth(&lower(at))).collect();
            let choice = if depth.len() == 1 { Some(depth[0]) } else { None };
            let choice = choice.or_else(|| pair("left", "right")).or_else(|| pair("cam0", "cam1"));
            let choice = choice.or_else(|| pair("1", "2")).or_else(|| pair("0", "1"));
            choice.ok_or_else(|| several(&found, &distinct))?
        }
    };
    let others: Vec<String> =
        distinct.iter().filter(|&&at| at != taken).take(5).map(|&at| format!("`{}`", found[at].path)).collect();
    let Found { path, camera } = found.swap_remove(taken);
    if others.is_empty() {
        return Ok(camera);
    }
    let note = format!("of {} cameras `{path}` is taken, not {}", distinct.len(), others.join(", "));
    Ok(camera.named(path).note(note))
}

/// Whether a way to a camera names that of the depth map; `depth_to_color` is none, and `aligned_depth` has the
/// pixels of the other camera.
fn is_depth(path: &str) -> bool {
    let plain: String = path.chars().filter(|c| c.is_alphanumeric()).collect();
    let is_other = ["depthto", "todepth", "aligneddepth", "depth2", "2depth"].iter().any(|name| plain.contains(name));
    path.contains("depth") && !is_other
}

fn several(found: &[Found], distinct: &[usize]) -> crate::error::Error {
    let shown = |&at: &usize| {
        let Found { path, camera } = &found[at];
        let camera = camera.intrinsics;
        format!("`{path}` {},{},{},{}", camera.fx, camera.fy, camera.cx, camera.cy)
    };
    let listed: Vec<String> = distinct.iter().take(5).map(shown).collect();
    let more = if distinct.len() > 5 { " and others" } else { "" };
    unreadable(format!(
        "it has several cameras that differ: {}{more}; give the one of the map with --intrinsics",
        listed.join("; ")
    ))
}
