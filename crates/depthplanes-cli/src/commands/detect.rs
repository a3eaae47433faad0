//! `depthplanes detect`: maps in, planes out as a table, as JSON or as files.

use crate::args::Detect;
use crate::failure::{Failure, Outcome, note};
use crate::folders::{make_folder, refuse_file};
use crate::inputs::{self, Input};
use crate::run::{Recipe, Runner};
use crate::{load, pool, show};
use depthplanes::noise::SensorNoise;
use depthplanes_io::outputs::{self, OUTPUTS, Output, Report, TableFile, TableForm};
use depthplanes_io::{ReadOptions, read_noise_table};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) fn run(wanted: &Detect, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, wanted.threads)?;
    let recipe = recipe.outlines(wanted.outlines, wanted.min_hole)?.merge_coplanar(wanted.merge_coplanar)?;
    let needs_curved =
        wanted.outputs.iter().map(|(output, _)| output).chain(&wanted.only).any(|output| output.needs_curved);
    let recipe = recipe.curved(wanted.curved || needs_curved)?;
    let inputs = inputs::expand(&wanted.inputs.words, wanted.inputs.recursive)?;
    check_outputs(wanted, &inputs)?;
    let mut options = load::options(&wanted.reading)?;
    options.noise = wanted.noise_table.as_ref().map(read_noise_table).transpose()?.map(SensorNoise::Table);
    let form = wanted.table.as_deref().map(TableForm::of).transpose()?;
    let plan = Plan { wanted, recipe: &recipe, options, form, alone: inputs.len() == 1 };
    let mut table = Table::begin(wanted, form)?;
    let bar = progress(inputs.len());
    let (mut tally, mut hint) = (Tally::default(), String::new());
    let work = || {
        let mut runner = Runner::new(&recipe);
        let (plan, inputs) = (&plan, &inputs);
        move |at: usize| {
            let input = &inputs[at];
            plan.process(&mut runner, input).map_err(|failure| failure.of_input(&input.name()))
        }
    };
    pool::in_order(inputs.len(), wanted.jobs, work, |_, done| {
        bar.inc(1);
        bar.suspend(|| {
            table.add(&done)?;
            if let Ok(Done { hint: said, .. }) = &done
                && hint.is_empty()
            {
                hint.clone_from(said);
            }
            print(done, plan.alone, &mut tally, out)
        })
    })?;
    bar.finish_and_clear();
    if let Some(line) = table.finish()?.filter(|_| !wanted.json) {
        writeln!(out, "{line}")?;
    }
    out.write_all(hint.as_bytes())?;
    tally.outcome(inputs.len())
}

/// What one input came to.
struct Done {
    text: String,
    notes: Vec<String>,
    /// What it adds to the table of all inputs.
    rows: String,
    planes: usize,
    /// What a camera would add; said once for many inputs.
    hint: String,
}

/// The table of all inputs, if it is wanted.
#[derive(Default)]
struct Table<'a> {
    file: Option<(TableFile, &'a Path)>,
    planes: usize,
    inputs: usize,
}

impl<'a> Table<'a> {
    fn begin(wanted: &'a Detect, form: Option<TableForm>) -> Outcome<Self> {
        let (Some(form), Some(path)) = (form, &wanted.table) else { return Ok(Table::default()) };
        Ok(Table { file: Some((form.begin(path)?, path)), ..Table::default() })
    }

    fn add(&mut self, done: &Outcome<Done>) -> Outcome {
        if let (Some((file, _)), Ok(done)) = (&mut self.file, done) {
            file.add(&done.rows)?;
            self.planes += done.planes;
            self.inputs += 1;
        }
        Ok(())
    }

    /// What is in it, in a line for people; nothing is written where no input was good.
    fn finish(self) -> Outcome<Option<String>> {
        let Some((file, path)) = self.file.filter(|_| self.inputs > 0) else { return Ok(None) };
        file.finish()?;
        let plural = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        let (planes, inputs) = (plural(self.planes, "plane"), plural(self.inputs, "input"));
        Ok(Some(format!("wrote {}: {planes} of {inputs}", path.display())))
    }
}

/// What is done with each input.
struct Plan<'a> {
    wanted: &'a Detect,
    recipe: &'a Recipe,
    options: ReadOptions,
    form: Option<TableForm>,
    alone: bool,
}

impl Plan<'_> {
    fn process(&self, runner: &mut Runner<'_>, input: &Input) -> Outcome<Done> {
        let name = input.name();
        let frame = load::frame(input, &self.options)?;
        let found = runner.detect(&frame, self.wanted.repeat)?;
        let report = Report {
            source: &name,
            frame: &frame,
            method: self.recipe.method,
            parameters: &self.recipe.values,
            detection: &found.detection,
            coplanar: self.recipe.coplanar,
            outlines: found.outlines.as_ref(),
            times: found.times.as_ref(),
            legend: self.wanted.legend,
        };
        let written = write(self.wanted, input, &report)?;
        let mut notes: Vec<String> = frame.warnings.iter().map(|warning| format!("{name}: {warning}")).collect();
        let text = if self.wanted.json {
            json(&report, self.alone)
        } else {
            notes.extend(show::advice(&report));
            readable(self.wanted, &report, &written, self.alone)
        };
        let rows = self.form.map(|form| form.rows(&report)).unwrap_or_default();
        let hint = if self.alone || self.wanted.json { String::new() } else { camera_hint(self.wanted, &report) };
        Ok(Done { text, notes, rows, planes: report.detection.planes.len(), hint })
    }
}

