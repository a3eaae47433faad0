//! Neighbour grouping (paper, section 3c): the 4-connected components of the links between valid
//! neighbours whose values differ by at most theta.
//!
//! In: a map and theta. Out: [`Groups`], every valid pixel in exactly one group. Why runs of linked
//! pixels instead of pixels: links of a row fit 64 to a machine word, so a row costs a few vector
//! instructions and only the places where a run first touches a run above cost a step each. The
//! answer is the same for every kernel and any number of threads, since components do not depend on
//! the order of unions and groups are numbered by their first pixel.
//!
//! How: `strip::scan` turns a strip of rows into runs and a forest of them, `strip::stitch` joins the
//! strips, `forest::flatten` numbers the groups and adds up their sizes.

mod forest;
mod kernels;
mod strip;

use crate::error::{Error, Result};
use crate::map::{DepthView, Pixel, Validity};
pub(crate) use kernels::SLACK;
pub(crate) use kernels::{Compiled, Isa};
pub use kernels::{Kernel, kernels};
pub(crate) use strip::RowMasks;
use strip::Strip;

/// When two neighbours are linked: both valid, values at most `theta` apart.
#[derive(Clone, Copy, Debug)]
pub struct LinkRule<T> {
    /// Which values count. For integers `low` is at least 1, so that the range rules out 0.
    pub(crate) validity: Validity<T>,
    /// Largest difference. Integer maps: theta rounded down, which links the same pixels; `f32`
    /// maps: the nearest `f32`.
    pub(crate) theta: T,
}

impl<T: Pixel> LinkRule<T> {
    /// The rule for a map and a theta in map units.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless theta is a number of at least 0.
    pub fn new(mut validity: Validity<T>, theta: f64) -> Result<Self> {
        if T::IS_INTEGER && validity.low == T::ZERO {
            validity.low = T::from_f64(1.0);
        }
        if theta >= 0.0 {
            Ok(LinkRule { validity, theta: T::floor_from(theta) })
        } else {
            Err(Error::Parameter { name: "theta", given: theta, accepted: "a number from 0 up, in map units".into() })
        }
    }

    /// Whether two values are at most theta apart.
    #[inline(always)]
    pub(crate) fn close(&self, a: T, b: T) -> bool {
        a.distance(b) <= self.theta
    }
}

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
pub struct Grouper {
    groups: Groups,
}

impl Default for Grouper {
    fn default() -> Self {
        Self::with_kernel(Kernel::best())
    }
}

impl Grouper {
    /// A grouper on the fastest kernel that this processor runs.
    pub fn new() -> Self {
        Self::default()
    }

    /// A grouper on a certain kernel of [`kernels`].
    pub fn with_kernel(kernel: &'static Kernel) -> Self {
        let (strips, group_of_run, sizes) = Default::default();
        Grouper { groups: Groups { kernel, width: 0, height: 0, strips, group_of_run, sizes } }
    }

    /// Groups one map on `threads` threads (0 counts as 1; one without the feature `parallel`).
    ///
    /// ```
    /// use depthplanes::{DepthView, group::{Grouper, LinkRule}};
    /// let map: [u8; 8] = [
    ///     10, 11, 30, 31,
    ///      0, 12, 29,  0,
    /// ];
    /// let view = DepthView::new(&map, 4, 2)?;
    /// let mut grouper = Grouper::new();
    /// let groups = grouper.group(&view, &LinkRule::new(view.validity(), 1.0)?, 1);
    /// assert_eq!(groups.count(), 2);
    /// assert_eq!(groups.valid_pixels(), 6);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn group<T: Pixel>(&mut self, map: &DepthView<'_, T>, rule: &LinkRule<T>, threads: usize) -> &Groups {
        let groups = &mut self.groups;
        groups.prepare(map, threads);
        groups.scan_strips(map, rule);
        groups.join_strips(map, rule);
        forest::flatten(&mut groups.group_of_run, &mut groups.sizes, &groups.strips);
        groups
    }

    /// The groups of the last map.
    pub fn groups(&self) -> &Groups {
        &self.groups
    }
}

/// Runs `work` on each item; on several threads if there are several items.
fn in_parallel<I: Send>(items: &mut [I], work: impl Fn(&mut I) + Send + Sync) {
    match items {
        [only] => work(only),
        #[cfg(feature = "parallel")]
        many => {
            use rayon::prelude::*;
            many.par_iter_mut().for_each(work);
        }
        #[cfg(not(feature = "parallel"))]
        many => many.iter_mut().for_each(work),
    }
}

