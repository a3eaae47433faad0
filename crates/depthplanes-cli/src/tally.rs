//! How many of several inputs failed.

use crate::failure::{Failure, Outcome};

/// The inputs that failed.
#[derive(Default)]
pub(crate) struct Tally {
    failed: usize,
    in_part: usize,
    machine: bool,
}

impl Tally {
    /// Tells of an input that failed.
    pub(crate) fn add(&mut self, failure: &Failure) {
        failure.report();
        self.failed += 1;
        self.machine |= failure.is_machine();
    }

    /// Tells of an input that has its output, but not all of it.
    pub(crate) fn add_in_part(&mut self, failure: &Failure) {
        failure.report();
        self.in_part += 1;
    }

    /// Failure if any input failed; the machine's if it was at fault once.
    pub(crate) fn outcome(&self, inputs: usize) -> Outcome {
        match (self.failed, self.in_part) {
            (0, 0) => return Ok(()),
            (0, part) => return Err(Failure::request(format!("{part} of {inputs} inputs failed in part"))),
            _ => (),
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
