//! `depthplanes score`: label images against the truth, as a table or as JSON.

use crate::args::Score;
use crate::failure::{Failure, Outcome, note};
use crate::pairs::{self, Pair, Truth};
use crate::table::{Align, aligned, row};
use depthplanes::metrics::{Contingency, Evops, Partition, SegComp, Split, Tolerance, evops, partition, segcomp};
use depthplanes::scene::Spec;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{LabelImage, read_labels};
use serde_json::{Map, Value, json};
use std::io::Write;

/// What is known of a pair.
struct Scored {
    pair: Pair,
    size: (usize, usize),
    /// Planes of the truth and of the prediction.
    planes: (usize, usize),
    segcomp: SegComp,
    evops: Evops,
    partition: Option<Partition>,
    on_planes: Option<Partition>,
}

/// What a measure reads off a pair.
#[derive(Clone, Copy)]
enum Reading {
    Count(fn(&Scored) -> usize),
    Share(fn(&Scored) -> f64),
    /// A number that some pairs do not have.
    Known(fn(&Scored) -> Option<f64>),
}
use Reading::{Count, Known, Share};

/// One measure: a line of the table, a field of the JSON.
struct Measure {
    /// The JSON object that it belongs to.
    family: &'static str,
    name: &'static str,
    /// Heading of its column in the table of several pairs; empty if it has none.
    column: &'static str,
    meaning: &'static str,
    reading: Reading,
}

impl Measure {
    fn value(&self, scored: &Scored) -> Option<f64> {
        match self.reading {
            Count(count) => Some(count(scored) as f64),
            Share(share) => Some(share(scored)),
            Known(number) => number(scored),
        }
    }

    /// For people.
    fn written(&self, scored: &Scored) -> String {
        match self.reading {
            Count(count) => count(scored).to_string(),
            _ => decimal(self.value(scored)),
        }
    }

    fn json(&self, scored: &Scored) -> Value {
        match self.reading {
            Count(count) => count(scored).into(),
            _ => self.value(scored).into(),
        }
    }

    /// Over the pairs that have it.
    fn mean(&self, scored: &[Scored]) -> Option<f64> {
        let values: Vec<f64> = scored.iter().filter_map(|one| self.value(one)).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }
}

const fn measure(
    family: &'static str,
    name: &'static str,
    column: &'static str,
    meaning: &'static str,
    reading: Reading,
) -> Measure {
    Measure { family, name, column, meaning, reading }
}

