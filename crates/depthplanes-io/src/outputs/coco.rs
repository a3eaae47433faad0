//! The planes as annotations of COCO: boxes, and masks by run lengths, which keep holes and single pixels.
//!
//! The form is that of COCO's object detection (cocodataset.org, "Data format"): counts of a mask go down the columns, pixels
//! outside of it first. Each annotation also has the plane's equation, which tools pass over.

use super::output::Report;
use depthplanes::{Detection, Plane};
use serde_json::{Value, json};

/// The one image and the one category of a file.
const ONE: u32 = 1;

/// The document.
pub(super) fn document(report: &Report<'_>) -> String {
    let detection = report.detection;
    let annotation = |plane: &Plane| annotation(detection, plane);
    json!({
        "info": {"description": "planes found by depthplanes", "version": env!("CARGO_PKG_VERSION")},
        "images": [{"id": ONE, "file_name": report.source, "width": detection.width, "height": detection.height}],
        "categories": [{"id": ONE, "name": "plane", "supercategory": "surface"}],
        "annotations": detection.planes.iter().map(annotation).collect::<Vec<_>>(),
    })
    .to_string()
        + "\n"
}

fn annotation(detection: &Detection, plane: &Plane) -> Value {
    let pixels = plane.bounding_box;
    let [width, height] = [pixels.u_max - pixels.u_min + 1, pixels.v_max - pixels.v_min + 1];
    let equation = plane.metric.map(|metric| {
        let ([a, b, c], d) = (metric.plane.normal, metric.plane.distance);
        [a, b, c, d]
    });
    json!({
        "id": plane.label,
        "image_id": ONE,
        "category_id": ONE,
        "iscrowd": 0,
        "bbox": [pixels.u_min, pixels.v_min, width, height],
        "area": plane.pixel_count,
        "segmentation": {"size": [detection.height, detection.width], "counts": counts(detection, plane.label)},
        "plane": equation,
    })
}

/// Lengths of runs down the columns: outside of the plane, on it, and so on in turn.
fn counts(detection: &Detection, label: u16) -> Vec<usize> {
    let (width, height) = (detection.width, detection.height);
    let (mut counts, mut is_on, mut length) = (Vec::new(), false, 0);
    for (u, v) in (0..width).flat_map(|u| (0..height).map(move |v| (u, v))) {
        if (detection.labels[v * width + u] == label) != is_on {
            counts.push(length);
            (is_on, length) = (!is_on, 0);
        }
        length += 1;
    }
    counts.push(length);
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_go_down_the_columns_and_begin_outside() {
        let mut found = Detection::default();
        (found.width, found.height, found.labels) = (3, 2, vec![1, 0, 1, 1, 2, 1]);
        assert_eq!(counts(&found, 1), [0, 2, 2, 2]);
        assert_eq!(counts(&found, 2), [3, 1, 2]);
        assert_eq!(counts(&found, 9), [6]);
    }
}
