//! What holds for every run.

use crate::case::Case;
use crate::support;
use depthplanes::detection::{Curved, PixelBox};
use depthplanes::outline::{Outliner, Outlines, Ring};
use depthplanes::{AnyView, Detection, Detector, Plane, Result as Outcome};
use depthplanes_io::outputs::{OUTPUTS, Report};
use depthplanes_io::{Frame, Pixels};
use serde_json::Value;

type Check = Result<(), String>;

macro_rules! check {
    ($holds:expr, $($what:tt)+) => {
        let holds: bool = $holds;
        if !holds {
            return Err(format!($($what)+));
        }
    };
}

/// How many runs were more than a refusal.
#[derive(Debug, Default)]
pub struct Tally {
    pub refused: u64,
    pub with_planes: u64,
    pub in_metres: u64,
    pub with_curved: u64,
}

pub fn run(case: &Case, tally: &mut Tally) -> Check {
    let detect = |detector: &mut Detector| -> Outcome<Detection> {
        Ok(match &case.map.pixels {
            Pixels::U8(pixels) => detector.detect(case.map.view(pixels))?,
            Pixels::U16(pixels) => detector.detect(case.map.view(pixels))?,
            Pixels::F32(pixels) => detector.detect(case.map.view(pixels))?,
        }
        .clone())
    };
    let mut detector = detector(case, 1)?;
    let first = detect(&mut detector);
    check!(same(&first, &detect(&mut detector)), "the next frame has another answer");
    for threads in [2, 4] {
        check!(same(&first, &detect(&mut self::detector(case, threads)?)), "{threads} threads have another answer");
    }
    let packed = case.map.packed();
    let frame = frame(case, packed);
    if let Some(at) = case.explained
        && let Ok(found) = &first
    {
        let why = detector.explain(frame.view().map_err(|error| error.to_string())?, at);
        check!(why.is_ok() || case.coplanar.is_some(), "explain: {why:?}");
        check!(found.width > at[0], "the pixel lies in the map");
    }
    let found = match first {
        Ok(found) => found,
        Err(refused) => {
            check!(!refused.to_string().is_empty(), "a refusal without a message");
            tally.refused += 1;
            return Ok(());
        }
    };
    tally.with_planes += u64::from(!found.planes.is_empty());
    tally.in_metres += u64::from(found.planes.iter().any(|plane| plane.metric.is_some()));
    tally.with_curved += u64::from(found.curved.as_ref().is_some_and(|curved| !curved.regions.is_empty()));
    contract(case, &found, frame.view().map_err(|error| error.to_string())?)?;
    found.planes.iter().try_for_each(finite)?;
    found.parts.iter().try_for_each(|part| finite(&part.plane))?;
    let mut outliner = Outliner::new(case.outline_tolerance_px).map_err(|error| error.to_string())?;
    let outlines = outliner.outline(&found, case.sensor.intrinsics.as_ref()).map_err(|error| error.to_string())?;
    finite_outlines(outlines)?;
    outputs(case, &frame, &found, outlines)
}

fn detector(case: &Case, threads: usize) -> Result<Detector, String> {
    let method = case.method.of_values(&case.values).map_err(|error| error.to_string())?;
    let detector = Detector::new(method).map_err(|error| error.to_string())?;
    let detector = detector.sensor(case.sensor).threads(threads).curved(case.curved);
    match case.coplanar {
        Some(within) => detector.merge_coplanar(within).map_err(|error| error.to_string()),
        None => Ok(detector),
    }
}

/// Whether two answers are the same to the last bit, numbers that are none included.
fn same(one: &Outcome<Detection>, other: &Outcome<Detection>) -> bool {
    match (one, other) {
        (Ok(one), Ok(other)) => {
            let records = |found: &Detection| format!("{:?} {:?}", found.planes, found.parts);
            let regions = |found: &Detection| found.curved.clone();
            one.labels == other.labels && regions(one) == regions(other) && records(one) == records(other)
        }
        (one, other) => format!("{one:?}") == format!("{other:?}"),
    }
}

fn frame(case: &Case, pixels: Pixels) -> Frame {
    let (width, height, sensor) = (case.map.width, case.map.height, case.sensor);
    let (missing, valid_range) = (case.map.missing, case.map.valid_range);
    Frame { width, height, pixels, missing, valid_range, sensor, ..support::frame() }
}

