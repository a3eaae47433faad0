//! Stage "group", third part: what was cut off from its plane goes to the one beside it.
//!
//! In: the region image and its groups. Out: fewer groups. The line where two planes meet goes on beyond the end of their
//! crease, and the plane of a small surface is not known well far from it: behind such a line a few pixels go to a plane
//! that they have no way to, though they lie on the one around them.

use super::field::Field;
use super::grid::limit;
use super::planes::{BENT, Planes};
use crate::group::{Grouper, Groups, Run, reserve_to};
use crate::parallel::{Numbered, in_parts};
use std::ops::Range;

/// Parts with nearly as many pixels each that strays are shared out to.
const PARTS: usize = 16;

/// Joins what was cut off; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Strays {
    /// Pixels of the map.
    pixels: usize,
    /// For each strip of the map its runs of small groups.
    by_strip: Vec<Vec<Run>>,
    /// All of them in raster order.
    runs: Vec<Run>,
    /// The same by group: the group, and behind it the run.
    by_group: Vec<u64>,
    parts: Vec<Part>,
    /// Groups that are one.
    pairs: Vec<[u32; 2]>,
}

/// Some strays.
#[derive(Debug, Default)]
struct Part {
    runs: Range<usize>,
    /// Labels and groups of the pixels beside a stray.
    beside: Vec<(u16, u32)>,
    /// The same labels, by how often they are there.
    often: Vec<(usize, u16)>,
    /// Groups that are one.
    pairs: Vec<[u32; 2]>,
}

/// What strays are held against.
struct Around<'a> {
    field: &'a Field,
    image: &'a [u16],
    planes: &'a Planes<'a>,
    groups: &'a Groups,
    min: u32,
}

impl Strays {
    /// Joins each group of at most `min` pixels that is less than half of its region to those of the region that it touches
    /// most, if it lies on that one's plane by the test of tiles. On as many threads.
    pub(super) fn join(
        &mut self,
        field: &Field,
        image: &[u16],
        planes: &Planes<'_>,
        min: u32,
        grouper: &mut Grouper,
        threads: usize,
    ) {
        self.list(field, min, grouper.groups(), threads);
        self.share_out(min);
        let Strays { runs, by_group, parts, pairs, .. } = self;
        let around = Around { field, image, planes, groups: grouper.groups(), min };
        let join = |parts: &mut [Part]| parts.iter_mut().for_each(|part| part.join(runs, by_group, &around));
        in_parts(threads, &mut parts[..], join, |(), ()| ());
        parts.iter().for_each(|part| pairs.extend(&part.pairs));
        grouper.unite(pairs);
    }

    /// Shares the strays out; where a single one may be large, they are all one part, which takes less memory.
    fn share_out(&mut self, min: u32) {
        let Strays { runs, by_group, parts, pixels, .. } = self;
        let largest = (*pixels).min(min as usize);
        let count = if largest > *pixels / PARTS { 1 } else { PARTS };
        let most = runs.iter().map(length).sum::<usize>().div_ceil(count);
        let mut rest = 0..runs.len();
        parts.resize_with(count, Part::default);
        for part in parts {
            let first = rest.start;
            let mut room = most;
            while room > 0 && !rest.is_empty() {
                let stray = group(by_group[rest.start]);
                while !rest.is_empty() && group(by_group[rest.start]) == stray {
                    room = room.saturating_sub(length(of(runs, by_group[rest.start])));
                    rest.start += 1;
                }
            }
            part.runs = first..rest.start;
            // A pixel has four neighbours.
            reserve_to(&mut part.beside, 4 * largest);
            reserve_to(&mut part.often, (4 * largest).min(BENT.into()));
            reserve_to(&mut part.pairs, 4 * (pixels.div_ceil(count) + largest));
        }
    }

