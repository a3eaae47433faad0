//! Outlines and ids of planes as RViz and Foxglove show them.

use crate::messages::{Colour, Header, Marker, MarkerArray, Point, Pose};
use depthplanes::outline::{Outline, Outliner};
use depthplanes::track::Tracks;
use depthplanes::{Detection, Result, Sensor};
use depthplanes_io::outputs::colour;

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
    let outlines = outliner.outline_seen_by(detection, sensor)?;
    let mut markers = vec![Marker { header: header.clone(), action: Marker::DELETE_ALL, ..Marker::default() }];
    for plane in &detection.planes {
        let Some(id) = tracks.id_of(plane.label) else { continue };
        let Some(outline) = outlines.get(plane.label).filter(Outline::is_metric) else { continue };
        markers.push(rings(outline, marker(id, header)));
        markers.extend(plane.metric.map(|metric| text(metric.centroid_m, id, marker(id, header))));
    }
    Ok(MarkerArray { markers })
}

fn marker(id: u32, header: &Header) -> Marker {
    let label = (id.saturating_sub(1) % u32::from(u16::MAX)) as u16 + 1;
    let [r, g, b] = colour(label).map(|part| f32::from(part) / 255.0);
    let color = Colour { r, g, b, a: 1.0 };
    Marker { header: header.clone(), id: id as i32, action: Marker::ADD, color, ..Marker::default() }
}

/// The rings of all parts of a plane and of their holes, each closed.
fn rings(outline: Outline<'_>, marker: Marker) -> Marker {
    let rings = outline.polygons().flat_map(|polygon| std::iter::once(polygon.outer()).chain(polygon.holes()));
    let mut points: Vec<Point> = Vec::new();
    for ring in rings.filter_map(|ring| ring.points_m()) {
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
