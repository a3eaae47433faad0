//! How steady each method's planes are over the frames of a set that is a sequence, from its label images.

use super::super::datasets::Item;
use super::super::rows::Row;
use super::names::labels;
use super::numbers::found;
use super::table::Table;
use crate::failure::Outcome;
use depthplanes::metrics::Sequence;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::read_labels;
use std::path::Path;

/// A line for each method, if the set is a sequence; `rows` are those of the set.
///
/// # Errors
/// A label image that cannot be read any more, frames of different sizes.
pub(super) fn of(folder: &Path, dataset: &str, rows: &[&Row], items: &[Item]) -> Outcome<Option<Table>> {
    let frames: Vec<&Item> = items.iter().filter(|item| item.dataset == dataset && item.is_sequence).collect();
    if frames.is_empty() {
        return Ok(None);
    }
    let mut lines = Vec::new();
    for label in labels(rows) {
        let own: Vec<&Row> = rows.iter().copied().filter(|row| row.key.label == label).collect();
        lines.push(line(label, &sequence(folder, &own, &frames)?));
    }
    let head = ["method", "pairs of frames", "large planes", "IoU", "IoU > 0.75 %", "planes", "sd of change"];
    let title = format!("{dataset}, from frame to frame");
    Ok(Some(Table { title, head: head.map(str::to_string).to_vec(), rows: lines }))
}

/// A method's frames in their order; one that it refused parts the sequence.
fn sequence(folder: &Path, rows: &[&Row], frames: &[&Item]) -> Outcome<Sequence> {
    let mut sequence = Sequence::default();
    for item in frames {
        match rows.iter().find(|row| row.key.map == item.name).and_then(|row| found(row)) {
            Some(found) => {
                let image = read_labels(folder.join(&found.labels), &DecodeOptions::default())?;
                sequence
                    .add(image.labels)
                    .map_err(|error| crate::failure::Failure::from(error).of_input(&item.name))?;
            }
            None => sequence.skip(),
        }
    }
    Ok(sequence)
}

fn line(label: String, sequence: &Sequence) -> Vec<String> {
    let written =
        |value: Option<f64>, digits: usize| value.map_or("-".to_string(), |value| format!("{value:.digits$}"));
    let percent = sequence.kept_share().map(|share| 100.0 * share);
    vec![
        label,
        sequence.pairs.len().to_string(),
        sequence.large_planes().to_string(),
        written(sequence.mean_iou(), 3),
        written(percent, 1),
        written(sequence.mean_planes(), 1),
        written(sequence.change_of_planes(), 2),
    ]
}
