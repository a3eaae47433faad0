//! Outlines and ids of planes as RViz and Foxglove show them.

use crate::messages::{Colour, Header, Marker, MarkerArray, Point, Pose};
use depthplanes::outline::Outliner;
use depthplanes::track::Tracks;
use depthplanes::{Detection, Result, Sensor};
use depthplanes_io::outputs::id_colour;
use depthplanes_video::{DrawnPlane, drawn_planes};

/// Width of outlines, metres.
const LINE_M: f64 = 0.01;
/// Height of ids, metres.
const TEXT_M: f64 = 0.1;

/// All markers of a frame. The first takes away those of the frame before, so that no message relies on another.
///
/// # Errors
/// Those of outlines.
pub(crate) fn markers(
    outliner: &mut Outliner,
    detection: &Detection,
    tracks: &Tracks,
    sensor: &Sensor,
    header: &Header,
) -> Result<MarkerArray> {
    let outlines = outliner.outline_labels(detection, tracks.labels_of(detection), sensor)?;
    let mut markers = vec![Marker { header: header.clone(), action: Marker::DELETE_ALL, ..Marker::default() }];
    for plane in drawn_planes(detection, tracks, outlines) {
        markers.push(rings(&plane, marker(plane.id, header)));
        markers.extend(plane.centroid_m().map(|at| text(at, plane.id, marker(plane.id, header))));
    }
    Ok(MarkerArray { markers })
}

fn marker(id: u32, header: &Header) -> Marker {
    let [r, g, b] = id_colour(id).map(|part| f32::from(part) / 255.0);
    let color = Colour { r, g, b, a: 1.0 };
    Marker { header: header.clone(), id: id as i32, action: Marker::ADD, color, ..Marker::default() }
}

/// The rings of all parts of a plane and of their holes, each closed.
fn rings(plane: &DrawnPlane<'_>, marker: Marker) -> Marker {
    let mut points: Vec<Point> = Vec::new();
    for ring in plane.rings_m() {
        let ring: Vec<Point> = ring.map(Point::from).collect();
        let next = ring.iter().cycle().skip(1);
        points.extend(ring.iter().zip(next).flat_map(|(&from, &to)| [from, to]));
    }
    let scale = Point { x: LINE_M, ..Point::default() };
    Marker { ns: "outlines".into(), r#type: Marker::LINE_LIST, scale, points, ..marker }
}

fn text(centroid_m: [f64; 3], id: u32, marker: Marker) -> Marker {
    let pose = Pose { position: centroid_m.into(), ..Pose::default() };
    let scale = Point { z: TEXT_M, ..Point::default() };
    Marker { ns: "ids".into(), r#type: Marker::TEXT_VIEW_FACING, scale, pose, text: id.to_string(), ..marker }
}
