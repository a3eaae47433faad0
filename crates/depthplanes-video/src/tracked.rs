//! What is known of a frame of a video in the end: its record as JSON, and its label image by ids.

use crate::error::{Error, Result};
use crate::frame::VideoFrame;
use depthplanes::detection::PixelBox;
use depthplanes::track::{TrackState, TrackedPlane, Tracks};
use depthplanes::{Detection, Plane};
use serde_json::{Value, json};

/// The name and version of the form of a record.
const SCHEMA: &str = "depthplanes.track/1";

/// A frame that was searched and tracked.
#[derive(Clone, Copy, Debug)]
pub struct Tracked<'a> {
    /// The frame, whose pose is the one that was used.
    pub video: &'a VideoFrame,
    /// What was found in it.
    pub detection: &'a Detection,
    /// The tracks after it.
    pub tracks: &'a Tracks,
    /// The record of its ground ([`depthplanes_io::outputs::ground_record`]), if that was found.
    pub ground: Option<&'a Value>,
    /// Frames that were dropped before it.
    pub dropped: u64,
}

impl Tracked<'_> {
    /// The record of the frame, `depthplanes.track/1`: docs/video.md tells its fields.
    pub fn record(&self) -> Value {
        let (video, detection, tracks) = (self.video, self.detection, self.tracks);
        let shown = shown(detection, tracks.labels_of(detection));
        let seen = detection.planes.iter().zip(&shown).filter_map(|(plane, shown)| {
            let track = tracks.plane(tracks.id_of(plane.label)?)?;
            Some(seen(plane, shown, track))
        });
        let hidden = |state: TrackState| tracks.planes.iter().filter(move |track| track.state == state).map(hidden);
        let mut record = json!({
            "schema": SCHEMA,
            "index": video.index,
            "name": video.name,
            "time_s": video.time_s,
            "width": detection.width,
            "height": detection.height,
            "pose": video.pose.map(|pose| json!({"rotation": pose.rotation(), "translation_m": pose.translation_m()})),
            "planes": seen.collect::<Vec<_>>(),
            "lost": hidden(TrackState::Lost).collect::<Vec<_>>(),
            "subsumed": hidden(TrackState::Subsumed).collect::<Vec<_>>(),
            "dropped": self.dropped,
        });
        if let Some(ground) = self.ground {
            record["ground"] = ground.clone();
        }
        record
    }

    /// The id of each pixel's plane, row by row; 0 where there is none. Borders do not flicker if the tracks were made so
    /// ([`Tracks::labels`]).
    ///
    /// # Errors
    /// [`Error::Source`] for an id above 65535.
    pub fn labels(&self) -> Result<Vec<u16>> {
        let ids = self.tracks.ids.iter().map(|&id| u16::try_from(id)).collect::<std::result::Result<Vec<u16>, _>>();
        let ids = ids.map_err(|_| {
            let wrong = "an id is above 65535, which 16-bit label images do not hold";
            Error::source(&self.video.name, wrong, "fewer frames; --out FILE.jsonl has all ids")
        })?;
        let id = |&label: &u16| usize::from(label).checked_sub(1).map_or(0, |at| ids[at]);
        Ok(self.tracks.labels_of(self.detection).iter().map(id).collect())
    }
}

/// The record of a frame that could not be read or searched.
pub fn failed_record(index: u64, error: &str) -> Value {
    json!({"schema": SCHEMA, "index": index, "error": error})
}

/// Pixels of a plane in the label image that is shown.
struct Shown {
    pixels: usize,
    bounds: PixelBox,
    centroid: [f64; 2],
}

/// Those of all planes; of one that has no pixels there, where the detection has them.
fn shown(found: &Detection, labels: &[u16]) -> Vec<Shown> {
    const NONE: PixelBox = PixelBox { u_min: u32::MAX, v_min: u32::MAX, u_max: 0, v_max: 0 };
    let mut all: Vec<Shown> =
        found.planes.iter().map(|_| Shown { pixels: 0, bounds: NONE, centroid: [0.0; 2] }).collect();
    for (row, v) in labels.chunks_exact(found.width.max(1)).zip(0..) {
        for (&label, u) in row.iter().zip(0..).filter(|(label, _)| **label > 0) {
            let Shown { pixels, bounds, centroid } = &mut all[usize::from(label) - 1];
            let PixelBox { u_min, v_min, u_max, v_max } = *bounds;
            *bounds = PixelBox { u_min: u_min.min(u), v_min: v_min.min(v), u_max: u_max.max(u), v_max: v_max.max(v) };
            *centroid = [centroid[0] + f64::from(u), centroid[1] + f64::from(v)];
            *pixels += 1;
        }
    }
    for (shown, plane) in all.iter_mut().zip(&found.planes) {
        match shown.pixels {
            0 => (shown.bounds, shown.centroid) = (plane.bounding_box, plane.centroid),
            pixels => shown.centroid = shown.centroid.map(|sum| sum / pixels as f64),
        }
    }
    all
}

fn seen(plane: &Plane, shown: &Shown, track: &TrackedPlane) -> Value {
    let pixels = shown.bounds;
    json!({
        "id": track.id,
        "label": plane.label,
        "state": track.state.name(),
        "age": track.age,
        "seen": track.seen,
        "split_from": track.split_from,
        "pixel_count": shown.pixels,
        "bounding_box": {"u_min": pixels.u_min, "v_min": pixels.v_min, "u_max": pixels.u_max, "v_max": pixels.v_max},
        "centroid_px": shown.centroid,
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
