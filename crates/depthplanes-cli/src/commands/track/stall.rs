//! Whether the source keeps the program waiting.

use crate::failure::note;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Waiting for a frame is worth a word after so long: slower cameras are rare.
const LONG: Duration = Duration::from_secs(5);

/// Since when the source has been asked for a frame, and whether that was said.
#[derive(Default)]
pub(super) struct Stall {
    asked: Mutex<Option<(Instant, bool)>>,
}

impl Stall {
    /// What a source answers, watched.
    pub(super) fn during<T>(&self, ask: impl FnOnce() -> T) -> T {
        let set = |asked| self.asked.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&asked);
        set(Some((Instant::now(), false)));
        let answer = ask();
        set(None);
        answer
    }

    /// Says once of each wait that it is long.
    pub(super) fn look(&self) {
        let mut asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        let Some((since, said)) = asked.as_mut().filter(|(since, said)| !said && since.elapsed() >= LONG) else {
            return;
        };
        *said = true;
        let seconds = since.elapsed().as_secs();
        note(&format!("no frame has come from the source for {seconds} s; still waiting for it (Ctrl-C ends)"));
    }
}
