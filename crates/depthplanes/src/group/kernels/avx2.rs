//! AVX2: comparisons give lanes of ones, which are packed to bytes and gathered by `vpmovmskb`.

use super::portable::Portable;
use super::{Isa, RowMasks, kernel};
use crate::group::LinkRule;
use std::arch::x86_64::*;

pub(super) struct Avx2;

kernel!("avx2", Avx2, "avx2,bmi1,bmi2,popcnt,lzcnt", || {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("popcnt")
        && is_x86_feature_detected!("lzcnt")
});

/// One pixel type: how 64 pixels are loaded and compared. `$bits` turns the lanes of a condition,
/// given the number of a block, into bits of the word.
macro_rules! masks {
    ($name:ident, $word:ident, $t:ty, $vector:ty, $load:path, $set:path, $bits:path,
     |$a:ident, $b:ident, $rule:ident| $valid:expr, $close:expr) => {
        #[target_feature(enable = "avx2,bmi1,bmi2")]
        fn $name(row: &[$t], up: Option<&[$t]>, rule: &LinkRule<$t>, out: RowMasks<'_>) {
            let above = up.unwrap_or(row);
            assert!(above.len() == row.len());
            let mut left_valid = 0; // validity of the pixel before the word, in bit 0
            for w in 0..row.len().div_ceil(64) {
                let at = w * 64;
                let inside = at > 0 && at + 64 <= row.len();
                let (valid, close_left, close_up) = if inside {
                    // SAFETY: pixels `at - 1..at + 64` lie within both rows.
                    unsafe { $word(row.as_ptr().add(at), row.as_ptr().add(at - 1), above.as_ptr().add(at), rule) }
                } else {
                    // At a row's ends, copies with missing pixels around them.
                    let count = (row.len() - at).min(64);
                    let (mut here, mut here_up) = ([0 as $t; 65], [0 as $t; 64]);
                    here[(at == 0) as usize..][..count + (at > 0) as usize]
                        .copy_from_slice(&row[at - (at > 0) as usize..at + count]);
                    here_up[..count].copy_from_slice(&above[at..at + count]);
                    // SAFETY: both copies hold 64 pixels from where they are read.
                    unsafe { $word(here.as_ptr().add(1), here.as_ptr(), here_up.as_ptr(), rule) }
                };
                out.valid[w] = valid;
                out.left[w] = close_left & valid & (valid << 1 | left_valid);
                out.above[w] = if up.is_some() { close_up & valid } else { 0 };
                left_valid = valid >> 63;
            }
        }

        /// Bits of 64 pixels: valid; close to the left; close to a valid one above.
        ///
        /// # Safety
        /// 64 pixels can be read at each pointer.
        #[inline]
        #[target_feature(enable = "avx2,bmi1,bmi2")]
        unsafe fn $word(here: *const $t, left: *const $t, up: *const $t, rule: &LinkRule<$t>) -> (u64, u64, u64) {
            struct Rule {
                low: $vector,
                high: $vector,
                sentinel: $vector,
                zero: $vector,
                theta: $vector,
            }
            let v = &rule.validity;
            let $rule = Rule {
                low: $set(v.low as _),
                high: $set(v.high as _),
                sentinel: $set(v.sentinel as _),
                zero: $set(0 as _),
                theta: $set(rule.theta as _),
            };
            // SAFETY: the callers' promise, block by block.
            unsafe {
                let load = |from: *const $t, lane: usize| $load(from.add(lane) as *const _);
                (
                    $bits(|lane| {
                        let $a = load(here, lane);
                        $valid
                    }),
                    $bits(|lane| {
                        let ($a, $b) = (load(here, lane), load(left, lane));
                        $close
                    }),
                    $bits(|lane| {
                        let ($a, $b) = (load(here, lane), load(up, lane));
                        let close = $close;
                        let $a = $b;
                        and(close, $valid)
                    }),
                )
            }
        }
    };
}