fn json(report: &Report<'_>, alone: bool) -> String {
    if alone { outputs::json_document(report) } else { outputs::json_line(report) + "\n" }
}

/// The table, unless the planes went to files.
fn readable(wanted: &Detect, report: &Report<'_>, written: &[(&Output, PathBuf)], alone: bool) -> String {
    let mut text = show::summary(report);
    if alone {
        text += &camera_hint(wanted, report);
    }
    if written.is_empty() {
        if wanted.table.is_some() {
            return text;
        }
        text += &show::table(report, wanted.rows);
        return text + if alone { show::table_key(report) } else { "\n" };
    }
    let files: Vec<String> = written.iter().map(|(_, path)| path.display().to_string()).collect();
    text += &format!("wrote {}\n", files.join(", "));
    if wanted.out_dir.is_some() && wanted.only.is_empty() && !report.is_metric() {
        text += "no point cloud and no mesh, since camera or unit are not known\n";
    }
    text
}

fn camera_hint(wanted: &Detect, report: &Report<'_>) -> String {
    show::camera_hint(report, wanted.reading.preset.is_some())
}

/// Writes the outputs that are wanted of an input; says which.
fn write(wanted: &Detect, input: &Input, report: &Report<'_>) -> Outcome<Vec<(&'static Output, PathBuf)>> {
    let mut files = wanted.outputs.clone();
    if let Some(folder) = &wanted.out_dir {
        make_folder(&folder.join(input.below()))?;
        let file = |output: &'static Output| (output, file_in(folder, input, output));
        if wanted.only.is_empty() {
            files.extend(OUTPUTS.iter().filter(|output| report.has_what_it_takes(output)).map(file));
        } else {
            files.extend(wanted.only.iter().copied().map(file));
        }
    }
    outputs::write_all(report, &files)?;
    Ok(files)
}

fn file_in(folder: &Path, input: &Input, output: &Output) -> PathBuf {
    folder.join(input.below()).join(format!("{}.{}", input.stem(), output.file))
}

/// Refuses outputs that have a wrong name or would overwrite something, before any work is done.
fn check_outputs(wanted: &Detect, inputs: &[Input]) -> Outcome {
    if let (Some((output, _)), true) = (wanted.outputs.first(), inputs.len() > 1) {
        let (name, count) = (output.name, inputs.len());
        let table = if name == "planes" { ", or --table for one file" } else { "" };
        let message = format!("--{name} names one file, but there are {count} inputs; use --out-dir{table}");
        return Err(Failure::request(message));
    }
    for (output, path) in &wanted.outputs {
        output.writer(path)?;
        outputs::check_folder(path)?;
    }
    let named = wanted.outputs.iter().map(|(output, path)| (path.clone(), format!("--{}", output.name)));
    let mut written: Vec<(PathBuf, String)> = named.collect();
    if let Some(path) = &wanted.table {
        TableForm::of(path)?;
        outputs::check_folder(path)?;
        written.push((path.clone(), "--table".into()));
    }
    if let Some(folder) = &wanted.out_dir {
        refuse_file(folder)?;
        for input in inputs {
            let name = |output: &Output| format!("the {} of {}", output.name, input.name());
            let all = OUTPUTS
                .iter()
                .filter(|output| wanted.only.is_empty() || wanted.only.iter().any(|o| o.name == output.name));
            written.extend(all.map(|output| (file_in(folder, input, output), name(output))));
        }
    }
    Ok(outputs::check_paths(&read_paths(wanted, inputs), &written)?)
}

/// The files that are read: inputs, camera and noise.
fn read_paths(wanted: &Detect, inputs: &[Input]) -> Vec<(PathBuf, String)> {
    let path = |input: &Input| match input {
        Input::File { path, .. } => Some((path.clone(), format!("the input {}", path.display()))),
        _ => None,
    };
    let camera = wanted.reading.camera.iter().map(|path| (path.clone(), "the camera file".to_string()));
    let noise = wanted.noise_table.iter().map(|path| (path.clone(), "the table of the noise".to_string()));
    inputs.iter().filter_map(path).chain(camera).chain(noise).collect()
}

/// A bar on the terminal for several inputs; otherwise one that is never seen.
fn progress(inputs: usize) -> ProgressBar {
    if inputs < 2 {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {pos} of {len}, {eta} left");
    ProgressBar::new(inputs as u64).with_style(style.expect("the template is right"))
}

/// Prints what an input came to. A failure among several inputs is reported and counted; that of a
/// single input is the command's own.
fn print(done: Outcome<Done>, alone: bool, tally: &mut Tally, out: &mut dyn Write) -> Outcome {
    match done {
        Ok(done) => {
            done.notes.iter().for_each(|message| note(message));
            out.write_all(done.text.as_bytes())?;
            Ok(out.flush()?)
        }
        Err(failure) if alone => Err(failure),
        Err(failure) => {
            tally.add(&failure);
            Ok(())
        }
    }
}

/// The inputs that failed.
#[derive(Default)]
struct Tally {
    failed: usize,
    machine: bool,
}

impl Tally {
    fn add(&mut self, failure: &Failure) {
        failure.report();
        self.failed += 1;
        self.machine |= failure.is_machine();
    }

    /// Failure if any input failed; the machine's if it was at fault once.
    fn outcome(&self, inputs: usize) -> Outcome {
        if self.failed == 0 {
            return Ok(());
        }
        let good = inputs - self.failed;
        let message =
            format!("{} of {inputs} inputs failed and have no output; the other {good} are done", self.failed);
        Err(if self.machine { Failure::machine(message) } else { Failure::request(message) })
    }
}
