//! Groups of a map, strip by strip on several threads.
//!
//! In: a map, and the rule for which neighbours are linked. Out: [`Groups`], the connected components.

use super::connectivity::Connectivity;
use super::kernels::{Compiles, Kernel, best};
use super::strip::Strip;
use crate::map::DepthView;
use crate::util::memory::reserve_to;
use crate::util::union_find::{flatten, unite};
#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// A maximal stretch of one row whose neighbours are all linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Row.
    pub v: u32,
    /// First column.
    pub u_first: u32,
    /// Last column, inclusive.
    pub u_last: u32,
    /// The group it belongs to, counted from 0 in raster order of first pixels.
    pub group: u32,
}

/// Groups maps; reuses its memory from map to map of one size.
#[derive(Debug)]
pub struct ConnectedComponents {
    groups: Groups,
}

impl Default for ConnectedComponents {
    fn default() -> Self {
        Self::with_kernel(best())
    }
}

impl ConnectedComponents {
    /// Connected components on the fastest kernel that this processor runs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Connected components on a certain kernel of `kernels`.
    pub fn with_kernel(kernel: &'static Kernel) -> Self {
        ConnectedComponents { groups: Groups::new(kernel) }
    }

    /// Whether groups of a single pixel may be left out, which saves time on noisy maps. Some are then
    /// neither counted nor listed; they remain valid pixels.
    pub fn leave_out_singles(&mut self, yes: bool) {
        self.groups.leaves_out_singles = yes;
    }

    /// Groups one map on `threads` threads (0 counts as 1; one without the feature `parallel`).
    ///
    /// ```
    /// use depthplanes::{DepthView, internals::{ConnectedComponents, Connectivity}};
    /// let map: [u8; 8] = [
    ///     10, 11, 30, 31,
    ///      0, 12, 29,  0,
    /// ];
    /// let view = DepthView::new(&map, 4, 2)?;
    /// let mut components = ConnectedComponents::new();
    /// let groups = components.group(&view, &Connectivity::new(view.validity(), 1.0)?, 1);
    /// assert_eq!(groups.count(), 2);
    /// assert_eq!(groups.valid_pixels(), 6);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn group<T: Compiles>(&mut self, map: &DepthView<'_, T>, rule: &Connectivity<T>, threads: usize) -> &Groups {
        let groups = &mut self.groups;
        groups.prepare(map, threads);
        groups.scan_strips(map, rule);
        groups.join_strips(map, rule);
        groups
    }

    /// Unites pairs of groups of the last map.
    pub(crate) fn unite(&mut self, pairs: &[[u32; 2]]) {
        if !pairs.is_empty() {
            self.groups.unite(pairs);
        }
    }

    /// The groups of the last map.
    pub fn groups(&self) -> &Groups {
        &self.groups
    }
}

/// Pixels of a strip, about: enough for the joining not to matter, few enough for threads to share.
const STRIP_PIXELS: usize = 1 << 19;

/// The groups of a map: its runs, and for each the group it belongs to.
#[derive(Debug)]
pub struct Groups {
    kernel: &'static Kernel,
    leaves_out_singles: bool,
    threads: usize,
    width: usize,
    height: usize,
    strips: Vec<Strip>,
    /// For each provisional label, strip after strip: its parent while strips are joined, afterwards its group.
    group_of_label: Vec<u32>,
    /// The pixels of each group.
    sizes: Vec<u32>,
    /// For each group, another that it is united with, or itself.
    parents: Vec<u32>,
}

impl Groups {
    fn new(kernel: &'static Kernel) -> Self {
        let (strips, group_of_label, sizes, parents) = Default::default();
        let [width, height] = [0; 2];
        Groups { kernel, leaves_out_singles: false, threads: 1, width, height, strips, group_of_label, sizes, parents }
    }

    fn prepare<T: Compiles>(&mut self, map: &DepthView<'_, T>, threads: usize) {
        (self.width, self.height, self.threads) = (map.width(), map.height(), threads);
        let height = (STRIP_PIXELS / self.width).clamp(1, self.height);
        self.strips.resize_with(self.height.div_ceil(height), Strip::default);
        for (strip, first) in self.strips.iter_mut().zip((0..).step_by(height)) {
            strip.leaves_out_singles = self.leaves_out_singles;
            strip.prepare(self.width, first..(first + height).min(self.height));
        }
        reserve_to(&mut self.group_of_label, map.area());
        reserve_to(&mut self.sizes, map.area());
        reserve_to(&mut self.parents, map.area());
    }

    fn unite(&mut self, pairs: &[[u32; 2]]) {
        let Groups { group_of_label, sizes, parents, .. } = self;
        parents.clear();
        parents.extend(0..sizes.len() as u32);
        pairs.iter().for_each(|&[a, b]| unite(parents, a, b));
        flatten(parents, sizes);
        group_of_label.iter_mut().for_each(|group| *group = parents[*group as usize]);
    }

