//! AVX-512: comparisons give bit masks directly, `vpcompressw` lists positions, `vpermw` paints.

use super::{Isa, RowMasks, SLACK, kernel, words};
use crate::group::LinkRule;
use std::arch::x86_64::*;

pub(super) struct Avx512;

kernel!("avx512", Avx512, "avx512f,avx512bw,avx512vl,avx512vbmi2,avx512bitalg,bmi1,bmi2,popcnt,lzcnt", || {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512vbmi2")
        && is_x86_feature_detected!("avx512bitalg")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("popcnt")
        && is_x86_feature_detected!("lzcnt")
});

/// One pixel type: its lanes, and the masks of one vector that say which lanes are valid and which
/// are within theta of each other.
macro_rules! masks {
    ($name:ident, $t:ty, $lanes:literal, $load:path, $set:path,
     |$a:ident, $b:ident, $zero:ident, $sentinel:ident, $low:ident, $high:ident, $theta:ident| $valid:expr, $close:expr) => {
        #[target_feature(enable = "avx512f,avx512bw,avx512vl,bmi1,bmi2")]
        fn $name(row: &[$t], up: &[$t], rule: &LinkRule<$t>, out: RowMasks<'_>) {
            let v = &rule.validity;
            let [$zero, $sentinel, $low, $high, $theta] =
                [0 as $t, v.sentinel, v.low, v.high, rule.theta].map(|x| $set(x as _));
            let valid = |here: *const $t| {
                (0..64).step_by($lanes).fold(0u64, |word, lane| {
                    // SAFETY: `words` passes pointers to 64 pixels.
                    let $a = unsafe { $load(here.add(lane) as *const _) };
                    word | ($valid as u64) << lane
                })
            };
            let close = |here: *const $t, there: *const $t| {
                (0..64).step_by($lanes).fold(0u64, |word, lane| {
                    // SAFETY: as above.
                    let ($a, $b) = unsafe { ($load(here.add(lane) as *const _), $load(there.add(lane) as *const _)) };
                    word | ($close as u64) << lane
                })
            };
            // SAFETY: both read 64 pixels at each pointer.
            unsafe { words(row, up, out, valid, close) }
        }
    };
}

masks!(
    masks_u8,
    u8,
    64,
    _mm512_loadu_si512,
    _mm512_set1_epi8,
    |a, b, _zero, sentinel, low, high, theta| _mm512_mask_cmpneq_epi8_mask(
        _mm512_cmpeq_epi8_mask(a, _mm512_min_epu8(_mm512_max_epu8(a, low), high)),
        a,
        sentinel
    ),
    _mm512_cmple_epu8_mask(_mm512_sub_epi8(_mm512_max_epu8(a, b), _mm512_min_epu8(a, b)), theta)
);

masks!(
    masks_u16,
    u16,
    32,
    _mm512_loadu_si512,
    _mm512_set1_epi16,
    |a, b, _zero, sentinel, low, high, theta| _mm512_mask_cmpneq_epi16_mask(
        _mm512_cmpeq_epi16_mask(a, _mm512_min_epu16(_mm512_max_epu16(a, low), high)),
        a,
        sentinel
    ),
    _mm512_cmple_epu16_mask(_mm512_sub_epi16(_mm512_max_epu16(a, b), _mm512_min_epu16(a, b)), theta)
);

masks!(
    masks_f32,
    f32,
    16,
    _mm512_loadu_ps,
    _mm512_set1_ps,
    |a, b, zero, sentinel, low, high, theta| _mm512_cmp_ps_mask::<_CMP_NEQ_UQ>(a, zero)
        & _mm512_cmp_ps_mask::<_CMP_NEQ_UQ>(a, sentinel)
        & _mm512_cmp_ps_mask::<_CMP_GE_OQ>(a, low)
        & _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, high),
    _mm512_cmp_ps_mask::<_CMP_LE_OQ>(_mm512_abs_ps(_mm512_sub_ps(a, b)), theta)
);

