//! The program `depthplanes` as a function of its words, for its own `main` and for that of the Python package.

mod args;
mod checksum;
mod commands;
mod eval;
mod failure;
mod folders;
mod inputs;
mod load;
mod manifest;
mod may_close;
mod pairs;
mod patience;
mod pool;
mod run;
mod runners;
mod shard;
mod show;
mod signals;
mod table;
mod tally;
mod terminal;

use std::ffi::OsString;
use std::io::Write;

/// Runs the program: `words` are the command line, the name of the program first. The exit code is the program's: 0 if all is
/// done, 1 if the machine fails, 2 for wrong use or a wrong input. What interrupts it may end the process.
pub fn main(words: impl IntoIterator<Item = OsString>) -> u8 {
    signals::prepare();
    let command = match args::parse(words.into_iter().collect()) {
        Ok(command) => command,
        Err(ended) => return ended,
    };
    let mut out = terminal::Plain(std::io::BufWriter::new(std::io::stdout()));
    let outcome = commands::run(&command, &mut out);
    let flushed = out.flush().map_err(failure::Failure::from);
    failure::exit_code(outcome.and(flushed))
}
