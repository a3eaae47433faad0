//! Whether memory can be had, asked before it is used: the map is refused then, and the program goes on.

use std::fs;
use std::path::Path;

use depthplanes::methods::MethodInfo;

use crate::error::{Error, Result};

/// What the machine says of its memory is read from so many bytes on; below, that takes longer than it is worth.
const MUCH: u64 = 1 << 28;

/// Address space is asked for in pieces of so many bytes, as programs do: systems refuse a single piece that is larger
/// than all their memory.
const PIECE: u64 = 1 << 26;

/// Whether memory can be had for work that uses `used` bytes at once and reserves `reserved`.
///
/// Memory that is reserved and never used costs address space alone, which limits of the process (`ulimit -v`) count. What
/// is used has to be free in the machine, as far as the system tells (Linux).
///
/// # Errors
/// [`Error::Memory`].
///
/// ```
/// assert!(depthplanes_io::memory::check(1 << 20, 1 << 21).is_ok());
/// assert!(depthplanes_io::memory::check(1 << 60, 1 << 60).is_err());
/// ```
pub fn check(used: u64, reserved: u64) -> Result<()> {
    if used >= MUCH && free().is_some_and(|free| used > free) {
        return Err(Error::Memory { what: "memory", bytes: used });
    }
    // Reserved, never touched, and given back: the system's own answer, whatever limits it.
    let mut pieces: Vec<Vec<u8>> = Vec::new();
    let mut left = used.max(reserved);
    while left > 0 {
        let mut piece = Vec::new();
        if left > 1 << 46 || piece.try_reserve_exact(left.min(PIECE) as usize).is_err() {
            return Err(Error::Memory { what: "address space", bytes: used.max(reserved) });
        }
        pieces.push(piece);
        left -= left.min(PIECE);
    }
    Ok(())
}

/// As [`check`], for reading a file of which no more than `most` bytes are read: its bytes, the samples, the pixels and what
/// is looked at in them. Of a file that is not there nothing is said.
///
/// # Errors
/// [`Error::Memory`].
pub fn check_of_file(path: &Path, most: u64) -> Result<()> {
    let needed = of_reading(fs::metadata(path).map_or(0, |about| about.len().min(most)));
    check(needed, needed)
}

/// Bytes that reading a file of so many bytes uses, for [`check`].
pub fn of_reading(bytes: u64) -> u64 {
    6 * bytes
}

/// Bytes that a detector of a method uses and reserves for a map of that size, for [`check`].
pub fn of_detection(method: &MethodInfo, width: usize, height: usize) -> [u64; 2] {
    method.bytes_per_pixel.map(|bytes| bytes * (width * height) as u64)
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
