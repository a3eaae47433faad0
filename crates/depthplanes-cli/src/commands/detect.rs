//! `depthplanes detect`: maps in, planes out as a table, as JSON or as files.

mod done;
mod print;
mod table;
mod targets;

use crate::args::Detect;
use crate::failure::{Failure, Outcome};
use crate::folders::make_folder;
use crate::inputs::{self, Input};
use crate::manifest::{Manifest, Seen, checksums};
use crate::may_close::MayClose;
use crate::run::Recipe;
use crate::runners::Runners;
use crate::shard;
use crate::tally::Tally;
use crate::terminal::plain;
use crate::{load, pool, show};
use depthplanes::noise::SensorNoise;
use depthplanes_io::outputs::{self, OUTPUTS, Output, Report, TableForm};
use depthplanes_io::{ReadOptions, doubts, memory};
use done::Done;
use indicatif::{ProgressBar, ProgressStyle};
use print::print;
use serde_json::json;
use std::io::Write;
use std::path::PathBuf;
use table::Table;
use targets::{check_outputs, file_in, is_standard_output};

pub(super) fn run(wanted: &Detect, out: &mut dyn Write) -> Outcome {
    if wanted.out_dir.is_none() && wanted.outputs.is_empty() && wanted.table.is_none() {
        return run_to(wanted, out);
    }
    run_to(wanted, &mut MayClose::new(out))
}

fn run_to(wanted: &Detect, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, wanted.threads)?;
    let recipe = recipe.outlines(wanted.outlines, wanted.min_hole)?.merge_coplanar(wanted.merge_coplanar)?;
    let needs_curved =
        wanted.outputs.iter().map(|(output, _)| output).chain(&wanted.only).any(|output| output.needs_curved);
    let recipe = recipe.curved(wanted.curved || needs_curved)?;
    let all = inputs::expand(&wanted.inputs.words, wanted.inputs.recursive)?;
    let alone = all.len() == 1;
    let inputs = match wanted.shard {
        Some(shard) => shard::part(shard, all),
        None => all,
    };
    check_outputs(wanted, &inputs)?;
    let mut options = load::options(&wanted.reading)?;
    options.noise = load::noise_table(wanted.noise_table.as_deref())?.map(SensorNoise::Table);
    let form = wanted.table.as_deref().map(TableForm::of).transpose()?;
    let files = wanted.outputs.iter().filter(|(_, path)| !is_standard_output(path)).cloned().collect();
    let manifest = manifest_of(wanted, &inputs, &recipe, form)?;
    let due = match &manifest {
        Some(manifest) => manifest.due(&inputs)?,
        None => inputs.iter().collect(),
    };
    let plan = Plan { wanted, files, recipe: &recipe, options, form, alone };
    let mut table = Table::begin(wanted, form)?;
    let bar = progress(due.len());
    let (mut tally, mut hint) = (Tally::default(), String::new());
    let runners = Runners::new(&recipe);
    let work = || {
        let (plan, due, runners, manifest) = (&plan, &due, &runners, manifest.as_ref());
        move |at: usize| {
            let input = due[at];
            let seen = manifest.map(|_| Seen::of(input)); // before it is read
            let outcome = plan.process(runners, input).map_err(|failure| failure.of_input(&input.name()));
            manifest.zip(seen).map_or(Ok(()), |(manifest, seen)| noted(manifest, input, seen, &outcome)).and(outcome)
        }
    };
    pool::in_order(due.len(), wanted.jobs, work, |_, done| {
        bar.inc(1);
        bar.suspend(|| {
            if let (Ok(done), None) = (&done, &manifest) {
                table.add(&done.rows, done.planes)?;
            }
            if let Ok(Done { hint: said, .. }) = &done
                && hint.is_empty()
            {
                hint.clone_from(said);
            }
            print(done, plan.alone, &mut tally, out)
        })
    })?;
    bar.finish_and_clear();
    if let Some(manifest) = &manifest {
        table.add_all(&inputs, manifest)?;
    }
    if let Some(line) = table.finish()?.filter(|_| !wanted.json) {
        writeln!(out, "{line}")?;
    }
    out.write_all(hint.as_bytes())?;
    tally.outcome(due.len())
}

