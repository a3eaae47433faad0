//! Patches of neighbouring blocks become regions (section 5 of Yang and Förstner).
//!
//! In: patches and which of them lie in neighbouring blocks. Out: regions. Two are merged if one plane describes both
//! in fewer bits: it saves a plane's bits and costs those of the larger distances. The pair that gains most goes
//! first. Pixels that are rounded alike err alike: together they tell no more of a plane than one (our addition).

use super::code::Code;
use crate::noise::Patch;
use crate::statistics::least_squares::Moments;
use crate::util::union_find::find;
use std::collections::BinaryHeap;

/// Pixels on one plane.
#[derive(Clone, Debug)]
pub(super) struct Region {
    sums: Moments,
    /// Lowest and highest column and row.
    low: [f64; 2],
    high: [f64; 2],
    pub(super) pixels: usize,
    /// Its plane, none if its pixels lie on a line.
    pub(super) plane: Option<[f64; 3]>,
    squares: f64,
    /// Regions in blocks beside its own, by number.
    pub(super) neighbours: Vec<usize>,
}

impl Region {
    /// A region without pixels.
    pub(super) fn new() -> Self {
        let (low, high) = ([f64::MAX; 2], [f64::MIN; 2]);
        Region { sums: Moments::default(), low, high, pixels: 0, plane: None, squares: 0.0, neighbours: Vec::new() }
    }

    pub(super) fn add(&mut self, pixel: &Moments, place: [f64; 2]) {
        self.join(pixel, place, place);
        self.pixels += 1;
    }

    fn join(&mut self, sums: &Moments, low: [f64; 2], high: [f64; 2]) {
        self.sums.merge(sums);
        for axis in [0, 1] {
            (self.low[axis], self.high[axis]) = (self.low[axis].min(low[axis]), self.high[axis].max(high[axis]));
        }
    }

    fn fit(&mut self) {
        let fit = self.sums.fit();
        self.plane = fit.as_ref().map(|fit| fit.abc);
        self.squares = fit.map_or(0.0, |fit| fit.rms * fit.rms * fit.n);
    }

    fn union(&self, other: &Region) -> Region {
        let mut both = self.clone();
        both.join(&other.sums, other.low, other.high);
        both.pixels += other.pixels;
        both.fit();
        both
    }

    /// How much of a plane's error is shared by its pixels: 1 where they err independently.
    fn shared(&self, code: &Code) -> f64 {
        let Some([a, b, _]) = self.plane else { return 1.0 };
        let extent = [0, 1].map(|axis| self.high[axis] - self.low[axis] + 1.0);
        code.shared(&Patch { gradient: [a, b], extent, pixels: self.pixels as f64 }, self.sums.q / self.sums.n)
    }
}

/// The regions and, for each patch, which of them it is part of. Patches come first and stay.
pub(super) fn merge(mut regions: Vec<Region>, code: &Code) -> (Vec<Region>, Vec<usize>) {
    let patches = regions.len();
    regions.iter_mut().for_each(Region::fit);
    for at in 0..patches {
        regions[at].neighbours.clone().into_iter().for_each(|other| regions[other].neighbours.push(at));
    }
    // Gains are above 0, and of such floats the larger has the larger bits.
    let gain = |a: &Region, b: &Region| {
        let both = a.union(b);
        let more = (both.squares - a.squares - b.squares) / a.shared(code).max(b.shared(code));
        let bits = code.plane() - code.bits(more);
        (both.plane.is_some() && bits > 0.0).then(|| bits.to_bits())
    };
    let mut parents: Vec<usize> = (0..patches).collect();
    let mut heap = BinaryHeap::new();
    for (a, region) in regions.iter().enumerate() {
        let later = region.neighbours.iter().filter(|&&b| b > a);
        heap.extend(later.filter_map(|&b| Some((gain(region, &regions[b])?, a, b))));
    }
    while let Some((_, a, b)) = heap.pop() {
        if parents[a] != a || parents[b] != b {
            continue;
        }
        let merged = regions.len();
        let [of_a, of_b] = [a, b].map(|part| std::mem::take(&mut regions[part].neighbours));
        let mut both = regions[a].union(&regions[b]);
        (parents[a], parents[b]) = (merged, merged);
        parents.push(merged);
        both.neighbours = of_a.into_iter().chain(of_b).map(|other| find(&parents, other)).collect();
        both.neighbours.sort_unstable();
        both.neighbours.dedup();
        both.neighbours.retain(|&other| other != merged);
        for &other in &both.neighbours {
            regions[other].neighbours.push(merged);
            heap.extend(gain(&both, &regions[other]).map(|gain| (gain, other, merged)));
        }
        regions.push(both);
    }
    for at in 0..regions.len() {
        let mut beside = std::mem::take(&mut regions[at].neighbours);
        beside.iter_mut().for_each(|other| *other = find(&parents, *other));
        beside.sort_unstable();
        beside.dedup();
        regions[at].neighbours = beside;
    }
    let region_of_patch = (0..patches).map(|patch| find(&parents, patch)).collect();
    (regions, region_of_patch)
}
