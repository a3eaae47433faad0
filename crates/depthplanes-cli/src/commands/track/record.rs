//! A frame of a tracked video as one line of JSON.

use super::follow::Followed;
use depthplanes::Plane;
use depthplanes::track::{TrackState, TrackedPlane};
use serde_json::{Value, json};

/// The name and version of the form of a line.
const SCHEMA: &str = "depthplanes.track/1";

/// The record of a frame.
pub(super) fn record(frame: &Followed) -> Value {
    let tracks = &frame.tracks;
    let seen = frame.detection.planes.iter().filter_map(|plane| {
        let track = tracks.plane(tracks.id_of(plane.label)?)?;
        Some(seen(plane, track))
    });
    let hidden = |state: TrackState| tracks.planes.iter().filter(move |track| track.state == state).map(hidden);
    let mut record = json!({
        "schema": SCHEMA,
        "index": frame.video.index,
        "name": frame.video.name,
        "time_s": frame.video.time_s,
        "width": frame.detection.width,
        "height": frame.detection.height,
        "pose": frame.video.pose.map(|pose| json!({"rotation": pose.rotation(), "translation_m": pose.translation_m()})),
        "planes": seen.collect::<Vec<_>>(),
        "lost": hidden(TrackState::Lost).collect::<Vec<_>>(),
        "subsumed": hidden(TrackState::Subsumed).collect::<Vec<_>>(),
        "dropped": frame.dropped,
    });
    if let Some(ground) = &frame.ground {
        record["ground"] = ground.record.clone();
    }
    record
}

/// The record of a frame that could not be read.
pub(super) fn failed(index: u64, error: &str) -> Value {
    json!({"schema": SCHEMA, "index": index, "error": error})
}

fn seen(plane: &Plane, track: &TrackedPlane) -> Value {
    let pixels = plane.bounding_box;
    json!({
        "id": track.id,
        "label": plane.label,
        "state": track.state.name(),
        "age": track.age,
        "seen": track.seen,
        "split_from": track.split_from,
        "pixel_count": plane.pixel_count,
        "bounding_box": {"u_min": pixels.u_min, "v_min": pixels.v_min, "u_max": pixels.u_max, "v_max": pixels.v_max},
        "centroid_px": plane.centroid,
        "normal": track.plane.map(|plane| plane.normal),
        "distance_m": track.plane.map(|plane| plane.distance),
        "covariance": track.plane.map(|_| track.covariance),
        "centroid_m": plane.metric.map(|metric| metric.centroid_m),
        "area_m2": plane.metric.and_then(|metric| metric.area_m2),
    })
}

fn hidden(track: &TrackedPlane) -> Value {
    json!({
        "id": track.id,
        "unseen": track.unseen,
        "subsumed_by": track.subsumed_by,
        "normal": track.plane.map(|plane| plane.normal),
        "distance_m": track.plane.map(|plane| plane.distance),
    })
}