/// In the order of the table; a family's measures stand together.
#[rustfmt::skip]
const MEASURES: &[Measure] = &[
    measure("planes", "truth", "truth", "planes of the truth", Count(|s| s.planes.0)),
    measure("planes", "predicted", "pred", "predicted planes", Count(|s| s.planes.1)),
    measure("segcomp", "correct", "correct", "truth planes found by one predicted plane", Count(|s| s.segcomp.correct.len())),
    measure("segcomp", "over_segmented", "over", "truth planes cut into several", Count(|s| s.segcomp.over_segmented.len())),
    measure("segcomp", "under_segmented", "under", "predicted planes that join several", Count(|s| s.segcomp.under_segmented.len())),
    measure("segcomp", "missed", "missed", "truth planes in none of these", Count(|s| s.segcomp.missed.len())),
    measure("segcomp", "noise", "noise", "predicted planes in none of these", Count(|s| s.segcomp.noise.len())),
    measure("synpeb", "f", "f", "share of the truth planes that are correct", Known(|s| s.segcomp.f)),
    measure("synpeb", "k", "k", "the same, weighted by pixels", Known(|s| s.segcomp.k)),
    measure("evops", "precision", "prec", "share of the predicted planes with IoU >= 0.75", Share(|s| s.evops.precision)),
    measure("evops", "recall", "recall", "share of the truth planes with IoU >= 0.75", Share(|s| s.evops.recall)),
    measure("evops", "f_score", "F", "harmonic mean of both", Share(|s| s.evops.f_score)),
    measure("evops", "mean_iou", "", "mean IoU of the matched planes", Share(|s| s.evops.mean_iou)),
    measure("evops", "mean_dice", "", "their mean Dice coefficient", Share(|s| s.evops.mean_dice)),
    measure("evops", "panoptic_iou", "panoptic", "mean_iou times f_score", Share(|s| s.evops.panoptic_iou)),
    measure("evops", "panoptic_dice", "", "mean_dice times f_score", Share(|s| s.evops.panoptic_dice)),
    measure("evops", "usr", "", "share of the predicted planes that join several", Share(|s| s.evops.under_segmented)),
    measure("evops", "osr", "", "share of the truth planes cut into several", Share(|s| s.evops.over_segmented)),
    measure("evops", "missed", "", "share of the truth planes that are missed", Share(|s| s.evops.missed)),
    measure("evops", "noise", "", "share of the predicted planes that are noise", Share(|s| s.evops.noise)),
    measure("partition", "rand_index", "RI", "RI over all pixels, no plane being one more region", Known(|s| Some(s.partition?.rand_index))),
    measure("partition", "variation_of_information", "VOI", "VOI, bits; 0 is best", Known(|s| Some(s.partition?.variation_of_information))),
    measure("partition", "segmentation_covering", "SC", "SC", Known(|s| Some(s.partition?.segmentation_covering))),
    measure("on_planes", "rand_index", "", "RI over the pixels on truth planes", Known(|s| Some(s.on_planes?.rand_index))),
    measure("on_planes", "variation_of_information", "", "VOI there", Known(|s| Some(s.on_planes?.variation_of_information))),
    measure("on_planes", "segmentation_covering", "", "SC there", Known(|s| Some(s.on_planes?.segmentation_covering))),
];

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
    Ok(Scored {
        pair,
        size,
        planes: (table.truth_planes().len(), table.predicted_planes().len()),
        segcomp: segcomp(&table, tolerance),
        evops: evops(&table),
        partition: partition(&table),
        on_planes: partition(&table.on_truth_planes()),
    })
}

/// More labels than anybody gives: a depth map that was taken for a label image.
const MANY: usize = 1000;

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
            let truth = spec.parse::<Spec>()?.frame()?.truth;
            let (width, height, labels) = (truth.width, truth.height, truth.labels);
            Ok(LabelImage { width, height, labels, warnings: Vec::new() })
        }
    }
}

fn read(path: &std::path::Path) -> Outcome<LabelImage> {
    let image = read_labels(path, &DecodeOptions::default())?;
    image.warnings.iter().for_each(|warning| note(&format!("{}: {warning}", path.display())));
    Ok(image)
}

/// A line for each measure.
fn one_pair(scored: &Scored) -> String {
    let (width, height) = scored.size;
    let (truth, prediction) = (scored.pair.truth.name(), scored.pair.prediction.display());
    let mut rows = vec![row(["measure", "", "value", "meaning"])];
    rows.extend(
        MEASURES.iter().map(|measure| row([measure.family, measure.name, &measure.written(scored), measure.meaning])),
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
    rows.extend(scored.iter().map(|one| line(&one.pair.name, &|measure| measure.written(one))));
    rows.push(line("mean", &|measure| decimal(measure.mean(scored))));
    let mut aligns = vec![Align::Right; rows[0].len()];
    aligns[0] = Align::Left;
    aligned(&aligns, &rows)
}

fn decimal(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.3}"))
}

fn document(wanted: &Score, scored: &[Scored]) -> Value {
    let means = families(|measure| measure.mean(scored).into());
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
    record.append(&mut families(|measure| measure.json(scored)));
    record.insert("classes".into(), classes(&scored.segcomp));
    record.into()
}

/// An object for each family, with a field for each of its measures.
fn families(value: impl Fn(&Measure) -> Value) -> Map<String, Value> {
    let mut all = Map::new();
    for measure in MEASURES {
        let family = all.entry(measure.family).or_insert_with(|| json!({}));
        family[measure.name] = value(measure);
    }
    all
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
