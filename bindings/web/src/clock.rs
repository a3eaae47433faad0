//! Milliseconds of stage after stage, by the clock of JavaScript: WebAssembly has none.

unsafe extern "C" {
    /// Milliseconds since some time; the one function that the module asks of JavaScript.
    safe fn now() -> f64;
}

/// What took how long.
pub(crate) struct Clock {
    start: f64,
    pub(crate) stages: Vec<(&'static str, f64)>,
}

impl Clock {
    pub(crate) fn new() -> Self {
        Clock { start: now(), stages: Vec::with_capacity(16) }
    }

    /// Ends a stage; one that ends twice has both times.
    pub(crate) fn ends(&mut self, stage: &'static str) {
        let now = now();
        let ms = now - self.start;
        self.start = now;
        match self.stages.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, sum)) => *sum += ms,
            None => self.stages.push((stage, ms)),
        }
    }
}
