//! The planes as text: JSON with everything that is known of the frame, CSV with one line a plane, and forms of others.

use super::output::{Output, Report, Writer};
use super::record::FrameRecord;
use super::{coco, geojson};
use depthplanes::Plane;
use serde_json::Value;
use std::fmt::Write;

pub(super) const OUTPUT: Output = Output {
    name: "planes",
    about: "planes with their equations, as JSON with the whole record, CSV, GeoJSON or COCO",
    file: "planes.json",
    needs_camera: false,
    needs_curved: false,
    writers: &[
        Writer { extension: "json", encode: |report| Ok(document(report).into_bytes()) },
        Writer { extension: "csv", encode: |report| Ok(csv(report).into_bytes()) },
        Writer { extension: "geojson", encode: |report| Ok(geojson::document(report)?.into_bytes()) },
        Writer { extension: "coco.json", encode: |report| Ok(coco::document(report).into_bytes()) },
    ],
};

/// The columns of the CSV form, in order. A number that is not known is left empty.
pub const CSV_COLUMNS: &[&str] = &[
    "source",
    "label",
    "pixel_count",
    "share_of_valid",
    "u_min",
    "v_min",
    "u_max",
    "v_max",
    "centroid_u",
    "centroid_v",
    "gradient_u",
    "gradient_v",
    "offset",
    "rms",
    "normal_x",
    "normal_y",
    "normal_z",
    "distance_m",
    "rms_m",
    "centroid_x_m",
    "centroid_y_m",
    "centroid_z_m",
    "area_m2",
];

/// The record as one line of JSON, without a line feed.
pub fn line(report: &Report<'_>) -> String {
    serde_json::to_string(&FrameRecord::from(report)).expect("numbers and strings are always JSON")
}

/// The record as a JSON document for people too: one field a line, one plane a line.
pub fn document(report: &Report<'_>) -> String {
    let record = serde_json::to_value(FrameRecord::from(report)).expect("numbers and strings are always JSON");
    let Value::Object(fields) = record else { unreachable!("a record is an object") };
    let field = |(name, value): (&String, &Value)| match value {
        Value::Array(planes) if name == "planes" && !planes.is_empty() => {
            let lines: Vec<String> = planes.iter().map(|plane| format!("    {plane}")).collect();
            format!("  \"{name}\": [\n{}\n  ]", lines.join(",\n"))
        }
        _ => format!("  \"{name}\": {value}"),
    };
    let fields: Vec<String> = fields.iter().map(field).collect();
    format!("{{\n{}\n}}\n", fields.join(",\n"))
}

fn csv(report: &Report<'_>) -> String {
    csv_head() + &csv_rows(report)
}

/// The line of the columns' names.
pub(super) fn csv_head() -> String {
    CSV_COLUMNS.join(",") + "\n"
}

/// A line for each plane.
pub(super) fn csv_rows(report: &Report<'_>) -> String {
    let source = quoted(report.source);
    let mut text = String::new();
    for plane in &report.detection.planes {
        let numbers: Vec<String> = numbers(plane).iter().map(number).collect();
        // Writing to a string never fails.
        let _ = writeln!(text, "{source},{}", numbers.join(","));
    }
    text
}

/// A line for each plane with the same as an array of JSON, null where a number is not known.
#[cfg(feature = "parquet")]
pub(super) fn array_rows(report: &Report<'_>) -> String {
    let mut text = String::new();
    for plane in &report.detection.planes {
        let row: Vec<Value> =
            std::iter::once(report.source.into()).chain(numbers(plane).into_iter().map(Value::from)).collect();
        let _ = writeln!(text, "{}", Value::Array(row));
    }
    text
}

/// All columns after the source.
fn numbers(plane: &Plane) -> Vec<Option<f64>> {
    let pixels = plane.bounding_box;
    let mut all = vec![f64::from(plane.label), plane.pixel_count as f64, plane.share_of_valid];
    all.extend([pixels.u_min, pixels.v_min, pixels.u_max, pixels.v_max].map(f64::from));
    all.extend(plane.centroid);
    let fit = plane.fit.map(|fit| [fit.gradient[0], fit.gradient[1], fit.offset, fit.rms]);
    let metric = plane.metric.map(|metric| {
        let ([nx, ny, nz], [x, y, z]) = (metric.plane.normal, metric.centroid_m);
        [nx, ny, nz, metric.plane.distance, metric.rms_m, x, y, z]
    });
    let area = plane.metric.and_then(|metric| metric.area_m2);
    let mut columns: Vec<Option<f64>> = all.into_iter().map(Some).collect();
    columns.extend(fit.map_or([None; 4], |fit| fit.map(Some)));
    columns.extend(metric.map_or([None; 8], |metric| metric.map(Some)));
    columns.push(area);
    columns
}

fn number(value: &Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map(|value| value.to_string()).unwrap_or_default()
}

/// A CSV field (RFC 4180): quoted where it holds a comma, a quote or a line feed.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}
