//! The operations in plain Rust, in a shape that compilers vectorise.

use super::kernel::kernel;
use crate::components::connectivity::Connectivity;
use crate::components::isa::{Isa, RowMasks};
use crate::map::Pixel;

pub(super) struct Portable;

kernel!("portable", Portable, || true);

impl Isa for Portable {
    fn masks_u8(row: &[u8], up: &[u8], rule: &Connectivity<u8>, out: RowMasks<'_>) {
        masks(row, up, rule, out);
    }
    fn masks_u16(row: &[u16], up: &[u16], rule: &Connectivity<u16>, out: RowMasks<'_>) {
        masks(row, up, rule, out);
    }
    fn masks_f32(row: &[f32], up: &[f32], rule: &Connectivity<f32>, out: RowMasks<'_>) {
        masks(row, up, rule, out);
    }

    #[inline(always)]
    fn paint_row(valid: &[u64], starts: &[u64], labels: &[u16], row: &mut [u16]) {
        let mut begun = 0;
        for (w, (&valid, &starts)) in valid.iter().zip(starts).enumerate() {
            // Where runs and gaps start.
            let mut rest = 1 | starts | (valid << 1 & !valid);
            if rest.count_ones() > MANY {
                for (bit, pixel) in row[64 * w..].iter_mut().take(64).enumerate() {
                    begun += (starts >> bit & 1) as usize;
                    *pixel = labels[begun] & ((valid >> bit & 1) as u16).wrapping_neg();
                }
                continue;
            }
            // Each is painted 64 pixels wide, and the next paints over it: many pixels take no longer than few.
            while rest != 0 {
                let bit = rest.trailing_zeros();
                rest &= rest - 1;
                begun += (starts >> bit & 1) as usize;
                let label = if valid >> bit & 1 > 0 { labels[begun] } else { 0 };
                let pixels = &mut row[64 * w + bit as usize..];
                match pixels.first_chunk_mut::<64>() {
                    Some(pixels) => pixels.fill(label),
                    None => pixels.fill(label),
                }
            }
        }
    }
}

/// 64 pixels of more runs and gaps than this are painted one by one, which takes a seventh less time on a noisy
/// Kinect map; clean maps, which have few runs, take half as long run by run.
const MANY: u32 = 16;

/// Masks of a row: flags in bytes, which vectorises, then eight bytes to eight bits.
#[inline(always)]
fn masks<T: Pixel>(row: &[T], up: &[T], rule: &Connectivity<T>, out: RowMasks<'_>) {
    let mut flags = [0u8; 64];
    for (w, block) in row.chunks(64).enumerate() {
        let first = w * 64;
        fill(&mut flags, block.iter().map(|&here| rule.validity.holds(here)));
        out.valid[w] = pack(&flags);
        fill(&mut flags, block.iter().zip(&up[first..]).map(|(&here, &up)| rule.close(here, up)));
        out.close_up[w] = pack(&flags);
        if first == 0 {
            flags[0] = 0;
            fill(&mut flags[1..], block[1..].iter().zip(row).map(|(&here, &left)| rule.close(here, left)));
        } else {
            fill(&mut flags, block.iter().zip(&row[first - 1..]).map(|(&here, &left)| rule.close(here, left)));
        }
        out.close_left[w] = pack(&flags);
    }
}

/// Writes the conditions as 0 and 1, and 0 after the last.
#[inline(always)]
fn fill(flags: &mut [u8], conditions: impl ExactSizeIterator<Item = bool>) {
    let count = conditions.len().min(flags.len());
    for (flag, condition) in flags.iter_mut().zip(conditions) {
        *flag = condition.into();
    }
    flags[count..].fill(0);
}

/// Bit i = `flags[i]`. The product moves the eight low bits of eight bytes into the top byte.
#[inline(always)]
fn pack(flags: &[u8; 64]) -> u64 {
    let mut word = 0;
    for (k, eight) in flags.chunks_exact(8).enumerate() {
        let bytes = u64::from_le_bytes(eight.try_into().expect("eight bytes"));
        word |= (bytes.wrapping_mul(0x0102_0408_1020_4080) >> 56) << (8 * k);
    }
    word
}