    /// The provisional labels of each strip.
    fn scan_strips<T: Compiles>(&mut self, map: &DepthView<'_, T>, rule: &Connectivity<T>) {
        let kernel = self.kernel;
        #[cfg(feature = "parallel")]
        if self.threads > 1 {
            let share = self.strips.len().div_ceil(self.threads);
            let shares = self.strips.par_chunks_mut(share);
            return shares.for_each(|share| share.iter_mut().for_each(|strip| kernel.scan(map, rule, strip)));
        }
        self.strips.iter_mut().for_each(|strip| kernel.scan(map, rule, strip));
    }

    /// Groups from the strips' labels, united along the borders.
    fn join_strips<T: Compiles>(&mut self, map: &DepthView<'_, T>, rule: &Connectivity<T>) {
        let (forest, sizes) = (&mut self.group_of_label, &mut self.sizes);
        if let [only] = &mut self.strips[..] {
            std::mem::swap(forest, &mut only.forest);
            std::mem::swap(sizes, &mut only.sizes);
        } else {
            for strip in &mut self.strips {
                strip.first_label = forest.len();
                let offset = forest.len() as u32;
                forest.extend(strip.forest.iter().map(|parent| parent + offset));
                sizes.extend_from_slice(&strip.sizes);
            }
        }
        for k in 1..self.strips.len() {
            let (above, below) = self.strips.split_at_mut(k);
            self.kernel.stitch(map, rule, &above[k - 1], &mut below[0], forest);
        }
        flatten(forest, sizes);
    }

    /// Columns of the map.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows of the map.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Valid pixels of the map, which is the sum of all groups' sizes and the singles left out.
    pub fn valid_pixels(&self) -> usize {
        self.strips.iter().map(|strip| strip.valid_pixels).sum()
    }

    /// How many groups of a single pixel were left out ([`ConnectedComponents::leave_out_singles`]).
    pub fn singles_left_out(&self) -> usize {
        self.strips.iter().map(|strip| strip.singles_left_out).sum()
    }

    /// How many groups there are, without the singles left out.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// How many runs there are.
    pub fn run_count(&self) -> usize {
        self.strips.iter().map(|strip| strip.run_count).sum()
    }

    /// Calls `visit` for each run in raster order.
    pub fn each_run(&self, mut visit: impl FnMut(Run)) {
        (0..self.strips.len()).for_each(|strip| self.each_run_of(strip, &mut visit));
    }

    /// Calls `visit` for each run of a strip in raster order.
    pub(crate) fn each_run_of(&self, strip: usize, mut visit: impl FnMut(Run)) {
        let strip = &self.strips[strip];
        let groups = &self.group_of_label[strip.first_label..];
        strip.each_run(|v, u_first, u_last, label| {
            visit(Run { v: v as u32, u_first, u_last, group: groups[label as usize] });
        });
    }

    /// Masks of row `v`, column u in bit u % 64 of word u / 64: its valid pixels, and the pixels where runs start.
    /// Rows beyond the map have empty masks.
    #[inline(always)]
    pub(crate) fn masks(&self, v: usize) -> [&[u64]; 2] {
        let strip = match &self.strips[..] {
            [only] => Some(only), // without a division
            strips => strips.get(v / strips[0].rows.len()),
        };
        match strip {
            Some(strip) if strip.rows.contains(&v) => {
                let words = strip.words_of(v - strip.rows.start);
                [&strip.valid[words.clone()], &strip.starts[words]]
            }
            _ => [&[]; 2],
        }
    }

    /// The group of the pixel in column `u`, row `v`, which has to be valid and must not be a single that was left out.
    #[inline(always)]
    pub(crate) fn at(&self, [u, v]: [usize; 2]) -> u32 {
        let strip = match &self.strips[..] {
            [only] => only, // without a division
            strips => &strips[v / strips[0].rows.len()],
        };
        let word = strip.words_of(v - strip.rows.start).start + u / 64;
        let label = strip.labels[strip.run_at(word, u64::MAX >> (63 - u % 64))];
        self.group_of_label[strip.first_label + label as usize]
    }

    /// The pixels of each group, in raster order of the groups' first pixels.
    pub fn sizes(&self) -> &[u32] {
        &self.sizes
    }

    /// Writes an image, `width * height`: each pixel the label of its group, each missing pixel 0.
    /// `label_of_provisional` is memory to work in.
    pub(crate) fn paint(&self, label_of_group: &[u16], label_of_provisional: &mut Vec<u16>, image: &mut [u16]) {
        assert_eq!(image.len(), self.width * self.height);
        label_of_provisional.clear();
        label_of_provisional.extend(self.group_of_label.iter().map(|&group| label_of_group[group as usize]));
        let paint = |(strip, part): (&Strip, &mut [u16])| {
            self.kernel.paint(strip, &label_of_provisional[strip.first_label..], part);
        };
        let part = self.strips[0].rows.len() * self.width;
        #[cfg(feature = "parallel")]
        if self.threads > 1 {
            let share = self.strips.len().div_ceil(self.threads);
            let shares = self.strips.par_chunks(share).zip(image.par_chunks_mut(share * part));
            return shares.for_each(|(strips, share)| strips.iter().zip(share.chunks_mut(part)).for_each(paint));
        }
        self.strips.iter().zip(image.chunks_mut(part)).for_each(paint);
    }
}
