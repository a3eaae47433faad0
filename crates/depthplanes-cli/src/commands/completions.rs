//! `depthplanes completions`: the completion script for a shell.

use crate::args;
use crate::failure::Outcome;
use std::io::Write;

pub(super) fn run(shell: args::Shell, out: &mut dyn Write) -> Outcome {
    // Made in memory: the generator cannot report a closed pipe.
    let mut script = Vec::new();
    args::completions(shell, &mut script);
    Ok(out.write_all(&script)?)
}