/// Both conditions, for integer and floating-point lanes alike.
trait Lanes {
    fn both(self, other: Self) -> Self;
}
impl Lanes for __m256i {
    #[inline(always)]
    fn both(self, other: Self) -> Self {
        // SAFETY: only used in this file, behind its kernel's features.
        unsafe { _mm256_and_si256(self, other) }
    }
}
impl Lanes for __m256 {
    #[inline(always)]
    fn both(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { _mm256_and_ps(self, other) }
    }
}
#[inline(always)]
fn and<L: Lanes>(a: L, b: L) -> L {
    a.both(b)
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

/// Lanes that differ.
#[inline]
#[target_feature(enable = "avx2")]
fn not(lanes: __m256i) -> __m256i {
    _mm256_xor_si256(lanes, _mm256_set1_epi8(-1))
}

masks!(
    masks_u8,
    word_u8,
    u8,
    __m256i,
    _mm256_loadu_si256,
    _mm256_set1_epi8,
    bits_8,
    |a, b, rule| and(
        not(_mm256_or_si256(_mm256_cmpeq_epi8(a, rule.zero), _mm256_cmpeq_epi8(a, rule.sentinel))),
        and(_mm256_cmpeq_epi8(_mm256_max_epu8(a, rule.low), a), _mm256_cmpeq_epi8(_mm256_min_epu8(a, rule.high), a))
    ),
    _mm256_cmpeq_epi8(
        rule.zero,
        _mm256_subs_epu8(_mm256_or_si256(_mm256_subs_epu8(a, b), _mm256_subs_epu8(b, a)), rule.theta)
    )
);

masks!(
    masks_u16,
    word_u16,
    u16,
    __m256i,
    _mm256_loadu_si256,
    _mm256_set1_epi16,
    bits_16,
    |a, b, rule| and(
        not(_mm256_or_si256(_mm256_cmpeq_epi16(a, rule.zero), _mm256_cmpeq_epi16(a, rule.sentinel))),
        and(
            _mm256_cmpeq_epi16(_mm256_max_epu16(a, rule.low), a),
            _mm256_cmpeq_epi16(_mm256_min_epu16(a, rule.high), a)
        )
    ),
    _mm256_cmpeq_epi16(
        rule.zero,
        _mm256_subs_epu16(_mm256_or_si256(_mm256_subs_epu16(a, b), _mm256_subs_epu16(b, a)), rule.theta)
    )
);

masks!(
    masks_f32,
    word_f32,
    f32,
    __m256,
    _mm256_loadu_ps,
    _mm256_set1_ps,
    bits_32,
    |a, b, rule| and(
        and(_mm256_cmp_ps::<_CMP_NEQ_UQ>(a, rule.zero), _mm256_cmp_ps::<_CMP_NEQ_UQ>(a, rule.sentinel)),
        and(_mm256_cmp_ps::<_CMP_GE_OQ>(a, rule.low), _mm256_cmp_ps::<_CMP_LE_OQ>(a, rule.high))
    ),
    _mm256_cmp_ps::<_CMP_LE_OQ>(_mm256_andnot_ps(_mm256_set1_ps(-0.0), _mm256_sub_ps(a, b)), rule.theta)
);

impl Isa for Avx2 {
    #[inline(always)]
    fn masks_u8(row: &[u8], up: Option<&[u8]>, rule: &LinkRule<u8>, out: RowMasks<'_>) {
        // SAFETY: reached only through the kernel of this file, whose features include those of the callee.
        unsafe { masks_u8(row, up, rule, out) }
    }
    #[inline(always)]
    fn masks_u16(row: &[u16], up: Option<&[u16]>, rule: &LinkRule<u16>, out: RowMasks<'_>) {
        // SAFETY: as above.
        unsafe { masks_u16(row, up, rule, out) }
    }
    #[inline(always)]
    fn masks_f32(row: &[f32], up: Option<&[f32]>, rule: &LinkRule<f32>, out: RowMasks<'_>) {
        // SAFETY: as above.
        unsafe { masks_f32(row, up, rule, out) }
    }
    #[inline(always)]
    fn positions(mask: &[u64], out: &mut Vec<u16>) {
        Portable::positions(mask, out);
    }
    #[inline(always)]
    fn paint_row(valid: &[u64], starts: &[u64], label_of_run: &[u16], row: &mut [u16]) {
        Portable::paint_row(valid, starts, label_of_run, row);
    }
}
