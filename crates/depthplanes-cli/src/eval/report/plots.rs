//! The plots of a report, as SVG.

use super::super::rows::{Found, Row};
use super::names::{in_order, labels};
use super::numbers::{by, mean, per_megapixel, share};
use kuva::prelude::*;

/// A plot with what it shows.
pub(in super::super) struct Plot {
    pub(super) caption: String,
    pub(super) svg: String,
}

impl Plot {
    /// The same with what it is of in its caption.
    pub(in super::super) fn of(self, what: &str) -> Self {
        Plot { caption: format!("{} ({what})", self.caption), ..self }
    }
}

/// A line of a plot: what it is called, and its points.
pub(in super::super) type Line = (String, Vec<(f64, f64)>);

/// Colours of the methods, in their order (Okabe and Ito's, which colour-blind people tell apart, then darker ones).
const COLOURS: [&str; 10] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8B4513", "#6A5ACD", "#708090"];

/// Of a plot, legend and labels included; two go side by side on the page.
const WIDTH: f64 = 570.0;
const HEIGHT: f64 = 360.0;

fn colour(at: usize) -> &'static str {
    COLOURS[at % COLOURS.len()]
}

/// A point for each method and set: how long, how good.
pub(in super::super) fn accuracy_by_time(rows: &[&Row]) -> Option<Plot> {
    let mut plots: Vec<kuva::prelude::Plot> = Vec::new();
    for (at, label) in labels(rows).iter().enumerate() {
        let own = by(rows, label);
        let point = |dataset: String| {
            let of_set = || own.iter().filter(|(row, _)| row.key.dataset == dataset);
            let time = mean(of_set().map(|(row, found)| Some(per_megapixel(row, found))))?;
            let score = mean(of_set().map(|(_, found)| found.scores.get("evops.f_score").copied()))?;
            Some((time, score))
        };
        let sets = in_order(own.iter().map(|(row, _)| row.key.dataset.as_str()));
        let points: Vec<(f64, f64)> = sets.into_iter().filter_map(point).collect();
        if !points.is_empty() {
            let scatter = ScatterPlot::new().with_data(points).with_color(colour(at)).with_size(5.0);
            plots.push(scatter.with_legend(label.clone()).into());
        }
    }
    let caption = "F (EVOPS, IoU 0.75) against time for a million pixels: a point for each set with truth";
    draw(plots, caption, ["ms for a megapixel", "F"], |layout| from_0_to_1(layout.with_log_x()))
}

/// Share of the truth planes found, by the tolerance.
pub(in super::super) fn correct_by_tolerance(rows: &[&Row]) -> Option<Plot> {
    let mut plots: Vec<kuva::prelude::Plot> = Vec::new();
    for (at, label) in labels(rows).iter().enumerate() {
        let scored: Vec<_> = by(rows, label).into_iter().filter(|(_, found)| !found.correct_at.is_empty()).collect();
        let truth: f64 = scored.iter().filter_map(|(_, found)| found.scores.get("planes.truth")).sum();
        let Some((_, first)) = scored.first().filter(|_| truth > 0.0) else { continue };
        let correct = |place: usize| scored.iter().map(|(_, found)| found.correct_at[place].1).sum::<usize>() as f64;
        let points =
            first.correct_at.iter().enumerate().map(|(place, (tolerance, _))| (*tolerance, correct(place) / truth));
        let line = LinePlot::new().with_data(points).with_color(colour(at)).with_stroke_width(2.0);
        plots.push(line.with_legend(label.clone()).into());
    }
    let caption = "Share of the truth's planes that are correct, by the SegComp tolerance";
    draw(plots, caption, ["tolerance", "correct"], from_0_to_1)
}

