//! From labelled pixels to plane records: counts, boxes, least-squares planes, metric planes.
//!
//! In: the map and its labelled runs in raster order. Out: one [`Plane`] for each label. Two passes
//! over the labelled pixels only: the first sums, the second, where a camera is known, measures
//! distances from the fitted planes. Both are taken in parts of the map that threads share.

use super::distances::{Distances, Seen};
use super::least_squares::AffineFit;
use super::parts::{ByLabel, runs_of_parts};
use super::plane_sums::{Margin, PlaneSums, Sums, sum};
use crate::camera::ValueKind;
use crate::components::selection::LabelledRun;
use crate::detection::{MapFit, Plane, share};
use crate::limits::MAX_PLANES;
use crate::map::{DepthView, Pixel};
use crate::noise::NoiseModel;
use crate::sensor::Sensor;
use crate::util::memory::parts_of;
use crate::util::parallel::map_reduce;
use crate::util::simd::vectorised;
use std::ops::Range;

/// Describes planes; reuses its memory from map to map.
#[derive(Debug, Default)]
pub struct PlaneStatistics {
    parts: Vec<MapPart>,
    tallies: Vec<PlaneSums>,
    distances: Vec<Distances>,
}

/// What is summed in one part of the map.
#[derive(Debug, Default)]
struct MapPart {
    runs: Range<usize>,
    sums: ByLabel<Sums>,
    distances: ByLabel<Distances>,
}

