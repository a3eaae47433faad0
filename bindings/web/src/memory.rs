//! Refuses maps that surely do not fit into the memory of a module, before they cost time.
//!
//! What counts is a module that was just started, whatever this one has done so far: JavaScript starts it anew where the memory
//! that it has left is too little, and refuses the map if that does not help.

use crate::error::{InputError, Result};
use depthplanes::methods::MethodInfo;
use depthplanes_io::memory;

/// Bytes that a module of 32 bits can address.
const ALL: u64 = 1 << 32;

/// Checks that a file or an array of so many bytes can be read.
///
/// # Errors
/// With how much memory that needs.
pub(crate) fn check_of_reading(bytes: usize) -> Result<()> {
    check(memory::of_reading(bytes as u64))
}

/// Checks that a scene of that size can be made.
///
/// # Errors
/// As [`check_of_reading`].
pub(crate) fn check_of_scene(width: usize, height: usize) -> Result<()> {
    check(64 * width as u64 * height as u64)
}

/// Checks that planes can be found in a map of that size. Unlike elsewhere, memory that is reserved and not used counts: it is
/// memory of the module.
///
/// # Errors
/// As [`check_of_reading`].
pub(crate) fn check_of_detection(method: &MethodInfo, width: usize, height: usize) -> Result<()> {
    let [used, reserved] = memory::of_detection(method, width, height);
    check(used.max(reserved))
}

fn check(needed: u64) -> Result<()> {
    if needed <= ALL {
        return Ok(());
    }
    let [needed, all] = [needed, ALL].map(|bytes| bytes.div_ceil(1_000_000));
    Err(InputError(format!(
        "{needed} MB of memory are needed; accepted: what fits into the {all} MB of a WebAssembly module"
    )))
}