/// The labels are those of the records, and no pixel is in two surfaces.
fn contract(case: &Case, found: &Detection, view: AnyView<'_>) -> Check {
    let (width, height) = (case.map.width, case.map.height);
    check!((found.width, found.height) == (width, height), "another size");
    let valid = depthplanes::with_view!(view, view => view.valid_pixels());
    check!(found.valid_pixels <= valid, "{} of {valid} pixels are valid", found.valid_pixels);
    let planes = found.planes.iter().map(|plane| (plane.label, plane.pixel_count, plane.bounding_box, plane.centroid));
    records("plane", &found.labels, width, planes.collect())?;
    check!(found.curved.is_some() == case.curved, "curved regions are given where they were not asked for, or not");
    for plane in &found.planes {
        check!((0.0..=1.0).contains(&plane.share_of_valid), "share {}", plane.share_of_valid);
    }
    if let Some(Curved { labels, regions, .. }) = &found.curved {
        let regions =
            regions.iter().map(|region| (region.label, region.pixel_count, region.bounding_box, region.centroid));
        records("curved region", labels, width, regions.collect())?;
        let both = labels.iter().zip(&found.labels).filter(|(curved, plane)| **curved > 0 && **plane > 0).count();
        check!(both == 0, "{both} pixels are both curved and in a plane");
    }
    Ok(())
}

fn records(what: &str, labels: &[u16], width: usize, records: Vec<(u16, usize, PixelBox, [f64; 2])>) -> Check {
    struct Seen {
        count: usize,
        first: usize,
        bounds: PixelBox,
        sum: [f64; 2],
    }
    let nothing = PixelBox { u_min: u32::MAX, v_min: u32::MAX, u_max: 0, v_max: 0 };
    let mut seen: Vec<Seen> = Vec::new();
    seen.resize_with(records.len(), || Seen { count: 0, first: usize::MAX, bounds: nothing, sum: [0.0; 2] });
    for (at, &label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
        let Some(seen) = seen.get_mut(usize::from(label) - 1) else {
            return Err(format!("{what} {label} of {} occurs", records.len()));
        };
        let (u, v) = ((at % width) as u32, (at / width) as u32);
        seen.count += 1;
        seen.first = seen.first.min(at);
        let PixelBox { u_min, v_min, u_max, v_max } = &mut seen.bounds;
        (*u_min, *v_min, *u_max, *v_max) = (u.min(*u_min), v.min(*v_min), u.max(*u_max), v.max(*v_max));
        seen.sum = [seen.sum[0] + f64::from(u), seen.sum[1] + f64::from(v)];
    }
    for (at, ((label, count, bounds, centroid), seen)) in records.iter().zip(&seen).enumerate() {
        check!(usize::from(*label) == at + 1, "{what} {} is called {label}", at + 1);
        check!(*count == seen.count && *count > 0, "{what} {label} has {count} pixels, {} are labelled", seen.count);
        check!(*bounds == seen.bounds, "{what} {label} lies in {:?}, its box is {bounds:?}", seen.bounds);
        for axis in 0..2 {
            let mean = seen.sum[axis] / seen.count as f64;
            check!((mean - centroid[axis]).abs() < 1e-6, "{what} {label} has its middle at {mean}, not {centroid:?}");
        }
    }
    let order = |pair: &[Seen]| (pair[1].count, pair[0].first) < (pair[0].count, pair[1].first);
    check!(seen.windows(2).all(order), "a {what} stands behind a smaller one");
    Ok(())
}

fn all_finite(what: &str, numbers: impl IntoIterator<Item = f64>) -> Check {
    for number in numbers {
        check!(number.is_finite(), "{what} has {number}");
    }
    Ok(())
}

