//! The message of a frame: what is known of it and of its planes, and the pictures behind.

use crate::message::Arrays;
use crate::picture::{Picture, thinned};
use crate::pipeline::Found;
use axum::body::Bytes;
use depthplanes::Plane;
use depthplanes::ground::Ground;
use depthplanes::outline::Outlines;
use depthplanes_io::outputs::{depth_m, id_colour};
use depthplanes_video::VideoFrame;
use serde_json::{Value, json};
use std::time::Instant;

/// What is known of a frame beside what was found in it.
pub(crate) struct About {
    /// One more for each message that is made.
    pub(crate) serial: u64,
    /// The number of its rays.
    pub(crate) camera: Option<u64>,
    /// Milliseconds that it took to read.
    pub(crate) read_ms: f64,
    /// What a person should know of it.
    pub(crate) notes: Vec<String>,
}

/// Makes the message of a frame.
pub(crate) fn message(about: About, video: &VideoFrame, found: &Found<'_>) -> Bytes {
    let start = Instant::now();
    let (frame, detection) = (&video.frame, found.detection);
    let view = frame.view().expect("it was looked at before");
    let picture = Picture::new(view, frame.sensor.value_kind);
    let mut arrays = Arrays::default();
    arrays.add_u16("depth", &picture.codes);
    arrays.add_u16("labels", &thinned(found.tracks.labels_of(detection), frame.width, picture.step));
    let marks = found.ground.map_or(&[][..], |ground| &ground.marks);
    if !marks.is_empty() {
        arrays.add_u8("marks", &thinned(marks, frame.width, picture.step));
    }
    let rings = rings(found.outlines, &mut arrays);
    let planes: Vec<Value> = detection.planes.iter().map(|of| plane(of, found, frame.sensor.value_kind)).collect();
    let mut stages = vec![("read", about.read_ms)];
    stages.extend(&found.stages);
    stages.push(("message", start.elapsed().as_secs_f64() * 1e3));
    let head = json!({
        "type": "frame",
        "serial": about.serial,
        "index": video.index,
        "name": video.name,
        "time_s": video.time_s,
        "has_pose": video.pose.is_some(),
        "map": {"width": frame.width, "height": frame.height},
        "width": picture.width,
        "height": picture.height,
        "step": picture.step,
        "low": picture.low,
        "scale": picture.scale,
        "unit": if picture.is_metric { "m" } else { "map units" },
        "encoding": frame.encoding,
        "camera": about.camera,
        "notes": about.notes,
        "stages": stages,
        "planes": planes,
        "rings": rings,
        "valid_pixels": detection.valid_pixels,
        "lost": found.tracks.planes.len() - found.tracks.ids.len(),
        "ground": found.ground.map(ground),
    });
    arrays.message(head)
}

fn plane(plane: &Plane, found: &Found<'_>, kind: depthplanes::ValueKind) -> Value {
    let track = found.tracks.id_of(plane.label).and_then(|id| found.tracks.plane(id));
    let id = track.map_or(u32::from(plane.label), |track| track.id);
    let class = found.ground.and_then(|ground| ground.planes.get(usize::from(plane.label) - 1));
    let box_px = plane.bounding_box;
    json!({
        "id": id,
        "label": plane.label,
        "colour": id_colour(id),
        "age": track.map(|track| track.age),
        "state": track.map(|track| track.state.name()),
        "class": class.map(|of| of.class.name()),
        "height_m": class.and_then(|of| of.height_m),
        "slope_deg": class.and_then(|of| of.slope_deg),
        "depth_m": depth_m(plane, kind),
        "pixel_count": plane.pixel_count,
        "bounding_box": [box_px.u_min, box_px.v_min, box_px.u_max, box_px.v_max],
        "centroid": plane.centroid,
        "centroid_m": plane.metric.map(|metric| metric.centroid_m),
        "normal": plane.normal(),
        "distance_m": plane.distance_m(),
        "area_m2": plane.metric.and_then(|metric| metric.area_m2),
        "rms_m": plane.metric.map(|metric| metric.rms_m),
    })
}

/// The outlines' rings: `[label, is a hole, corners]` of each, and the corners of all one after the other, in pixels of the map
/// and, where the camera is known, in metres.
fn rings(outlines: &Outlines, arrays: &mut Arrays) -> Vec<Value> {
    let (mut pixels, mut metres, mut rings) = (Vec::new(), Vec::new(), Vec::new());
    for outline in outlines.iter() {
        for polygon in outline.polygons() {
            let all = std::iter::once((polygon.outer(), 0)).chain(polygon.holes().map(|hole| (hole, 1)));
            for (ring, is_hole) in all {
                let points = ring.points_px();
                rings.push(json!([outline.label(), is_hole, points.len()]));
                match ring.points_m() {
                    Some(points) => metres.extend(points.flatten().map(|x| x as f32)),
                    None => metres.extend((0..3 * points.len()).map(|_| f32::NAN)),
                }
                pixels.extend(points.flatten().map(|x| x as f32));
            }
        }
    }
    arrays.add_f32("corners_px", &pixels);
    arrays.add_f32("corners_m", &metres);
    rings
}

fn ground(ground: &Ground) -> Value {
    json!({
        "up": ground.up,
        "floor": ground.floor,
        "obstacles": ground.obstacles,
        "sectors": ground.sectors,
        "steps": ground.steps,
    })
}
