//! The instruction sets that grouping runs on, fastest first.
//!
//! The algorithm stands once, in `strip.rs` and `labels.rs`; an instruction set brings two operations
//! (masks of a row, painting of labels), perhaps faster addition and two more operations for rows of
//! many runs, and one function that compiles the algorithm for it. On aarch64 the portable operations
//! are compiled with NEON, which is in its baseline.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod portable;
#[cfg(target_arch = "x86_64")]
mod words;

use super::LinkRule;
use super::labels::Links;
use super::strip::{RowMasks, Strip};
use crate::map::{DepthView, Pixel};
use std::fmt;
#[cfg(target_arch = "x86_64")]
use words::words;

/// Elements that an operation may write or read beyond the end of a buffer's used part.
pub(super) const SLACK: usize = 64;

/// The operations of an instruction set. A type that implements it exists only as a marker, and its
/// operations are only reached through a [`Kernel`] whose processor features were found.
pub trait Isa {
    /// Masks of one row of 8-bit values.
    fn masks_u8(row: &[u8], up: &[u8], rule: &LinkRule<u8>, out: RowMasks<'_>);
    /// Masks of one row of 16-bit values.
    fn masks_u16(row: &[u16], up: &[u16], rule: &LinkRule<u16>, out: RowMasks<'_>);
    /// Masks of one row of floating-point values.
    fn masks_f32(row: &[f32], up: &[f32], rule: &LinkRule<f32>, out: RowMasks<'_>);

    /// Adds two numbers of many words, the lowest first. What the last word carries out is lost.
    #[inline(always)]
    fn add(a: &[u64], b: &[u64], sums: &mut [u64]) {
        let mut carry = false;
        for (sum, (a, &b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            let (of_both, over) = a.overflowing_add(b);
            let (of_all, over_too) = of_both.overflowing_add(carry.into());
            (*sum, carry) = (of_all, over | over_too);
        }
    }

    /// Whether there are [`Isa::dense_labels`] and [`Isa::positions`], for rows of many runs.
    const HAS_DENSE_LABELS: bool = false;

    /// Lists the positions of the set bits of two masks that have `count` each. The lists have room for
    /// them and [`SLACK`] to spare.
    fn positions(_masks: [&[u64]; 2], _count: usize, _lists: &mut [Vec<u16>; 2]) {
        unreachable!("only called where HAS_DENSE_LABELS says so")
    }

    /// Labels the runs of a row, many at a time; how many labels are new. `above[0]` stands before the
    /// label of the first run above; `labels` begins with the row's first run; both have [`SLACK`] to
    /// spare. `inherited` is memory for a label per pixel.
    fn dense_labels(
        _links: &Links<'_>,
        _above: &[u32],
        _inherited: &mut [u32],
        _labels: &mut [u32],
        _new_label: u32,
    ) -> u32 {
        unreachable!("only called where HAS_DENSE_LABELS says so")
    }

    /// Writes labels of part of a row: 0 where not valid, else the label of the pixel's run.
    /// `labels[i]` belongs to the i-th run that starts in it, `labels[0]` to one that reaches into it;
    /// there is room for a
    /// label for each pixel and [`SLACK`] to spare.
    fn paint_row(valid: &[u64], starts: &[u64], labels: &[u16], row: &mut [u16]);
}

type Scan<T> = unsafe fn(&DepthView<'_, T>, &LinkRule<T>, &mut Strip);
type Stitch<T> = unsafe fn(&DepthView<'_, T>, &LinkRule<T>, &Strip, &mut Strip, &mut [u32]);

/// The algorithm compiled for one instruction set and pixel type.
#[derive(Clone, Copy)]
pub struct Compiled<T> {
    scan: Scan<T>,
    stitch: Stitch<T>,
}

/// Grouping for one instruction set.
pub struct Kernel {
    name: &'static str,
    runs_here: fn() -> bool,
    pub(crate) u8: Compiled<u8>,
    pub(crate) u16: Compiled<u16>,
    pub(crate) f32: Compiled<f32>,
    masks: unsafe fn(&[u16], &[u16], &LinkRule<u16>, RowMasks<'_>),
    paint: unsafe fn(&Strip, &[u16], &mut [u16]),
}

/// Compiles the algorithm for an instruction set: `kernel!(name, Marker, "features", detection)`.
macro_rules! kernel {
    ($name:literal, $isa:ty, $features:literal, $runs_here:expr) => {
        pub(super) const KERNEL: super::Kernel = {
            use crate::group::{LinkRule, strip};
            use crate::map::{DepthView, Pixel};

            #[target_feature(enable = $features)]
            fn scan<T: Pixel>(map: &DepthView<'_, T>, rule: &LinkRule<T>, rows: &mut strip::Strip) {
                strip::scan::<$isa, T>(map, rule, rows);
            }
            #[target_feature(enable = $features)]
            fn stitch<T: Pixel>(
                map: &DepthView<'_, T>,
                rule: &LinkRule<T>,
                upper: &strip::Strip,
                lower: &mut strip::Strip,
                parent: &mut [u32],
            ) {
                strip::stitch::<$isa, T>(map, rule, upper, lower, parent);
            }
            #[target_feature(enable = $features)]
            fn masks(row: &[u16], up: &[u16], rule: &LinkRule<u16>, out: strip::RowMasks<'_>) {
                <$isa as super::Isa>::masks_u16(row, up, rule, out);
            }
            #[target_feature(enable = $features)]
            fn paint(rows: &strip::Strip, label_of_provisional: &[u16], image: &mut [u16]) {
                super::paint_strip::<$isa>(rows, label_of_provisional, image);
            }
            super::Kernel {
                name: $name,
                runs_here: $runs_here,
                u8: super::Compiled { scan: scan::<u8>, stitch: stitch::<u8> },
                u16: super::Compiled { scan: scan::<u16>, stitch: stitch::<u16> },
                f32: super::Compiled { scan: scan::<f32>, stitch: stitch::<f32> },
                masks,
                paint,
            }
        };
    };
}
use kernel;

/// All kernels of this build, fastest first; the last one runs everywhere.
static KERNELS: &[Kernel] = &[
    #[cfg(target_arch = "x86_64")]
    avx512::KERNEL,
    #[cfg(target_arch = "x86_64")]
    avx2::KERNEL,
    portable::KERNEL,
];

/// How many of [`KERNELS`] are passed over: none but in tests of the slower ones.
#[cfg(not(test))]
#[inline(always)]
fn passed_over() -> usize {
    0
}

#[cfg(test)]
static PASSED_OVER: std::sync::atomic::AtomicUsize = std::sync::atomic::AtomicUsize::new(0);

#[cfg(test)]
fn passed_over() -> usize {
    PASSED_OVER.load(std::sync::atomic::Ordering::Relaxed)
}

/// Calls `work` with each kernel that this processor runs as the fastest there is, on all threads.
#[cfg(test)]
pub(crate) fn with_each_kernel(mut work: impl FnMut(&'static str)) {
    for (first, kernel) in KERNELS.iter().enumerate().filter(|(_, kernel)| (kernel.runs_here)()) {
        PASSED_OVER.store(first, std::sync::atomic::Ordering::Relaxed);
        work(kernel.name);
    }
    PASSED_OVER.store(0, std::sync::atomic::Ordering::Relaxed);
}

/// The kernels that this processor runs, fastest first.
pub fn kernels() -> impl Iterator<Item = &'static Kernel> {
    KERNELS[passed_over()..].iter().filter(|kernel| (kernel.runs_here)())
}

/// Runs `work`, compiled for this processor's vectors as well. It does the same additions in the same
/// order on any of them, so its results are the same: Rust neither reorders floating-point operations nor fuses a
/// multiplication with an addition, unless it is told to.
#[inline(always)]
pub(crate) fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    {
        if passed_over() < 1 && avx512::is_here() {
            // SAFETY: the features were just found.
            return unsafe { avx512::run(work) };
        }
        if passed_over() < 2 && avx2::is_here() {
            // SAFETY: the features were just found.
            return unsafe { avx2::run(work) };
        }
    }
    work()
}

impl Kernel {
    /// The fastest kernel that this processor runs.
    pub fn best() -> &'static Kernel {
        kernels().next().expect("the portable kernel runs everywhere")
    }

    /// Its name: `avx512`, `avx2`, `portable`.
    pub fn name(&self) -> &'static str {
        self.name
    }

    pub(super) fn scan<T: Pixel>(&self, map: &DepthView<'_, T>, rule: &LinkRule<T>, strip: &mut Strip) {
        // SAFETY: a kernel is only handed out by `kernels`, after `runs_here` found its features.
        unsafe { (T::compiled(self).scan)(map, rule, strip) }
    }

    pub(super) fn stitch<T: Pixel>(
        &self,
        map: &DepthView<'_, T>,
        rule: &LinkRule<T>,
        upper: &Strip,
        lower: &mut Strip,
        parent: &mut [u32],
    ) {
        // SAFETY: as in `scan`.
        unsafe { (T::compiled(self).stitch)(map, rule, upper, lower, parent) }
    }

    /// Masks of a row of numbers, and of how they are like those above.
    pub(crate) fn masks(&self, row: &[u16], up: &[u16], rule: &LinkRule<u16>, out: RowMasks<'_>) {
        // SAFETY: as in `scan`.
        unsafe { (self.masks)(row, up, rule, out) }
    }

    pub(super) fn paint(&self, strip: &Strip, label_of_provisional: &[u16], image: &mut [u16]) {
        // SAFETY: as in `scan`.
        unsafe { (self.paint)(strip, label_of_provisional, image) }
    }
}

impl fmt::Debug for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Kernel({})", self.name)
    }
}

/// Words of a row that are painted at a time, so that their runs' labels fit on the stack.
const BLOCK: usize = 16;

/// Writes a strip's part of the label image, given the labels of its provisional labels.
#[inline(always)]
fn paint_strip<I: Isa>(strip: &Strip, label_of_provisional: &[u16], image: &mut [u16]) {
    let mut provisional = strip.labels();
    let mut labels = [0; 1 + BLOCK * 64 + SLACK];
    for (row, pixels) in image.chunks_exact_mut(strip.width).enumerate() {
        let words = strip.words_of(row);
        let (valid, starts) = (strip.valid[words.clone()].chunks(BLOCK), strip.starts[words].chunks(BLOCK));
        for ((valid, starts), pixels) in valid.zip(starts).zip(pixels.chunks_mut(BLOCK * 64)) {
            let runs: usize = starts.iter().map(|word| word.count_ones() as usize).sum();
            let (here, after) = provisional.split_at(runs);
            provisional = after;
            let looked_up = &mut labels[1..][..runs];
            let (fours, rest) = looked_up.as_chunks_mut::<4>();
            let (fours_here, rest_here) = here.as_chunks::<4>();
            for (labels, provisional) in fours.iter_mut().zip(fours_here) {
                *labels = provisional.map(|provisional| label_of_provisional[provisional as usize]);
            }
            for (label, &provisional) in rest.iter_mut().zip(rest_here) {
                *label = label_of_provisional[provisional as usize];
            }
            I::paint_row(valid, starts, &labels, pixels);
            labels[0] = labels[runs]; // the run that may reach into the next block
        }
    }
}
