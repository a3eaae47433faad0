//! The tables of a report: a line for each method, a table for each set.

use super::super::rows::{Found, Row};
use super::names::labels;
use super::numbers::{self, by, mean, per_megapixel, share};
use crate::table::{Align, aligned};
use crate::terminal::plain;

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
        format!("{}\n{}", plain(&self.title), aligned(&self.aligns(), &rows))
    }

    pub(super) fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            format!("| {} |\n", cells.iter().map(|cell| plain(cell)).collect::<Vec<_>>().join(" | "))
        };
        let rule = |align: Align| if align == Align::Left { "---|" } else { "---:|" };
        let rule = format!("|{}\n", self.aligns().into_iter().map(rule).collect::<String>());
        line(&self.head) + &rule + &self.rows.iter().map(|row| line(row)).collect::<String>()
    }

    /// As an object: the heading, and a list of cells for each row.
    pub(super) fn json(&self) -> serde_json::Value {
        serde_json::json!({"title": self.title, "head": self.head, "rows": self.rows})
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

/// A column: its heading, and what it reads off rows.
struct Column {
    head: &'static str,
    digits: usize,
    value: Value,
    needs: Truth,
}

/// What a column reads off the rows of a method.
enum Value {
    /// The mean over the maps that have the number.
    Mean(fn(&Row, &Found) -> Option<f64>),
    /// The sum of a count over all maps.
    Sum(&'static str),
    /// The sum of a count as a share of the sum of another, times a factor: a map weighs as much as it has of it.
    Share(&'static str, &'static str, f64),
}

/// The truth that a column needs.
#[derive(Clone, Copy, PartialEq)]
enum Truth {
    None,
    Whole,
    /// Of some surfaces.
    Partial,
}

impl Column {
    fn of(&self, found: &[(&Row, &Found)]) -> Option<f64> {
        // A sum of no counts is no number.
        let sum = |count: &str| found.iter().filter_map(|(_, found)| scored(found, count)).reduce(|a, b| a + b);
        match self.value {
            Value::Mean(value) => mean(found.iter().map(|(row, found)| value(row, found))),
            Value::Sum(count) => sum(count),
            Value::Share(part, whole, times) => Some(times * sum(part)? / sum(whole).filter(|whole| *whole > 0.0)?),
        }
    }

    fn written(&self, found: &[(&Row, &Found)]) -> String {
        self.of(found).map_or("-".into(), |value| format!("{value:.*}", self.digits))
    }
}

fn scored(found: &Found, measure: &str) -> Option<f64> {
    found.scores.get(measure).copied()
}

const fn column(head: &'static str, digits: usize, value: fn(&Row, &Found) -> Option<f64>) -> Column {
    Column { head, digits, value: Value::Mean(value), needs: Truth::None }
}

const fn score(head: &'static str, digits: usize, value: fn(&Row, &Found) -> Option<f64>) -> Column {
    Column { head, digits, value: Value::Mean(value), needs: Truth::Whole }
}

const fn sum(head: &'static str, count: &'static str) -> Column {
    Column { head, digits: 0, value: Value::Sum(count), needs: Truth::Partial }
}

const fn percent(head: &'static str, part: &'static str, whole: &'static str) -> Column {
    Column { head, digits: 1, value: Value::Share(part, whole, 100.0), needs: Truth::Partial }
}

const fn ratio(head: &'static str, part: &'static str, whole: &'static str) -> Column {
    Column { head, digits: 2, value: Value::Share(part, whole, 1.0), needs: Truth::Partial }
}

/// The columns.
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
    sum("surfaces", "surfaces.all"),
    percent("correct %", "surfaces.correct", "surfaces.all"),
    percent("by px %", "surfaces.correct_pixels", "surfaces.pixels"),
    percent("merged %", "surfaces.merged", "surfaces.all"),
    percent("split %", "surfaces.split", "surfaces.all"),
    percent("missed %", "surfaces.missed", "surfaces.all"),
    ratio("pieces", "surfaces.pieces", "surfaces.all"),
    sum("3k", "surfaces_3000.all"),
    percent("3k correct %", "surfaces_3000.correct", "surfaces_3000.all"),
    percent("3k by px %", "surfaces_3000.correct_pixels", "surfaces_3000.pixels"),
    ratio("3k pieces", "surfaces_3000.pieces", "surfaces_3000.all"),
    sum("10k", "surfaces_10000.all"),
    percent("10k correct %", "surfaces_10000.correct", "surfaces_10000.all"),
    percent("10k by px %", "surfaces_10000.correct_pixels", "surfaces_10000.pixels"),
    ratio("10k pieces", "surfaces_10000.pieces", "surfaces_10000.all"),
    percent("not planar %", "not_planar.covered", "not_planar.pixels"),
];

/// The columns of what is known of these rows.
fn columns(rows: &[&Row]) -> Vec<&'static Column> {
    let truth = |row: &&Row| match numbers::found(row) {
        Some(found) if scored(found, "surfaces.all").is_some() => Truth::Partial,
        Some(found) if !found.scores.is_empty() => Truth::Whole,
        _ => Truth::None,
    };
    let known: Vec<Truth> = rows.iter().map(truth).collect();
    COLUMNS.iter().filter(|column| column.needs == Truth::None || known.contains(&column.needs)).collect()
}

fn heads(first: [&str; 2], columns: &[&Column]) -> Vec<String> {
    first.into_iter().chain(columns.iter().map(|column| column.head)).map(str::to_string).collect()
}

/// A line for each method; scores only where there is a truth.
pub(in super::super) fn of(title: &str, rows: &[&Row]) -> Table {
    let columns = columns(rows);
    let line = |label: &String| {
        let found = by(rows, label);
        let first = [label.clone(), found.len().to_string()];
        first.into_iter().chain(columns.iter().map(|column| column.written(&found))).collect()
    };
    let lines = labels(rows).iter().map(line).collect();
    Table { title: title.into(), head: heads(["method", "maps"], &columns), rows: lines }
}

/// A line for each map and method, for sets whose truths are partial; none for others. Such frames differ in sensor and
/// scene, and their mean hides which of them a method fails on.
pub(super) fn by_map(title: &str, rows: &[&Row]) -> Option<Table> {
    let columns: Vec<&Column> = columns(rows);
    if !columns.iter().any(|column| column.needs == Truth::Partial) {
        return None;
    }
    let line = |row: &&Row| {
        let found: Vec<_> = numbers::found(row).map(|found| (*row, found)).into_iter().collect();
        let first = [row.key.map.clone(), row.key.label.clone()];
        first.into_iter().chain(columns.iter().map(|column| column.written(&found))).collect()
    };
    let head = heads(["map", "method"], &columns);
    Some(Table { title: format!("{title}, map by map"), head, rows: rows.iter().map(line).collect() })
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
        cells.push(numbers::found(row).map_or(String::new(), |found| found.least_ms.to_string()));
        let value = |column: &Column| numbers::found(row).and_then(|found| column.of(&[(row, found)]));
        cells.extend(COLUMNS.iter().map(|column| value(column).map_or(String::new(), |value| value.to_string())));
        text += &(cells.join(",") + "\n");
    }
    text
}
