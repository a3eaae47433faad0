//! A report for people: what was read, what was found, and what to try if that is little.

use crate::table::{Align, aligned, row};
use crate::terminal::plain;
use depthplanes::detection::Curved;
use depthplanes::{Detection, Plane, ValueKind};
use depthplanes_io::Frame;
use depthplanes_io::outputs::{Report, Times, depth_m, noise_in_words};

/// One line on the frame, one on the method and what it found, one on the time if it was measured.
pub(crate) fn summary(report: &Report<'_>) -> String {
    let (frame, detection) = (report.frame, report.detection);
    let valid = percent(detection.valid_pixels as f64 / (frame.width * frame.height).max(1) as f64);
    let mut text = format!(
        "{}: {} x {}, {}, {} ({}), {valid} valid\n",
        plain(report.source),
        frame.width,
        frame.height,
        frame.format,
        frame.encoding,
        meaning(frame)
    );
    let planes = match detection.planes.len() {
        1 => "1 plane".into(),
        count => format!("{count} planes"),
    };
    let joined = detection.parts.chunk_by(|a, b| a.of == b.of).count();
    let joined = match joined {
        0 => String::new(),
        _ => format!(" ({joined} joined of {} parts)", detection.parts.len()),
    };
    let whole = if detection.filled_pixels > 0 { "valid and filled pixels" } else { "valid pixels" };
    let share = percent(detection.labelled_share());
    text += &format!("{}: {planes}{joined} on {share} of the {whole}\n", method(report));
    if let Some(curved) = &detection.curved {
        text += &surfaces(curved, detection);
    }
    if let Some(times) = report.times {
        text += &time(times);
    }
    text
}

/// One line on what a camera would add and what to type, where it is not known and could be. `preset`: whether one was
/// given, which then has no camera.
pub(crate) fn camera_hint(frame: &Frame, preset: bool) -> String {
    let sensor = frame.sensor;
    let adds = "adds distance, normal and area in metres";
    match sensor.value_kind {
        // Neither grey levels nor relative depth have metres, whatever the camera.
        ValueKind::Disparity if ["grey", "inverse-depth"].contains(&frame.encoding) => String::new(),
        _ if sensor.intrinsics.is_some() => String::new(),
        ValueKind::Disparity => {
            format!("no camera: --baseline METRES with --intrinsics FX,FY,CX,CY or --camera FILE {adds}\n")
        }
        _ if preset || matches!(sensor.value_kind, ValueKind::InverseDepth { .. }) => {
            format!("no camera: --intrinsics FX,FY,CX,CY or --camera FILE {adds}\n")
        }
        _ => format!("no camera: --preset SENSOR, --intrinsics FX,FY,CX,CY or --camera FILE {adds}\n"),
    }
}

/// One line on the surfaces that bend.
fn surfaces(curved: &Curved, detection: &Detection) -> String {
    let pixels: usize = curved.regions.iter().map(|region| region.pixel_count).sum();
    let share = percent(pixels as f64 / detection.valid_pixels.max(1) as f64);
    match curved.regions.len() {
        1 => format!("1 surface that bends on {share} of the valid pixels\n"),
        count => format!("{count} curved surfaces on {share} of the valid pixels\n"),
    }
}

fn meaning(frame: &Frame) -> String {
    match frame.sensor.value_kind {
        ValueKind::Depth { metres } => format!("depth, 1 unit = {}", length(metres)),
        ValueKind::InverseDepth { .. } => "inverse depth".into(),
        ValueKind::Disparity if frame.encoding == "grey" => "no unit".into(),
        ValueKind::Disparity if frame.encoding == "inverse-depth" => "inverse depth without a scale".into(),
        ValueKind::Disparity => "disparity of an unknown rig".into(),
    }
}

/// The method as it ran: the parameters of its paper, our additions where they are used, and where its noise is from.
fn method(report: &Report<'_>) -> String {
    let all = report.method.params.iter().zip(report.parameters);
    let told = all.filter(|(param, value)| param.source.is_some() || **value != param.default);
    let pairs: Vec<String> = told.map(|(param, value)| format!("{} {value}", param.name)).collect();
    let mut text = report.method.name.to_string();
    if !pairs.is_empty() {
        text += &format!(" ({})", pairs.join(", "));
    }
    text + &noise_in_words(report).map(|noise| format!(", {noise}")).unwrap_or_default()
}

fn time(times: &Times) -> String {
    let stages: Vec<String> =
        times.stages.iter().map(|(name, spread)| format!("{name} {:.3}", spread.median)).collect();
    let (median, min) = (times.total.median, times.total.min);
    format!("time: {median:.3} ms median, {min:.3} ms least; medians of the stages: {}\n", stages.join(", "))
}

/// The first planes in columns; empty if there is none. `depth` is along the view at the plane's middle, `distance` is that
/// of the camera from the plane, perpendicular to it.
pub(crate) fn table(report: &Report<'_>, most: usize) -> String {
    let planes = &report.detection.planes;
    if planes.is_empty() {
        return String::new();
    }
    let shown = &planes[..planes.len().min(most)];
    let value_kind = report.frame.sensor.value_kind;
    let row: fn(&Plane, ValueKind) -> Vec<String> = if report.is_metric() { metric_row } else { map_row };
    let mut rows = vec![if report.is_metric() { metric_heading() } else { map_heading() }];
    rows.extend(shown.iter().map(|plane| row(plane, value_kind)));
    let mut text = aligned(&vec![Align::Right; rows[0].len()], &rows);
    if shown.len() < planes.len() {
        let hidden = planes.len() - shown.len();
        text += &format!("... and {hidden} smaller; --rows N shows more, --planes FILE writes all\n");
    }
    text
}

