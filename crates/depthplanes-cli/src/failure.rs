//! What went wrong, whose fault it is, and the exit code that says so.

use crate::terminal::plain;
use depthplanes_io::outputs::OutputError;
use std::fmt;
use std::io::{self, Write};

/// Why a command did not do all that was asked.
#[derive(Debug)]
pub(crate) struct Failure {
    fault: Fault,
    message: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// Wrong use or a wrong input: exit code 2.
    Request,
    /// The machine, while processing or writing: exit code 1.
    Machine,
    /// Nobody reads standard output any more: quiet, exit code 0.
    ClosedPipe,
}

/// What a command returns.
pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// The request or an input is wrong.
    pub(crate) fn request(message: impl Into<String>) -> Self {
        Failure { fault: Fault::Request, message: message.into() }
    }

    /// The machine failed.
    pub(crate) fn machine(message: impl Into<String>) -> Self {
        Failure { fault: Fault::Machine, message: message.into() }
    }

    /// The same failure with the input's name in front.
    pub(crate) fn of_input(self, name: &str) -> Self {
        let named = self.message.starts_with(&format!("{name}: "));
        let message = if named { self.message } else { format!("{name}: {}", self.message) };
        Failure { message, ..self }
    }

    /// Whether the machine is at fault.
    pub(crate) fn is_machine(&self) -> bool {
        self.fault == Fault::Machine
    }

    /// Whether standard output was closed by its reader.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        self.fault == Fault::ClosedPipe
    }

    /// Prints the failure to standard error.
    pub(crate) fn report(&self) {
        let red = anstyle::AnsiColor::Red.on_default().bold();
        say(&format!("{red}error:{red:#} {}", plain(&self.message)));
    }
}

/// Prints something that a person should know, but that is no failure.
pub(crate) fn note(message: &str) {
    let yellow = anstyle::AnsiColor::Yellow.on_default().bold();
    say(&format!("{yellow}note:{yellow:#} {}", plain(message)));
}

/// Lines to standard error; whoever says them has seen to names in them. Where nobody can be told nothing is said.
pub(crate) fn say(line: &str) {
    let _ = writeln!(anstream::stderr().lock(), "{line}");
}

/// Reports a failure, and the exit code for it.
pub(crate) fn exit_code(outcome: Outcome) -> u8 {
    match outcome {
        Ok(()) => 0,
        Err(failure) if failure.is_closed_pipe() => 0,
        Err(failure) => {
            failure.report();
            if failure.is_machine() { 1 } else { 2 }
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl From<depthplanes::Error> for Failure {
    fn from(error: depthplanes::Error) -> Self {
        let how = match error {
            depthplanes::Error::NotMetric { is_disparity: true, .. } => ": give --focal and --baseline",
            depthplanes::Error::NotMetric { .. } => ": give --intrinsics fx,fy,cx,cy, --camera FILE or --preset SENSOR",
            _ => "",
        };
        Failure::request(format!("{error}{how}"))
    }
}

impl From<depthplanes_io::Error> for Failure {
    fn from(error: depthplanes_io::Error) -> Self {
        let message = error.to_string();
        match error.kind() {
            depthplanes_io::Error::Memory { .. } => Failure::machine(message),
            _ => Failure::request(message),
        }
    }
}

impl From<depthplanes_video::Error> for Failure {
    fn from(error: depthplanes_video::Error) -> Self {
        match error {
            depthplanes_video::Error::Read(error) => error.into(),
            depthplanes_video::Error::Library(error) => error.into(),
            error => Failure::request(error.to_string()),
        }
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        let message = error.to_string();
        if error.is_usage() { Failure::request(message) } else { Failure::machine(message) }
    }
}

/// Errors of standard output; files have errors with their names.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        let fault = if error.kind() == io::ErrorKind::BrokenPipe { Fault::ClosedPipe } else { Fault::Machine };
        Failure { fault, message: format!("standard output: {error}") }
    }
}