    fn list(&mut self, field: &Field, min: u32, groups: &Groups, threads: usize) {
        let Strays { pixels, by_strip, runs, by_group, pairs, .. } = self;
        *pixels = field.width * field.height;
        reserve_to(runs, *pixels);
        reserve_to(by_group, *pixels);
        reserve_to(pairs, 4 * *pixels);
        let [strips, most] = groups.strips();
        by_strip.resize_with(strips, Vec::new);
        let list = |strips: Numbered<'_, Vec<Run>>| {
            for (strip, runs) in (strips.first..).zip(strips.all) {
                reserve_to(runs, most);
                groups.each_run_of(strip, |run| {
                    if groups.sizes()[run.group as usize] <= min {
                        runs.push(run);
                    }
                });
            }
        };
        in_parts(threads, Numbered { first: 0, all: &mut by_strip[..] }, list, |(), ()| ());
        by_strip.iter().for_each(|strip| runs.extend(strip));
        by_group.extend((0..).zip(&*runs).map(|(at, run): (u64, _)| u64::from(run.group) << 32 | at));
        by_group.sort_unstable();
    }
}

impl Part {
    fn join(&mut self, runs: &[Run], by_group: &[u64], around: &Around<'_>) {
        let &Around { field, image, planes, groups, min } = around;
        let Part { runs: range, beside, often, pairs } = self;
        let label = |run: &Run| image[run.v as usize * field.stride + run.u_first as usize];
        for stray in by_group[range.clone()].chunk_by(|a, b| group(*a) == group(*b)) {
            let (stray_group, own) = (group(stray[0]), label(of(runs, stray[0])));
            let pixels = f64::from(groups.sizes()[stray_group as usize]);
            if 2.0 * pixels >= planes.region(u32::from(own) - 1).sums.n {
                continue;
            }
            beside.clear();
            stray.iter().for_each(|&key| list_beside(field, image, own, of(runs, key), groups, beside));
            // Of two strays each may suit the other's plane.
            beside.retain(|&(_, group)| groups.sizes()[group as usize] > min);
            beside.sort_unstable();
            often.clear();
            often.extend(beside.chunk_by(|a, b| a.0 == b.0).map(|same| (same.len(), same[0].0)));
            often.sort_unstable_by(|a, b| b.cmp(a));
            let suits =
                |&&(_, label): &&(usize, u16)| lies_on(field, planes, label, stray.iter().map(|&key| of(runs, key)));
            if let Some(&(_, label)) = often.iter().find(suits) {
                let there = beside.iter().filter(|(other, _)| *other == label);
                pairs.extend(there.map(|&(_, group)| [stray_group, group]));
            }
        }
    }
}

/// The group of a key of [`Strays::by_group`].
fn group(key: u64) -> u32 {
    (key >> 32) as u32
}

/// Its run.
fn of(runs: &[Run], key: u64) -> &Run {
    &runs[key as u32 as usize]
}

fn length(run: &Run) -> usize {
    (run.u_last - run.u_first) as usize + 1
}

/// Lists the labels and groups of the pixels around a run that have other ones than its own.
fn list_beside(field: &Field, image: &[u16], own: u16, run: &Run, groups: &Groups, beside: &mut Vec<(u16, u32)>) {
    let (first, last, v) = (run.u_first as usize, run.u_last as usize, run.v as usize);
    let mut ask = |u: usize, v: usize| {
        let label = image[v * field.stride + u];
        if label != own && label != 0 && label != BENT {
            beside.push((label, groups.at([u, v])));
        }
    };
    if first > 0 {
        ask(first - 1, v);
    }
    if last + 1 < field.width {
        ask(last + 1, v);
    }
    for u in first..=last {
        if v > 0 {
            ask(u, v - 1);
        }
        if v + 1 < field.height {
            ask(u, v + 1);
        }
    }
}

/// Whether the pixels of some runs lie on a region's plane.
fn lies_on<'a>(field: &Field, planes: &Planes<'_>, label: u16, runs: impl Iterator<Item = &'a Run>) -> bool {
    let region = planes.region(u32::from(label) - 1);
    let [mut n, mut squares] = [0.0; 2];
    for run in runs {
        let row = run.v as usize * field.stride;
        for u in run.u_first..=run.u_last {
            let on_plane = region.at(u.into(), run.v.into());
            let off = f64::from(field.q[row + u as usize]) - on_plane;
            squares += off * off / planes.variance(region, on_plane);
            n += 1.0;
        }
    }
    squares <= f64::from(limit(n as f32, planes.confidence as f32))
}
