//! The commands, one file each.

mod compare;
mod completions;
mod demo;
mod detect;
mod explain;
mod floor;
mod inspect;
mod lists;
mod man;
mod next;
mod noise;
mod score;
mod serve;
mod track;

use crate::args::Command;
use crate::failure::Outcome;
use crate::signals;
use std::io::Write;

/// What to do after a command that writes files was interrupted; `None` for other commands, and `track`, which sees to it itself.
fn after_interruption(command: &Command) -> Option<&'static str> {
    match command {
        Command::Eval(_) | Command::Paper(_) => Some("the same words go on"),
        Command::Detect(wanted) if wanted.resume => Some("the same words go on"),
        Command::Detect(wanted) if wanted.out_dir.is_some() => {
            Some("the same words begin again; with --resume, from the first run on, they go on")
        }
        Command::Detect(wanted) if wanted.writes_files() => Some("the same words begin again"),
        Command::Demo { .. } | Command::Compare(_) | Command::Man { .. } => Some("the same words begin again"),
        _ => None,
    }
}

/// Runs a command; `out` is standard output.
pub(crate) fn run(command: &Command, out: &mut dyn Write) -> Outcome {
    if let Some(next) = after_interruption(command) {
        signals::tidy_up_if_interrupted(next);
    }
    match command {
        Command::Detect(wanted) => detect::run(wanted, out),
        Command::Explain(wanted) => explain::run(wanted, out),
        Command::Floor(wanted) => floor::run(wanted, out),
        Command::Inspect { inputs, reading, json } => inspect::run(inputs, reading, *json, out),
        Command::Noise { inputs, reading, json } => noise::run(inputs, reading, *json, out),
        Command::Track(wanted) => track::run(wanted, out),
        Command::Serve(wanted) => serve::run(wanted, out),
        Command::Score(wanted) => score::run(wanted, out),
        Command::Compare(wanted) => compare::run(wanted, out),
        Command::Eval(wanted) => crate::eval::run(wanted, out),
        Command::Paper(wanted) => crate::eval::paper::run(wanted, out),
        Command::Datasets => lists::datasets(out),
        Command::Demo { out_dir } => demo::run(out_dir, out),
        Command::Methods => lists::methods(out),
        Command::Params { method } => lists::params(*method, out),
        Command::Formats => lists::formats(out),
        Command::Encodings => lists::encodings(out),
        Command::Presets => lists::presets(out),
        Command::Completions { shell } => completions::run(*shell, out),
        Command::Man { out_dir } => man::run(out_dir.as_deref(), out),
    }
}
