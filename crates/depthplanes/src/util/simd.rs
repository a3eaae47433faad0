//! Code that is compiled a second time for the vectors of this processor.

#[cfg(test)]
use std::sync::atomic::{AtomicUsize, Ordering};

/// How many of the instruction sets, fastest first, are passed over: none but in tests of the slower ones.
#[cfg(not(test))]
#[inline(always)]
pub(crate) fn passed_over() -> usize {
    0
}

#[cfg(test)]
static PASSED_OVER: AtomicUsize = AtomicUsize::new(0);

#[cfg(test)]
pub(crate) fn passed_over() -> usize {
    PASSED_OVER.load(Ordering::Relaxed)
}

/// An instruction set's name, and whether this processor has it.
#[cfg(test)]
type Level = (&'static str, fn() -> bool);

/// Instruction sets in tests: name, and whether this processor has it. In the order of the kernels of grouping.
#[cfg(test)]
const LEVELS: &[Level] = &[
    #[cfg(target_arch = "x86_64")]
    ("avx512", has_avx512),
    #[cfg(target_arch = "x86_64")]
    ("avx2", has_avx2),
    ("portable", || true),
];

/// Calls `work` once for each instruction set of this processor as if it were the fastest there is, on all threads.
#[cfg(test)]
pub(crate) fn with_each_level(mut work: impl FnMut(&'static str)) {
    for (first, (name, _)) in LEVELS.iter().enumerate().filter(|(_, (_, is_here))| is_here()) {
        PASSED_OVER.store(first, Ordering::Relaxed);
        work(name);
    }
    PASSED_OVER.store(0, Ordering::Relaxed);
}

/// Runs `work`, compiled for this processor's vectors as well. It does the same additions in the same
/// order on any of them, so its results are the same: Rust neither reorders floating-point operations nor fuses a
/// multiplication with an addition, unless it is told to.
#[inline(always)]
pub(crate) fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    {
        if passed_over() < 1 && has_avx512() {
            // SAFETY: the features were just found.
            return unsafe { run_avx512(work) };
        }
        if passed_over() < 2 && has_avx2() {
            // SAFETY: the features were just found.
            return unsafe { run_avx2(work) };
        }
    }
    work()
}

/// Whether this processor has the features that code for AVX-512 is compiled with.
#[cfg(target_arch = "x86_64")]
pub(crate) fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512vbmi2")
        && is_x86_feature_detected!("avx512vpopcntdq")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("popcnt")
        && is_x86_feature_detected!("lzcnt")
}

/// Runs `work` with its code compiled for these vectors.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi2,avx512vpopcntdq,bmi1,bmi2,popcnt,lzcnt")]
fn run_avx512<R>(work: impl FnOnce() -> R) -> R {
    work()
}

/// Whether this processor has the features that code for AVX2 is compiled with.
#[cfg(target_arch = "x86_64")]
pub(crate) fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("popcnt")
        && is_x86_feature_detected!("lzcnt")
}

/// Runs `work` with its code compiled for these vectors.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt,lzcnt")]
fn run_avx2<R>(work: impl FnOnce() -> R) -> R {
    work()
}
