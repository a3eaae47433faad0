//! The report of an evaluation: one page that opens without a network, the same as Markdown, the rows as CSV and JSON, and
//! the tables as JSON.
//!
//! In: the rows, and the maps for their pictures. Out: files, each written whole.

mod html;
mod names;
mod numbers;
mod page;
pub(super) mod plots;
mod sequence;
pub(super) mod strips;
pub(super) mod table;

pub(super) use names::in_order;
pub(super) use numbers::{by, found, mean, share};
pub(super) use page::Section;

use super::datasets::Item;
use super::rows::{Made, Row};
use crate::failure::{Outcome, note};
use crate::terminal::plain;
use depthplanes_io::outputs::write_file;
use page::Page;
use std::io::Write;
use std::path::Path;
use table::Table;

/// The version that our own rows are of.
const OWN: &str = env!("CARGO_PKG_VERSION");

/// Writes the report, and its tables for the terminal.
///
/// # Errors
/// A disk or an output that refuses.
pub(super) fn write(title: &str, folder: &Path, rows: &[&Row], sections: &[Section], out: &mut dyn Write) -> Outcome {
    let written = write_files(title, folder, rows, sections)?;
    write!(out, "{}", summary(sections))?;
    let refused = rows.iter().filter(|row| matches!(row.outcome, Made::Refused(_))).count();
    if refused > 0 {
        note(&format!("{refused} of {} results are refusals; the report says why", rows.len()));
    }
    writeln!(out, "wrote {}", plain(&written.join(", ")))?;
    Ok(())
}

/// Writes the files; their names.
///
/// # Errors
/// A disk that refuses.
fn write_files(title: &str, folder: &Path, rows: &[&Row], sections: &[Section]) -> Outcome<Vec<String>> {
    let page = Page { title, facts: facts(rows), sections, refusals: refusals(rows) };
    let json = serde_json::to_string_pretty(rows).expect("rows are plain values");
    let tables: Vec<_> = sections.iter().flat_map(|section| &section.tables).map(Table::json).collect();
    let tables = serde_json::to_string_pretty(&tables).expect("tables are plain text");
    let files = [
        ("report.html", html::page(&page)),
        ("report.md", markdown(&page)),
        ("rows.csv", table::csv(rows)),
        ("rows.json", json + "\n"),
        ("tables.json", tables + "\n"),
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
fn summary(sections: &[Section]) -> String {
    sections.iter().flat_map(|section| &section.tables).map(|table| table.text() + "\n").collect()
}

/// Strips of a set.
const STRIPS: usize = 4;

/// A section for all sets together, if there are several, and one for each.
///
/// # Errors
/// A map or a label image that cannot be read any more.
pub(super) fn by_dataset(folder: &Path, rows: &[&Row], items: &[Item]) -> Outcome<Vec<Section>> {
    let whole = [plots::accuracy_by_time(rows), plots::time_by_size(rows)].into_iter().flatten().collect();
    let mut sections = vec![Section { title: "All sets".into(), plots: whole, ..Section::default() }];
    for dataset in in_order(rows.iter().map(|row| row.key.dataset.as_str())) {
        let own: Vec<&Row> = rows.iter().copied().filter(|row| row.key.dataset == dataset).collect();
        // Maps with a truth say more.
        let with = |has_truth| items.iter().filter(move |item| item.truth.is_some() == has_truth);
        let maps = with(true).chain(with(false)).filter(|item| item.dataset == dataset).take(STRIPS);
        sections.push(Section {
            title: dataset.clone(),
            text: String::new(),
            tables: [
                Some(table::of(&dataset, &own)),
                sequence::of(folder, &dataset, &own, items)?,
                table::by_map(&dataset, &own),
            ]
            .into_iter()
            .flatten()
            .collect(),
            plots: [plots::correct_by_tolerance(&own), plots::three_measures(&own)].into_iter().flatten().collect(),
            strips: strips::of_maps(folder, &own, maps, None)?,
        });
    }
    Ok(sections)
}

fn facts(rows: &[&Row]) -> Vec<[String; 2]> {
    let all = |read: &dyn Fn(&Row) -> String| {
        let mut values: Vec<String> = rows.iter().map(|row| read(row)).collect();
        values.sort();
        values.dedup();
        values.join("; ")
    };
    let mut facts = vec![
        ["program".to_string(), format!("depthplanes {OWN}")],
        ["machine".into(), all(&|row| row.machine.clone())],
        ["made on".into(), all(&|row| row.date.clone())],
        ["timed runs a map".into(), all(&|row| row.key.repeat.to_string())],
        ["maps at the same time".into(), all(&|row| row.jobs.to_string())],
    ];
    for method in in_order(rows.iter().map(|row| row.key.method.as_str())) {
        let own = || rows.iter().filter(|row| row.key.method == method);
        let written = in_order(own().map(|row| row.key.parameters.as_str()));
        // A peer says whose it is.
        let whose = in_order(own().map(|row| row.key.version.as_str()).filter(|version| *version != OWN)).join(" / ");
        let said = if whose.is_empty() { values(&written) } else { format!("{whose}; {}", written.join(" / ")) };
        facts.push([method, said]);
    }
    facts
}

/// Each parameter once with all the values that it has: `min-pixels 32 / 64, theta 1`.
fn values(written: &[String]) -> String {
    let pairs = || written.iter().flat_map(|all| all.split(", ")).map(|one| one.split_once(' ').unwrap_or((one, "")));
    let of = |name: String| {
        let values = in_order(pairs().filter(|(own, _)| *own == name).map(|(_, value)| value));
        format!("{name} {}", values.join(" / "))
    };
    in_order(pairs().map(|(name, _)| name)).into_iter().map(of).collect::<Vec<_>>().join(", ")
}

fn refusals(rows: &[&Row]) -> Vec<String> {
    let refusal = |row: &&Row| match &row.outcome {
        Made::Refused(why) => Some(format!("{} on {}: {why}", row.key.label, row.key.map)),
        Made::Found(_) => None,
    };
    rows.iter().filter_map(refusal).collect()
}

fn markdown(page: &Page<'_>) -> String {
    let mut text = format!("# {}\n\n", page.title);
    page.facts.iter().for_each(|[what, value]| text += &format!("- {what}: {value}\n"));
    for section in page.sections.iter().filter(|section| !section.tables.is_empty() || !section.text.is_empty()) {
        text += &format!("\n## {}\n\n", plain(&section.title));
        if !section.text.is_empty() {
            text += &format!("{}\n\n", section.text);
        }
        for (at, table) in section.tables.iter().enumerate() {
            text += if at > 0 { "\n" } else { "" };
            text += &if table.title == section.title { String::new() } else { format!("{}:\n\n", table.title) };
            text += &table.markdown();
        }
    }
    if !page.refusals.is_empty() {
        text += "\n## Refusals\n\n";
        page.refusals.iter().for_each(|refusal| text += &format!("- {}\n", plain(refusal)));
    }
    text
}
