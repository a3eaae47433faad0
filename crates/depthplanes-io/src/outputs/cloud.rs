//! The point cloud: every valid pixel in metres, with its colour and its plane's label.
//!
//! Binary little-endian PLY, which MeshLab, CloudCompare, Open3D and Blender read. Points are in the
//! optical frame: x right, y down, z forward. Points beyond single precision are left out.

use super::colour::palette;
use super::error::OutputError;
use super::output::{Output, Report, Writer};
use super::shade;
use depthplanes::with_view;

pub(super) const OUTPUT: Output = Output {
    name: "cloud",
    about: "point cloud in metres with colours and labels; needs the camera",
    file: "cloud.ply",
    needs_camera: true,
    needs_curved: false,
    writers: &[Writer { extension: "ply", encode: ply }],
};

fn ply(report: &Report<'_>) -> Result<Vec<u8>, OutputError> {
    let points = points(report)?;
    let count = points.len() / POINT_BYTES;
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\ncomment depthplanes: metres, x right, y down, z forward\n\
         element vertex {count}\n\
         property float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\n\
         property ushort label\nend_header\n"
    )
    .into_bytes();
    bytes.extend(points);
    Ok(bytes)
}

/// Three floats, three colour channels, one label.
const POINT_BYTES: usize = 3 * 4 + 3 + 2;

fn points(report: &Report<'_>) -> Result<Vec<u8>, OutputError> {
    let sensor = report.metric_sensor()?;
    let value_kind = sensor.value_kind;
    let greys = shade::greys(report.frame.view()?, report.frame.sensor.value_kind);
    let labels = &report.detection.labels;
    let palette = palette(report.detection.planes.len());
    let width = report.frame.width;
    let mut bytes = Vec::with_capacity(labels.len() * POINT_BYTES);
    let mut add = |at: usize, value: f64| {
        let Some(z) = value_kind.depth_m(value) else { return };
        let Some(ray) = sensor.ray((at % width) as f64, (at / width) as f64) else { return };
        let point = ray.map(|r| (r * z) as f32);
        if !point.iter().all(|x| x.is_finite()) {
            return; // beyond single precision
        }
        let label = labels[at];
        let shown = if label == 0 { greys[at] } else { palette[usize::from(label)] };
        bytes.extend(point.iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend(shown);
        bytes.extend(label.to_le_bytes());
    };
    with_view!(report.frame.view()?, view => {
        let valid = view.validity();
        for (at, &value) in view.rows().flatten().enumerate() {
            if valid.holds(value) {
                add(at, f64::from(value));
            }
        }
    });
    Ok(bytes)
}