impl Isa for Avx512 {
    #[inline(always)]
    fn masks_u8(row: &[u8], up: &[u8], rule: &LinkRule<u8>, out: RowMasks<'_>) {
        // SAFETY: reached only through the kernel of this file, whose features include those of the callee.
        unsafe { masks_u8(row, up, rule, out) }
    }
    #[inline(always)]
    fn masks_u16(row: &[u16], up: &[u16], rule: &LinkRule<u16>, out: RowMasks<'_>) {
        // SAFETY: as above.
        unsafe { masks_u16(row, up, rule, out) }
    }
    #[inline(always)]
    fn masks_f32(row: &[f32], up: &[f32], rule: &LinkRule<f32>, out: RowMasks<'_>) {
        // SAFETY: as above.
        unsafe { masks_f32(row, up, rule, out) }
    }
    #[inline(always)]
    fn positions(mask: &[u64], out: &mut Vec<u16>) {
        // SAFETY: as above.
        unsafe { positions(mask, out) }
    }
    #[inline(always)]
    fn paint_row(valid: &[u64], starts: &[u64], label_of_run: &[u16], row: &mut [u16]) {
        // SAFETY: as above.
        unsafe { paint_row(valid, starts, label_of_run, row) }
    }
}

/// 0, 1, .. 31.
static LANE: [u16; 32] = {
    let mut lane = [0; 32];
    let mut i = 0;
    while i < 32 {
        lane[i] = i as u16;
        i += 1;
    }
    lane
};

/// For lanes 0..16 and again for 16..32 the bits up to and including the lane's own.
static UP_TO: [u16; 32] = {
    let mut up_to = [0; 32];
    let mut i = 0;
    while i < 32 {
        up_to[i] = ((2u32 << (i % 16)) - 1) as u16;
        i += 1;
    }
    up_to
};

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vbmi2,popcnt")]
fn positions(mask: &[u64], out: &mut Vec<u16>) {
    let count: usize = mask.iter().map(|word| word.count_ones() as usize).sum();
    assert!(out.capacity() - out.len() >= count + SLACK);
    // SAFETY: each store writes 32 elements from the first unused one, of which `count_ones` stay;
    // the room for all of them and 32 more was just checked.
    unsafe {
        let mut end = out.as_mut_ptr().add(out.len());
        let mut lane = _mm512_loadu_si512(LANE.as_ptr().cast());
        for &word in mask {
            for half in [word as u32, (word >> 32) as u32] {
                _mm512_storeu_si512(end.cast(), _mm512_maskz_compress_epi16(half, lane));
                end = end.add(half.count_ones() as usize);
                lane = _mm512_add_epi16(lane, _mm512_set1_epi16(32));
            }
        }
        out.set_len(out.len() + count);
    }
}

/// The label of a pixel is the entry of `label_of_run` at the number of run starts up to it, counted
/// within 16 pixels by `vpopcntw`.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512bitalg,popcnt")]
fn paint_row(valid: &[u64], starts: &[u64], label_of_run: &[u16], row: &mut [u16]) {
    let runs: usize = starts.iter().map(|word| word.count_ones() as usize).sum();
    assert!(label_of_run.len() >= runs + SLACK);
    // SAFETY: both constants are 64 bytes.
    let up_to = unsafe { _mm512_loadu_si512(UP_TO.as_ptr().cast()) };
    let mut begun = 0usize; // runs begun before the block
    for block in 0..row.len().div_ceil(32) {
        let shift = block % 2 * 32;
        let valid = (valid[block / 2] >> shift) as u32;
        let starts = (starts[block / 2] >> shift) as u32;
        // The table begins with the run that reaches into the block, if its first pixel starts none.
        let continues = (starts & 1 == 0) as usize;
        let table = (begun - continues.min(begun)) as usize;
        let skipped = (begun - table) as i16; // 1 if the table has that run in front
        let low = (starts as u16).count_ones() as i16;
        let bits = _mm512_mask_set1_epi16(_mm512_set1_epi16(starts as i16), 0xFFFF_0000, (starts >> 16) as i16);
        let base = _mm512_mask_set1_epi16(_mm512_set1_epi16(skipped - 1), 0xFFFF_0000, skipped - 1 + low);
        let index = _mm512_add_epi16(_mm512_popcnt_epi16(_mm512_and_si512(bits, up_to)), base);
        let at = block * 32;
        let within = u32::MAX >> (32 - (row.len() - at).min(32));
        // SAFETY: `table + 32 <= runs + SLACK`, checked above; the masked store writes only pixels of the row.
        unsafe {
            let labels = _mm512_loadu_si512(label_of_run.as_ptr().add(table).cast());
            let painted = _mm512_maskz_permutexvar_epi16(valid, index, labels);
            _mm512_mask_storeu_epi16(row.as_mut_ptr().add(at).cast(), within, painted);
        }
        begun += starts.count_ones() as usize;
    }
}
