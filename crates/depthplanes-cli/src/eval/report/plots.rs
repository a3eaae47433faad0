//! The plots of a report, as SVG.

use super::super::rows::Row;
use super::{datasets, mean, methods, of, per_megapixel};
use kuva::prelude::*;

/// A plot with what it shows.
pub(super) struct Plot {
    pub(super) caption: String,
    pub(super) svg: String,
}

/// Colours of the methods, in their order (Okabe and Ito's, which colour-blind people tell apart, then darker ones).
const COLOURS: [&str; 10] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8B4513", "#6A5ACD", "#708090"];

/// Of a plot, legend and labels included; two go side by side on the page.
const WIDTH: f64 = 570.0;
const HEIGHT: f64 = 360.0;

fn colour(at: usize) -> &'static str {
    COLOURS[at % COLOURS.len()]
}

/// All plots for which there are numbers.
pub(super) fn all(rows: &[&Row]) -> Vec<Plot> {
    let mut plots = Vec::new();
    plots.extend(accuracy_by_time(rows));
    plots.extend(datasets(rows).iter().filter_map(|dataset| correct_by_tolerance(rows, dataset)));
    plots.extend(time_by_size(rows));
    plots.extend(datasets(rows).iter().filter_map(|dataset| three_measures(rows, dataset)));
    plots
}

/// A point for each method and set: how long, how good.
fn accuracy_by_time(rows: &[&Row]) -> Option<Plot> {
    let mut plots: Vec<kuva::prelude::Plot> = Vec::new();
    for (at, method) in methods(rows).iter().enumerate() {
        let point = |dataset: &String| {
            let found = of(rows, dataset, method);
            let time = mean(found.iter().map(|(row, found)| Some(per_megapixel(row, found))))?;
            let score = mean(found.iter().map(|(_, found)| found.scores.get("evops.f_score").copied()))?;
            Some((time, score))
        };
        let points: Vec<(f64, f64)> = datasets(rows).iter().filter_map(point).collect();
        if !points.is_empty() {
            let scatter = ScatterPlot::new().with_data(points).with_color(colour(at)).with_size(5.0);
            plots.push(scatter.with_legend(method.clone()).into());
        }
    }
    let caption = "F (EVOPS, IoU 0.75) against time for a million pixels: a point for each set with truth";
    draw(plots, caption, ["ms for a megapixel", "F"], |layout| {
        layout.with_log_x().with_y_axis_min(0.0).with_y_axis_max(1.0)
    })
}

/// Share of the truth planes found, by the tolerance.
fn correct_by_tolerance(rows: &[&Row], dataset: &str) -> Option<Plot> {
    let mut plots: Vec<kuva::prelude::Plot> = Vec::new();
    for (at, method) in methods(rows).iter().enumerate() {
        let found = of(rows, dataset, method);
        let truth: f64 = found.iter().filter_map(|(_, found)| found.scores.get("planes.truth")).sum();
        let tolerances =
            found.iter().find(|(_, found)| !found.correct_at.is_empty()).map(|(_, found)| &found.correct_at);
        let share = |at: usize| {
            found.iter().filter_map(|(_, found)| found.correct_at.get(at)).map(|(_, n)| *n).sum::<usize>() as f64
                / truth
        };
        let Some(tolerances) = tolerances.filter(|_| truth > 0.0) else { continue };
        let points: Vec<(f64, f64)> =
            tolerances.iter().enumerate().map(|(at, (tolerance, _))| (*tolerance, share(at))).collect();
        let line = LinePlot::new().with_data(points).with_color(colour(at)).with_stroke_width(2.0);
        plots.push(line.with_legend(method.clone()).into());
    }
    let caption = format!("{dataset}: share of the truth's planes that are correct, by the SegComp tolerance");
    draw(plots, &caption, ["tolerance", "correct"], |layout| layout.with_y_axis_min(0.0).with_y_axis_max(1.0))
}

/// A point for each method and map: how large, how long.
fn time_by_size(rows: &[&Row]) -> Option<Plot> {
    let mut plots: Vec<kuva::prelude::Plot> = Vec::new();
    let megapixels = |row: &Row| (row.size[0] * row.size[1]) as f64 / 1e6;
    let first = rows.first().map(|row| row.size)?;
    if rows.iter().all(|row| row.size == first) {
        return None;
    }
    for (at, method) in methods(rows).iter().enumerate() {
        let of_method = rows.iter().filter(|row| row.key.method == *method);
        let points: Vec<(f64, f64)> =
            of_method.filter_map(|row| Some((megapixels(row), super::found(row)?.median_ms))).collect();
        let scatter = ScatterPlot::new().with_data(points).with_color(colour(at)).with_size(3.0);
        plots.push(scatter.with_legend(method.clone()).into());
    }
    draw(plots, "Median time by the size of the map: a point for each map", ["megapixels", "ms"], |layout| {
        layout.with_log_x().with_log_y()
    })
}

/// The paper's three measures side by side, each as a share of the largest (Fig. 15).
fn three_measures(rows: &[&Row], dataset: &str) -> Option<Plot> {
    let methods = methods(rows);
    let means = |value: &dyn Fn(&Row, &super::Found) -> f64| -> Vec<f64> {
        let of_method = |method: &String| {
            mean(of(rows, dataset, method).iter().map(|(row, found)| Some(value(row, found)))).unwrap_or(0.0)
        };
        methods.iter().map(of_method).collect()
    };
    let time = means(&|_, found| found.median_ms);
    let planes = means(&|_, found| found.planes as f64);
    let share = means(&|row, found| found.labelled_pixels as f64 / row.valid_pixels.max(1) as f64);
    let of_largest = |values: &[f64], at: usize| {
        let largest = values.iter().copied().fold(0.0, f64::max);
        if largest > 0.0 { values[at] / largest } else { 0.0 }
    };
    let mut bars = BarPlot::new();
    for (at, method) in methods.iter().enumerate() {
        let values =
            [(of_largest(&time, at), COLOURS[1]), (of_largest(&planes, at), COLOURS[0]), (share[at], COLOURS[2])];
        bars = bars.with_group(method.clone(), values.to_vec());
    }
    let bars = bars.with_legend(vec!["time / longest", "planes / most", "share of valid pixels"]);
    let caption = format!("{dataset}: time, number of planes and share of valid pixels, as in the paper's Fig. 15");
    draw(vec![bars.into()], &caption, ["", "share"], |layout| layout.with_y_axis_min(0.0).with_y_axis_max(1.0))
}

fn draw(
    plots: Vec<kuva::prelude::Plot>,
    caption: &str,
    [x, y]: [&str; 2],
    shape: impl Fn(Layout) -> Layout,
) -> Option<Plot> {
    if plots.is_empty() {
        return None;
    }
    let layout = Layout::auto_from_plots(&plots).with_x_label(x).with_y_label(y).with_width(WIDTH).with_height(HEIGHT);
    Some(Plot { caption: caption.into(), svg: render_to_svg(plots, shape(layout)) })
}
