//! What an instruction set provides for grouping: a handful of operations on rows.

use super::connectivity::Connectivity;
use crate::map::Pixel;

/// Elements that an operation may write or read beyond the end of a buffer's used part.
pub(super) const SLACK: usize = 64;

/// The operations of an instruction set. A type that implements it exists only as a marker, and its
/// operations are only reached through a [`Kernel`] whose processor features were found.
pub trait Isa {
    /// Masks of one row of 8-bit values.
    fn masks_u8(row: &[u8], up: &[u8], rule: &Connectivity<u8>, out: RowMasks<'_>);
    /// Masks of one row of 16-bit values.
    fn masks_u16(row: &[u16], up: &[u16], rule: &Connectivity<u16>, out: RowMasks<'_>);
    /// Masks of one row of floating-point values.
    fn masks_f32(row: &[f32], up: &[f32], rule: &Connectivity<f32>, out: RowMasks<'_>);

    /// Adds two numbers of many words, the lowest word first. A carry out of the last word is lost.
    #[inline(always)]
    fn add(a: &[u64], b: &[u64], sums: &mut [u64]) {
        let mut carry = false;
        for (sum, (a, &b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            let (of_both, over) = a.overflowing_add(b);
            let (of_all, over_too) = of_both.overflowing_add(carry.into());
            (*sum, carry) = (of_all, over | over_too);
        }
    }

    /// Whether [`Isa::dense_labels`] and [`Isa::positions`] exist, for rows of many runs.
    const HAS_DENSE_LABELS: bool = false;

    /// Lists the positions of the set bits of two masks that have `count` each. The lists have room for
    /// them and [`SLACK`] to spare.
    fn positions(_masks: [&[u64]; 2], _count: usize, _lists: &mut [Vec<u16>; 2]) {
        unreachable!("only called where HAS_DENSE_LABELS says so")
    }

    /// Labels the runs of a row, many at a time; returns how many labels are new. `above[0]` stands before the label
    /// of the first run above; `labels` begins with the row's first run; both have [`SLACK`] to spare. `inherited` is
    /// memory for a label per pixel.
    fn dense_labels(
        _links: &Links<'_>,
        _above: &[u32],
        _inherited: &mut [u32],
        _labels: &mut [u32],
        _new_label: u32,
    ) -> u32 {
        unreachable!("only called where HAS_DENSE_LABELS says so")
    }

    /// Writes labels of part of a row: 0 where not valid, else the label of the pixel's run. `labels[i]` belongs to
    /// the i-th run that starts in it, `labels[0]` to one that reaches into it; there is room for a label for each
    /// pixel and [`SLACK`] to spare.
    fn paint_row(valid: &[u64], starts: &[u64], labels: &[u16], row: &mut [u16]);
}

/// The masks of one row, one bit a pixel, as an instruction set computes them.
pub struct RowMasks<'a> {
    /// Pixels that are valid.
    pub valid: &'a mut [u64],
    /// Pixels within theta of their left neighbour, valid or not; column 0 has none.
    pub close_left: &'a mut [u64],
    /// Pixels within theta of the neighbour above, valid or not.
    pub close_up: &'a mut [u64],
}

/// How the runs of a row touch those above.
pub struct Links<'a> {
    /// One pixel of each run: its first contact, or its end if it is an orphan.
    pub marks: &'a [u64],
    /// Last pixels of runs without a contact (orphans).
    pub orphans: &'a [u64],
    /// Last pixels of runs.
    pub ends: &'a [u64],
    /// First pixels of the runs above.
    pub starts_above: &'a [u64],
}

/// Pixel types that instruction sets compare.
pub trait Masked: Pixel {
    /// The instruction set's masks for this type.
    fn masks<I: Isa>(row: &[Self], up: &[Self], rule: &Connectivity<Self>, out: RowMasks<'_>);
}

macro_rules! masked {
    ($t:ty, $masks:ident) => {
        impl Masked for $t {
            #[inline(always)]
            fn masks<I: Isa>(row: &[Self], up: &[Self], rule: &Connectivity<Self>, out: RowMasks<'_>) {
                I::$masks(row, up, rule, out)
            }
        }
    };
}
masked!(u8, masks_u8);
masked!(u16, masks_u16);
masked!(f32, masks_f32);
