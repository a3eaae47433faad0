//! The program `depthplanes`: planes from depth and disparity maps, on the command line.

mod args;
mod checksum;
mod commands;
mod eval;
mod failure;
mod folders;
mod inputs;
mod load;
mod measures;
mod pairs;
mod patience;
mod pool;
mod run;
mod runners;
mod show;
mod signals;
mod table;
mod terminal;

use std::io::Write;
use std::process::ExitCode;

// musl's own allocator asks the system anew for each large block: `ngaf`, `normals` and `hough` take half as long again.
#[cfg(target_env = "musl")]
#[global_allocator]
static ALLOCATOR: dlmalloc::GlobalDlmalloc = dlmalloc::GlobalDlmalloc;

fn main() -> ExitCode {
    signals::prepare();
    let command = match args::parse() {
        Ok(command) => command,
        Err(ended) => return ended,
    };
    let mut out = terminal::Plain(std::io::BufWriter::new(std::io::stdout()));
    let outcome = commands::run(&command, &mut out);
    let flushed = out.flush().map_err(failure::Failure::from);
    failure::exit_code(outcome.and(flushed))
}