/// The manifest, if a run is to go on.
fn manifest_of(
    wanted: &Detect,
    inputs: &[Input],
    recipe: &Recipe,
    form: Option<TableForm>,
) -> Outcome<Option<Manifest>> {
    let Some(folder) = wanted.out_dir.as_ref().filter(|_| wanted.resume) else { return Ok(None) };
    if inputs.contains(&Input::Standard) {
        return Err(Failure::request(
            "-: --resume cannot tell one standard input from another; accepted: files, folders, scenes",
        ));
    }
    make_folder(folder)?;
    let settings = json!({
        "command": "detect",
        "version": env!("CARGO_PKG_VERSION"),
        "method": recipe.method.name,
        "parameters": recipe.named_values(),
        "reading": wanted.reading.words,
        "noise-table": wanted.noise_table,
        "files": checksums(wanted.reading.camera.iter().chain(&wanted.noise_table).map(PathBuf::as_path)),
        "merge-coplanar": wanted.merge_coplanar,
        "outlines": wanted.outlines,
        "min-hole": wanted.min_hole,
        "curved": wanted.curved,
        "legend": wanted.legend,
        "only": wanted.only.iter().map(|output| output.name).collect::<Vec<_>>(),
        "table": form.map(|form| form.name()),
    });
    Manifest::open(folder, wanted.shard, &settings).map(Some)
}

/// Notes in the manifest what came of an input.
fn noted(manifest: &Manifest, input: &Input, seen: Seen, outcome: &Outcome<Done>) -> Outcome {
    let entry = outcome.as_ref().map(Done::entry);
    manifest.add(input, seen, entry.as_ref().map_err(|failure| *failure))
}

/// What is done with each input.
struct Plan<'a> {
    wanted: &'a Detect,
    /// Outputs that go to files.
    files: Vec<(&'static Output, PathBuf)>,
    recipe: &'a Recipe,
    options: ReadOptions,
    form: Option<TableForm>,
    alone: bool,
}

impl Plan<'_> {
    fn process(&self, runners: &Runners<'_>, input: &Input) -> Outcome<Done> {
        let name = input.name();
        let frame = load::frame(input, &self.options)?;
        let found = runners.detect(&frame, self.wanted.repeat)?;
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
        let text = if self.wanted.json {
            json_text(&report, self.alone)
        } else {
            notes.extend(show::advice(&report));
            self.readable(&report, &written, bytes.is_some())
        };
        let rows = self.form.map(|form| form.rows(&report)).unwrap_or_default();
        let written = written.into_iter().map(|(_, path)| path).collect();
        let hint = if self.alone || self.wanted.json { String::new() } else { self.camera_hint(&report) };
        Ok(Done { text, notes, bytes, rows, written, planes: report.detection.planes.len(), hint })
    }

    /// Writes the outputs that are wanted of an input; says which.
    fn write(&self, input: &Input, report: &Report<'_>) -> Outcome<Vec<(&'static Output, PathBuf)>> {
        let (mut files, only) = (self.files.clone(), &self.wanted.only);
        if let Some(folder) = &self.wanted.out_dir {
            make_folder(&folder.join(input.below()))?;
            let file = |output: &'static Output| (output, file_in(folder, input, output));
            if only.is_empty() {
                files.extend(OUTPUTS.iter().filter(|output| report.has_what_it_takes(output)).map(file));
            } else {
                files.extend(only.iter().copied().map(file));
            }
        }
        // As measured: up to 37 bytes a pixel for all outputs.
        let needed = if files.is_empty() { 0 } else { 40 * (report.frame.width * report.frame.height) as u64 };
        memory::check(needed, needed)?;
        outputs::write_all(report, &files)?;
        Ok(files)
    }

    /// The table, unless the planes go elsewhere.
    fn readable(&self, report: &Report<'_>, written: &[(&Output, PathBuf)], to_standard_output: bool) -> String {
        let wanted = self.wanted;
        let mut text = show::summary(report);
        if self.alone {
            text += &self.camera_hint(report);
        }
        if written.is_empty() && !to_standard_output {
            if wanted.table.is_some() {
                return text;
            }
            text += &show::table(report, wanted.rows);
            return text + if self.alone { show::table_key(report) } else { "\n" };
        }
        let files: Vec<String> =
            written.iter().map(|(_, path)| plain(&path.display().to_string()).into_owned()).collect();
        if !files.is_empty() {
            text += &format!("wrote {}\n", files.join(", "));
        }
        if wanted.out_dir.is_some() && wanted.only.is_empty() && !report.is_metric() {
            text += "no point cloud and no mesh, since camera or unit are not known\n";
        }
        text
    }

    fn camera_hint(&self, report: &Report<'_>) -> String {
        show::camera_hint(report.frame, self.wanted.reading.preset.is_some())
    }
}

fn json_text(report: &Report<'_>, alone: bool) -> String {
    if alone { outputs::json_document(report) } else { outputs::json_line(report) + "\n" }
}

/// A bar on the terminal for several inputs; otherwise one that is never seen.
fn progress(inputs: usize) -> ProgressBar {
    if inputs < 2 {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {pos} of {len}, {eta} left");
    ProgressBar::new(inputs as u64).with_style(style.expect("the template is right"))
}
