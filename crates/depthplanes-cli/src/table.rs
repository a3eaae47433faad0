//! Text in columns.

use crate::terminal::plain;
use std::borrow::Cow;

/// How a column's cells stand in it.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// Lines of cells padded to columns; the first row is the heading. Nothing trails a line, and each cell is in one.
pub(crate) fn aligned(columns: &[Align], rows: &[Vec<String>]) -> String {
    let rows: Vec<Vec<_>> = rows.iter().map(|row| row.iter().map(|cell| plain(cell)).collect()).collect();
    let widest = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns.len()).map(widest).collect();
    let mut text = String::new();
    for row in &rows {
        let cell = |(column, cell): (usize, &Cow<'_, str>)| match columns[column] {
            Align::Left => format!("{cell:<width$}", width = widths[column]),
            Align::Right => format!("{cell:>width$}", width = widths[column]),
        };
        let cells: Vec<String> = row.iter().enumerate().map(cell).collect();
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    text
}

/// A row of cells.
pub(crate) fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(String::from).to_vec()
}
