//! Maps with more pixels than measurements are worked on at the size at which they were measured.
//!
//! In: a map. Out: its detection. The stages see what the map was measured at ([`Reduced`]), by a camera of as many pixels.
//! What was found is painted on the whole map: for each pixel that was repeated the label of its source pixel, for each
//! that was measured the nearest of the planes around its bin. There it is grouped, selected and fitted, so that
//! `min-pixels`, areas and places are those of the map that was given. Repeated pixels say no more than one: errors of
//! planes are those of the source's pixels.

use super::explain::explain;
use super::parameters::Planar;
use super::pipeline::Runner;
use crate::camera::Intrinsics;
use crate::components::ConnectedComponents;
use crate::detection::Detection;
use crate::error::Result;
use crate::explanation::{Explanation, Suggestion, Verdict};
use crate::limits::MAX_PLANES;
use crate::map::{DepthView, Pixel};
use crate::methods::extraction::{STAGES, Wanted};
use crate::methods::method::{Job, MethodInfo};
use crate::methods::reduced::{Pieces, Reduced, ReducedFinder, paint};
use crate::methods::spread::Spreader;
use crate::methods::tries::Tries;
use crate::noise::scales::RAY;
use crate::noise::{Enlargement, NoiseModel, Space};
use crate::sensor::Sensor;
use crate::util::memory::reserve_to;

/// Fewest pixels of the source that are asked of a plane: those of a tile. `min-pixels` may be less than that.
const TILE: u32 = 16;

/// The source of a map and what was found in it; reuses its memory.
#[derive(Default)]
pub(super) struct Source {
    finder: ReducedFinder,
    /// One value a source pixel; single precision holds integers of 16 bits exactly.
    pixels: Vec<f32>,
    found: Detection,
    /// Labels of the source on the whole map.
    image: Vec<u16>,
    spreader: Spreader,
    pieces: Pieces,
}

impl Source {
    /// Makes room for the sources of maps of so many pixels, whichever frame is the first that has one.
    fn reserve(&mut self, area: usize) {
        let Source { pixels, found, image, spreader, pieces, .. } = self;
        reserve_to(pixels, area);
        reserve_to(image, area);
        reserve_to(&mut found.labels, area);
        reserve_to(&mut found.planes, area.min(MAX_PLANES));
        spreader.reserve(area);
        pieces.reserve(area);
    }

    /// Finds planes in a map, reduced or not.
    ///
    /// # Errors
    /// As [`crate::Detector::detect`].
    pub(super) fn run<T: Pixel>(
        &mut self,
        runner: &mut Runner,
        map: &DepthView<'_, T>,
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        self.reserve(map.area());
        let Source { finder, pixels, found, image, spreader, pieces } = self;
        let Some(reduced) = finder.find(map) else { return runner.planar(*map, job, out, &mut |_, _, _| ()) };
        let Planar { min_pixels, min_area, inlier_threshold, .. } = runner.params;
        if min_area > 0.0 {
            job.sensor.check_metric("min-area")?;
        }
        let mut noise = None;
        let view = reduced.source(map, pixels)?;
        with_source(runner, job, &reduced, |runner, job| {
            runner.params.min_area = 0.0;
            runner.planar(view, job, found, &mut |_, _, seen| noise = Some(*seen))
        })?;
        let noise = noise.map(|noise| of_whole(noise, &reduced, &runner.params));
        let labels = match (&reduced, &noise) {
            (Reduced::Sparse(sparse), Some(noise)) => {
                let space = Space::of(job.sensor.value_kind);
                spreader.spread(map, space, sparse, &found.labels, noise, inlier_threshold, image);
                DepthView::new(&image[..], map.width(), map.height())?.valid_range(1, u16::MAX)?
            }
            _ => paint(&found.labels, &reduced, map, image)?,
        };
        let wanted = Wanted { min_pixels, min_area, noise: noise.as_ref(), valid_pixels: map.valid_pixels() };
        // The source is done with it.
        let extraction = &mut runner.extraction;
        extraction.extract_united(map, &labels, &wanted, |components| pieces.join(&labels, components), job, out)?;
        if let Reduced::Repeated(enlargement) = &reduced {
            errors_of_source(found, labels, enlargement, out);
        }
        let old = out.curved.take();
        if let Some(curved) = &found.curved {
            paint(&curved.labels, &reduced, map, image)?;
            image.iter_mut().zip(&out.labels).filter(|(_, label)| **label > 0).for_each(|(curved, _)| *curved = 0);
            let labels = DepthView::new(&image[..], map.width(), map.height())?.valid_range(1, u16::MAX)?;
            let unite = |components: &mut ConnectedComponents| pieces.join(&labels, components);
            out.curved = Some(extraction.extract_curved(map, &labels, min_pixels, unite, job, old)?);
            job.done("label");
        }
        Ok(())
    }

