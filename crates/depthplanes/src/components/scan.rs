//! From rows of a map to labelled runs, and how the labels of neighbouring strips become one.
//!
//! In: the rows of a strip. Out: its labelled runs; block by block of rows come the masks of their links, the runs in
//! these, and their labels.

use super::connectivity::Connectivity;
use super::isa::SLACK;
use super::isa::{Isa, Masked, RowMasks};
use super::labels::label_block;
use super::scratch::Scratch;
use super::strip::Strip;
use crate::map::DepthView;
use crate::util::bits::next_bit;
use crate::util::union_find::unite;
use std::ops::Range;

/// Labels a strip, block by block of rows: first its links, then its runs, their contacts, and a label for each run.
#[inline(always)]
pub(super) fn scan<I: Isa, T: Masked>(map: &DepthView<'_, T>, rule: &Connectivity<T>, strip: &mut Strip) {
    (strip.valid_pixels, strip.singles_left_out, strip.run_count) = (0, 0, 0);
    let (height, block_rows) = (strip.rows.len(), strip.block_rows());
    for first in (0..height).step_by(block_rows) {
        let block = first..(first + block_rows).min(height);
        find_links::<I, T>(map, rule, strip, &block);
        find_runs(strip, &block);
        strip.scratch.find_contacts::<I>(block.len() * strip.words, strip.words);
        label_block::<I>(strip, &block);
    }
}

/// Finds the links of a block's rows and of the row below, which show the pixels without any. Those of the block's
/// first row are known from the block above.
#[inline(always)]
fn find_links<I: Isa, T: Masked>(
    map: &DepthView<'_, T>,
    rule: &Connectivity<T>,
    strip: &mut Strip,
    block: &Range<usize>,
) {
    let (words, block_rows) = (strip.words, strip.block_rows());
    let Scratch { left, up, .. } = &mut strip.scratch;
    let known = block.start + usize::from(block.start > 0);
    if block.start > 0 {
        // The last two rows of the block above are the first two here.
        let last_two = block_rows * words..(block_rows + 2) * words;
        left.copy_within(last_two.clone(), 0);
        up.copy_within(last_two, 0);
    }
    let rows = known..(block.end + 1).min(strip.rows.len());
    let (start, at) = ((known + 1) * words, (known + 1 - block.start) * words);
    let (left, up) = (&mut left[at..][..rows.len() * words], &mut up[at..][..rows.len() * words]);
    let valid = &mut strip.valid[start..][..rows.len() * words];
    let rows_of_masks = valid.chunks_exact_mut(words).zip(left.chunks_exact_mut(words).zip(up.chunks_exact_mut(words)));
    for (row, (valid, (close_left, close_up))) in rows.clone().zip(rows_of_masks) {
        let v = strip.rows.start + row;
        T::masks::<I>(map.row(v), map.row(v.saturating_sub(1)), rule, RowMasks { valid, close_left, close_up });
    }
    // Both sides of a link are valid. Above the strip there is nothing.
    let all = &strip.valid[..start + left.len()];
    let (here, before, above) = (&all[start..], &all[start - 1..], &all[start - words..]);
    let (left, up) = (&mut left[..here.len()], &mut up[..here.len()]);
    let mut pixels = 0;
    for w in 0..here.len() {
        left[w] &= here[w] & (here[w] << 1 | before[w] >> 63);
        up[w] &= here[w] & above[w];
        pixels += u64::from(here[w].count_ones());
    }
    strip.valid_pixels += pixels as usize;
}

