//! Maps with more pixels than measurements are worked on at the size at which they were measured.
//!
//! In: a map. Out: its detection. Of a map that was enlarged by repeating pixels ([`EnlargementFinder`]) the stages see
//! the source: one value a pixel, seen by a camera of as many pixels. Of a map that was measured at few of its pixels
//! ([`SparseFinder`]) they see one measured pixel of each bin, again by a camera of as many pixels. What was found is
//! painted on the whole map: the label of its source pixel for each that was repeated, the nearest of the planes
//! around its bin for each that was measured. There it is grouped, selected and fitted, so that `min-pixels`, areas and places
//! are those of the map that was given. Repeated pixels say no more than one: errors of planes are those of the
//! source's pixels.

use super::explain::explain;
use super::parameters::Planar;
use super::pipeline::Runner;
use crate::camera::Intrinsics;
use crate::components::{ConnectedComponents, Run};
use crate::detection::Detection;
use crate::error::Result;
use crate::explanation::{Explanation, Finding, Suggestion, Verdict};
use crate::limits::MAX_PLANES;
use crate::map::{DepthView, Pixel, Validity};
use crate::methods::extraction::{Extraction, STAGES, Wanted};
use crate::methods::method::{Job, MethodInfo};
use crate::methods::spread::Spreader;
use crate::methods::tries::Tries;
use crate::noise::scales::RAY;
use crate::noise::{Enlargement, EnlargementFinder, NoiseModel, Space, Sparse, SparseFinder};
use crate::sensor::Sensor;
use crate::util::memory::reserve_to;

/// Fewest pixels of the source that are asked of a plane: those of a tile. `min-pixels` may be less than that.
const TILE: u32 = 16;

/// What the stages see instead of a map.
enum Reduced<'a> {
    /// Each pixel of the source once.
    Repeated(Enlargement<'a>),
    /// One measured pixel of each bin.
    Sparse(Sparse<'a>),
}

impl Reduced<'_> {
    /// Columns and rows of the map for one of the source.
    fn factor(&self) -> [f64; 2] {
        match self {
            Reduced::Repeated(enlargement) => enlargement.factor,
            Reduced::Sparse(sparse) => sparse.side.map(|side| side as f64),
        }
    }

    /// Where a source pixel lies among those that it stands for, columns and rows from the first.
    fn centre(&self) -> [f64; 2] {
        match self {
            Reduced::Repeated(enlargement) => enlargement.factor.map(|factor| (factor - 1.0) / 2.0),
            Reduced::Sparse(sparse) => sparse.centre,
        }
    }

    /// How far off that it is, source pixels, one standard deviation.
    fn jitter(&self) -> f64 {
        match self {
            Reduced::Repeated(_) => 0.0,
            Reduced::Sparse(sparse) => sparse.jitter,
        }
    }

    /// The source pixel of a pixel.
    fn place(&self, at: [usize; 2]) -> [usize; 2] {
        match self {
            Reduced::Repeated(enlargement) => [0, 1].map(|axis| {
                let firsts = [enlargement.columns, enlargement.rows][axis];
                firsts.partition_point(|&first| first as usize <= at[axis]) - 1
            }),
            Reduced::Sparse(sparse) => [0, 1].map(|axis| at[axis] / sparse.side[axis]),
        }
    }

    /// What `explain` says of it.
    fn finding(&self, [column, row]: [usize; 2]) -> Finding {
        let subject = format!("the pixel's source, column {column}, row {row}: what follows is of the source");
        let what = match self {
            Reduced::Repeated(_) => "the map was enlarged by repeating pixels",
            Reduced::Sparse(_) => "the map was measured at few of its pixels; one stands for each bin",
        };
        let [x, y] = self.factor();
        Finding::new("map", subject, what).with("columns", x, "").with("rows", y, "")
    }

    /// The source of a map.
    fn source<'a, T: Pixel>(&self, map: &DepthView<'_, T>, pixels: &'a mut Vec<f32>) -> Result<DepthView<'a, f32>> {
        match self {
            Reduced::Repeated(enlargement) => shrunk(map, enlargement, pixels),
            Reduced::Sparse(sparse) => chosen(map, sparse, pixels),
        }
    }
}

/// Finds out whether the stages are to see something else than the map itself; reuses its memory.
#[derive(Default)]
struct Finder {
    enlargement: EnlargementFinder,
    sparse: SparseFinder,
}

impl Finder {
    fn find<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> Option<Reduced<'_>> {
        let Finder { enlargement, sparse } = self;
        match enlargement.find(map) {
            Some(enlargement) => Some(Reduced::Repeated(enlargement)),
            None => sparse.find(map).map(Reduced::Sparse),
        }
    }
}