    /// Says why a pixel has a plane or none; of a reduced map it is the source pixel that is looked at.
    ///
    /// # Errors
    /// As [`crate::Detector::explain`].
    pub(super) fn explain<T: Pixel>(
        &mut self,
        runner: &mut Runner,
        info: &'static MethodInfo,
        map: &DepthView<'_, T>,
        job: &mut Job<'_>,
        at: [usize; 2],
    ) -> Result<Explanation> {
        let is_measured = map.validity().holds(map.row(at[1])[at[0]]);
        let Some(reduced) = self.finder.find(map).filter(|_| is_measured) else {
            return explain(runner, info, (*map).into(), job, at);
        };
        let (factor, place) = (reduced.factor(), reduced.place(at));
        let finding = reduced.finding(place);
        let view = reduced.source(map, &mut self.pixels)?;
        let mut explanation =
            with_source(runner, job, &reduced, |runner, job| explain(runner, info, view.into(), job, place))?;
        let mut out = Detection::default();
        self.run(runner, map, job, &mut out)?;
        explanation.findings.insert(0, finding);
        explanation.verdict = self.verdict(explanation.verdict, runner.params.min_pixels, factor, &out, at);
        let values = runner.params.values();
        let planes = out.planes.len();
        let tries = Tries { info, values: &values, map: (*map).into(), sensor: job.sensor, at, planes };
        explanation.suggestions = retried(explanation.suggestions, &tries, factor);
        explanation.at = at;
        Ok(explanation)
    }

    /// The verdict on a source pixel as one on pixels of the whole map.
    fn verdict(
        &self,
        of_source: Verdict,
        min_pixels: u32,
        [x, y]: [f64; 2],
        out: &Detection,
        at: [usize; 2],
    ) -> Verdict {
        let whole = |pixels: usize| (pixels as f64 * x * y).round() as usize;
        let label = out.labels[at[1] * out.width + at[0]];
        match of_source {
            _ if label > 0 => {
                let off = if let Verdict::Plane { off, .. } = of_source { off } else { None };
                Verdict::Plane { label, pixels: out.planes[usize::from(label) - 1].pixel_count, off }
            }
            Verdict::Plane { pixels, .. } => Verdict::Small { pixels: whole(pixels), min_pixels, early: false },
            Verdict::Small { pixels, early, .. } => Verdict::Small { pixels: whole(pixels), min_pixels, early },
            Verdict::Off { off, most, label } => Verdict::Off { off, most, label: self.label_of(label, out) },
            other => other,
        }
    }

    /// The label in the whole map of a plane of the source; 0 if it has none.
    fn label_of(&self, of_source: u16, out: &Detection) -> u16 {
        let first = self.image.iter().position(|&label| of_source > 0 && label == of_source);
        first.map_or(0, |first| out.labels[first])
    }
}

/// The suggestions for a source pixel that work on the whole map too.
fn retried(suggestions: Vec<Suggestion>, tries: &Tries<'_>, [x, y]: [f64; 2]) -> Vec<Suggestion> {
    let of_whole = |(name, value): (&'static str, f64)| match name {
        "min-pixels" => (name, (value * x.floor() * y.floor()).floor()),
        _ => (name, value),
    };
    let changes = suggestions.into_iter().map(|suggestion| suggestion.parameters.into_iter().map(of_whole).collect());
    changes.filter_map(|change| tries.first([change])).collect()
}

/// Runs something on the source of a map: with parameters and a sensor for its pixels. The stages up to the region image
/// are told, the others are those of the whole map.
fn with_source<R>(
    runner: &mut Runner,
    job: &mut Job<'_>,
    reduced: &Reduced<'_>,
    run: impl FnOnce(&mut Runner, &mut Job<'_>) -> Result<R>,
) -> Result<R> {
    let ([x, y], [u, v]) = (reduced.factor(), reduced.centre());
    let params = runner.params;
    // A plane of more than `min-pixels` pixels has more than this of the source, whatever the blocks.
    let min_pixels = params.min_pixels / (x.ceil() * y.ceil()) as u32;
    let lateral_noise = (params.lateral_noise / (x * y).sqrt()).hypot(reduced.jitter());
    runner.params = Planar { min_pixels: min_pixels.max(params.min_pixels.min(TILE)), lateral_noise, ..params };
    let camera =
        |Intrinsics { fx, fy, cx, cy }| Intrinsics { fx: fx / x, fy: fy / y, cx: (cx - u) / x, cy: (cy - v) / y };
    let sensor = Sensor { intrinsics: job.sensor.intrinsics.map(camera), ..job.sensor };
    let observer = &mut *job.observer;
    let mut observe = |stage: &'static str| {
        if !STAGES.contains(&stage) {
            observer(stage);
        }
    };
    let mut job = Job { sensor, threads: job.threads, curved: job.curved, joiner: None, observer: &mut observe };
    let result = run(runner, &mut job);
    runner.params = params;
    result
}

