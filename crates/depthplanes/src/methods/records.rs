//! What may happen to the records of planes after the fit: coplanar ones are joined, small ones dropped.
//!
//! In: selected groups and their records. Out: the records that remain, and the selection with their labels, which
//! stay 1.. by decreasing pixel count.

use crate::components::Groups;
use crate::components::selection::Selection;
use crate::coplanar::Joiner;
use crate::detection::{Detection, Plane};
use crate::map::{DepthView, Pixel};
use crate::statistics::{PlaneStatistics, Seen};

/// The planes of a map and all that their records are made of.
pub(crate) struct Records<'a, T> {
    pub(crate) map: &'a DepthView<'a, T>,
    pub(crate) groups: &'a Groups,
    pub(crate) margin: u32,
    pub(crate) seen: Seen<'a>,
    pub(crate) threads: usize,
    pub(crate) selection: &'a mut Selection,
    pub(crate) statistics: &'a mut PlaneStatistics,
}

impl<T: Pixel> Records<'_, T> {
    /// Joins coplanar planes, if that is wanted, and fits their unions anew from all pixels.
    pub(crate) fn join(&mut self, joiner: Option<&mut Joiner>, out: &mut Detection) {
        let Records { map, groups, margin, seen, threads, selection, statistics } = self;
        let Some(joiner) = joiner else { return };
        let is_any_joined = joiner.join(&out.planes, selection.runs(groups));
        joiner.parts(&out.planes, &mut out.parts);
        if !is_any_joined {
            return;
        }
        selection.relabel(|label| joiner.labels()[usize::from(label) - 1]);
        let runs = selection.runs(groups);
        statistics.tally(map, runs, *margin, seen.sensor, *threads);
        statistics.describe(map, runs, seen, *threads, &mut out.planes);
    }

    /// Drops planes of less than an area in square metres, and planes that are not known in metres. One that reaches
    /// infinity has no area and stays.
    pub(crate) fn drop_smaller(&mut self, area_m2: f64, out: &mut Detection) {
        let is_large = |plane: &Plane| {
            let metric = plane.metric.as_ref();
            metric.is_some_and(|metric| metric.area_m2.is_none_or(|area| area >= area_m2))
        };
        let mut labels = 1..;
        for plane in &mut out.planes {
            plane.label = if is_large(plane) { labels.next().expect("no more than before") } else { 0 };
        }
        let new = |label: u16| out.planes[usize::from(label) - 1].label;
        self.selection.relabel(new);
        out.parts.iter_mut().for_each(|part| part.of = new(part.of));
        out.parts.retain(|part| part.of > 0);
        out.planes.retain(|plane| plane.label > 0);
    }
}
