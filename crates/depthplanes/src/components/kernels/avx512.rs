//! AVX-512: comparisons give bit masks directly, `vpcompressw` lists positions, `vpermw` paints.

use super::kernel::kernel;
use super::words::words;
use crate::components::connectivity::Connectivity;
use crate::components::isa::{Isa, Links, RowMasks, SLACK};
use crate::util::simd::has_avx512;
use std::arch::x86_64::*;

pub(super) struct Avx512;

kernel!(
    "avx512",
    Avx512,
    has_avx512,
    target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi2,avx512vpopcntdq,bmi1,bmi2,popcnt,lzcnt")
);

/// One pixel type: its lanes, and the masks of one vector that say which lanes are valid and which
/// are within theta of each other.
macro_rules! masks {
    ($name:ident, $t:ty, $lanes:literal, $load:path, $set:path,
     |$a:ident, $b:ident, $sentinel:ident, $low:ident, $high:ident, $theta:ident| $valid:expr, $by_default:expr, $close:expr) => {
        #[target_feature(enable = "avx512f,avx512bw,avx512vl,bmi1,bmi2")]
        fn $name(row: &[$t], up: &[$t], rule: &Connectivity<$t>, out: RowMasks<'_>) {
            let v = &rule.validity;
            let [$sentinel, $low, $high, $theta] =
                [v.sentinel, v.low, rule.high_or_span, rule.theta].map(|x| $set(x as _));
            let valid = |here: *const $t| {
                (0..64).step_by($lanes).fold(0u64, |word, lane| {
                    // SAFETY: `words` passes pointers to 64 pixels.
                    let $a = unsafe { $load(here.add(lane) as *const _) };
                    word | ($valid as u64) << lane
                })
            };
            let by_default = |here: *const $t| {
                (0..64).step_by($lanes).fold(0u64, |word, lane| {
                    // SAFETY: as above.
                    let $a = unsafe { $load(here.add(lane) as *const _) };
                    word | ($by_default as u64) << lane
                })
            };
            let close = |here: *const $t, there: *const $t| {
                (0..64).step_by($lanes).fold(0u64, |word, lane| {
                    // SAFETY: as above.
                    let ($a, $b) = unsafe { ($load(here.add(lane) as *const _), $load(there.add(lane) as *const _)) };
                    word | ($close as u64) << lane
                })
            };
            // SAFETY: all read 64 pixels at each pointer.
            unsafe {
                match rule.is_default {
                    true => words(row, up, out, by_default, close),
                    false => words(row, up, out, valid, close),
                }
            }
        }
    };
}

masks!(
    masks_u8,
    u8,
    64,
    _mm512_loadu_si512,
    _mm512_set1_epi8,
    |a, b, sentinel, low, span, theta| _mm512_mask_cmpneq_epi8_mask(
        _mm512_cmple_epu8_mask(_mm512_sub_epi8(a, low), span),
        a,
        sentinel
    ),
    _mm512_test_epi8_mask(a, a),
    _mm512_cmple_epu8_mask(_mm512_sub_epi8(_mm512_max_epu8(a, b), _mm512_min_epu8(a, b)), theta)
);

masks!(
    masks_u16,
    u16,
    32,
    _mm512_loadu_si512,
    _mm512_set1_epi16,
    |a, b, sentinel, low, span, theta| _mm512_mask_cmpneq_epi16_mask(
        _mm512_cmple_epu16_mask(_mm512_sub_epi16(a, low), span),
        a,
        sentinel
    ),
    _mm512_test_epi16_mask(a, a),
    _mm512_cmple_epu16_mask(_mm512_sub_epi16(_mm512_max_epu16(a, b), _mm512_min_epu16(a, b)), theta)
);

masks!(
    masks_f32,
    f32,
    16,
    _mm512_loadu_ps,
    _mm512_set1_ps,
    |a, b, sentinel, low, high, theta| _mm512_cmp_ps_mask::<_CMP_NEQ_UQ>(a, _mm512_setzero_ps())
        & _mm512_cmp_ps_mask::<_CMP_NEQ_UQ>(a, sentinel)
        & _mm512_cmp_ps_mask::<_CMP_GE_OQ>(a, low)
        & _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, high),
    _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(
        _mm512_cmp_ps_mask::<_CMP_NEQ_UQ>(a, _mm512_setzero_ps()),
        _mm512_abs_ps(a),
        _mm512_set1_ps(f32::MAX)
    ),
    _mm512_cmp_ps_mask::<_CMP_LE_OQ>(_mm512_abs_ps(_mm512_sub_ps(a, b)), theta)
);