/// The noise of the source's pixels as that of the map's. How far a pixel lies from the middle of its bin is known there.
fn of_whole(noise: NoiseModel, reduced: &Reduced<'_>, params: &Planar) -> NoiseModel {
    match reduced {
        Reduced::Repeated(_) => noise,
        Reduced::Sparse(sparse) if sparse.jitter > 0.0 => noise.with_ray(params.lateral_noise.max(RAY[0])),
        Reduced::Sparse(sparse) => noise.with_ray(noise.ray() * ((sparse.side[0] * sparse.side[1]) as f64).sqrt()),
    }
}

/// Gives planes the errors that they have in the source: repeated pixels say no more than one, and what a plane rises by
/// within a block is no noise. Planes that were joined have none there; theirs fall with the number of pixels.
fn errors_of_source(found: &Detection, labels: DepthView<'_, u16>, enlargement: &Enlargement<'_>, out: &mut Detection) {
    let [x, y] = enlargement.factor;
    let Detection { planes, parts, width, .. } = out;
    let parts_of = |label: u16| parts.iter().any(|part| part.of == label);
    for plane in planes.iter_mut() {
        let Some(metric) = &mut plane.metric else { continue };
        let top = plane.bounding_box.v_min as usize;
        let place = out.labels[top * *width..][..*width].iter().position(|&label| label == plane.label);
        let of_source = place.and_then(|u| found.planes.get(usize::from(labels.row(top)[u]).checked_sub(1)?));
        match of_source.and_then(|plane| plane.metric.as_ref()).filter(|_| !parts_of(plane.label)) {
            Some(right) => {
                (metric.covariance, metric.white_share, metric.covariance_from) =
                    (right.covariance, right.white_share, right.covariance_from);
            }
            None => widen(&mut metric.covariance, x * y),
        }
    }
    let parts = parts.iter_mut().filter_map(|part| part.plane.metric.as_mut());
    parts.for_each(|metric| widen(&mut metric.covariance, x * y));
}

fn widen(covariance: &mut [[f64; 4]; 4], times: f64) {
    covariance.as_flattened_mut().iter_mut().for_each(|number| *number *= times);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ValueKind;

    #[test]
    fn the_stages_see_the_camera_of_the_source_and_parameters_for_its_pixels_and_neither_stays() {
        let camera = Intrinsics { fx: 500.0, fy: 480.0, cx: 319.5, cy: 200.0 };
        let sensor = Sensor { value_kind: ValueKind::Disparity, intrinsics: Some(camera), ..Sensor::default() };
        let enlargement = Enlargement { columns: &[0], rows: &[0], factor: [2.0, 3.0] };
        let params = Planar { min_pixels: 600, lateral_noise: 0.6, ..Planar::default() };
        let mut runner = Runner { params, ..Runner::default() };
        let mut told = Vec::new();
        let mut observer = |stage| told.push(stage);
        let mut job = Job { sensor, threads: 1, curved: true, joiner: None, observer: &mut observer };
        with_source(&mut runner, &mut job, &Reduced::Repeated(enlargement), |runner, job| {
            assert_eq!((runner.params.min_pixels, job.curved), (100, true));
            assert!((runner.params.lateral_noise - 0.6 / 6.0f64.sqrt()).abs() < 1e-12);
            let source = job.sensor.intrinsics.unwrap();
            // The middle of a source pixel is the middle of its block.
            for [u, v] in [[0.0, 0.0], [7.0, 3.0], [100.0, 60.0]] {
                let whole = camera.ray((u + 0.5) * 2.0 - 0.5, (v + 0.5) * 3.0 - 0.5);
                let found = source.ray(u, v);
                (0..3).for_each(|i| assert!((whole[i] - found[i]).abs() < 1e-12, "{found:?}, not {whole:?}"));
            }
            ["tiles", "grow", STAGES[0], STAGES[3]].into_iter().for_each(|stage| job.done(stage));
            Ok(())
        })
        .unwrap();
        assert_eq!((runner.params, job.sensor), (params, sensor));
        // Stages of the whole map are told by the whole map alone.
        assert_eq!(told, ["tiles", "grow"]);
        // A plane of the source has a tile, unless fewer pixels are asked for.
        for (min_pixels, expected) in [(30, TILE), (10, 10), (0, 0)] {
            let mut runner = Runner { params: Planar { min_pixels, ..params }, ..Runner::default() };
            let mut job = Job { sensor, threads: 1, curved: false, joiner: None, observer: &mut |_| () };
            with_source(&mut runner, &mut job, &Reduced::Repeated(enlargement), |runner, _| {
                assert_eq!(runner.params.min_pixels, expected);
                Ok(())
            })
            .unwrap();
        }
    }

    #[test]
    fn errors_are_widened_by_as_much_as_pixels_were_repeated() {
        let mut covariance = [[1.0, 2.0, 3.0, 4.0]; 4];
        widen(&mut covariance, 6.0);
        assert_eq!(covariance, [[6.0, 12.0, 18.0, 24.0]; 4]);
    }
}
