//! `depthplanes compare`: several methods on one map, as a table and as one picture.

use crate::args::Compare;
use crate::failure::{Failure, Outcome, note};
use crate::inputs::{self, Input};
use crate::load;
use crate::patience::patiently;
use crate::run::{Recipe, Runner};
use crate::table::{Align, aligned, row};
use crate::terminal::plain;
use depthplanes::metrics::{Contingency, Tolerance};
use depthplanes::scene::Spec;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::measures::Scores;
use depthplanes_io::outputs::{Tile, side_by_side, write_file};
use depthplanes_io::{Frame, read_labels};
use std::io::Write;

/// Columns of a picture.
const WIDTH: usize = 320;

/// What a method made of the map.
struct Made {
    method: &'static str,
    labels: Vec<u16>,
    cells: Vec<String>,
}

pub(super) fn run(wanted: &Compare, out: &mut dyn Write) -> Outcome {
    let recipes = Recipe::several(&wanted.methods, &wanted.parameters, wanted.threads)?;
    let inputs = inputs::expand(std::slice::from_ref(&wanted.input), false)?;
    let [input] = &inputs[..] else {
        return Err(Failure::request(format!("{}: {} maps; compare takes one", wanted.input.display(), inputs.len())));
    };
    let frame = load::frame(input, &load::options(&wanted.reading)?)?;
    frame.warnings.iter().for_each(|warning| note(&format!("{}: {warning}", input.name())));
    let truth = truth(wanted, input, &frame)?;
    let mut made = Vec::new();
    for recipe in &recipes {
        match of_method(recipe, &frame, truth.as_deref(), wanted) {
            Ok(one) => made.push(one),
            Err(failure) => note(&format!("{}: {failure}", recipe.method.name)),
        }
    }
    if made.is_empty() {
        return Err(Failure::request(format!("{}: no method could do it", input.name())));
    }
    let scores: &[&str] = if truth.is_some() { &["truth", "correct", "F"] } else { &[] };
    let head = row(["method", "planes", "% of valid", "ms", "least ms"]).into_iter();
    let mut rows = vec![head.chain(scores.iter().map(|head| head.to_string())).collect::<Vec<_>>()];
    rows.extend(made.iter().map(|one| one.cells.clone()));
    let mut aligns = vec![Align::Right; rows[0].len()];
    aligns[0] = Align::Left;
    writeln!(out, "{}: {} x {}", plain(&input.name()), frame.width, frame.height)?;
    write!(out, "{}", aligned(&aligns, &rows))?;
    if let Some(path) = &wanted.picture {
        write_file(path, &picture(&frame, truth.as_deref(), &made)?)?;
        writeln!(out, "wrote {}", plain(&path.display().to_string()))?;
    }
    Ok(())
}

/// A label for each pixel of the map, lower ones than planes have as 0; none where no truth is known.
fn truth(wanted: &Compare, input: &Input, frame: &Frame) -> Outcome<Option<Vec<u16>>> {
    let image = match (&wanted.truth, input) {
        (Some(path), _) => {
            let image = patiently(path.as_ref(), || read_labels(path, &DecodeOptions::default()))?;
            if (image.width, image.height) != (frame.width, frame.height) {
                let (path, of) = (path.display(), input.name());
                return Err(Failure::request(format!(
                    "{path}: {} x {} labels, but {of} has {} x {} pixels",
                    image.width, image.height, frame.width, frame.height
                )));
            }
            image.labels
        }
        (None, Input::Scene(spec)) => spec.parse::<Spec>()?.frame()?.measured_labels(),
        (None, _) => return Ok(None),
    };
    Ok(Some(image.into_iter().map(|label| if label < wanted.truth_from { 0 } else { label }).collect()))
}

fn of_method(recipe: &Recipe, frame: &Frame, truth: Option<&[u16]>, wanted: &Compare) -> Outcome<Made> {
    let found = Runner::new(recipe).detect(frame, wanted.repeat)?;
    let (detection, times) = (found.detection, found.times.unwrap_or_default().total);
    let share = 100.0 * detection.labelled_share();
    let mut cells = row([recipe.method.name, &detection.planes.len().to_string(), &format!("{share:.1}")]);
    cells.extend([times.median, times.min].map(|time| format!("{time:.2}")));
    if let Some(truth) = truth {
        let scores = Scores::of(&Contingency::new(truth, &detection.labels)?, Tolerance::default());
        cells.extend([scores.planes.0, scores.segcomp.correct.len()].map(|count| count.to_string()));
        cells.push(format!("{:.3}", scores.evops.f_score));
    }
    Ok(Made { method: recipe.method.name, labels: detection.labels, cells })
}

/// The map, the truth if it is known, and each method's planes.
fn picture(frame: &Frame, truth: Option<&[u16]>, made: &[Made]) -> Outcome<Vec<u8>> {
    let none = vec![0; frame.width * frame.height];
    let mut tiles = vec![Tile { caption: "map", labels: &none }];
    tiles.extend(truth.map(|labels| Tile { caption: "truth", labels }));
    tiles.extend(made.iter().map(|one| Tile { caption: one.method, labels: &one.labels }));
    Ok(side_by_side(frame, &tiles, WIDTH)?)
}
