//! What inputs came to, on the terminal.

use super::done::Done;
use crate::failure::{Outcome, note, say};
use crate::tally::Tally;
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