impl Isa for Avx512 {
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
    fn add(a: &[u64], b: &[u64], sums: &mut [u64]) {
        // SAFETY: as above.
        unsafe { add(a, b, sums) }
    }
    #[inline(always)]
    fn positions(masks: [&[u64]; 2], count: usize, lists: &mut [Vec<u16>; 2]) {
        // SAFETY: as above.
        unsafe { positions(masks, count, lists) }
    }
    const HAS_DENSE_LABELS: bool = true;
    #[inline(always)]
    fn dense_labels(
        links: &Links<'_>,
        above: &[u32],
        inherited: &mut [u32],
        labels: &mut [u32],
        new_label: u32,
    ) -> u32 {
        // SAFETY: as above.
        unsafe { dense_labels(links, above, inherited, labels, new_label) }
    }
    #[inline(always)]
    fn paint_row(valid: &[u64], starts: &[u64], labels: &[u16], row: &mut [u16]) {
        // SAFETY: as above.
        unsafe { paint_row(valid, starts, labels, row) }
    }
}

/// Adds eight words at a time. Words that overflow carry into the next, and words that are all ones pass a carry on:
/// both are bits of a small number, and one addition of these propagates every carry.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl,bmi2")]
fn add(a: &[u64], b: &[u64], sums: &mut [u64]) {
    assert!(a.len() == sums.len() && b.len() == sums.len());
    let ones = _mm512_set1_epi64(-1);
    let mut carry = 0;
    for (sums, (a, b)) in sums.chunks_mut(8).zip(a.chunks(8).zip(b.chunks(8))) {
        let lanes = u8::MAX >> (8 - sums.len());
        // SAFETY: the masked loads and the masked store touch only the words of the three.
        unsafe {
            let a = _mm512_maskz_loadu_epi64(lanes, a.as_ptr().cast());
            let sum = _mm512_add_epi64(a, _mm512_maskz_loadu_epi64(lanes, b.as_ptr().cast()));
            let overflows = u32::from(_mm512_cmplt_epu64_mask(sum, a));
            let hands_on = u32::from(_mm512_cmpeq_epi64_mask(sum, ones));
            let carries = ((overflows << 1 | carry) + hands_on) ^ hands_on;
            let sum = _mm512_mask_sub_epi64(sum, carries as u8, sum, ones);
            _mm512_mask_storeu_epi64(sums.as_mut_ptr().cast(), lanes, sum);
            carry = carries >> 8;
        }
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

/// For the even and for the odd of 32 pixels the bits up to and including the pixel's own, without bit 0.
static UP_TO: [[u32; 16]; 2] = {
    let mut up_to = [[0; 16]; 2];
    let mut i = 0;
    while i < 32 {
        up_to[i % 2][i / 2] = ((2u64 << i) - 2) as u32;
        i += 1;
    }
    up_to
};

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vbmi2,popcnt")]
fn positions([a, b]: [&[u64]; 2], count: usize, [list_a, list_b]: &mut [Vec<u16>; 2]) {
    assert!(list_a.capacity() >= count + SLACK && list_b.capacity() >= count + SLACK);
    // SAFETY: each store writes 32 elements from the first unused one, of which `count_ones` stay.
    // There is room for `count` and 64 more, and the pointers are held to `count` word by word.
    unsafe {
        let (mut next_a, mut next_b) = (list_a.as_mut_ptr(), list_b.as_mut_ptr());
        let (end_a, end_b) = (next_a.add(count), next_b.add(count));
        let lanes = _mm512_loadu_si512(LANE.as_ptr().cast());
        for (first, (&a, &b)) in (0u32..).step_by(64).zip(a.iter().zip(b)) {
            if a | b == 0 {
                continue;
            }
            let low = _mm512_add_epi16(lanes, _mm512_set1_epi16(first as i16)); // 16 bits, signed or not
            let high = _mm512_add_epi16(low, _mm512_set1_epi16(32));
            for (word, next) in [(a, &mut next_a), (b, &mut next_b)] {
                _mm512_storeu_si512((*next).cast(), _mm512_maskz_compress_epi16(word as u32, low));
                *next = next.add((word as u32).count_ones() as usize);
                _mm512_storeu_si512((*next).cast(), _mm512_maskz_compress_epi16((word >> 32) as u32, high));
                *next = next.add((word >> 32).count_ones() as usize);
            }
            assert!(next_a <= end_a && next_b <= end_b, "more bits than counted");
        }
        list_a.set_len(count);
        list_b.set_len(count);
    }
}

/// Spreads the labels above over the pixels, compresses those at first contacts to a list, and
/// expands the list to the runs that have one, and new labels to the others.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vpopcntdq,bmi1,bmi2,popcnt")]
fn dense_labels(links: &Links<'_>, above: &[u32], inherited: &mut [u32], labels: &mut [u32], new_label: u32) -> u32 {
    let starts_above = links.starts_above;
    let ones = |words: &[u64]| words.iter().map(|word| word.count_ones() as usize).sum::<usize>();
    assert!(above.len() > ones(starts_above) && inherited.len() >= ones(links.marks) + SLACK);
    assert!(labels.len() >= ones(links.ends) + SLACK && links.ends.len() == starts_above.len());
    let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    // The bits up to and including a lane's own.
    let up_to = _mm512_sub_epi32(_mm512_sllv_epi32(_mm512_set1_epi32(2), lanes), _mm512_set1_epi32(1));
    let (mut begun, mut listed, mut taken, mut run, mut new) = (0, 0, 0, 0, new_label);
    for w in 0..starts_above.len() {
        for shift in (0..64).step_by(16) {
            let starts = (starts_above[w] >> shift) as u16;
            let contacts = ((links.marks[w] ^ links.orphans[w]) >> shift) as u16;
            // As in `paint_row`: the table is read from the run of the first pixel.
            let table = begun + usize::from(starts & 1);
            let bits = _mm512_and_si512(_mm512_set1_epi32(i32::from(starts & !1)), up_to);
            let index = _mm512_popcnt_epi32(bits);
            let present = u16::MAX >> 16usize.saturating_sub(above.len() - table).min(16);
            // SAFETY: the masked load reads what `above` has from `table` on; the store writes 16
            // elements from `listed`, of which no more than the contacts stay.
            unsafe {
                let table = _mm512_maskz_loadu_epi32(present, above.as_ptr().add(table).cast());
                let pixels = _mm512_permutexvar_epi32(index, table);
                _mm512_storeu_si512(
                    inherited.as_mut_ptr().add(listed).cast(),
                    _mm512_maskz_compress_epi32(contacts, pixels),
                );
            }
            begun += starts.count_ones() as usize;
            listed += contacts.count_ones() as usize;
        }
        let mut ends = links.ends[w].count_ones() as usize;
        let mut orphans = _pext_u64(links.orphans[w], links.ends[w]);
        while ends > 0 {
            let here = u16::MAX >> (16 - ends.min(16));
            let (fresh, heirs) = (orphans as u16 & here, !(orphans as u16) & here);
            // SAFETY: the load reads 16 elements from `taken`, which is not above the contacts; the store
            // writes 16 from `run`, which is below the runs.
            unsafe {
                let fresh_labels = _mm512_add_epi32(lanes, _mm512_set1_epi32(new as i32));
                let list = _mm512_loadu_si512(inherited.as_ptr().add(taken).cast());
                let both = _mm512_or_si512(
                    _mm512_maskz_expand_epi32(fresh, fresh_labels),
                    _mm512_maskz_expand_epi32(heirs, list),
                );
                _mm512_storeu_si512(labels.as_mut_ptr().add(run).cast(), both);
            }
            new += fresh.count_ones();
            taken += heirs.count_ones() as usize;
            run += ends.min(16);
            ends -= ends.min(16);
            orphans >>= 16;
        }
    }
    new - new_label
}

/// The label of a pixel is the entry of the table at the number of run starts up to it, counted by
/// `vpopcntd` for even pixels and for odd ones.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vpopcntdq,popcnt")]
fn paint_row(valid: &[u64], starts: &[u64], labels: &[u16], row: &mut [u16]) {
    assert!(labels.len() >= starts.len() * 64 + SLACK && valid.len() == starts.len());
    // SAFETY: both are 64 bytes.
    let [up_to_even, up_to_odd] =
        unsafe { [&UP_TO[0], &UP_TO[1]].map(|constant| _mm512_loadu_si512(constant.as_ptr().cast())) };
    let mut begun = 0; // runs begun before the block
    let mut block = |valid: u32, starts: u32| {
        // The table is read from the run of the block's first pixel, which leaves 31 others to count.
        let table = begun + (starts & 1) as usize;
        begun += starts.count_ones() as usize;
        let bits = _mm512_set1_epi32(starts as i32);
        let even = _mm512_popcnt_epi32(_mm512_and_si512(bits, up_to_even));
        let odd = _mm512_popcnt_epi32(_mm512_and_si512(bits, up_to_odd));
        let index = _mm512_or_si512(even, _mm512_slli_epi32::<16>(odd));
        // SAFETY: `table` is at most the pixels before the block; room for 32 more was checked above.
        let labels = unsafe { _mm512_loadu_si512(labels.as_ptr().add(table).cast()) };
        _mm512_maskz_permutexvar_epi16(valid, index, labels)
    };
    let (whole, rest) = row.as_chunks_mut::<64>();
    let mut masks = valid.iter().zip(starts);
    for (pixels, (&valid, &starts)) in whole.iter_mut().zip(masks.by_ref()) {
        for (half, pixels) in pixels.as_chunks_mut::<32>().0.iter_mut().enumerate() {
            let painted = block((valid >> (32 * half)) as u32, (starts >> (32 * half)) as u32);
            // SAFETY: 32 pixels of 2 bytes are 64 bytes.
            unsafe { _mm512_storeu_si512(pixels.as_mut_ptr().cast(), painted) };
        }
    }
    if let Some((&valid, &starts)) = masks.next() {
        for (half, pixels) in rest.chunks_mut(32).enumerate() {
            let painted = block((valid >> (32 * half)) as u32, (starts >> (32 * half)) as u32);
            // SAFETY: the masked store writes only pixels of the row.
            unsafe { _mm512_mask_storeu_epi16(pixels.as_mut_ptr().cast(), u32::MAX >> (32 - pixels.len()), painted) };
        }
    }
}
