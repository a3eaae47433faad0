//! The instruction sets that grouping runs on, fastest first.
//!
//! The algorithm stands once, in `strip.rs`; an instruction set brings three operations (masks of a
//! row, positions of set bits, painting of labels) and one function that compiles the algorithm for
//! it. On aarch64 the portable operations are compiled with NEON, which is in its baseline.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod portable;
#[cfg(target_arch = "x86_64")]
mod words;

use super::LinkRule;
use super::strip::{RowMasks, Strip};
use crate::map::{DepthView, Pixel};
use std::fmt;
#[cfg(target_arch = "x86_64")]
use words::words;

/// Elements that an operation may write or read beyond the end of a buffer's used part.
pub(crate) const SLACK: usize = 64;

/// The operations of an instruction set. A type that implements it exists only as a marker, and its
/// operations are only reached through a [`Kernel`] whose processor features were found.
pub trait Isa {
    /// Masks of one row of 8-bit values.
    fn masks_u8(row: &[u8], up: &[u8], rule: &LinkRule<u8>, out: RowMasks<'_>);
    /// Masks of one row of 16-bit values.
    fn masks_u16(row: &[u16], up: &[u16], rule: &LinkRule<u16>, out: RowMasks<'_>);
    /// Masks of one row of floating-point values.
    fn masks_f32(row: &[f32], up: &[f32], rule: &LinkRule<f32>, out: RowMasks<'_>);

    /// Appends the positions of the `count` set bits to `out`, which has [`SLACK`] to spare.
    fn positions(mask: &[u64], count: usize, out: &mut Vec<u16>);

    /// Writes a row of labels: 0 where not valid, else the label of the pixel's run.
    /// `labels[i]` belongs to the row's run i, counted from 1; there is [`SLACK`] to spare.
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
            fn paint(rows: &strip::Strip, labels: &[u16], image: &mut [u16]) {
                super::paint_strip::<$isa>(rows, labels, image);
            }
            super::Kernel {
                name: $name,
                runs_here: $runs_here,
                u8: super::Compiled { scan: scan::<u8>, stitch: stitch::<u8> },
                u16: super::Compiled { scan: scan::<u16>, stitch: stitch::<u16> },
                f32: super::Compiled { scan: scan::<f32>, stitch: stitch::<f32> },
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

/// The kernels that this processor runs, fastest first.
pub fn kernels() -> impl Iterator<Item = &'static Kernel> {
    KERNELS.iter().filter(|kernel| (kernel.runs_here)())
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

    pub(super) fn paint(&self, strip: &Strip, labels: &[u16], image: &mut [u16]) {
        // SAFETY: as in `scan`.
        unsafe { (self.paint)(strip, labels, image) }
    }
}

impl fmt::Debug for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Kernel({})", self.name)
    }
}

/// Writes a strip's part of the label image; its run i, counted from 1, has `labels[i]`.
#[inline(always)]
fn paint_strip<I: Isa>(strip: &Strip, labels: &[u16], image: &mut [u16]) {
    for (row, pixels) in image.chunks_exact_mut(strip.width).enumerate() {
        let words = row * strip.words..(row + 1) * strip.words;
        let labels = &labels[strip.row_first_run[row] as usize..];
        I::paint_row(&strip.valid[words.clone()], &strip.starts[words], labels, pixels);
    }
}
