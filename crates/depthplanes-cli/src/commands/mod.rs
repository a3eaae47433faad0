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

/// Runs a command; `out` is standard output.
pub(crate) fn run(command: &Command, out: &mut dyn Write) -> Outcome {
    let is_writing = match command {
        Command::Detect(wanted) => wanted.writes_files(),
        Command::Demo { .. } | Command::Compare(_) | Command::Eval(_) | Command::Paper(_) | Command::Man { .. } => true,
        _ => false,
    };
    if is_writing {
        signals::tidy_up_if_interrupted();
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
