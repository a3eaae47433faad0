//! Provisional labels for the runs of a block of rows, from where they touch the runs above.
//!
//! In: the block's links and run starts, and the labels of the row above. Out: a label for each run. Only the first
//! pixel of each touching pair of runs matters. At its first such contact a run takes the label above without any
//! search, since it has none until then; each of the few later contacts unites two labels.

use super::isa::{Isa, Links};
use super::scratch::Scratch;
use super::strip::Strip;
use crate::util::bits::next_bit;
use crate::util::union_find::unite;
use std::hint::select_unpredictable;
use std::ops::Range;

/// A row is dense if it has more runs than one in this many pixels. From there on labelling many runs at a time pays;
/// measured at 6, 10 and 16, which differ by at most 6 % on any of six frames.
const DENSE: usize = 6;

/// Labels the runs of a block: dense rows one by one, the rows between them together.
#[inline(always)]
pub(super) fn label_block<I: Isa>(strip: &mut Strip, block: &Range<usize>) {
    let orphans = &strip.scratch.orphans[..block.len() * strip.words];
    let orphans: u64 = orphans.iter().map(|word| u64::from(word.count_ones())).sum();
    let mut new_label = strip.forest.len() as u32;
    strip.forest.extend(new_label..new_label + orphans as u32);
    strip.sizes.resize(strip.forest.len(), 0);
    let mut rows = block.start..block.start;
    while rows.start < block.end {
        while rows.end < block.end && !(I::HAS_DENSE_LABELS && strip.runs_of(rows.end).len() * DENSE > strip.width) {
            rows.end += 1;
        }
        if rows.is_empty() {
            rows.end += 1;
            dense_labels::<I>(strip, block, rows.start, &mut new_label);
        } else {
            sparse_labels(strip, block, &rows, &mut new_label);
        }
        rows.start = rows.end;
    }
}

/// Labels the runs of a row, many at a time.
#[inline(always)]
fn dense_labels<I: Isa>(strip: &mut Strip, block: &Range<usize>, row: usize, new_label: &mut u32) {
    let (words, here, runs) = (strip.words, strip.words_of(row), strip.runs_of(row));
    let above = here.start - words..here.start;
    let at = (row - block.start) * words;
    let Scratch { marks, orphans, ends, columns, inherited, .. } = &mut strip.scratch;
    let [marks, orphans, ends] = [marks, orphans, ends].map(|masks| &masks[at..][..words]);
    let links = Links { marks, orphans, ends, starts_above: &strip.starts[above.clone()] };
    let (labels_above, labels_here) = strip.labels.split_at_mut(runs.start);
    let labels_above = &labels_above[strip.runs_before[above.start] as usize..];
    *new_label += I::dense_labels(&links, labels_above, inherited, labels_here, *new_label);
    I::positions([&strip.starts[here], ends], runs.len(), columns);
    let [first_columns, last_columns] = columns;
    for (&label, (first, last)) in strip.labels[runs].iter().zip(first_columns.iter().zip(last_columns)) {
        strip.sizes[label as usize] += u32::from(*last - *first) + 1;
    }
    unite_later_contacts(strip, block, &(row..row + 1));
}

/// Labels the runs of some rows of a block one by one, in the order of their marks.
#[inline(always)]
fn sparse_labels(strip: &mut Strip, block: &Range<usize>, rows: &Range<usize>, new_label: &mut u32) {
    let (words, count) = (strip.words, rows.len() * strip.words);
    let (here, at) = (strip.words_of(rows.start).start, (rows.start - block.start) * words);
    let first_run = strip.runs_of(rows.start).start;
    let labels = &mut strip.labels[..];
    let [marks, orphans, ends] =
        [&strip.scratch.marks, &strip.scratch.orphans, &strip.scratch.ends].map(|masks| &masks[at..][..count]);
    let (starts_above, before_above) =
        (&strip.starts[here - words..][..count], &strip.runs_before[here - words..][..count]);
    let (mut run, mut next_label) = (first_run, *new_label);
    let above = starts_above.iter().zip(before_above);
    for ((&marks, &orphans), (starts_above, before_above)) in marks.iter().zip(orphans).zip(above) {
        let mut rest = marks;
        while rest != 0 {
            let is_new = orphans & rest & rest.wrapping_neg() != 0;
            let up_to = rest ^ (rest - 1);
            let inherited = labels[(before_above + (starts_above & up_to).count_ones()) as usize];
            labels[run] = select_unpredictable(is_new, next_label, inherited);
            next_label += u32::from(is_new);
            run += 1;
            rest &= rest - 1;
        }
    }
    *new_label = next_label;
    // Between the ends of two runs all valid pixels are the second one's.
    let (labels, sizes) = (&strip.labels[first_run..run], &mut strip.sizes[..]);
    let (mut labels, mut pixels, mut counted) = (labels.iter(), 0, 0);
    for (&ends, &valid) in ends.iter().zip(&strip.valid[here..][..count]) {
        let mut rest = ends;
        while rest != 0 {
            let &label = labels.next().expect("as many ends as marks");
            let up_to_end = pixels + (valid & (rest ^ (rest - 1))).count_ones();
            sizes[label as usize] += up_to_end - counted;
            counted = up_to_end;
            rest &= rest - 1;
        }
        pixels += valid.count_ones();
    }
    unite_later_contacts(strip, block, rows);
}

/// Unites labels where runs touch each other after a run's first contact.
#[inline(always)]
fn unite_later_contacts(strip: &mut Strip, block: &Range<usize>, rows: &Range<usize>) {
    let (words, count) = (strip.words, rows.len() * strip.words);
    let (here, at) = (strip.words_of(rows.start).start, (rows.start - block.start) * words);
    let (contacts, marks) = (&strip.scratch.contacts[at + words..][..count], &strip.scratch.marks[at..][..count]);
    for (eight, (contacts, marks)) in (0..).step_by(8).zip(contacts.chunks(8).zip(marks.chunks(8))) {
        if contacts.iter().zip(marks).fold(0, |any, (contacts, marks)| any | contacts & !marks) == 0 {
            continue;
        }
        for (w, (contacts, marks)) in (here + eight..).zip(contacts.iter().zip(marks)) {
            let mut later = contacts & !marks;
            while let Some(up_to) = next_bit(&mut later) {
                let [here, above] = [w, w - words].map(|w| strip.labels[strip.run_at(w, up_to)]);
                unite(&mut strip.forest, here, above);
            }
        }
    }
}
