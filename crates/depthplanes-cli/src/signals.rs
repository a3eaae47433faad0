//! Signals that would end the program without a word become errors with an exit code of the machine's, and those that
//! interrupt it leave no file that is not finished.

#[cfg(unix)]
use crate::failure::say;
use std::sync::atomic::{AtomicI32, Ordering};

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

/// Before files are written: waits, in a thread of its own, for a signal that interrupts the program. The files that are
/// not finished are removed then, and the exit code is that of shells, 128 and the signal's number. `next` says what to do.
#[cfg(unix)]
pub(crate) fn tidy_up_if_interrupted(next: &'static str) {
    use depthplanes_io::outputs::remove_unfinished;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
    let wait = move || {
        let Ok(mut signals) = Signals::new(heard) else { return };
        if let Some(signal) = signals.forever().next() {
            remove_unfinished();
            say(&format!("interrupted: files that were finished are kept; {next}"));
            std::process::exit(128 + signal);
        }
    };
    // Without a thread the system's own way stays.
    drop(std::thread::Builder::new().stack_size(1 << 17).spawn(wait));
}

#[cfg(not(unix))]
pub(crate) fn tidy_up_if_interrupted(_next: &'static str) {}

/// For a command that finishes what it writes when it is interrupted: from now on the signal's number, 0 before. A second
/// signal ends the program as the first one ends others.
pub(crate) fn interruption() -> &'static AtomicI32 {
    static SIGNAL: AtomicI32 = AtomicI32::new(0);
    #[cfg(unix)]
    if let Ok(Interruption(mut signals)) = Interruption::heard() {
        let wait = move || {
            if let Some(first) = signals.forever().next() {
                SIGNAL.store(first, Ordering::Relaxed);
            }
            if let Some(second) = signals.forever().next() {
                depthplanes_io::outputs::remove_unfinished();
                std::process::exit(128 + second);
            }
        };
        // Without a thread the system's own way stays.
        drop(std::thread::Builder::new().stack_size(1 << 17).spawn(wait));
    }
    &SIGNAL
}

/// A signal that ends a command which otherwise goes on.
#[cfg(unix)]
pub(crate) struct Interruption(signal_hook::iterator::Signals);

#[cfg(unix)]
impl Interruption {
    /// From now on interrupting the program only ends what [`Interruption::wait`] waits for.
    ///
    /// # Errors
    /// What the system says.
    pub(crate) fn heard() -> std::io::Result<Self> {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
        signal_hook::iterator::Signals::new(heard).map(Interruption)
    }

    /// Waits for the signal.
    pub(crate) fn wait(mut self) {
        self.0.forever().next();
    }
}

/// Where there are no signals the system ends the program its own way.
#[cfg(not(unix))]
pub(crate) struct Interruption;

#[cfg(not(unix))]
impl Interruption {
    pub(crate) fn heard() -> std::io::Result<Self> {
        Ok(Interruption)
    }

    pub(crate) fn wait(self) {
        loop {
            std::thread::park();
        }
    }
}

/// Whether whoever started the program wants it to live on, as `nohup` does, and shells where it runs in the background.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
