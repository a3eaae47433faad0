//! AVX2: comparisons give lanes of ones, which are packed to bytes and gathered by `vpmovmskb`.

use super::kernel::kernel;
use super::portable::Portable;
use super::words::words;
use crate::components::connectivity::Connectivity;
use crate::components::isa::{Isa, RowMasks};
use crate::util::simd::has_avx2;
use std::arch::x86_64::*;

pub(super) struct Avx2;

kernel!("avx2", Avx2, has_avx2, target_feature(enable = "avx2,bmi1,bmi2,popcnt,lzcnt"));

/// One pixel type: how lanes are compared, and how the lanes of a condition, given the position of
/// a vector's first lane, become the bits of a word.
macro_rules! masks {
    ($name:ident, $t:ty, $load:path, $set:path, $bits:path,
     |$a:ident, $b:ident, $sentinel:ident, $low:ident, $high:ident, $theta:ident| $valid:expr, $close:expr) => {
        #[target_feature(enable = "avx2,bmi1,bmi2")]
        fn $name(row: &[$t], up: &[$t], rule: &Connectivity<$t>, out: RowMasks<'_>) {
            let v = &rule.validity;
            let [$sentinel, $low, $high, $theta] =
                [v.sentinel, v.low, rule.high_or_span, rule.theta].map(|x| $set(x as _));
            let valid = |here: *const $t| {
                $bits(|lane| {
                    // SAFETY: `words` passes pointers to 64 pixels.
                    let $a = unsafe { $load(here.add(lane) as *const _) };
                    $valid
                })
            };
            let close = |here: *const $t, there: *const $t| {
                $bits(|lane| {
                    // SAFETY: as above.
                    let ($a, $b) = unsafe { ($load(here.add(lane) as *const _), $load(there.add(lane) as *const _)) };
                    $close
                })
            };
            // SAFETY: both read 64 pixels at each pointer.
            unsafe { words(row, up, out, valid, close) }
        }
    };
}

/// Bits of two blocks of 32 one-byte lanes.
#[inline]
#[target_feature(enable = "avx2")]
fn bits_8(condition: impl Fn(usize) -> __m256i) -> u64 {
    let half = |lane| _mm256_movemask_epi8(condition(lane)) as u32 as u64;
    half(0) | half(32) << 32
}

/// Bits of four blocks of 16 two-byte lanes.
#[inline]
#[target_feature(enable = "avx2")]
fn bits_16(condition: impl Fn(usize) -> __m256i) -> u64 {
    let half = |lane| {
        let packed = _mm256_packs_epi16(condition(lane), condition(lane + 16));
        _mm256_movemask_epi8(_mm256_permute4x64_epi64::<0b11_01_10_00>(packed)) as u32 as u64
    };
    half(0) | half(32) << 32
}

/// Bits of eight blocks of 8 four-byte lanes.
#[inline]
#[target_feature(enable = "avx2")]
fn bits_32(condition: impl Fn(usize) -> __m256) -> u64 {
    (0..64).step_by(8).fold(0, |word, lane| word | (_mm256_movemask_ps(condition(lane)) as u32 as u64) << lane)
}

masks!(
    masks_u8,
    u8,
    _mm256_loadu_si256,
    _mm256_set1_epi8,
    bits_8,
    |a, b, sentinel, low, span, theta| {
        let above_low = _mm256_sub_epi8(a, low);
        let in_range = _mm256_cmpeq_epi8(_mm256_min_epu8(above_low, span), above_low);
        _mm256_andnot_si256(_mm256_cmpeq_epi8(a, sentinel), in_range)
    },
    {
        let distance = _mm256_sub_epi8(_mm256_max_epu8(a, b), _mm256_min_epu8(a, b));
        _mm256_cmpeq_epi8(_mm256_min_epu8(distance, theta), distance)
    }
);

masks!(
    masks_u16,
    u16,
    _mm256_loadu_si256,
    _mm256_set1_epi16,
    bits_16,
    |a, b, sentinel, low, span, theta| {
        let above_low = _mm256_sub_epi16(a, low);
        let in_range = _mm256_cmpeq_epi16(_mm256_min_epu16(above_low, span), above_low);
        _mm256_andnot_si256(_mm256_cmpeq_epi16(a, sentinel), in_range)
    },
    {
        let distance = _mm256_sub_epi16(_mm256_max_epu16(a, b), _mm256_min_epu16(a, b));
        _mm256_cmpeq_epi16(_mm256_min_epu16(distance, theta), distance)
    }
);

masks!(
    masks_f32,
    f32,
    _mm256_loadu_ps,
    _mm256_set1_ps,
    bits_32,
    |a, b, sentinel, low, high, theta| {
        let there = _mm256_cmp_ps::<_CMP_NEQ_UQ>(a, _mm256_setzero_ps());
        let there = _mm256_and_ps(there, _mm256_cmp_ps::<_CMP_NEQ_UQ>(a, sentinel));
        let in_range = _mm256_and_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(a, low), _mm256_cmp_ps::<_CMP_LE_OQ>(a, high));
        _mm256_and_ps(there, in_range)
    },
    _mm256_cmp_ps::<_CMP_LE_OQ>(_mm256_andnot_ps(_mm256_set1_ps(-0.0), _mm256_sub_ps(a, b)), theta)
);

impl Isa for Avx2 {
    #[inline(always)]
    fn masks_u8(row: &[u8], up: &[u8], rule: &Connectivity<u8>, out: RowMasks<'_>) {
        // SAFETY: reached only through the kernel of this file, whose features include those of the callee.
        unsafe { masks_u8(row, up, rule, out) }
    }
    #[inline(always)]
    fn masks_u16(row: &[u16], up: &[u16], rule: &Connectivity<u16>, out: RowMasks<'_>) {
        // SAFETY: as above.
        unsafe { masks_u16(row, up, rule, out) }
    }
    #[inline(always)]
    fn masks_f32(row: &[f32], up: &[f32], rule: &Connectivity<f32>, out: RowMasks<'_>) {
        // SAFETY: as above.
        unsafe { masks_f32(row, up, rule, out) }
    }
    #[inline(always)]
    fn paint_row(valid: &[u64], starts: &[u64], labels: &[u16], row: &mut [u16]) {
        Portable::paint_row(valid, starts, labels, row);
    }
}
