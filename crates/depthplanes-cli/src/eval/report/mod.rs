//! The report of an evaluation: one page that opens without a network, the same as Markdown, and the rows as CSV and JSON.
//!
//! In: the rows, and the maps for their pictures. Out: files, each written whole.

mod html;
mod plots;
mod strips;
mod table;

use super::datasets::Item;
use super::rows::{Found, Made, Row};
use crate::failure::Outcome;
use depthplanes_io::outputs::write_file;
use std::path::Path;
use table::Table;

/// Writes the report; the names of its files.
///
/// # Errors
/// A map that cannot be read any more, a disk that refuses.
pub(super) fn write(folder: &Path, rows: &[&Row], items: &[Item]) -> Outcome<Vec<String>> {
    let page = Page {
        facts: facts(rows),
        tables: table::all(rows),
        plots: plots::all(rows),
        strips: strips::all(folder, rows, items)?,
        refusals: refusals(rows),
    };
    let json = serde_json::to_string_pretty(rows).expect("rows are plain values");
    let files = [
        ("report.html", html::page(&page)),
        ("report.md", markdown(&page)),
        ("rows.csv", table::csv(rows)),
        ("rows.json", json + "\n"),
    ];
    let mut written = Vec::new();
    for (name, text) in files {
        let path = folder.join(name);
        write_file(&path, text.as_bytes())?;
        written.push(path.display().to_string());
    }
    Ok(written)
}

/// The tables, for the terminal.
pub(super) fn summary(rows: &[&Row]) -> String {
    table::all(rows).iter().map(Table::text).collect::<Vec<_>>().join("\n")
}

/// What is in a report.
struct Page {
    /// Where, when and how: a heading and a value each.
    facts: Vec<[String; 2]>,
    tables: Vec<Table>,
    plots: Vec<plots::Plot>,
    strips: Vec<strips::Strip>,
    refusals: Vec<String>,
}

fn facts(rows: &[&Row]) -> Vec<[String; 2]> {
    let all = |read: &dyn Fn(&Row) -> String| {
        let mut values: Vec<String> = rows.iter().map(|row| read(row)).collect();
        values.sort();
        values.dedup();
        values.join("; ")
    };
    let mut facts = vec![
        ["program".to_string(), all(&|row| format!("depthplanes {}", row.key.version))],
        ["machine".into(), all(&|row| row.machine.clone())],
        ["made on".into(), all(&|row| row.date.clone())],
        ["timed runs a map".into(), all(&|row| row.key.repeat.to_string())],
        ["maps at the same time".into(), all(&|row| row.jobs.to_string())],
    ];
    for method in methods(rows) {
        let parameters = |row: &&&Row| row.key.method == method;
        let mut values: Vec<&str> = rows.iter().filter(parameters).map(|row| row.key.parameters.as_str()).collect();
        values.sort_unstable();
        values.dedup();
        facts.push([method, values.join(" / ")]);
    }
    facts
}

/// Names of the methods in the order in which they were asked for.
fn methods(rows: &[&Row]) -> Vec<String> {
    in_order(rows.iter().map(|row| row.key.method.as_str()))
}

/// Names of the sets in that order.
fn datasets(rows: &[&Row]) -> Vec<String> {
    in_order(rows.iter().map(|row| row.key.dataset.as_str()))
}

fn in_order<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut seen: Vec<String> = Vec::new();
    for name in names {
        if !seen.iter().any(|other| other == name) {
            seen.push(name.to_string());
        }
    }
    seen
}

fn found(row: &Row) -> Option<&Found> {
    match &row.outcome {
        Made::Found(found) => Some(found),
        Made::Refused(_) => None,
    }
}

/// Of a set by a method.
fn of<'a>(rows: &[&'a Row], dataset: &str, method: &str) -> Vec<(&'a Row, &'a Found)> {
    let is_wanted = |row: &&&Row| row.key.dataset == dataset && row.key.method == method;
    rows.iter().filter(is_wanted).filter_map(|row| Some((*row, found(row)?))).collect()
}

/// The mean of those that have a value.
fn mean(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let known: Vec<f64> = values.flatten().collect();
    (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
}

/// Milliseconds for each million pixels.
fn per_megapixel(row: &Row, found: &Found) -> f64 {
    found.median_ms / (row.size[0] * row.size[1]) as f64 * 1e6
}

fn refusals(rows: &[&Row]) -> Vec<String> {
    let refusal = |row: &&Row| match &row.outcome {
        Made::Refused(why) => Some(format!("{} on {}: {why}", row.key.method, row.key.map)),
        Made::Found(_) => None,
    };
    rows.iter().filter_map(refusal).collect()
}

fn markdown(page: &Page) -> String {
    let mut text = String::from("# Evaluation\n\n");
    page.facts.iter().for_each(|[what, value]| text += &format!("- {what}: {value}\n"));
    page.tables.iter().for_each(|table| text += &format!("\n## {}\n\n{}", table.title, table.markdown()));
    if !page.refusals.is_empty() {
        text += "\n## Refusals\n\n";
        page.refusals.iter().for_each(|refusal| text += &format!("- {refusal}\n"));
    }
    text
}
