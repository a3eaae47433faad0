//! The instruction sets that grouping runs on, fastest first.
//!
//! The algorithm stands once, in `scan.rs` and `labels.rs`; an instruction set brings two operations
//! (masks of a row, painting of labels), perhaps faster addition and two more operations for rows of
//! many runs. `kernel.rs` compiles the algorithm for it. The portable operations are compiled with what every
//! processor of a target has, SSE2 on x86-64 and NEON on aarch64.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod kernel;
mod portable;
#[cfg(target_arch = "x86_64")]
mod words;

use crate::util::simd::passed_over;
pub use kernel::{Compiles, Kernel};

/// All kernels of this build, fastest first; the last one runs everywhere.
static KERNELS: &[Kernel] = &[
    #[cfg(target_arch = "x86_64")]
    avx512::KERNEL,
    #[cfg(target_arch = "x86_64")]
    avx2::KERNEL,
    portable::KERNEL,
];

/// The kernels that this processor runs, fastest first.
pub fn kernels() -> impl Iterator<Item = &'static Kernel> {
    KERNELS[passed_over()..].iter().filter(|kernel| (kernel.runs_here)())
}

/// The fastest kernel that this processor runs.
pub fn best() -> &'static Kernel {
    kernels().next().expect("the portable kernel runs everywhere")
}
