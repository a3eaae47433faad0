//! Planes that no camera sees.

use depthplanes::detection::MetricPlane;
use depthplanes::{Detector, Intrinsics, Plane, Sensor, ValueKind};

use crate::outputs::Report;
use crate::traps::{EXACTLY, doubt_of_depth, length};

/// The largest plane that a camera may see, m2: a field of 100 m x 100 m.
const LARGEST_M2: f64 = 1e4;

/// Metres: what is out of sight and nearer than this is too near, not too far.
const NEAR_M: f64 = 1.0;

/// A plane nearer or farther than cameras see.
pub(super) fn out_of_sight(report: &Report<'_>) -> Option<String> {
    let depth = |metric: &MetricPlane| metric.centroid_m[2];
    let doubt = |plane: &Plane| {
        let depth_m = depth(plane.metric.as_ref()?);
        Some((plane.label, depth_m, doubt_of_depth(report.frame, depth_m)?))
    };
    let odd: Vec<_> = report.detection.planes.iter().filter_map(doubt).collect();
    let (label, depth_m, remedy) = odd.first()?;
    let is_told = |words: &str| report.frame.warnings.iter().any(|warning| warning.contains(words));
    // It was told of the whole map, or of the pixels of the only odd plane.
    if is_told(remedy) || odd.len() == 1 && is_told(EXACTLY) {
        return None;
    }
    let others = match odd.len() {
        1 => String::new(),
        count => format!(" and {} more planes do so", count - 1),
    };
    // If most are odd it is the unit; a few among others are no surfaces.
    let remedy = match (odd.len() * 2 > report.detection.planes.len(), *depth_m < NEAR_M) {
        (true, _) => remedy.clone(),
        (false, true) => "pixels without depth rather than a surface? try --missing or --valid-range".into(),
        (false, false) => "a background rather than a surface? try --valid-range or --missing".into(),
    };
    Some(format!("plane {label} lies at a depth of {}{others}, where no camera sees: {remedy}", length(*depth_m)))
}

/// A plane larger than cameras see.
pub(super) fn huge(report: &Report<'_>) -> Option<String> {
    let area = |plane: &Plane| plane.metric.as_ref()?.area_m2;
    let plane = report.detection.planes.iter().find(|plane| area(plane).is_some_and(|area| area > LARGEST_M2))?;
    let within =
        plane.metric.as_ref().is_some_and(|metric| doubt_of_depth(report.frame, metric.centroid_m[2]).is_none());
    within.then(|| {
        let area = area(plane).unwrap_or_default();
        let camera = report.frame.sensor.intrinsics.map_or(String::new(), |camera| {
            format!(" (fx {}, fy {}, {} x {} pixels)", camera.fx, camera.fy, report.frame.width, report.frame.height)
        });
        format!(
            "plane {} has {area:.1e} m2, more than a camera sees: check the camera{camera} and the unit",
            plane.label
        )
    })
}

/// Scatter of a plane's points, as a share of its depth, beyond which it is no surface. Of 136 planes on more than a tenth of
/// 56 recorded frames it is 0.13 on a far one of a stereo camera, and at most 0.03 on all others.
const SCATTER: f64 = 0.15;

/// A plane whose points scatter as those of no surface do.
pub(super) fn scattered(report: &Report<'_>) -> Option<String> {
    let sensor = nominal(report)?;
    let mut detector;
    let again = match report.is_metric() {
        true => None,
        // Planes bend in the map's values: only those that scatter there are worth the time.
        false if !report.detection.planes.iter().any(scatters_in_values) => return None,
        false => {
            detector = Detector::default().sensor(sensor);
            Some(detector.detect(report.frame.view().ok()?).ok()?)
        }
    };
    let planes = again.unwrap_or(report.detection).planes.iter().filter(|plane| plane.share_of_valid > 0.1);
    let found = planes.filter_map(|plane| Some((plane.label, plane.metric.as_ref()?)));
    let (label, metric) = found.into_iter().find(|(_, metric)| metric.rms_m > SCATTER * metric.centroid_m[2])?;
    Some(format!(
        "the points of plane {label} scatter by {} at a depth of {}: noise or a photograph rather than a surface? check --encoding \
         and the file",
        length(metric.rms_m),
        length(metric.centroid_m[2])
    ))
}

/// The sensor, with a usual camera where none is known: how far points are off a plane hardly depends on it.
fn nominal(report: &Report<'_>) -> Option<Sensor> {
    let (frame, sensor) = (report.frame, report.frame.sensor);
    if sensor.intrinsics.is_some() {
        return Some(sensor);
    }
    let [width, height] = [frame.width, frame.height].map(|side| side as f64);
    let (is_depth, focal) = (matches!(sensor.value_kind, ValueKind::Depth { .. }), 0.9 * width.max(height));
    let camera = Intrinsics::new(focal, focal, 0.5 * (width - 1.0), 0.5 * (height - 1.0)).ok()?;
    (is_depth && report.method.name == "planar").then(|| sensor.intrinsics(Some(camera)))
}

fn scatters_in_values(plane: &Plane) -> bool {
    let ([u, v], is_large) = (plane.centroid, plane.share_of_valid > 0.1);
    is_large
        && plane.fit.is_some_and(|fit| fit.rms > SCATTER * (fit.gradient[0] * u + fit.gradient[1] * v + fit.offset))
}
