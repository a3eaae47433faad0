//! What inputs came to, on the terminal, and how many of them failed.

use super::done::Done;
use crate::failure::{Failure, Outcome, note, say};
use std::io::Write;

/// Prints what an input came to. A failure among several inputs is reported and counted; that of a
/// single input is the command's own.
pub(super) fn print(done: Outcome<Done>, alone: bool, tally: &mut Tally, out: &mut dyn Write) -> Outcome {
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
pub(super) struct Tally {
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
    pub(super) fn outcome(&self, inputs: usize) -> Outcome {
        if self.failed == 0 {
            return Ok(());
        }
        let others = match inputs - self.failed {
            0 => String::new(),
            1 => "; the other one is done".to_string(),
            good => format!("; the other {good} are done"),
        };
        let have = if self.failed == 1 { "has" } else { "have" };
        let message = format!("{} of {inputs} inputs failed and {have} no output{others}", self.failed);
        Err(if self.machine { Failure::machine(message) } else { Failure::request(message) })
    }
}
