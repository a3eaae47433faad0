//! The paper's figures 9, 11, 12, 13, 14 and 15 with our numbers.

use super::super::report::plots::{self, Line};
use super::super::report::table::{self, Table};
use super::super::report::{Section, by, found, in_order, mean, share};
use super::super::rows::{Found, Row};
use super::trial::{COMPARED, MINS, NGAF, Results, label};
use crate::failure::Outcome;
use std::path::Path;

/// "Non planar" in the paper's Fig. 14.
const RED: [u8; 3] = [205, 30, 30];

/// Figs. 9 and 11: the planes of `ngaf` on each map for each `min`.
pub(super) fn planes_on_maps(title: &str, more: &str, folder: &Path, results: &Results<'_>) -> Outcome<Section> {
    let rows = results.of(NGAF);
    Ok(Section {
        title: title.into(),
        text: format!(
            "Number of planes and their share of the valid pixels for each min; the time is that of min 32. In the pictures \
             what has no plane stays grey.{more}"
        ),
        tables: vec![counts(title, &rows)],
        strips: results.strips(folder, &rows, None)?,
        ..Section::default()
    })
}

/// A line for each map: planes and shares by `min`.
fn counts(title: &str, rows: &[&Row]) -> Table {
    let mut head = vec!["map".to_string()];
    head.extend(MINS.map(|min| format!("planes, min {min}")));
    head.extend(MINS.map(|min| format!("%, min {min}")));
    head.push("ms".into());
    let line = |map: &String| {
        let of_min = |min: u32| of_map(rows, map, &label(NGAF, min));
        let cell = |min: u32, text: &dyn Fn(&Row, &Found) -> String| {
            of_min(min).map_or("-".to_string(), |(row, found)| text(row, found))
        };
        let mut cells = vec![map.clone()];
        cells.extend(MINS.map(|min| cell(min, &|_, found| found.planes.to_string())));
        cells.extend(MINS.map(|min| cell(min, &|row, found| format!("{:.2}", 100.0 * share(row, found)))));
        cells.push(cell(MINS[0], &|_, found| format!("{:.2}", found.median_ms)));
        cells
    };
    Table { title: title.into(), head, rows: maps(rows).iter().map(line).collect() }
}

/// Figs. 12 and 13: planes against `min`, of `ngaf` on each map and of each method on all.
pub(super) fn planes_by_min(middlebury: &Results<'_>, kinect: &Results<'_>) -> Section {
    let figure = |results: &Results<'_>, number: &str| {
        let caption = format!("Planes of ngaf by min, a line for each map, as in the paper's Fig. {number}");
        let of_maps = plots::planes_by_min(by_map(&results.of(NGAF)), &caption);
        let of_methods = plots::planes_by_min(by_method(results), "Planes by min, mean over the maps, of each method");
        [of_maps, of_methods].into_iter().filter_map(|plot| results.plot(plot)).collect::<Vec<_>>()
    };
    Section {
        title: "Figs. 12 and 13: planes against min".into(),
        text: "A larger min leaves fewer planes. How fast they go says how many of them are small.".into(),
        plots: [figure(middlebury, "12"), figure(kinect, "13")].into_iter().flatten().collect(),
        ..Section::default()
    }
}

fn by_map(rows: &[&Row]) -> Vec<Line> {
    let count = |map: &str, min: u32| of_map(rows, map, &label(NGAF, min)).map(|(_, found)| found.planes as f64);
    maps(rows).into_iter().map(|map| (map.clone(), points(|min| count(&map, min)))).collect()
}

fn by_method(results: &Results<'_>) -> Vec<Line> {
    let methods = in_order(results.rows.iter().map(|row| row.key.method.as_str()));
    let count = |method: &str, min: u32| {
        mean(by(&results.rows, &label(method, min)).into_iter().map(|(_, found)| Some(found.planes as f64)))
    };
    methods.into_iter().map(|method| (method.clone(), points(|min| count(&method, min)))).collect()
}

/// A point for each `min` at which there are planes; the axes are logarithmic.
fn points(count: impl Fn(u32) -> Option<f64>) -> Vec<(f64, f64)> {
    let point = |min: u32| Some((f64::from(min), count(min).filter(|count| *count > 0.0)?));
    MINS.into_iter().filter_map(point).collect()
}

/// Fig. 14: the methods' planes side by side.
pub(super) fn side_by_side(folder: &Path, middlebury: &Results<'_>) -> Outcome<Section> {
    Ok(Section {
        title: "Fig. 14: methods side by side".into(),
        text: format!(
            "The paper shows the elevations of Toulouse St-Michel, which are not public; these are its maps of Middlebury, \
             with min {COMPARED}. Red is what has a value and no plane: \"non planar\" in the paper."
        ),
        strips: middlebury.strips(folder, &middlebury.compared(), Some(RED))?,
        ..Section::default()
    })
}

/// Fig. 15: time, planes and share of each method.
pub(super) fn three_measures(all: &[&Results<'_>]) -> Section {
    let plot = |results: &&Results<'_>| results.plot(plots::three_measures(&results.compared()));
    let table = |results: &&Results<'_>| table::of(results.trial.name, &results.compared());
    Section {
        title: "Fig. 15: time, planes and valid points".into(),
        text: format!("Means over the maps, with min {COMPARED}; the paper has them for Toulouse St-Michel."),
        tables: all.iter().map(table).collect(),
        plots: all.iter().filter_map(plot).collect(),
        ..Section::default()
    }
}

fn maps(rows: &[&Row]) -> Vec<String> {
    in_order(rows.iter().map(|row| row.key.map.as_str()))
}

/// What was found on a map under a label.
pub(super) fn of_map<'a>(rows: &[&'a Row], map: &str, label: &str) -> Option<(&'a Row, &'a Found)> {
    let row = rows.iter().find(|row| row.key.map == map && row.key.label == label)?;
    Some((row, found(row)?))
}
