//! The message of a frame: what is known of it and of its planes, and the pictures behind.

use super::message::Message;
use super::picture::{Picture, thinned};
use crate::frame::Frame;
use crate::outputs::{depth_m, id_colour};
use depthplanes::ground::Ground;
use depthplanes::outline::Outlines;
use depthplanes::track::Tracks;
use depthplanes::{Detection, Plane};
use serde_json::{Value, json};

/// A frame and all that a page shows of it.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// The frame.
    pub frame: &'a Frame,
    /// Its planes.
    pub detection: &'a Detection,
    /// Their outlines.
    pub outlines: &'a Outlines,
    /// Their ids, in a video; else these are the labels.
    pub tracks: Option<&'a Tracks>,
    /// The ground, if it was looked for.
    pub ground: Option<&'a Ground>,
}

/// The message of a frame, with the arrays `depth`, `labels`, `marks`, `curved`, `corners_px` and `corners_m`.
///
/// # Errors
/// Those of [`Frame::view`].
pub fn frame_message(shown: &Shown<'_>) -> depthplanes::Result<Message> {
    let Shown { frame, detection, outlines, tracks, ground } = *shown;
    let picture = Picture::new(frame.view()?, frame.sensor.value_kind);
    let labels = tracks.map_or(&detection.labels[..], |tracks| tracks.labels_of(detection));
    let mut message = Message::default();
    message.add_u16("depth", &picture.codes);
    message.add_u16("labels", &thinned(labels, frame.width, picture.step));
    let marks = ground.map_or(&[][..], |ground| &ground.marks);
    if !marks.is_empty() {
        message.add_u8("marks", &thinned(marks, frame.width, picture.step));
    }
    if let Some(curved) = &detection.curved {
        message.add_u16("curved", &thinned(&curved.labels, frame.width, picture.step));
    }
    let rings = rings(outlines, &mut message);
    let planes: Vec<Value> = detection.planes.iter().map(|of| plane(of, shown)).collect();
    Ok(message.with(json!({
        "type": "frame",
        "map": {"width": frame.width, "height": frame.height},
        "width": picture.width,
        "height": picture.height,
        "step": picture.step,
        "low": picture.low,
        "scale": picture.scale,
        "unit": if picture.is_metric { "m" } else { "map units" },
        "encoding": frame.encoding,
        "planes": planes,
        "rings": rings,
        "valid_pixels": detection.valid_pixels,
        "lost": tracks.map_or(0, |tracks| tracks.planes.len() - tracks.ids.len()),
        "ground": ground.map(ground_record),
    })))
}

fn plane(plane: &Plane, shown: &Shown<'_>) -> Value {
    let track = shown.tracks.and_then(|tracks| tracks.plane(tracks.id_of(plane.label)?));
    let id = track.map_or(u32::from(plane.label), |track| track.id);
    let class = shown.ground.and_then(|ground| ground.planes.get(usize::from(plane.label) - 1));
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
        "depth_m": depth_m(plane, shown.frame.sensor.value_kind),
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
fn rings(outlines: &Outlines, message: &mut Message) -> Vec<Value> {
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
    message.add_f32("corners_px", &pixels);
    message.add_f32("corners_m", &metres);
    rings
}

fn ground_record(ground: &Ground) -> Value {
    json!({
        "up": ground.up,
        "floor": ground.floor,
        "obstacles": ground.obstacles,
        "sectors": ground.sectors,
        "steps": ground.steps,
    })
}
