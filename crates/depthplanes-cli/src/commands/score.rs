//! `depthplanes score`: label images against the truth, as a table or as JSON.

use crate::args::Score;
use crate::failure::{Failure, Outcome, note};
use crate::pairs::{self, Pair, Truth};
use crate::patience::patiently;
use crate::table::{Align, aligned, row};
use crate::terminal::plain;
use depthplanes::metrics::{Contingency, NOT_PLANAR, SegComp, Split, Tolerance};
use depthplanes::scene::Spec;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::measures::{MEASURES, Measure, Scores, decimal, families};
use depthplanes_io::{LabelImage, read_labels};
use serde_json::{Map, Value, json};
use std::io::Write;

/// What is known of a pair.
struct Scored {
    pair: Pair,
    size: (usize, usize),
    scores: Scores,
}

pub(super) fn run(wanted: &Score, out: &mut dyn Write) -> Outcome {
    let tolerance = Tolerance::new(wanted.tolerance)?;
    let pairs = pairs::pairs(&wanted.truth, &wanted.prediction)?;
    // A mean over some of the pairs would look like one over all, so the first failure ends it.
    let scored =
        pairs.into_iter().map(|pair| score(pair, tolerance, wanted.truth_from)).collect::<Outcome<Vec<_>>>()?;
    let text = match &scored[..] {
        _ if wanted.json => format!("{:#}\n", document(wanted, &scored)),
        [one] => one_pair(one),
        several => several_pairs(several),
    };
    Ok(out.write_all(text.as_bytes())?)
}

fn score(pair: Pair, tolerance: Tolerance, truth_from: u16) -> Outcome<Scored> {
    let truth = read_truth(&pair.truth)?;
    let prediction = read(&pair.prediction)?;
    let size = (truth.width, truth.height);
    if size != (prediction.width, prediction.height) {
        return Err(Failure::request(format!(
            "{}: {} x {} labels, but the truth {} has {} x {}; both must be of the same map",
            pair.prediction.display(),
            prediction.width,
            prediction.height,
            pair.truth.name(),
            truth.width,
            truth.height
        )));
    }
    let table = Contingency::new(&truth.labels, &prediction.labels)?.truth_from(truth_from);
    warn_of_maps(&pair, &table);
    tell_of_partial_truth(&pair, &table);
    Ok(Scored { pair, size, scores: Scores::of(&table, tolerance) })
}

/// More labels than anybody gives: a depth map that was taken for a label image.
const MANY: usize = 1000;

/// Says of a truth that is partial that another command counts by it.
fn tell_of_partial_truth(pair: &Pair, table: &Contingency) {
    if table.truth().iter().any(|region| region.label == NOT_PLANAR) {
        note(&format!(
            "{}: 65535 is taken for a plane here; if the truth is partial, 0 being not labelled and 65535 not planar, \
             `depthplanes eval real` counts its surfaces (docs/metrics.md)",
            pair.truth.name()
        ));
    }
}

fn warn_of_maps(pair: &Pair, table: &Contingency) {
    let sides = [(pair.truth.name(), table.truth()), (pair.prediction.display().to_string(), table.prediction())];
    for (name, regions) in sides.iter().filter(|(_, regions)| regions.len() > MANY) {
        note(&format!("{name}: {} different labels; is this a map, not a label image?", regions.len()));
    }
}

fn read_truth(truth: &Truth) -> Outcome<LabelImage> {
    match truth {
        Truth::File(path) => read(path),
        Truth::Scene(spec) => {
            let frame = spec.parse::<Spec>()?.frame()?;
            let (width, height, labels) = (frame.width, frame.height, frame.measured_labels());
            Ok(LabelImage { width, height, labels, warnings: Vec::new() })
        }
    }
}

fn read(path: &std::path::Path) -> Outcome<LabelImage> {
    let image = patiently(path, || read_labels(path, &DecodeOptions::default()))?;
    image.warnings.iter().for_each(|warning| note(&format!("{}: {warning}", path.display())));
    Ok(image)
}

/// A line for each measure.
fn one_pair(scored: &Scored) -> String {
    let (width, height) = scored.size;
    let (truth, prediction) = (scored.pair.truth.name(), scored.pair.prediction.display().to_string());
    let (truth, prediction) = (plain(&truth), plain(&prediction));
    let mut rows = vec![row(["measure", "", "value", "meaning"])];
    rows.extend(
        MEASURES
            .iter()
            .map(|measure| row([measure.family, measure.name, &measure.written(&scored.scores), measure.meaning])),
    );
    let columns = [Align::Left, Align::Left, Align::Right, Align::Left];
    format!("{prediction} against {truth}: {width} x {height} pixels\n{}", aligned(&columns, &rows))
}

/// A line for each pair, and their means.
fn several_pairs(scored: &[Scored]) -> String {
    let columns: Vec<&Measure> = MEASURES.iter().filter(|measure| !measure.column.is_empty()).collect();
    let line = |name: &str, cell: &dyn Fn(&Measure) -> String| {
        std::iter::once(name.to_string()).chain(columns.iter().map(|measure| cell(measure))).collect::<Vec<_>>()
    };
    let mut rows = vec![line("pair", &|measure| measure.column.to_string())];
    rows.extend(scored.iter().map(|one| line(&one.pair.name, &|measure| measure.written(&one.scores))));
    rows.push(line("mean", &|measure| decimal(mean(measure, scored))));
    let mut aligns = vec![Align::Right; rows[0].len()];
    aligns[0] = Align::Left;
    aligned(&aligns, &rows)
}

/// Over the pairs that have it.
fn mean(measure: &Measure, scored: &[Scored]) -> Option<f64> {
    let values: Vec<f64> = scored.iter().filter_map(|one| measure.value(&one.scores)).collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

fn document(wanted: &Score, scored: &[Scored]) -> Value {
    let means = families(|measure| mean(measure, scored).into());
    json!({
        "schema": "depthplanes.score/1",
        "version": env!("CARGO_PKG_VERSION"),
        "tolerance": wanted.tolerance,
        "truth_from": wanted.truth_from,
        "pairs": scored.iter().map(record).collect::<Vec<_>>(),
        "mean": means,
    })
}

fn record(scored: &Scored) -> Value {
    let mut record = Map::new();
    record.insert("truth".into(), scored.pair.truth.name().into());
    record.insert("prediction".into(), scored.pair.prediction.display().to_string().into());
    record.insert("width".into(), scored.size.0.into());
    record.insert("height".into(), scored.size.1.into());
    record.append(&mut families(|measure| measure.json(&scored.scores)));
    record.insert("classes".into(), classes(&scored.scores.segcomp));
    record.into()
}

/// SegComp's classes, label by label.
fn classes(found: &SegComp) -> Value {
    let correct = found.correct.iter().map(|pair| json!({"truth": pair.truth, "prediction": pair.prediction}));
    let over = |split: &Split| json!({"truth": split.whole, "predictions": split.parts});
    let under = |split: &Split| json!({"prediction": split.whole, "truths": split.parts});
    json!({
        "correct": correct.collect::<Vec<_>>(),
        "over_segmented": found.over_segmented.iter().map(over).collect::<Vec<_>>(),
        "under_segmented": found.under_segmented.iter().map(under).collect::<Vec<_>>(),
        "missed": found.missed,
        "noise": found.noise,
    })
}