/// Fewest rows that are worth a strip of their own.
const LEAST_STRIP_ROWS: usize = 32;

/// The groups of a map: its runs, and for each the group it belongs to.
#[derive(Debug)]
pub struct Groups {
    kernel: &'static Kernel,
    width: usize,
    height: usize,
    strips: Vec<Strip>,
    /// For each run, in raster order, its parent in the forest, and after flattening its group.
    group_of_run: Vec<u32>,
    /// The pixels of each group.
    sizes: Vec<u32>,
}

impl Groups {
    fn prepare<T: Pixel>(&mut self, map: &DepthView<'_, T>, threads: usize) {
        (self.width, self.height) = (map.width(), map.height());
        let threads = if cfg!(feature = "parallel") { threads } else { 1 };
        let count = threads.clamp(1, self.height.div_ceil(LEAST_STRIP_ROWS));
        self.strips.resize_with(count, Strip::default);
        for (k, strip) in self.strips.iter_mut().enumerate() {
            let rows = self.height * k / count..self.height * (k + 1) / count;
            strip.prepare(self.width, rows);
        }
        let most_runs = self.width * self.height;
        reserve_to(&mut self.group_of_run, most_runs);
        reserve_to(&mut self.sizes, most_runs + 1);
    }

    /// Scans each strip, side by side where threads are to be had.
    fn scan_strips<T: Pixel>(&mut self, map: &DepthView<'_, T>, rule: &LinkRule<T>) {
        let kernel = self.kernel;
        in_parallel(&mut self.strips, |strip| kernel.scan(map, rule, strip));
    }

    /// One forest from the strips' forests: appended, then united along the borders.
    fn join_strips<T: Pixel>(&mut self, map: &DepthView<'_, T>, rule: &LinkRule<T>) {
        if let [only] = &mut self.strips[..] {
            std::mem::swap(&mut self.group_of_run, &mut only.parent);
            return;
        }
        self.group_of_run.clear();
        for strip in &mut self.strips {
            let offset = self.group_of_run.len() as u32;
            strip.first_run = offset;
            self.group_of_run.extend(strip.parent.iter().map(|parent| parent + offset));
        }
        for k in 1..self.strips.len() {
            let (above, below) = self.strips.split_at_mut(k);
            self.kernel.stitch(map, rule, &above[k - 1], &mut below[0], &mut self.group_of_run);
        }
    }

    /// Columns of the map.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows of the map.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Valid pixels of the map, which is the sum of all groups' sizes.
    pub fn valid_pixels(&self) -> usize {
        self.strips.iter().map(|strip| strip.valid_pixels).sum()
    }

    /// How many groups there are.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// How many runs there are.
    pub fn run_count(&self) -> usize {
        self.group_of_run.len()
    }

    /// All runs in raster order.
    pub fn runs(&self) -> impl Iterator<Item = Run> + '_ {
        self.strips.iter().flat_map(|strip| strip.runs(&self.group_of_run))
    }

    /// The pixels of each group, in raster order of the groups' first pixels.
    pub fn sizes(&self) -> &[u32] {
        &self.sizes
    }

    /// For each run in raster order its group.
    pub fn group_of_run(&self) -> &[u32] {
        &self.group_of_run
    }

    /// Writes an image, `width * height`, in which every pixel of run i, counted from 1, is `labels[i]`
    /// and every missing pixel is 0. `labels` has [`SLACK`] entries to spare at its end.
    pub(crate) fn paint(&self, labels: &[u16], image: &mut [u16]) {
        assert_eq!(image.len(), self.width * self.height);
        let paint = |strip: &Strip, part: &mut [u16]| {
            self.kernel.paint(strip, &labels[strip.first_run as usize..], part);
        };
        if let [only] = &self.strips[..] {
            return paint(only, image);
        }
        #[cfg(feature = "parallel")]
        rayon::scope(|scope| {
            let mut rest = image;
            for strip in &self.strips {
                let (part, after) = rest.split_at_mut(strip.rows.len() * self.width);
                scope.spawn(move |_| paint(strip, part));
                rest = after;
            }
        });
    }
}

/// Makes room for `capacity` elements once and for all. Pages that are never written stay unmapped,
/// so the worst case costs address space, not memory.
pub(crate) fn reserve_to<T>(vec: &mut Vec<T>, capacity: usize) {
    vec.clear();
    vec.reserve(capacity);
}
