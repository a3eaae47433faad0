//! The frame's record as it stands in JSON; docs/planes-schema.md describes each field.

use super::noise::NoiseRecord;
use super::outline::OutlineRecord;
use super::output::Report;
use super::times::{Spread, Times};
use depthplanes::detection::{CurvedRegion, PixelBox};
use depthplanes::methods::ParamKind;
use depthplanes::{Coplanar, Distortion, Intrinsics, Plane, ValueKind};
use serde::Serialize;
use serde_json::{Map, Number, Value};

/// Name and version of the layout. A field may be added within a version; none changes its meaning.
pub const SCHEMA: &str = "depthplanes.planes/1";

#[derive(Serialize)]
pub(super) struct FrameRecord<'a> {
    schema: &'static str,
    version: &'static str,
    source: &'a str,
    format: &'static str,
    encoding: &'static str,
    encoding_from: &'a str,
    preset: Option<&'static str>,
    ray_distance: bool,
    missing: Option<f64>,
    valid_range: Option<(f64, f64)>,
    width: usize,
    height: usize,
    /// The value kind.
    measure: ValueKindRecord,
    intrinsics: Option<IntrinsicsRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    distortion: Option<DistortionRecord>,
    method: &'static str,
    parameters: Map<String, Value>,
    noise: Option<NoiseRecord>,
    valid_pixels: usize,
    filled_pixels: usize,
    labelled_pixels: usize,
    labelled_share: f64,
    warnings: Vec<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    merge_coplanar: Option<CoplanarRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    outline_tolerance_px: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    outline_min_hole_px: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    time_ms: Option<Map<String, Value>>,
    planes: Vec<PlaneRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curved: Option<Vec<CurvedRecord>>,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum ValueKindRecord {
    Depth { metres_per_unit: f64 },
    InverseDepth { slope_per_m: f64, offset_per_m: f64 },
    Disparity,
}

#[derive(Serialize)]
struct IntrinsicsRecord {
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
}

#[derive(Serialize)]
struct CoplanarRecord {
    angle_deg: f64,
    distance_m: f64,
}

#[derive(Serialize)]
struct PlaneRecord {
    label: u16,
    pixel_count: usize,
    share_of_valid: f64,
    bounding_box: BoxRecord,
    centroid_px: [f64; 2],
    fit: Option<FitRecord>,
    metric: Option<MetricRecord>,
    #[serde(skip_serializing_if = "Option::is_none")]
    outline: Option<OutlineRecord>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<PlaneRecord>,
}

#[derive(Serialize)]
struct CurvedRecord {
    label: u16,
    pixel_count: usize,
    bounding_box: BoxRecord,
    centroid_px: [f64; 2],
}

#[derive(Serialize)]
struct BoxRecord {
    u_min: u32,
    v_min: u32,
    u_max: u32,
    v_max: u32,
}

#[derive(Serialize)]
struct FitRecord {
    gradient: [f64; 2],
    offset: f64,
    rms: f64,
}

#[derive(Serialize)]
struct DistortionRecord {
    model: &'static str,
    coefficients: Vec<f64>,
}

#[derive(Serialize)]
struct MetricRecord {
    normal: [f64; 3],
    distance_m: f64,
    rms_m: f64,
    centroid_m: [f64; 3],
    area_m2: Option<f64>,
    covariance: [[f64; 4]; 4],
    covariance_from: &'static str,
}

impl<'a> From<&Report<'a>> for FrameRecord<'a> {
    fn from(report: &Report<'a>) -> Self {
        let (frame, detection) = (report.frame, report.detection);
        FrameRecord {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            source: report.source,
            format: frame.format,
            encoding: frame.encoding,
            encoding_from: &frame.provenance.encoding,
            preset: frame.provenance.preset,
            ray_distance: frame.provenance.ray_distance,
            missing: frame.missing,
            valid_range: frame.valid_range,
            width: frame.width,
            height: frame.height,
            measure: frame.sensor.value_kind.into(),
            intrinsics: frame.sensor.intrinsics.map(IntrinsicsRecord::from),
            distortion: frame.sensor.distortion.map(DistortionRecord::from),
            method: report.method.name,
            parameters: parameters(report),
            noise: NoiseRecord::of(report),
            valid_pixels: detection.valid_pixels,
            filled_pixels: detection.filled_pixels,
            labelled_pixels: detection.labelled_pixels(),
            labelled_share: detection.labelled_share(),
            warnings: frame.warnings.iter().chain(report.notes).map(String::as_str).collect(),
            merge_coplanar: report.coplanar.map(CoplanarRecord::from),
            outline_tolerance_px: report.outlines.map(|outlines| outlines.tolerance_px()),
            outline_min_hole_px: report.outlines.map(|outlines| outlines.min_hole_px()).filter(|&pixels| pixels > 0),
            time_ms: report.times.map(times),
            planes: detection.planes.iter().map(|plane| PlaneRecord::with_all(plane, report)).collect(),
            curved: detection.curved.as_ref().map(|curved| curved.regions.iter().map(CurvedRecord::from).collect()),
        }
    }
}