fn finite(plane: &Plane) -> Check {
    all_finite("the plane's middle", plane.centroid)?;
    if let Some(fit) = plane.fit {
        all_finite("the fit", [fit.gradient[0], fit.gradient[1], fit.offset, fit.rms])?;
    }
    let Some(metric) = plane.metric else { return Ok(()) };
    all_finite("the normal", metric.plane.normal)?;
    all_finite("the distance", [metric.plane.distance])?;
    all_finite("rms_m", [metric.rms_m])?;
    all_finite("centroid_m", metric.centroid_m)?;
    all_finite("the area", metric.area_m2)?;
    all_finite("the covariance", metric.covariance.into_iter().flatten())?;
    let length = metric.plane.normal.iter().map(|x| x * x).sum::<f64>();
    check!((length - 1.0).abs() < 1e-9, "the normal's squared length is {length}");
    check!(metric.area_m2.is_none_or(|area| area >= 0.0), "the area is {:?}", metric.area_m2);
    check!((0..4).all(|i| metric.covariance[i][i] >= 0.0), "negative variances: {:?}", metric.covariance);
    Ok(())
}

fn finite_outlines(outlines: &Outlines) -> Check {
    let ring = |ring: Ring<'_>| {
        all_finite("an outline in pixels", ring.points_px().flatten())?;
        all_finite("an outline in metres", ring.points_m().into_iter().flatten().flatten())
    };
    for outline in outlines.iter() {
        for polygon in outline.polygons() {
            ring(polygon.outer())?;
            polygon.holes().try_for_each(ring)?;
        }
        ring(outline.hull())?;
        let pixels = outline.rectangle_px();
        all_finite("a rectangle in pixels", [pixels.centre, pixels.axes[0], pixels.axes[1], pixels.sides].concat())?;
        if let Some(metres) = outline.rectangle_m() {
            let [x, y] = metres.axes;
            all_finite("a rectangle in metres", [metres.centre, x, y].concat())?;
            all_finite("a rectangle in metres", metres.sides)?;
        }
    }
    Ok(())
}

fn outputs(case: &Case, frame: &Frame, found: &Detection, outlines: &Outlines) -> Check {
    let report = Report {
        method: case.method,
        parameters: &case.values,
        coplanar: case.coplanar,
        outlines: Some(outlines),
        legend: case.curved,
        ..support::report(frame, found)
    };
    for output in OUTPUTS.iter().filter(|output| report.has_what_it_takes(output)) {
        for writer in output.writers {
            let bytes = (writer.encode)(&report).map_err(|error| format!("{}: {error}", output.name))?;
            match writer.extension {
                "json" => json("", &serde_json::from_slice(&bytes).map_err(|error| error.to_string())?)?,
                "csv" => csv(&bytes)?,
                "ply" => ply(output.name, &bytes)?,
                _ => (),
            }
        }
    }
    Ok(())
}

/// Fields that may be null: what is not known.
const UNKNOWN: &[&str] = &[
    "preset",
    "missing",
    "valid_range",
    "intrinsics",
    "noise",
    "smooth",
    "fit",
    "metric",
    "area_m2",
    "polygons_m",
    "hull_m",
    "rectangle_m",
];

/// A number that is none is written as null.
fn json(name: &str, value: &Value) -> Check {
    match value {
        Value::Null => {
            check!(UNKNOWN.contains(&name), "`{name}` is null in the record");
            Ok(())
        }
        Value::Array(values) => values.iter().try_for_each(|value| json("an element of a list", value)),
        Value::Object(fields) => fields.iter().try_for_each(|(name, value)| json(name, value)),
        _ => Ok(()),
    }
}

fn csv(bytes: &[u8]) -> Check {
    let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
    for line in text.lines().skip(1) {
        let numbers = line.rsplit(',').take(22).filter(|field| !field.is_empty());
        all_finite("the table", numbers.map(|field| field.parse().unwrap_or(f64::NAN)))?;
    }
    Ok(())
}

/// Vertices of three floats, three colours and a label.
fn ply(name: &str, bytes: &[u8]) -> Check {
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|part| part == end).ok_or("no header")? + end.len();
    let header = String::from_utf8_lossy(&bytes[..start]);
    let line = header.lines().find_map(|line| line.strip_prefix("element vertex ")).ok_or("no vertices")?;
    let count: usize = line.parse().map_err(|_| "no number of vertices")?;
    for vertex in bytes[start..].chunks(17).take(count) {
        let numbers =
            vertex[..12].chunks(4).map(|four| f64::from(f32::from_le_bytes([four[0], four[1], four[2], four[3]])));
        all_finite(name, numbers)?;
    }
    Ok(())
}
