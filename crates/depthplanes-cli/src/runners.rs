//! Runners for several jobs: no more at once than there is memory for. A job without one waits until another is done, and
//! takes its runner, which has its memory already.

use crate::failure::{Outcome, note};
use crate::run::{Found, Recipe, Runner};
use depthplanes_io::{Frame, memory};
use std::sync::{Condvar, Mutex, MutexGuard, Once, PoisonError};

/// The runners of a recipe.
pub(crate) struct Runners<'a> {
    recipe: &'a Recipe,
    state: Mutex<State<'a>>,
    back: Condvar,
}

#[derive(Default)]
struct State<'a> {
    idle: Vec<Runner<'a>>,
    /// Runners at work.
    busy: usize,
    /// Bytes used and reserved that runners at work have not had before.
    claimed: [u64; 2],
}

impl<'a> Runners<'a> {
    pub(crate) fn new(recipe: &'a Recipe) -> Self {
        Runners { recipe, state: Mutex::default(), back: Condvar::new() }
    }

    /// As [`Runner::detect`], with a runner that is free or a new one; waits for one if there is no memory for a new one.
    ///
    /// # Errors
    /// Those of [`Runner::detect`]; memory that cannot be had with nobody else at work.
    pub(crate) fn detect(&self, frame: &Frame, repeat: usize) -> Outcome<Found> {
        let mut lent = self.lend(frame)?;
        let found = lent.runner.as_mut().expect("it is lent").detect(frame, repeat);
        lent.is_whole = true;
        found
    }

    fn lend(&self, frame: &Frame) -> Outcome<Lent<'a, '_>> {
        let needed = self.recipe.memory(frame);
        let mut state = self.state();
        loop {
            if let Some(at) = state.idle.iter().position(|runner| runner.has_memory_for(frame)) {
                let runner = state.idle.swap_remove(at);
                state.busy += 1;
                return Ok(Lent { of: self, runner: Some(runner), claimed: [0; 2], is_whole: false });
            }
            let together = [0, 1].map(|part| state.claimed[part].saturating_add(needed[part]));
            match memory::check(together[0], together[1]) {
                Ok(()) => {
                    // One that is free but has too little is better than a further one.
                    let mut runner = state.idle.pop().unwrap_or_else(|| Runner::new(self.recipe));
                    runner.keep(needed);
                    (state.busy, state.claimed) = (state.busy + 1, together);
                    return Ok(Lent { of: self, runner: Some(runner), claimed: needed, is_whole: false });
                }
                Err(_) if !state.idle.is_empty() => state.idle.clear(),
                Err(error) if state.busy == 0 => return Err(error.into()),
                Err(_) => {
                    static SAID: Once = Once::new();
                    SAID.call_once(|| {
                        note("there is no memory for so many maps at once (--jobs): some wait for others")
                    });
                    state = self.back.wait(state).unwrap_or_else(PoisonError::into_inner);
                }
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State<'a>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A runner at work; it comes back when this is dropped, unless it panicked.
struct Lent<'a, 'b> {
    of: &'b Runners<'a>,
    runner: Option<Runner<'a>>,
    claimed: [u64; 2],
    is_whole: bool,
}

impl Drop for Lent<'_, '_> {
    fn drop(&mut self) {
        let mut state = self.of.state();
        state.busy -= 1;
        state.claimed = [0, 1].map(|part| state.claimed[part] - self.claimed[part]);
        state.idle.extend(self.runner.take().filter(|_| self.is_whole));
        self.of.back.notify_all();
    }
}
