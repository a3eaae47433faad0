//! The outlines of the planes as GeoJSON (RFC 7946), in pixels: positions are (u, v), centres of pixels at whole numbers.
//!
//! A plane is one feature, and its parts are the polygons of it. The outer rings turn from u towards v, and holes the other way,
//! as the standard has it of its x and y.

use super::error::OutputError;
use super::output::Report;
use depthplanes::Plane;
use depthplanes::outline::{Outline, Outliner, Outlines, Ring};
use serde_json::{Value, json};

/// The document; outlines that the report does not have are made within the usual tolerance.
pub(super) fn document(report: &Report<'_>) -> Result<String, OutputError> {
    let mut outliner = Outliner::default();
    let outlines: &Outlines = match report.outlines {
        Some(outlines) => outlines,
        None => outliner.outline_seen_by(report.detection, &report.frame.sensor)?,
    };
    let planes = report.detection.planes.iter();
    let features = planes.filter_map(|plane| Some(feature(plane, &outlines.get(plane.label)?)));
    let collection = json!({
        "type": "FeatureCollection",
        "source": report.source,
        "width": report.detection.width,
        "height": report.detection.height,
        "features": features.collect::<Vec<_>>(),
    });
    Ok(collection.to_string() + "\n")
}

fn feature(plane: &Plane, outline: &Outline<'_>) -> Value {
    let polygons: Vec<Value> = outline
        .polygons()
        .map(|polygon| {
            let holes = polygon.holes().map(|hole| ring(&hole, false));
            std::iter::once(ring(&polygon.outer(), true)).chain(holes).collect()
        })
        .collect();
    let metric = plane.metric;
    json!({
        "type": "Feature",
        "id": plane.label,
        "geometry": {"type": "MultiPolygon", "coordinates": polygons},
        "properties": {
            "label": plane.label,
            "pixel_count": plane.pixel_count,
            "normal": plane.normal(),
            "distance_m": plane.distance_m(),
            "rms_m": metric.map(|metric| metric.rms_m),
            "centroid_m": metric.map(|metric| metric.centroid_m),
            "area_m2": metric.and_then(|metric| metric.area_m2),
        },
    })
}

/// A ring that ends where it begins and turns as asked.
fn ring(ring: &Ring<'_>, is_outer: bool) -> Value {
    let mut points: Vec<[f64; 2]> = ring.points_px().collect();
    if (twice_area(&points) > 0.0) != is_outer {
        points.reverse();
    }
    points.extend(points.first().copied());
    json!(points)
}

/// Twice the area within a ring, above 0 where it turns from the first axis towards the second (the shoelace formula).
fn twice_area(points: &[[f64; 2]]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum()
}