/// The source of a map and what was found in it; reuses its memory.
#[derive(Default)]
pub(super) struct Source {
    finder: Finder,
    /// One value a source pixel; single precision holds integers of 16 bits exactly.
    pixels: Vec<f32>,
    found: Detection,
    /// Labels of the source on the whole map.
    image: Vec<u16>,
    spreader: Spreader,
    extraction: Extraction,
    pieces: Pieces,
}

impl Source {
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
        let Source { finder, pixels, found, image, spreader, extraction, pieces } = self;
        let Some(reduced) = finder.find(map) else { return runner.planar(*map, job, out, &mut |_, _, _| ()) };
        let Planar { min_pixels, min_area, inlier_threshold, .. } = runner.params;
        if min_area > 0.0 {
            job.sensor.check_metric("min-area")?;
        }
        // Sources of maps of one size have several.
        reserve_to(&mut found.labels, map.area());
        reserve_to(&mut found.planes, map.area().min(MAX_PLANES));
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

/// The source of a map.
fn shrunk<'a, T: Pixel>(
    map: &DepthView<'_, T>,
    Enlargement { columns, rows, .. }: &Enlargement<'_>,
    pixels: &'a mut Vec<f32>,
) -> Result<DepthView<'a, f32>> {
    reserve_to(pixels, map.area());
    for &v in *rows {
        let row = map.row(v as usize);
        pixels.extend(columns.iter().map(|&u| row[u as usize].to_f32()));
    }
    let Validity { low, high, sentinel } = map.validity();
    let view = DepthView::new(&pixels[..], columns.len(), rows.len())?;
    view.missing_value(sentinel.to_f32()).valid_range(low.to_f32(), high.to_f32())
}

/// One measured pixel for each bin of a sparse map; not a number where there is none.
fn chosen<'a, T: Pixel>(
    map: &DepthView<'_, T>,
    sparse: &Sparse<'_>,
    pixels: &'a mut Vec<f32>,
) -> Result<DepthView<'a, f32>> {
    reserve_to(pixels, map.area());
    let value = |at: usize| map.row(at / map.width())[at % map.width()].to_f32();
    pixels.extend(
        sparse.pixels.iter().map(|&pixel| if pixel == Sparse::EMPTY { f32::NAN } else { value(pixel as usize) }),
    );
    DepthView::new(&pixels[..], sparse.size[0], sparse.size[1])
}

/// The noise of the source's pixels as that of the map's. How far a pixel lies from the middle of its bin is known there.
fn of_whole(noise: NoiseModel, reduced: &Reduced<'_>, params: &Planar) -> NoiseModel {
    match reduced {
        Reduced::Repeated(_) => noise,
        Reduced::Sparse(sparse) if sparse.jitter > 0.0 => noise.with_ray(params.lateral_noise.max(RAY[0])),
        Reduced::Sparse(sparse) => noise.with_ray(noise.ray() * ((sparse.side[0] * sparse.side[1]) as f64).sqrt()),
    }
}

/// Labels of the source on the measured pixels that each stands for.
fn paint<'a, T: Pixel>(
    labels: &[u16],
    reduced: &Reduced<'_>,
    map: &DepthView<'_, T>,
    image: &'a mut Vec<u16>,
) -> Result<DepthView<'a, u16>> {
    let sparse = match reduced {
        Reduced::Repeated(enlargement) => return enlarge(labels, enlargement, map, image),
        Reduced::Sparse(sparse) => sparse,
    };
    reserve_to(image, map.area());
    let validity = map.validity();
    for (v, row) in map.rows().enumerate() {
        let labels = &labels[v / sparse.side[1] * sparse.size[0]..][..sparse.size[0]];
        let of_pixel = |(u, &value): (usize, &T)| if validity.holds(value) { labels[u / sparse.side[0]] } else { 0 };
        image.extend(row.iter().enumerate().map(of_pixel));
    }
    DepthView::new(&image[..], map.width(), map.height())?.valid_range(1, u16::MAX)
}

/// Labels of the source as an image of the whole map, in which 0 is missing.
fn enlarge<'a, T: Pixel>(
    labels: &[u16],
    Enlargement { columns, rows, .. }: &Enlargement<'_>,
    map: &DepthView<'_, T>,
    image: &'a mut Vec<u16>,
) -> Result<DepthView<'a, u16>> {
    let (width, height) = (map.width(), map.height());
    reserve_to(image, map.area());
    for (k, labels) in labels.chunks(columns.len()).enumerate() {
        let first = image.len();
        let ends = columns[1..].iter().copied().chain([width as u32]);
        for ((&label, &from), to) in labels.iter().zip(*columns).zip(ends) {
            image.extend(std::iter::repeat_n(label, (to - from) as usize));
        }
        let end = rows.get(k + 1).map_or(height, |&row| row as usize);
        (rows[k] as usize + 1..end).for_each(|_| image.extend_from_within(first..first + width));
    }
    DepthView::new(image, width, height)?.valid_range(1, u16::MAX)
}