/// A point for each method and map: how large, how long.
pub(in super::super) fn time_by_size(rows: &[&Row]) -> Option<Plot> {
    let first = rows.first().map(|row| row.size)?;
    if rows.iter().all(|row| row.size == first) {
        return None;
    }
    let megapixels = |row: &Row| (row.size[0] * row.size[1]) as f64 / 1e6;
    let scatter = |(at, label): (usize, &String)| {
        let points = by(rows, label).into_iter().map(|(row, found)| (megapixels(row), found.median_ms));
        let scatter = ScatterPlot::new().with_data(points).with_color(colour(at)).with_size(3.0);
        scatter.with_legend(label.clone()).into()
    };
    let plots = labels(rows).iter().enumerate().map(scatter).collect();
    let caption = "Median time by the size of the map: a point for each map";
    draw(plots, caption, ["megapixels", "ms"], |layout| layout.with_log_x().with_log_y())
}

/// The paper's three measures side by side, two of them as shares of the largest (Fig. 15).
pub(in super::super) fn three_measures(rows: &[&Row]) -> Option<Plot> {
    let labels = labels(rows);
    let means = |value: &dyn Fn(&Row, &Found) -> f64| -> Vec<f64> {
        let of_method = |label: &String| mean(by(rows, label).iter().map(|(row, found)| Some(value(row, found))));
        labels.iter().map(|label| of_method(label).unwrap_or(0.0)).collect()
    };
    let of_largest = |values: Vec<f64>| -> Vec<f64> {
        let largest = values.iter().copied().fold(0.0, f64::max);
        values.into_iter().map(|value| if largest > 0.0 { value / largest } else { 0.0 }).collect()
    };
    let time = of_largest(means(&|_, found| found.median_ms));
    let planes = of_largest(means(&|_, found| found.planes as f64));
    let share = means(&share);
    let mut bars = BarPlot::new();
    for (at, label) in labels.iter().enumerate() {
        bars = bars
            .with_group(label.clone(), vec![(time[at], COLOURS[1]), (planes[at], COLOURS[0]), (share[at], COLOURS[2])]);
    }
    let bars = bars.with_legend(vec!["time / longest", "planes / most", "share of valid pixels"]);
    let caption = "Time, number of planes and share of valid pixels, as in the paper's Fig. 15";
    draw(vec![bars.into()], caption, ["", "share"], |layout| from_0_to_1(layout.with_x_tick_rotate(-30.0)))
}

/// A point for each method and map: planes counted for each of the truth's, and the share of the truth's that is correct.
pub(in super::super) fn correct_by_count(rows: &[&Row]) -> Option<Plot> {
    let mut plots: Vec<kuva::prelude::Plot> = Vec::new();
    for (at, label) in labels(rows).iter().enumerate() {
        let point = |(_, found): (&Row, &Found)| {
            let truth = *found.scores.get("planes.truth").filter(|truth| **truth > 0.0)?;
            (found.planes > 0).then_some((found.planes as f64 / truth, found.scores.get("segcomp.correct")? / truth))
        };
        let points: Vec<(f64, f64)> = by(rows, label).into_iter().filter_map(point).collect();
        if !points.is_empty() {
            let scatter = ScatterPlot::new().with_data(points).with_color(colour(at)).with_size(4.0);
            plots.push(scatter.with_legend(label.clone()).into());
        }
    }
    let caption = "Share of the truth's planes that are correct, by the number of planes counted: a point for each map";
    draw(plots, caption, ["planes counted for each true one", "correct"], |layout| from_0_to_1(layout.with_log_x()))
}

/// Numbers of planes by `min`.
pub(in super::super) fn planes_by_min(lines: Vec<Line>, caption: &str) -> Option<Plot> {
    let line = |(at, (name, points)): (usize, Line)| {
        let line = LinePlot::new().with_data(points).with_color(colour(at)).with_stroke_width(2.0);
        line.with_legend(name).into()
    };
    let ends = lines.iter().find_map(|(_, points)| Some([points.first()?.0, points.last()?.0]))?;
    let plots = lines.into_iter().filter(|(_, points)| !points.is_empty()).enumerate().map(line).collect();
    draw(plots, caption, ["min, pixels", "planes"], |layout| {
        layout.with_log_x().with_log_y().with_x_axis_min(ends[0]).with_x_axis_max(ends[1])
    })
}

fn from_0_to_1(layout: Layout) -> Layout {
    layout.with_y_axis_min(0.0).with_y_axis_max(1.0)
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