/// What two of the columns mean, where both are there.
pub(crate) fn table_key(report: &Report<'_>) -> &'static str {
    if report.is_metric() && !report.detection.planes.is_empty() {
        "depth: along the view, at the plane's middle; distance: from the camera to the plane, perpendicular to it\n"
    } else {
        ""
    }
}

fn metric_heading() -> Vec<String> {
    row(["plane", "pixels", "share", "depth", "distance", "normal x", "y", "z", "rms", "area", "columns", "rows"])
}

fn map_heading() -> Vec<String> {
    row(["plane", "pixels", "share", "depth", "mean value", "per column", "per row", "rms", "columns", "rows"])
}

fn metric_row(plane: &Plane, value_kind: ValueKind) -> Vec<String> {
    let middle = plane.metric.map_or(unknown(6), |metric| {
        let mut cells = vec![format!("{:.3} m", metric.plane.distance)];
        cells.extend(metric.plane.normal.map(direction));
        cells.push(format!("{:.1} mm", 1e3 * metric.rms_m));
        cells.push(metric.area_m2.map_or("-".into(), |area| format!("{area:.3} m2")));
        cells
    });
    assemble(plane, value_kind, middle)
}

fn map_row(plane: &Plane, value_kind: ValueKind) -> Vec<String> {
    let middle = plane.fit.map_or(unknown(4), |fit| {
        let [u, v] = plane.centroid;
        let mean = fit.gradient[0] * u + fit.gradient[1] * v + fit.offset;
        [mean, fit.gradient[0], fit.gradient[1], fit.rms].map(significant).to_vec()
    });
    assemble(plane, value_kind, middle)
}

fn assemble(plane: &Plane, value_kind: ValueKind, middle: Vec<String>) -> Vec<String> {
    let pixels = plane.bounding_box;
    let mut cells = vec![plane.label.to_string(), plane.pixel_count.to_string(), percent(plane.share_of_valid)];
    cells.push(depth_m(plane, value_kind).map_or("-".into(), |depth| format!("{depth:.3} m")));
    cells.extend(middle);
    cells.push(format!("{}..{}", pixels.u_min, pixels.u_max));
    cells.push(format!("{}..{}", pixels.v_min, pixels.v_max));
    cells
}

fn unknown(cells: usize) -> Vec<String> {
    vec!["-".into(); cells]
}

/// What a person may want to know or try, given what was found.
pub(crate) fn advice(report: &Report<'_>) -> Vec<String> {
    let (detection, source) = (report.detection, report.source);
    if detection.valid_pixels == 0 {
        return vec![format!(
            "{source}: no pixel is valid: all are 0, NaN, the missing value or outside the valid range; \
             `depthplanes inspect` shows the values"
        )];
    }
    let mut notes = Vec::new();
    if detection.planes.is_empty() {
        notes.push(format!(
            "{source}: no plane found by {}; `depthplanes params {name}` says what its parameters do, \
             `depthplanes explain` why a pixel has no plane, `depthplanes inspect` shows the map's values",
            method(report),
            name = report.method.name
        ));
    }
    notes.extend(units_advice(report));
    notes
}

/// Differences between neighbours of a surface, metres, that depth cameras show at a few metres.
const USUAL_STEP_M: f64 = 0.005;

/// More planes than a scene has: surfaces have fallen into bands.
const MANY_PLANES: usize = 200;

/// A parameter in map units means another length in each encoding; says so where that matters.
fn units_advice(report: &Report<'_>) -> Vec<String> {
    let ValueKind::Depth { metres } = report.frame.sensor.value_kind else { return Vec::new() };
    let detection = report.detection;
    let doubtful = detection.labelled_share() < 0.25 || detection.planes.len() > MANY_PLANES;
    let mut notes = Vec::new();
    for (param, value) in report.method.params.iter().zip(report.parameters) {
        let given_m = value * metres;
        let odd = given_m > 20.0 * USUAL_STEP_M || (doubtful && given_m < USUAL_STEP_M / 2.0);
        // 0 switches a parameter off, whatever the unit.
        if param.unit == "map units" && *value > 0.0 && odd {
            notes.push(format!(
                "{}: {} {value} is {} here, since a unit of the map is {}; try --{} {}",
                report.source,
                param.name,
                length(given_m),
                length(metres),
                param.name.replace('_', "-"),
                significant(USUAL_STEP_M / metres)
            ));
        }
    }
    notes
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// A component of a unit vector, never `-0.000`.
fn direction(x: f64) -> String {
    let text = format!("{x:.3}");
    if text == "-0.000" { "0.000".into() } else { text }
}

/// A length with the unit that suits it.
pub(crate) fn length(metres: f64) -> String {
    if metres.abs() >= 1.0 { format!("{} m", significant(metres)) } else { format!("{} mm", significant(metres * 1e3)) }
}

/// About four significant digits, no trailing zeros, no `-0`.
pub(crate) fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.to_string()
}

#[cfg(test)]
mod tests {
    use super::{length, significant};

    #[test]
    fn numbers_are_shown_with_about_four_digits() {
        let shown = [1234.56, 12.3456, 0.00123456, -40.0, 100.0, 0.0, -0.0].map(significant);
        assert_eq!(shown, ["1235", "12.35", "0.001235", "-40", "100", "0", "0"]);
    }

    #[test]
    fn lengths_get_the_unit_that_suits_them() {
        assert_eq!([length(0.0002), length(0.5), length(2.0)], ["0.2 mm", "500 mm", "2 m"]);
    }
}