/// Joins groups of one label: pieces that were one plane in the source.
#[derive(Default)]
struct Pieces {
    pairs: Vec<[u32; 2]>,
    /// For each label the first group that has it.
    first: Vec<Option<u32>>,
}

impl Pieces {
    fn join(&mut self, labels: &DepthView<'_, u16>, components: &mut ConnectedComponents) {
        let Pieces { pairs, first } = self;
        reserve_to(pairs, labels.area());
        first.clear();
        first.resize(usize::from(u16::MAX) + 1, None);
        components.groups().each_run(|Run { v, u_first, group, .. }| {
            let label = labels.row(v as usize)[u_first as usize];
            let first = *first[usize::from(label)].get_or_insert(group);
            if first != group && pairs.last() != Some(&[first, group]) {
                pairs.push([first, group]);
            }
        });
        components.unite(pairs);
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
                (metric.covariance, metric.covariance_from) = (right.covariance, right.covariance_from);
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
    use crate::components::Connectivity;
    use crate::util::random::Random;

    /// The first places of source pixels that are two or three wide, and how long the whole is.
    fn firsts(random: &mut Random, count: usize) -> (Vec<u32>, usize) {
        let mut next = 0;
        let mut first = |_| {
            let first = next;
            next += random.whole(2, 3) as u32;
            first
        };
        let firsts = (0..count).map(&mut first).collect();
        (firsts, next as usize)
    }

    #[test]
    fn labels_that_are_enlarged_and_shrunk_again_are_the_same_and_each_pixel_has_that_of_its_source() {
        let (mut random, mut image, mut pixels) = (Random::new(2), vec![9; 3], Vec::new());
        for _ in 0..20 {
            let [(columns, width), (rows, height)] = [0; 2].map(|_| {
                let count = random.whole(1, 30);
                firsts(&mut random, count)
            });
            let enlargement = Enlargement { columns: &columns, rows: &rows, factor: [2.5, 2.5] };
            let labels: Vec<u16> = (0..columns.len() * rows.len()).map(|_| random.whole(0, 5) as u16).collect();
            let map = vec![1.0f32; width * height];
            let map = DepthView::new(&map, width, height).unwrap();
            let whole = enlarge(&labels, &enlargement, &map, &mut image).unwrap();
            assert_eq!((whole.width(), whole.height()), (width, height));
            for (u, v) in (0..height).flat_map(|v| (0..width).map(move |u| (u, v))) {
                let [column, row] = [(u, &columns), (v, &rows)]
                    .map(|(at, firsts)| firsts.iter().filter(|&&first| first as usize <= at).count() - 1);
                assert_eq!(whole.row(v)[u], labels[row * columns.len() + column], "at {u}, {v}");
            }
            let source = shrunk(&whole, &enlargement, &mut pixels).unwrap();
            assert_eq!(source.rows().flatten().map(|&label| label as u16).collect::<Vec<_>>(), labels);
            // What is missing of the whole is missing of the source.
            assert_eq!(source.valid_pixels(), labels.iter().filter(|&&label| label > 0).count());
        }
    }

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
    fn pieces_of_one_label_are_one_group_and_those_of_two_stay_two() {
        let labels: [u16; 24] = [
            1, 1, 0, 1, 0, 2, //
            0, 0, 0, 0, 0, 2, //
            2, 0, 3, 3, 0, 0, //
            2, 0, 0, 0, 1, 1, //
        ];
        let view = DepthView::new(&labels, 6, 4).unwrap().valid_range(1, u16::MAX).unwrap();
        let mut components = ConnectedComponents::default();
        let mut pieces = Pieces::default();
        for _ in 0..2 {
            components.group(&view, &Connectivity::new(view.validity(), 0.0).unwrap(), 1);
            assert_eq!(components.groups().count(), 6);
            pieces.join(&view, &mut components);
            assert_eq!(components.groups().sizes(), [5, 4, 2]);
        }
    }

    #[test]
    fn errors_are_widened_by_as_much_as_pixels_were_repeated() {
        let mut covariance = [[1.0, 2.0, 3.0, 4.0]; 4];
        widen(&mut covariance, 6.0);
        assert_eq!(covariance, [[6.0, 12.0, 18.0, 24.0]; 4]);
    }
}
