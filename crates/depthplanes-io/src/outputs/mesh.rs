//! The planes as a mesh: each in its colour, cut out along its outline, with its holes.
//!
//! Binary little-endian PLY in the optical frame (x right, y down, z forward), metres. Vertices lie
//! on the fitted planes; faces turn counter-clockwise seen from the camera. Planes that are not
//! known in metres, reach infinity or lie beyond single precision are left out.

use super::colour::colour;
use super::error::OutputError;
use super::output::{Output, Report, Writer};
use depthplanes::outline::{Outline, Outliner, Outlines, Polygon, Ring};
use earcut::Earcut;

pub(super) const OUTPUT: Output = Output {
    name: "mesh",
    about: "planes as coloured surfaces with holes, in metres; needs the camera",
    file: "mesh.ply",
    needs_camera: true,
    needs_curved: false,
    writers: &[Writer { extension: "ply", encode: ply }],
};

fn ply(report: &Report<'_>) -> Result<Vec<u8>, OutputError> {
    let sensor = report.metric_sensor()?;
    Ok(match report.outlines {
        Some(outlines) => mesh_ply(outlines),
        None => mesh_ply(Outliner::default().outline_seen_by(report.detection, &sensor)?),
    })
}

/// Planes as the bytes of a binary PLY file: coloured surfaces with holes, metres in camera coordinates. Planes that are not
/// known in metres are left out.
///
/// ```
/// use depthplanes::{DepthView, Detector, Intrinsics, Sensor, outline::Outliner};
/// use depthplanes_io::outputs::mesh_ply;
/// let depth_mm = [1000u16; 64 * 48];
/// let camera = Intrinsics::new(58.0, 58.0, 31.5, 23.5)?;
/// let mut detector = Detector::default().sensor(Sensor::default().intrinsics(camera));
/// let found = detector.detect(DepthView::new(&depth_mm, 64, 48)?)?;
/// let ply = mesh_ply(Outliner::default().outline(found, Some(&camera))?);
/// assert!(ply.starts_with(b"ply\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mesh_ply(outlines: &Outlines) -> Vec<u8> {
    let mut mesh = Mesh::default();
    mesh.add_planes(outlines);
    mesh.ply()
}

#[derive(Default)]
struct Mesh {
    /// Three floats, three colour channels, one label for each.
    vertices: Vec<u8>,
    vertex_count: u32,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    fn add_planes(&mut self, outlines: &Outlines) {
        let mut earcut = Earcut::new();
        for outline in outlines.iter().filter(is_in_reach) {
            outline.polygons().for_each(|polygon| self.add(&polygon, outline.label(), &mut earcut));
        }
    }

    /// Triangles are cut on the picture, where straight lines are straight as well.
    fn add(&mut self, polygon: &Polygon<'_>, label: u16, earcut: &mut Earcut<f64>) {
        let rings = || std::iter::once(polygon.outer()).chain(polygon.holes());
        let (mut points, mut holes, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        for ring in rings() {
            holes.push(points.len() as u32);
            points.extend(ring.points_px());
        }
        earcut.earcut(points.iter().copied(), &holes[1..], &mut triangles);
        let turned = turns_back(&points[..holes.get(1).map_or(points.len(), |&end| end as usize)]);
        for triangle in triangles.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|corner| self.vertex_count + corner);
            let against = turns_back(&triangle.map(|corner| points[corner as usize]));
            self.triangles.push(if against == turned { [a, b, c] } else { [a, c, b] });
        }
        for point in rings().filter_map(|ring| ring.points_m()).flatten() {
            self.vertices.extend(point.iter().flat_map(|&x| (x as f32).to_le_bytes()));
            self.vertices.extend(colour(label));
            self.vertices.extend(label.to_le_bytes());
            self.vertex_count += 1;
        }
    }

    fn ply(self) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\ncomment depthplanes: metres, x right, y down, z forward\n\
             element vertex {}\n\
             property float x\nproperty float y\nproperty float z\n\
             property uchar red\nproperty uchar green\nproperty uchar blue\n\
             property ushort label\n\
             element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.vertex_count,
            self.triangles.len()
        )
        .into_bytes();
        bytes.extend(self.vertices);
        for triangle in self.triangles {
            bytes.push(3);
            bytes.extend(triangle.iter().flat_map(|corner| corner.to_le_bytes()));
        }
        bytes
    }
}

/// Whether all corners of an outline are known in metres and can be written in single precision.
fn is_in_reach(outline: &Outline<'_>) -> bool {
    let is_finite =
        |ring: Ring<'_>| ring.points_m().is_some_and(|points| points.flatten().all(|x| (x as f32).is_finite()));
    let mut rings = outline.polygons().flat_map(|polygon| std::iter::once(polygon.outer()).chain(polygon.holes()));
    rings.all(is_finite)
}

/// Whether a ring on the picture has a negative area, u to the right and v down.
fn turns_back(ring: &[[f64; 2]]) -> bool {
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - b[0] * a[1];
    let (Some(&first), Some(&last)) = (ring.first(), ring.last()) else { return false };
    ring.windows(2).map(|pair| cross(pair[0], pair[1])).sum::<f64>() + cross(last, first) < 0.0
}
