//! Grouping compiled for one instruction set: the algorithm of `scan.rs` and `labels.rs` with the operations of an
//! [`Isa`].

use crate::components::connectivity::Connectivity;
use crate::components::isa::{Isa, Masked, RowMasks, SLACK};
use crate::components::strip::Strip;
use crate::map::DepthView;
use std::fmt;

type Scan<T> = unsafe fn(&DepthView<'_, T>, &Connectivity<T>, &mut Strip);
type Stitch<T> = unsafe fn(&DepthView<'_, T>, &Connectivity<T>, &Strip, &mut Strip, &mut [u32]);

/// The algorithm compiled for one instruction set and pixel type.
#[derive(Clone, Copy)]
pub struct Compiled<T> {
    pub(super) scan: Scan<T>,
    pub(super) stitch: Stitch<T>,
}

/// Grouping for one instruction set.
pub struct Kernel {
    pub(super) name: &'static str,
    pub(super) runs_here: fn() -> bool,
    pub(super) u8: Compiled<u8>,
    pub(super) u16: Compiled<u16>,
    pub(super) f32: Compiled<f32>,
    pub(super) masks: unsafe fn(&[u16], &[u16], &Connectivity<u16>, RowMasks<'_>),
    pub(super) paint: unsafe fn(&Strip, &[u16], &mut [u16]),
}

/// Compiles the algorithm for an instruction set: `kernel!(name, Marker, detection, attribute)`, the attribute
/// being `target_feature(..)`.
macro_rules! kernel {
    ($name:literal, $isa:ty, $runs_here:expr $(, $attribute:meta)?) => {
        pub(in crate::components) const KERNEL: $crate::components::kernels::kernel::Kernel = {
            use crate::components::isa::{Isa, Masked, RowMasks};
            use crate::components::kernels::kernel::{Compiled, Kernel, paint_strip};
            use crate::components::connectivity::Connectivity;
            use crate::components::scan;
            use crate::components::strip::Strip;
            use crate::map::DepthView;

            $(#[$attribute])?
            fn scan<T: Masked>(map: &DepthView<'_, T>, rule: &Connectivity<T>, rows: &mut Strip) {
                scan::scan::<$isa, T>(map, rule, rows);
            }
            $(#[$attribute])?
            fn stitch<T: Masked>(
                map: &DepthView<'_, T>,
                rule: &Connectivity<T>,
                upper: &Strip,
                lower: &mut Strip,
                parent: &mut [u32],
            ) {
                scan::stitch::<$isa, T>(map, rule, upper, lower, parent);
            }
            $(#[$attribute])?
            fn masks(row: &[u16], up: &[u16], rule: &Connectivity<u16>, out: RowMasks<'_>) {
                <$isa as Isa>::masks_u16(row, up, rule, out);
            }
            $(#[$attribute])?
            fn paint(rows: &Strip, label_of_provisional: &[u16], image: &mut [u16]) {
                paint_strip::<$isa>(rows, label_of_provisional, image);
            }
            Kernel {
                name: $name,
                runs_here: $runs_here,
                u8: Compiled { scan: scan::<u8>, stitch: stitch::<u8> },
                u16: Compiled { scan: scan::<u16>, stitch: stitch::<u16> },
                f32: Compiled { scan: scan::<f32>, stitch: stitch::<f32> },
                masks,
                paint,
            }
        };
    };
}
pub(super) use kernel;

/// Pixel types that grouping is compiled for.
pub trait Compiles: Masked {
    /// The kernel's functions for this type.
    fn compiled(kernel: &Kernel) -> Compiled<Self>;
}

macro_rules! compiles {
    ($t:ident) => {
        impl Compiles for $t {
            fn compiled(kernel: &Kernel) -> Compiled<Self> {
                kernel.$t
            }
        }
    };
}
compiles!(u8);
compiles!(u16);
compiles!(f32);

impl Kernel {
    /// Its name: `avx512`, `avx2`, `portable`.
    pub fn name(&self) -> &'static str {
        self.name
    }

    pub(in crate::components) fn scan<T: Compiles>(
        &self,
        map: &DepthView<'_, T>,
        rule: &Connectivity<T>,
        strip: &mut Strip,
    ) {
        // SAFETY: a kernel is only handed out by [`super::kernels`], after `runs_here` found its features.
        unsafe { (T::compiled(self).scan)(map, rule, strip) }
    }

    pub(in crate::components) fn stitch<T: Compiles>(
        &self,
        map: &DepthView<'_, T>,
        rule: &Connectivity<T>,
        upper: &Strip,
        lower: &mut Strip,
        parent: &mut [u32],
    ) {
        // SAFETY: as in `scan`.
        unsafe { (T::compiled(self).stitch)(map, rule, upper, lower, parent) }
    }

    /// Masks of a row of region numbers: those that are set, and those equal to the number at their left or above.
    pub(crate) fn masks(&self, row: &[u16], up: &[u16], rule: &Connectivity<u16>, out: RowMasks<'_>) {
        // SAFETY: as in `scan`.
        unsafe { (self.masks)(row, up, rule, out) }
    }

    pub(in crate::components) fn paint(&self, strip: &Strip, label_of_provisional: &[u16], image: &mut [u16]) {
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

/// Writes a strip's part of the label image, given the plane's label for each provisional label.
#[inline(always)]
pub(super) fn paint_strip<I: Isa>(strip: &Strip, label_of_provisional: &[u16], image: &mut [u16]) {
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
