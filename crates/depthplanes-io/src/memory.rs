//! Whether memory can be had, asked before it is used: the map is refused then, and the program goes on.

use std::fs;

use crate::error::{Error, Result};

/// Memory of this many bytes is asked of the machine and not of the process alone; below, reading what the machine says
/// takes longer than it is worth.
const MUCH: u64 = 1 << 28;

/// Whether so many bytes can be had at once: in the process's address space and, as far as the system tells (Linux), in
/// the machine.
///
/// # Errors
/// [`Error::Memory`].
///
/// ```
/// assert!(depthplanes_io::memory::check(1 << 20).is_ok());
/// assert!(depthplanes_io::memory::check(u64::MAX).is_err());
/// ```
pub fn check(bytes: u64) -> Result<()> {
    // Reserved, never touched, and given back: the system's own answer, whatever limits it.
    let fits = usize::try_from(bytes).is_ok_and(|bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok());
    let free = || if bytes < MUCH { None } else { free() };
    if fits && free().is_none_or(|free| bytes <= free) { Ok(()) } else { Err(Error::Memory { bytes }) }
}

/// Free bytes of the machine, or of the container if it has fewer; none where that cannot be known.
fn free() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let kilobytes = |name: &str| -> Option<u64> {
        let line = text.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next()?.parse().ok()
    };
    let machine = 1024 * (kilobytes("MemAvailable:")? + kilobytes("SwapFree:").unwrap_or(0));
    let container = fs::read_to_string("/sys/fs/cgroup/memory.max").ok().and_then(|most| most.trim().parse().ok());
    Some(container.map_or(machine, |most: u64| machine.min(most)))
}
