//! `depthplanes detect`: maps in, planes out as a table, as JSON or as files.

use crate::args::Detect;
use crate::failure::{Failure, Outcome, note, say};
use crate::folders::{make_folder, refuse_file};
use crate::inputs::{self, Input};
use crate::run::{Recipe, Runner};
use crate::terminal::plain;
use crate::{load, pool, show};
use depthplanes::noise::SensorNoise;
use depthplanes_io::outputs::{self, OUTPUTS, Output, Report};
use depthplanes_io::{ReadOptions, doubts, memory, read_noise_table};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

pub(super) fn run(wanted: &Detect, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, wanted.threads)?;
    let recipe = recipe.outlines(wanted.outlines)?.merge_coplanar(wanted.merge_coplanar)?;
    let recipe = recipe.curved(wanted.curved || wanted.outputs.iter().any(|(output, _)| output.needs_curved))?;
    let inputs = inputs::expand(&wanted.inputs)?;
    check_outputs(wanted, &inputs)?;
    let mut options = load::options(&wanted.reading)?;
    options.noise = wanted.noise_table.as_ref().map(read_noise_table).transpose()?.map(SensorNoise::Table);
    let files = wanted.outputs.iter().filter(|(_, path)| !is_standard_output(path)).cloned().collect();
    let plan = Plan { wanted, files, recipe: &recipe, options, alone: inputs.len() == 1 };
    let bar = progress(inputs.len());
    let mut tally = Tally::default();
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
        bar.suspend(|| print(done, plan.alone, &mut tally, out))
    })?;
    bar.finish_and_clear();
    tally.outcome(inputs.len())
}

/// What one input came to.
struct Done {
    text: String,
    notes: Vec<String>,
    /// An output that goes to standard output; the text goes to standard error then.
    bytes: Option<Vec<u8>>,
}

/// What is done with each input.
struct Plan<'a> {
    wanted: &'a Detect,
    /// Outputs that go to files.
    files: Vec<(&'static Output, PathBuf)>,
    recipe: &'a Recipe,
    options: ReadOptions,
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
            notes: &[],
        };
        let doubts = doubts(&report);
        let report = Report { notes: &doubts, ..report };
        let bytes = match self.wanted.outputs.iter().find(|(_, path)| is_standard_output(path)) {
            Some((output, path)) => Some((output.writer(path)?.encode)(&report)?),
            None => None,
        };
        let written = self.write(input, &report)?;
        let told = frame.warnings.iter().chain(&doubts);
        let mut notes: Vec<String> = told.map(|warning| format!("{name}: {warning}")).collect();
        if self.wanted.json {
            return Ok(Done { text: json(&report, self.alone), notes, bytes });
        }
        notes.extend(show::advice(&report));
        let to_files = !written.is_empty() || bytes.is_some();
        Ok(Done { text: readable(self.wanted, &report, to_files, &written, self.alone), notes, bytes })
    }

    /// Writes the outputs that are wanted of an input; says which.
    fn write(&self, input: &Input, report: &Report<'_>) -> Outcome<Vec<(&'static Output, PathBuf)>> {
        let mut files = self.files.clone();
        if let Some(folder) = &self.wanted.out_dir {
            make_folder(folder)?;
            let possible = OUTPUTS.iter().filter(|output| report.has_what_it_takes(output));
            files.extend(possible.map(|output| (output, file_in(folder, input, output))));
        }
        if !files.is_empty() {
            // As measured: up to 37 bytes a pixel for all outputs.
            let needed = 40 * (report.frame.width * report.frame.height) as u64;
            memory::check(needed, needed)?;
        }
        outputs::write_all(report, &files)?;
        Ok(files)
    }
}

fn json(report: &Report<'_>, alone: bool) -> String {
    if alone { outputs::json_document(report) } else { outputs::json_line(report) + "\n" }
}

/// The table, unless the planes went to files.
fn readable(
    wanted: &Detect,
    report: &Report<'_>,
    to_files: bool,
    written: &[(&Output, PathBuf)],
    alone: bool,
) -> String {
    let mut text = show::summary(report);
    if !to_files {
        text += &show::table(report, wanted.rows);
        return if alone { text } else { text + "\n" };
    }
    let files: Vec<String> = written.iter().map(|(_, path)| plain(&path.display().to_string()).into_owned()).collect();
    if !files.is_empty() {
        text += &format!("wrote {}\n", files.join(", "));
    }
    if wanted.out_dir.is_some() && !report.is_metric() {
        text += "no point cloud and no mesh, since camera or unit are not known\n";
    }
    text
}

fn file_in(folder: &Path, input: &Input, output: &Output) -> PathBuf {
    folder.join(format!("{}.{}", input.stem(), output.file))
}

/// Refuses outputs that have a wrong name or would overwrite something, before any work is done.
fn check_outputs(wanted: &Detect, inputs: &[Input]) -> Outcome {
    if let (Some((output, _)), true) = (wanted.outputs.first(), inputs.len() > 1) {
        let message = format!("--{} names one file, but there are {} inputs; use --out-dir", output.name, inputs.len());
        return Err(Failure::request(message));
    }
    for (output, path) in &wanted.outputs {
        let writer = output.writer(path)?;
        if is_standard_output(path) {
            check_standard_output(wanted, output.name, !["json", "csv"].contains(&writer.extension))?;
        } else {
            outputs::check_folder(path)?;
        }
    }
    let to_files = wanted.outputs.iter().filter(|(_, path)| !is_standard_output(path));
    let named = to_files.map(|(output, path)| (path.clone(), format!("--{}", output.name)));
    let mut written: Vec<(PathBuf, String)> = named.collect();
    if let Some(folder) = &wanted.out_dir {
        refuse_file(folder)?;
        for input in inputs {
            let name = |output: &Output| format!("the {} of {}", output.name, input.name());
            written.extend(OUTPUTS.iter().map(|output| (file_in(folder, input, output), name(output))));
        }
    }
    Ok(outputs::check_paths(&read_paths(wanted, inputs), &written)?)
}

/// Whether an output goes to standard output: `-`, or the system's name for it.
fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdout")
}

/// Refuses a second thing on standard output, and bytes that are no text on a terminal.
fn check_standard_output(wanted: &Detect, name: &str, is_binary: bool) -> Outcome {
    let outputs = wanted.outputs.iter().filter(|(_, path)| is_standard_output(path)).count();
    if outputs > 1 || wanted.json {
        let message = "standard output takes one output, and --json is one; give the others file names";
        return Err(Failure::request(format!("--{name} -: {message}")));
    }
    if is_binary && std::io::stdout().is_terminal() {
        let message = "standard output is a terminal; send it to a file or a program, with > or |";
        return Err(Failure::request(format!("--{name} -: {message}")));
    }
    Ok(())
}

/// The files that are read: inputs, camera and noise.
fn read_paths(wanted: &Detect, inputs: &[Input]) -> Vec<(PathBuf, String)> {
    let path = |input: &Input| match input {
        Input::File(path) => Some((path.clone(), format!("the input {}", path.display()))),
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
            if let Some(bytes) = done.bytes {
                say(done.text.trim_end());
                // Not text, and so not through what escapes text.
                let mut standard = std::io::stdout().lock();
                return Ok(standard.write_all(&bytes).and_then(|()| standard.flush())?);
            }
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