impl PlaneStatistics {
    /// First pass, on `threads` threads. Labels are 1, 2, .. in `runs`, and none is left out.
    pub fn tally<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        runs: &[LabelledRun],
        margin: u32,
        sensor: &Sensor,
        threads: usize,
    ) {
        let inner = Margin { margin, width: map.width() as u32, height: map.height() as u32 };
        // Planes of depth maps are affine in inverse depth; all others in the map's own values.
        let inverse = match (sensor.intrinsics, sensor.value_kind) {
            (Some(_), ValueKind::Depth { metres }) => {
                let per_metre = 1.0 / metres;
                Some(move |value: T| per_metre / value.into())
            }
            _ => None,
        };
        let parts = self.each_part(map, runs, threads, |part, runs, room| {
            part.sums.clear(room);
            vectorised(
                #[inline(always)]
                || sum(&mut part.sums, map, runs, inverse, &inner),
            );
        });
        self.tallies.clear();
        self.tallies.reserve(MAX_PLANES.min(map.area()));
        for (label, sums) in self.parts[..parts].iter().flat_map(|part| part.sums.each()) {
            let at = usize::from(label) - 1;
            if at >= self.tallies.len() {
                self.tallies.resize_with(at + 1, PlaneSums::none);
            }
            self.tallies[at].add(sums);
        }
        self.tallies.iter_mut().for_each(|tally| tally.finish(sensor));
    }

    /// Calls `work` for each part of the map with the part's runs and how many labels to make room for, on `threads`
    /// threads: all parts together have room for as many as there can be. Returns how many parts there are.
    fn each_part<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        runs: &[LabelledRun],
        threads: usize,
        work: impl Fn(&mut MapPart, &[LabelledRun], usize) + Sync,
    ) -> usize {
        let count = runs_of_parts(runs, [map.width(), map.height()]).count();
        let parts = parts_of(&mut self.parts, count);
        let room = MAX_PLANES.min(map.area()).div_ceil(count);
        for (part, runs) in parts.iter_mut().zip(runs_of_parts(runs, [map.width(), map.height()])) {
            part.runs = runs;
        }
        let work_on = |parts: &mut [MapPart]| {
            for part in parts {
                let runs = &runs[part.runs.clone()];
                work(part, runs, room);
            }
        };
        map_reduce(threads, parts, work_on, |(), ()| ());
        count
    }

    /// The planes' sums; label 1 is the first.
    pub fn tallies(&self) -> &[PlaneSums] {
        &self.tallies
    }

    /// Drops the sums of some planes; the labels of the others move up.
    pub fn retain(&mut self, keep: impl FnMut(&PlaneSums) -> bool) {
        self.tallies.retain(keep);
    }

    /// Second pass, on `threads` threads: the records, in order of label. Shares are taken of the map's
    /// `valid_pixels`, covariances from the noise if it is known.
    pub fn describe<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        runs: &[LabelledRun],
        seen: &Seen<'_>,
        threads: usize,
        planes: &mut Vec<Plane>,
    ) {
        let Seen { sensor, valid_pixels, .. } = *seen;
        planes.clear();
        planes.reserve(self.tallies.capacity());
        self.distances.clear();
        match (sensor.intrinsics, sensor.value_kind) {
            (Some(camera), ValueKind::Depth { metres }) => {
                self.measure_distances(
                    map,
                    runs,
                    threads,
                    #[inline(always)]
                    |distances, run, values, plane| distances.add_depths(run, values, plane, metres),
                );
                for (distances, tally) in self.distances.iter_mut().zip(&self.tallies) {
                    distances.point = tally.points(metres, &camera);
                }
            }
            (Some(camera), ValueKind::InverseDepth { slope, offset }) => {
                let inverse_depth = |value: T| slope * value.into() + offset;
                self.measure_distances(
                    map,
                    runs,
                    threads,
                    #[inline(always)]
                    |distances, run, values, plane| {
                        distances.add_inverse_depths(run, values, plane, &camera, inverse_depth);
                    },
                );
            }
            _ => (),
        }
        planes.extend((1..).zip(&self.tallies).map(|(label, tally)| {
            let is_finite = |fit: &AffineFit| fit.abc.iter().chain([&fit.rms]).all(|number| number.is_finite());
            let fit = tally.fit.filter(is_finite);
            let fit = fit.map(|fit| MapFit { gradient: [fit.abc[0], fit.abc[1]], offset: fit.abc[2], rms: fit.rms });
            let metric = || self.distances.get(usize::from(label) - 1)?.metric(tally, seen);
            Plane {
                label,
                pixel_count: tally.pixel_count,
                share_of_valid: share(tally.pixel_count, valid_pixels),
                bounding_box: tally.bounding_box,
                centroid: tally.centroid,
                fit,
                metric: metric(),
            }
        }));
    }

    /// The noise, with an estimated smooth part made as large as the residuals of all planes together show it: the
    /// estimate from neighbouring cells misses what is smooth over far more than these.
    pub fn as_residuals_show(&self, noise: &NoiseModel, sensor: &Sensor) -> NoiseModel {
        if !noise.is_smooth_shown() {
            return *noise;
        }
        let squares = self.tallies.iter().filter_map(|tally| tally.known(sensor)?.smooth_squares(noise));
        let [shown, expected] = squares.fold([0.0; 2], |sum, squares| [0, 1].map(|i| sum[i] + squares[i]));
        if expected > 0.0 { noise.with_smooth_times((shown.max(0.0) / expected).sqrt()) } else { *noise }
    }

    /// Sums what the records need of every pixel's depth; `add` adds those of a run and its plane.
    fn measure_distances<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        runs: &[LabelledRun],
        threads: usize,
        add: impl Fn(&mut Distances, &LabelledRun, &[T], &AffineFit) + Sync,
    ) {
        let tallies = std::mem::take(&mut self.tallies);
        let parts = self.each_part(map, runs, threads, |part, runs, room| {
            part.distances.clear(room);
            vectorised(
                #[inline(always)]
                || {
                    for run in runs {
                        if let Some(plane) = &tallies[usize::from(run.label) - 1].inverse_depth {
                            let distances = part.distances.of(run.label, Distances::default);
                            add(distances, run, run.of(map), plane);
                        }
                    }
                },
            );
        });
        self.distances.reserve(tallies.capacity());
        self.distances.resize(tallies.len(), Distances::default());
        self.tallies = tallies;
        for (label, distances) in self.parts[..parts].iter().flat_map(|part| part.distances.each()) {
            self.distances[usize::from(label) - 1].merge(distances);
        }
    }
}