fn parameters(report: &Report<'_>) -> Map<String, Value> {
    let pair = |(param, &value): (&depthplanes::methods::Param, &f64)| {
        let whole = param.kind != ParamKind::Real;
        let number = if whole { Some(Number::from(value as i64)) } else { Number::from_f64(value) };
        (param.name.to_string(), number.map_or(Value::Null, Value::Number))
    };
    report.method.params.iter().zip(report.parameters).map(pair).collect()
}

fn times(times: &Times) -> Map<String, Value> {
    let spread = |name: &str, spread: &Spread| {
        (name.to_string(), serde_json::to_value(spread).expect("two numbers are always JSON"))
    };
    let mut all: Map<String, Value> = [spread("total", &times.total)].into_iter().collect();
    all.extend(times.stages.iter().map(|(name, stage)| spread(name, stage)));
    all
}

impl From<ValueKind> for ValueKindRecord {
    fn from(value_kind: ValueKind) -> Self {
        match value_kind {
            ValueKind::Depth { metres } => ValueKindRecord::Depth { metres_per_unit: metres },
            ValueKind::InverseDepth { slope, offset } => {
                ValueKindRecord::InverseDepth { slope_per_m: slope, offset_per_m: offset }
            }
            ValueKind::Disparity => ValueKindRecord::Disparity,
        }
    }
}

impl From<Distortion> for DistortionRecord {
    fn from(distortion: Distortion) -> Self {
        DistortionRecord { model: distortion.model().name(), coefficients: distortion.coefficients().to_vec() }
    }
}

impl From<Intrinsics> for IntrinsicsRecord {
    fn from(camera: Intrinsics) -> Self {
        IntrinsicsRecord { fx: camera.fx, fy: camera.fy, cx: camera.cx, cy: camera.cy }
    }
}

impl From<Coplanar> for CoplanarRecord {
    fn from(within: Coplanar) -> Self {
        CoplanarRecord { angle_deg: within.angle_deg, distance_m: within.distance_m }
    }
}

impl PlaneRecord {
    /// With its outline and its parts.
    fn with_all(plane: &Plane, report: &Report<'_>) -> Self {
        let outline = report.outlines.and_then(|outlines| outlines.get(plane.label)).map(OutlineRecord::from);
        let parts = report.detection.parts_of(plane.label).iter().map(|part| PlaneRecord::new(&part.plane)).collect();
        PlaneRecord { outline, parts, ..PlaneRecord::new(plane) }
    }

    fn new(plane: &Plane) -> Self {
        PlaneRecord {
            label: plane.label,
            pixel_count: plane.pixel_count,
            share_of_valid: plane.share_of_valid,
            bounding_box: plane.bounding_box.into(),
            centroid_px: plane.centroid,
            fit: plane.fit.map(|fit| FitRecord { gradient: fit.gradient, offset: fit.offset, rms: fit.rms }),
            metric: plane.metric.map(|metric| MetricRecord {
                normal: metric.plane.normal,
                distance_m: metric.plane.distance,
                rms_m: metric.rms_m,
                centroid_m: metric.centroid_m,
                area_m2: metric.area_m2,
                covariance: metric.covariance,
                covariance_from: metric.covariance_from.name(),
            }),
            outline: None,
            parts: Vec::new(),
        }
    }
}

impl From<PixelBox> for BoxRecord {
    fn from(pixels: PixelBox) -> Self {
        BoxRecord { u_min: pixels.u_min, v_min: pixels.v_min, u_max: pixels.u_max, v_max: pixels.v_max }
    }
}

impl From<&CurvedRegion> for CurvedRecord {
    fn from(region: &CurvedRegion) -> Self {
        CurvedRecord {
            label: region.label,
            pixel_count: region.pixel_count,
            bounding_box: region.bounding_box.into(),
            centroid_px: region.centroid,
        }
    }
}
