//! The tables of a report: a line for each method, a table for each set.

use super::super::rows::{Found, Row};
use super::{by, labels, mean, per_megapixel, share};
use crate::table::{Align, aligned};

/// A table with a heading row.
pub(in super::super) struct Table {
    pub(in super::super) title: String,
    pub(in super::super) head: Vec<String>,
    pub(in super::super) rows: Vec<Vec<String>>,
}

impl Table {
    /// Aligned columns.
    pub(super) fn text(&self) -> String {
        let mut rows = vec![self.head.clone()];
        rows.extend(self.rows.iter().cloned());
        format!("{}\n{}", self.title, aligned(&self.aligns(), &rows))
    }

    pub(super) fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule = |align: Align| if align == Align::Left { "---|" } else { "---:|" };
        let rule = format!("|{}\n", self.aligns().into_iter().map(rule).collect::<String>());
        line(&self.head) + &rule + &self.rows.iter().map(|row| line(row)).collect::<String>()
    }

    /// Names and other words to the left, numbers to the right.
    pub(super) fn aligns(&self) -> Vec<Align> {
        let begins_with_a_letter = |cell: &String| cell.starts_with(char::is_alphabetic);
        let align = |column: usize| {
            let is_words = self.rows.iter().any(|row| begins_with_a_letter(&row[column]));
            if column == 0 || is_words { Align::Left } else { Align::Right }
        };
        (0..self.head.len()).map(align).collect()
    }
}

/// A column: its heading, and what it reads off a row.
struct Column {
    head: &'static str,
    digits: usize,
    value: fn(&Row, &Found) -> Option<f64>,
    /// Whether it needs a truth.
    is_score: bool,
}

fn scored(found: &Found, measure: &str) -> Option<f64> {
    found.scores.get(measure).copied()
}

const fn column(head: &'static str, digits: usize, value: fn(&Row, &Found) -> Option<f64>) -> Column {
    Column { head, digits, value, is_score: false }
}

const fn score(head: &'static str, digits: usize, value: fn(&Row, &Found) -> Option<f64>) -> Column {
    Column { head, digits, value, is_score: true }
}

/// The columns; each cell is a mean over the maps that have the number.
#[rustfmt::skip]
const COLUMNS: &[Column] = &[
    column("ms", 2, |_, found| Some(found.median_ms)),
    column("ms/MP", 2, |row, found| Some(per_megapixel(row, found))),
    column("planes", 1, |_, found| Some(found.planes as f64)),
    column("% of valid", 1, |row, found| Some(100.0 * share(row, found))),
    score("truth", 1, |_, found| scored(found, "planes.truth")),
    score("correct", 2, |_, found| scored(found, "segcomp.correct")),
    score("over", 2, |_, found| scored(found, "segcomp.over_segmented")),
    score("under", 2, |_, found| scored(found, "segcomp.under_segmented")),
    score("missed", 2, |_, found| scored(found, "segcomp.missed")),
    score("noise", 2, |_, found| scored(found, "segcomp.noise")),
    score("F", 3, |_, found| scored(found, "evops.f_score")),
    score("RI", 3, |_, found| scored(found, "partition.rand_index")),
    score("VOI", 3, |_, found| scored(found, "partition.variation_of_information")),
    score("SC", 3, |_, found| scored(found, "partition.segmentation_covering")),
    score("normal deg", 3, |_, found| found.normal_error_deg),
];

/// A line for each method; scores only where there is a truth.
pub(in super::super) fn of(title: &str, rows: &[&Row]) -> Table {
    let has_truth = rows.iter().filter_map(|row| super::found(row)).any(|found| !found.scores.is_empty());
    let columns: Vec<&Column> = COLUMNS.iter().filter(|column| has_truth || !column.is_score).collect();
    let line = |label: &String| {
        let found = by(rows, label);
        let cell = |column: &&Column| {
            let value = mean(found.iter().map(|(row, found)| (column.value)(row, found)));
            value.map_or("-".into(), |value| format!("{value:.*}", column.digits))
        };
        let first = [label.clone(), found.len().to_string()];
        first.into_iter().chain(columns.iter().map(cell)).collect()
    };
    let heads = ["method", "maps"].into_iter().chain(columns.iter().map(|column| column.head));
    Table {
        title: title.into(),
        head: heads.map(str::to_string).collect(),
        rows: labels(rows).iter().map(line).collect(),
    }
}

/// Every row with its key and the columns' numbers.
pub(super) fn csv(rows: &[&Row]) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let fixed = [
        "dataset",
        "map",
        "label",
        "method",
        "parameters",
        "version",
        "machine",
        "date",
        "jobs",
        "repeat",
        "columns",
        "rows",
        "least ms",
    ];
    let head = fixed.into_iter().chain(COLUMNS.iter().map(|column| column.head)).map(quoted);
    let mut text = head.collect::<Vec<_>>().join(",") + "\n";
    for row in rows {
        let key = &row.key;
        let named =
            [&key.dataset, &key.map, &key.label, &key.method, &key.parameters, &key.version, &row.machine, &row.date];
        let mut cells: Vec<String> = named.into_iter().map(|cell| quoted(cell)).collect();
        cells.extend([row.jobs, key.repeat, row.size[0], row.size[1]].map(|number| number.to_string()));
        cells.push(super::found(row).map_or(String::new(), |found| found.least_ms.to_string()));
        let value = |column: &Column| super::found(row).and_then(|found| (column.value)(row, found));
        cells.extend(COLUMNS.iter().map(|column| value(column).map_or(String::new(), |value| value.to_string())));
        text += &(cells.join(",") + "\n");
    }
    text
}
