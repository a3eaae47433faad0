//! Signals that would end the program without a word become errors with an exit code of the machine's.

/// What to do about signals. Where it cannot be set the system's own way stays.
#[cfg(unix)]
pub(crate) fn prepare() {
    use signal_hook::consts::{SIGABRT, SIGXFSZ};
    use signal_hook::flag;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    // A file above the limit of its size (ulimit -f): the write that hits it fails, and that is told.
    let _ = flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
    // What is left of failures without a way back, memory that cannot be had above all: the standard library has said
    // what it is, and ends the program.
    let _ = flag::register_conditional_shutdown(SIGABRT, 1, Arc::new(AtomicBool::new(true)));
}

#[cfg(not(unix))]
pub(crate) fn prepare() {}