/// Runs of a block: one starts at each valid pixel that is not linked to its left, and ends before the
/// next pixel that is not.
#[inline(always)]
fn find_runs(strip: &mut Strip, block: &Range<usize>) {
    let (words, count) = (strip.words, block.len() * strip.words);
    let at = (block.start + 1) * words;
    let (valid, starts) = (&mut strip.valid[at..][..count], &mut strip.starts[at..][..count]);
    let Scratch { left, ends, .. } = &mut strip.scratch;
    let (left, next, ends) = (&left[words..][..count], &left[words + 1..][..count], &mut ends[..count]);
    for w in 0..count {
        starts[w] = valid[w] & !left[w];
        ends[w] = valid[w] & !(left[w] >> 1 | next[w] << 63);
    }
    if strip.leaves_out_singles {
        leave_out_singles(strip, block);
    }
    let (starts, before) = (&strip.starts[at..][..count], &mut strip.runs_before[at..][..count]);
    let mut runs = strip.run_count as u32;
    for w in 0..count {
        before[w] = runs;
        runs += starts[w].count_ones();
    }
    strip.run_count = runs as usize;
    if strip.labels.len() < 1 + strip.run_count + SLACK {
        strip.labels.resize(1 + strip.run_count + SLACK, 0);
    }
}

/// Marks pixels as missing that are a run of their own and linked neither up nor down: each is a group that nobody
/// asked for, and noise makes many. The strip's outer rows are left as they are, for they have links to other strips.
#[inline(always)]
fn leave_out_singles(strip: &mut Strip, block: &Range<usize>) {
    let words = strip.words;
    let inner = block.start.max(1)..block.end.min(strip.rows.len() - 1).max(1);
    let (at, from, count) = ((inner.start + 1) * words, (inner.start - block.start) * words, inner.len() * words);
    let (valid, starts) = (&mut strip.valid[at..][..count], &mut strip.starts[at..][..count]);
    let Scratch { up, ends, .. } = &mut strip.scratch;
    let (ends, up, below) =
        (&mut ends[from..][..count], &up[from + words..][..count], &up[from + 2 * words..][..count]);
    let mut singles = 0;
    for w in 0..count {
        let single = starts[w] & ends[w] & !(up[w] | below[w]);
        valid[w] ^= single;
        starts[w] ^= single;
        ends[w] ^= single;
        singles += u64::from(single.count_ones());
    }
    strip.singles_left_out += singles as usize;
}

/// Unites the labels on both sides of the border between two strips, in the forest of all strips.
#[inline(always)]
pub(super) fn stitch<I: Isa, T: Masked>(
    map: &DepthView<'_, T>,
    rule: &Connectivity<T>,
    upper: &Strip,
    lower: &mut Strip,
    forest: &mut [u32],
) {
    let (words, v) = (lower.words, lower.rows.start);
    let (here, there) = (lower.words_of(0), upper.words_of(upper.rows.len() - 1));
    let (starts, starts_above) = (&lower.starts[here.clone()], &upper.starts[there.clone()]);
    let (valid, valid_above) = (&lower.valid[here.clone()], &upper.valid[there.clone()]);
    let (here, there) = (here.start, there.start);
    // The last row of the upper strip is copied to where the row above a block stands.
    let Scratch { left, up, ends: unused, .. } = &mut lower.scratch;
    let (left_above, left) = left.split_at_mut(words);
    let (left, up) = (&mut left[..words], &mut up[words..][..words]);
    let masks = RowMasks { valid: &mut unused[..words], close_left: left, close_up: up };
    T::masks::<I>(map.row(v), map.row(v - 1), rule, masks);
    for w in 0..words {
        up[w] &= valid[w] & valid_above[w];
        left[w] = valid[w] & !starts[w];
        left_above[w] = valid_above[w] & !starts_above[w];
    }
    lower.scratch.find_contacts::<I>(words, words);
    for w in 0..words {
        let mut contacts = lower.scratch.contacts[words + w];
        while let Some(up_to) = next_bit(&mut contacts) {
            let here = lower.labels[lower.run_at(here + w, up_to)] + lower.first_label as u32;
            let there = upper.labels[upper.run_at(there + w, up_to)] + upper.first_label as u32;
            unite(forest, here, there);
        }
    }
}
