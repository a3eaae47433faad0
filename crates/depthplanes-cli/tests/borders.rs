//! Borders do not flicker: of recorded videos whose poses are known, how many pixels are of another plane in the next frame.

mod support;

use depthplanes::track::{CameraPose, Tracker};
use depthplanes::{Detector, Intrinsics, with_view};
use depthplanes_video::{SourceOptions, VideoFrame, open};
use support::data;

/// A point of the frame before is the same one if its depth is what was measured there, within this share.
const SAME: f64 = 0.02;

/// A frame as it was shown: the id of each pixel by the detection and by the tracker, and the depth.
struct Shown {
    ids: [Vec<u32>; 2],
    depth: Vec<Option<f64>>,
    pose: CameraPose,
}

/// Of the pixels that are in both of two frames in turn, the share that changes its plane: of the detection's label images, and
/// of the tracker's.
fn flicker(source: &str) -> [f64; 2] {
    let mut source = open(source, &SourceOptions::default()).unwrap();
    let (mut detector, mut tracker) = (Detector::default().threads(0), Tracker::default());
    let mut before: Option<Shown> = None;
    let (mut both, mut changed) = (0, [0; 2]);
    while let Some(video) = source.next_frame() {
        let video = video.unwrap();
        let shown = shown(&video, &mut detector, &mut tracker);
        if let Some(before) = &before {
            let (width, camera) = (video.frame.width, video.frame.sensor.intrinsics.unwrap());
            for (at, depth) in shown.depth.iter().enumerate().filter_map(|(at, depth)| Some((at, (*depth)?))) {
                let point = camera.ray((at % width) as f64, (at / width) as f64).map(|x| x * depth);
                let place = seen_before(point, &shown.pose, &before.pose, &camera, [width, video.frame.height]);
                let Some((was, there)) = place else { continue };
                if before.depth[was].is_some_and(|measured| (measured - there).abs() < SAME * there) {
                    both += 1;
                    for (changed, (now, before)) in changed.iter_mut().zip(shown.ids.iter().zip(&before.ids)) {
                        *changed += u64::from(now[at] != before[was]);
                    }
                }
            }
        }
        before = Some(shown);
    }
    changed.map(|changed| changed as f64 / f64::from(both))
}

fn shown(video: &VideoFrame, detector: &mut Detector, tracker: &mut Tracker) -> Shown {
    let (map, sensor, pose) = (video.frame.view().unwrap(), video.frame.sensor, video.pose.unwrap());
    detector.set_sensor(sensor);
    let found = detector.detect(map).unwrap();
    let tracks = tracker.track_with_map(map, found, &sensor, Some(&pose)).unwrap();
    let ids = |labels: &[u16]| labels.iter().map(|&label| tracks.id_of(label).unwrap_or(0)).collect();
    let depth = |value: f64| sensor.value_kind.depth_m(value).filter(|depth| depth.is_finite());
    let depth = with_view!(map, view => view.rows().flatten().map(|&value| depth(value.into())).collect());
    Shown { ids: [ids(&found.labels), ids(&tracks.labels)], depth, pose }
}

/// The pixel where a point was in the frame before, and its depth there.
fn seen_before(
    point: [f64; 3],
    now: &CameraPose,
    before: &CameraPose,
    camera: &Intrinsics,
    size: [usize; 2],
) -> Option<(usize, f64)> {
    let world: [f64; 3] =
        std::array::from_fn(|k| (0..3).map(|j| now.rotation()[k][j] * point[j]).sum::<f64>() + now.translation_m()[k]);
    let [x, y, z] = before.to_camera([0, 1, 2].map(|k| world[k] - before.translation_m()[k]));
    let [u, v] = camera.project([x, y, z]).map(f64::round);
    let is_seen = z > 0.0 && u >= 0.0 && v >= 0.0 && u < size[0] as f64 && v < size[1] as f64;
    is_seen.then(|| (v as usize * size[0] + u as usize, z))
}

#[test]
fn of_recorded_videos_two_fifths_fewer_pixels_change_their_plane_from_frame_to_frame() {
    let Some(data) = data() else { return };
    for folder in ["video_7scenes", "video_tsdf_fusion"] {
        let [detected, shown] = flicker(data.join(folder).to_str().unwrap()).map(|share| 100.0 * share);
        println!(
            "{folder}: {detected:.2} % of the pixels change their plane in the detections, {shown:.2} % in the tracks"
        );
        assert!(shown < 0.65 * detected, "{folder}: {shown:.2} instead of {detected:.2} %");
    }
}
