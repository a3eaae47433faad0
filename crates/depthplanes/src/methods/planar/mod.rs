//! planar: true planes.
//!
//! In: any map; a camera only for metric planes. Out: connected regions that one plane explains to
//! within the sensor's noise. The paper's idea that a plane has one gradient (eq. 5), in the space
//! where it is exact: inverse depth or disparity, `q = a u + b v + c`.

mod assign;
mod bands;
mod bent;
mod bows;
mod contact;
mod counts;
mod curved;
mod enlarged;
mod explain;
mod explained;
mod field;
mod grid;
mod grow;
mod level;
mod merge;
mod near;
mod pieces;
mod planes;
mod pyramid;
mod quadratic;
mod reach;
mod rule;
mod seams;
mod seen;
mod settle;
mod shown;
mod switches;
#[cfg(test)]
mod tests;
mod thresholds;
mod tiles;
mod turns;

use super::finish::{Finisher, MIN, STAGES, Wanted};
use super::noise::{NOISE, NOISE_GROWTH, NOISE_SCALE, SMOOTH_NOISE, SMOOTH_NOISE_GROWTH, stated};
use super::rays::Rays;
use super::{Job, Method, MethodInfo, Param, ParamKind};
use crate::camera::{Measure, Sensor};
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::explanation::Explanation;
use crate::group::Grouper;
use crate::map::{AnyView, DepthView, Pixel};
use crate::noise::scales::{Errors, RAY, Scales};
use crate::noise::{NoiseModel, PADDED, Rounding, RoundingFinder, SensorNoise, Space};
use crate::parallel::side_by_side;
use crate::with_view;
use bent::Bent;
use contact::Contacts;
use counts::Counts;
use curved::{Facets, Optics};
use enlarged::Source;
use explained::Explainer;
use field::Field;
use grow::{Region, Regions};
use merge::Merger;
use pieces::Pieces;
use planes::Planes;
use pyramid::Pyramid;
use reach::Reach;
use seams::Seams;
use shown::Shown;
use switches::is_on;
use thresholds::{EDGE_ON, SHOWN_MOST};

pub(super) static INFO: MethodInfo = MethodInfo {
    name: "planar",
    about: "Finds true planes: regions that one plane explains to within the sensor's noise, in inverse depth or disparity.",
    stages: &["tiles", "grow", "merge", "judge", "assign", STAGES[0], STAGES[1], STAGES[2], STAGES[3]],
    tells_curved: true,
    params: PARAMS,
    build: |values| {
        INFO.check(values)?;
        Planar::from_values(values).try_into()
    },
};

const PARAMS: &[Param] = &[
    MIN,
    Param {
        name: "min-area",
        default: 0.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "m2",
        meaning: "A plane has at least this area; needs unit and camera; 0 for off.",
        source: None,
    },
    NOISE,
    NOISE_GROWTH,
    SMOOTH_NOISE,
    SMOOTH_NOISE_GROWTH,
    NOISE_SCALE,
    Param {
        name: "ray",
        default: 0.0,
        min: 0.0,
        max: 100.0,
        kind: ParamKind::Real,
        unit: "pixels",
        meaning: "How well the ray of a pixel is known, one standard deviation; a slant makes noise of it. With 0 it is estimated from the map, 0.05 and more.",
        source: None,
    },
    Param {
        name: "inlier-threshold",
        default: 4.0,
        min: 0.5,
        max: 100.0,
        kind: ParamKind::Real,
        unit: "standard deviations",
        meaning: "How far from a plane its pixels may lie.",
        source: None,
    },
];

/// Parameters of the method `planar`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planar {
    /// A plane has strictly more pixels than this.
    pub min: u32,
    /// A plane has at least this area ([`crate::detection::MetricPlane::area_m2`]), square metres; 0 for off.
    pub min_area: f64,
    /// Standard deviation of a pixel by itself: of depth at range 0, metres; of disparity, map units. If this and
    /// `noise_growth` are 0, it is the sensor's ([`crate::Sensor::noise`]), or else estimated from each map.
    pub noise: f64,
    /// What the standard deviation of depth grows by with the square of the range, 1/m; not used for disparity.
    pub noise_growth: f64,
    /// Standard deviation of the part of the error that neighbouring pixels share over tens of pixels, in the units of
    /// `noise`: it does not average out within a surface. If this and `smooth_noise_growth` are 0, it is the sensor's
    /// ([`crate::Sensor::smooth_noise`]), or else estimated from each map. What wide cells and large regions of a map show beyond it
    /// counts as well.
    pub smooth_noise: f64,
    /// What that of depth grows by with the square of the range, 1/m; not used for disparity.
    pub smooth_noise_growth: f64,
    /// What both parts are multiplied by, stated or estimated, 0.01..=100; a `ray` that is estimated, too. Larger joins
    /// more.
    pub noise_scale: f64,
    /// How well the ray of a pixel is known, pixels, one standard deviation, 0..=100: what a surface's slope makes of it
    /// comes on top of the noise. If it is 0, it is estimated from each map, as 0.05 and more, whether or not the noise
    /// is stated.
    pub ray: f64,
    /// How far from a plane its pixels may lie, standard deviations, 0.5..=100.
    pub inlier_threshold: f64,
}

/// What `depthplanes noise` looks at is what is looked at here.
const _: () = assert!(PADDED[0] == field::COLUMNS && PADDED[1] == field::ROWS);

impl Planar {
    fn from_values(values: &[f64]) -> Self {
        assert_eq!(values.len(), PARAMS.len(), "one value for each row of PARAMS");
        Planar {
            min: values[0] as u32,
            min_area: values[1],
            noise: values[2],
            noise_growth: values[3],
            smooth_noise: values[4],
            smooth_noise_growth: values[5],
            noise_scale: values[6],
            ray: values[7],
            inlier_threshold: values[8],
        }
    }

    fn values(&self) -> [f64; 9] {
        let noise = [self.noise, self.noise_growth, self.smooth_noise, self.smooth_noise_growth];
        let [white, white_growth, smooth, smooth_growth] = noise;
        let Planar { min, min_area, noise_scale, ray, inlier_threshold, .. } = *self;
        [min.into(), min_area, white, white_growth, smooth, smooth_growth, noise_scale, ray, inlier_threshold]
    }

    /// The noise to expect: each part as the parameters state it, or else as the sensor's, or else as a map shows it whose
    /// values are rounded so.
    fn expected(&self, sensor: &Sensor, shown: &Errors, rounding: Rounding) -> NoiseModel {
        let (space, scale) = (Space::of(sensor.measure), self.noise_scale);
        // What is stated for another kind of map counts as not stated.
        let model = |noise: SensorNoise| {
            Some(NoiseModel::new(sensor.measure, noise.times(scale), 0.0)?.with_rounding(rounding))
        };
        let estimated = |factor: f64| shown.times(factor, space);
        let white =
            stated(space, self.noise, self.noise_growth).or(sensor.noise).and_then(model).unwrap_or_else(|| {
                model(estimated(shown.white)).expect("an estimate is of the map's own kind").of_scatter()
            });
        let stated_smooth = self.stated_smooth(sensor);
        let white = if stated_smooth.is_none() { white.of_smooth_shown() } else { white };
        let smooth = stated_smooth.unwrap_or_else(|| estimated(shown.smooth)).times(scale);
        match self.ray {
            0.0 => {
                let [ray, smooth_ray] = [shown.white, shown.smooth].map(|factor| scale * factor * shown.ray);
                white.with_ray(ray.max(RAY[0])).with_smooth(smooth, smooth_ray)
            }
            // Of its error the same share is smooth as of the noise that the map shows.
            ray => white.with_ray(ray).with_smooth(smooth, ray * shown.smooth / shown.white),
        }
    }

    /// The smooth part as the parameters state it, or else as the sensor's, if it is of the map's kind.
    fn stated_smooth(&self, sensor: &Sensor) -> Option<SensorNoise> {
        let stated = stated(Space::of(sensor.measure), self.smooth_noise, self.smooth_noise_growth);
        stated.or(sensor.smooth_noise).filter(|&noise| NoiseModel::new(sensor.measure, noise, 0.0).is_some())
    }

    /// Fewest pixels of a region of tiles: a plane has many of its pixels in tiles that it shares with others.
    fn least(&self) -> f64 {
        f64::from(self.min) * 0.5
    }

    /// What pixels are held against.
    fn planes<'a>(&self, regions: &'a [Region], noise: &'a NoiseModel, curved: bool) -> Planes<'a> {
        Planes { regions, noise, inlier_threshold: self.inlier_threshold, curved }
    }
}

impl Default for Planar {
    fn default() -> Self {
        Self::from_values(&INFO.defaults())
    }
}

impl TryFrom<Planar> for Box<dyn Method> {
    type Error = Error;

    fn try_from(params: Planar) -> Result<Self> {
        INFO.check(&params.values())?;
        Ok(Box::new(Runner { params, ..Runner::default() }))
    }
}

/// The method with its memory.
#[derive(Default)]
struct Runner {
    params: Planar,
    field: Field,
    pyramid: Pyramid,
    rounding: RoundingFinder,
    scales: Scales,
    regions: Regions,
    merger: Merger,
    facets: Facets,
    shown: Shown,
    explainer: Explainer,
    image: Vec<u16>,
    seams: Seams,
    reach: Reach,
    contacts: Contacts,
    bent: Bent,
    finisher: Finisher,
    pieces: Pieces,
    source: Source,
    counts: Counts,
}

impl Method for Runner {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn run(&mut self, map: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()> {
        with_view!(map, map => self.planar_of_counts(&map, job, out))
    }

    fn explain(&mut self, map: AnyView<'_>, job: &mut Job<'_>, at: [usize; 2]) -> Result<Explanation> {
        with_view!(map, map => self.explain_of_counts(&map, job, at))
    }
}

/// Places of a run where [`explain`] looks at what there is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Moment {
    /// Regions have grown.
    Grown,
    /// Those that one plane explains are merged, none is dropped yet.
    Merged,
    /// Large regions showed more of the smooth part, and more are merged by it.
    Shown,
    /// It is known which are curved and which are explained by others.
    Judged,
    /// Every pixel has its region.
    Assigned,
}

/// Told of each moment of a run.
type Watch<'a> = dyn FnMut(Moment, &Runner, &NoiseModel) + 'a;

/// Whether a region is seen too much edge-on for a plane.
fn is_edge_on(region: &Region, measure: Measure) -> bool {
    is_on("edge-on") && region.steepness(Space::at_infinity(measure)) > EDGE_ON
}

impl Runner {
    /// The method: a line for each step, in the order of docs/planar.md.
    fn planar<T: Pixel>(
        &mut self,
        map: DepthView<'_, T>,
        job: &mut Job<'_>,
        out: &mut Detection,
        watch: &mut Watch<'_>,
    ) -> Result<()> {
        if self.params.min_area > 0.0 {
            job.sensor.check_metric("min-area")?;
        }
        let (rays, threads) = (&Rays::of(&job.sensor, map.width(), map.height()), job.threads);

        self.sum_tiles(&map, job);
        let (mut noise, wide) = self.estimate_noise(&map, job);
        job.done("tiles");

        self.grow(&noise, threads);
        self.settle(threads);
        watch(Moment::Grown, self, &noise);
        job.done("grow");

        self.merge(rays, threads);
        watch(Moment::Merged, self, &noise);
        self.drop_small(threads)?;
        if let Some(times) = self.smooth_shown(wide, rays, job) {
            noise = noise.with_smooth_times(times);
            self.merge_again(times, rays, threads)?;
            watch(Moment::Shown, self, &noise);
        }
        job.done("merge");

        self.look_at_shapes(&noise, threads);
        self.mark_curved(Optics { noise: &noise, rays }, threads);
        watch(Moment::Judged, self, &noise);
        self.drop_no_planes(job.sensor.measure, threads);
        job.done("judge");

        self.assign(&noise, false, threads);
        self.reach(&noise, threads);
        watch(Moment::Assigned, self, &noise);
        self.join_contacts(threads);
        job.done("assign");

        self.finish(&map, &noise, job, out)?;
        out.curved = match job.curved {
            true => Some(self.find_bent(&map, job, &noise, out.curved.take())?),
            false => None,
        };
        if job.curved {
            job.done("label");
        }
        Ok(())
    }

    /// Tiles: the map in the space where planes are affine, and the sums of its cells.
    fn sum_tiles<T: Pixel>(&mut self, map: &DepthView<'_, T>, job: &Job<'_>) {
        self.field.prepare(map);
        self.pyramid.sum(map, Space::of(job.sensor.measure), job.threads, &mut self.field);
    }

    /// The noise to expect: stated, or as the cells show it; and how many times its smooth part the cells show with the
    /// longer waves.
    fn estimate_noise<T: Pixel>(&mut self, map: &DepthView<'_, T>, job: &Job<'_>) -> (NoiseModel, f64) {
        let space = Space::of(job.sensor.measure);
        let rounding = if is_on("rounding") { self.rounding.find(map, space) } else { Rounding::NONE };
        self.scales.look(&self.pyramid);
        let errors = self.scales.errors(space, &rounding).unwrap_or(Errors::NONE);
        let noise = self.params.expected(&job.sensor, &errors, rounding);
        let wide = errors.wide.max(errors.smooth) * errors.variance(errors.q, 0.0).sqrt();
        // A map without any error has none over long ways either.
        let times = match noise.smooth_sigma(errors.q) {
            sigma if sigma > 0.0 && is_on("wide") => (self.params.noise_scale * wide / sigma).min(SHOWN_MOST),
            _ => 0.0,
        };
        (noise, times)
    }

    /// Grow: regions of cells on one plane.
    fn grow(&mut self, noise: &NoiseModel, threads: usize) {
        let inlier_threshold = self.params.inlier_threshold;
        self.pyramid.expect(noise, inlier_threshold, threads);
        self.regions.grow(&mut self.pyramid, inlier_threshold, threads);
    }

    /// Border tiles go to the region beside them that they suit better.
    fn settle(&mut self, threads: usize) {
        if is_on("settle") {
            self.regions.settle(&mut self.pyramid, threads);
        }
    }

    /// Merge: regions that one plane explains become one.
    fn merge(&mut self, rays: &Rays, threads: usize) {
        self.merger.merge(&self.pyramid.grids[0], &mut self.regions, rays, threads);
    }

    /// Leaves out what is too small and what became part of another.
    fn drop_small(&mut self, threads: usize) -> Result<()> {
        self.merger.drop_small(&mut self.pyramid.grids[0], &mut self.regions, self.params.least(), threads)
    }

    /// How many times the smooth part that is expected of patches there is over long ways, if more than once: as cells
    /// show it or large regions.
    fn smooth_shown(&mut self, wide: f64, rays: &Rays, job: &Job<'_>) -> Option<f64> {
        let Runner { params, pyramid, regions, facets, shown, .. } = self;
        pyramid.hand_up(job.threads);
        facets.bows.measure(pyramid, &regions.all);
        let by_regions = shown.times(&regions.all, &facets.bows, rays, pyramid.grids[0].len());
        let by_regions = if is_on("shown") { params.noise_scale * by_regions } else { 0.0 };
        Some(wide.max(by_regions)).filter(|&times| times > 1.0)
    }

    /// Merges regions that are one by so many times the smooth part.
    fn merge_again(&mut self, times: f64, rays: &Rays, threads: usize) -> Result<()> {
        let Runner { pyramid, regions, merger, .. } = self;
        pyramid.widen_smooth((times * times) as f32);
        regions.all.iter_mut().for_each(|region| region.smooth *= times * times);
        merger.merge_listed(&mut regions.all, rays, threads);
        self.drop_small(threads)
    }

    /// Judge: how regions bow, and which of them larger ones beside them explain.
    fn look_at_shapes(&mut self, noise: &NoiseModel, threads: usize) {
        let Runner { params, field, pyramid, regions, merger, facets, explainer, .. } = self;
        pyramid.hand_up(threads);
        let planes = params.planes(&regions.all, noise, false);
        let (Facets { bows, boxes, .. }, tiles) = (&mut *facets, &pyramid.grids[0]);
        side_by_side(
            threads,
            || {
                curved::find_boxes(tiles, &regions.all, boxes);
                explainer.find(field, tiles, &planes, &merger.pairs, boxes, threads);
            },
            || bows.measure(pyramid, &regions.all),
        );
    }

    /// Marks the regions that are facets of curved surfaces.
    fn mark_curved(&mut self, optics: Optics<'_>, threads: usize) {
        let Runner { pyramid, regions, merger, facets, explainer, .. } = self;
        facets.mark(pyramid, regions, &merger.pairs, &explainer.is_explained, optics, threads);
    }

    /// Leaves out regions that larger ones explain, and those that are seen edge-on.
    fn drop_no_planes(&mut self, measure: Measure, threads: usize) {
        let Runner { pyramid, regions, merger, explainer, .. } = self;
        let mut explained = explainer.is_explained.iter();
        let goes = |region: &Region| explained.next() == Some(&true) || is_edge_on(region, measure);
        merger.drop(&mut pyramid.grids[0], regions, threads, goes);
    }

    /// Assign: the region of every pixel: its plane, or its curved region; while planes are sought, all curved ones as
    /// [`planes::BENT`].
    fn assign(&mut self, noise: &NoiseModel, curved: bool, threads: usize) {
        let Runner { params, field, pyramid, regions, image, .. } = self;
        image.resize(field.q.len(), 0);
        pyramid.hand_up(threads);
        let [tiles, blocks, ..] = &pyramid.grids;
        let planes = params.planes(&regions.all, noise, curved);
        assign::assign(field, [tiles, blocks], &planes, threads, image);
    }

    /// Planes reach on along strips that are too thin for a tile; those that touch are listed.
    fn reach(&mut self, noise: &NoiseModel, threads: usize) {
        let Runner { params, field, pyramid, regions, image, seams, reach, contacts, .. } = self;
        let planes = params.planes(&regions.all, noise, false);
        seams.find(image, field.stride, threads);
        contacts.list(seams, image, threads);
        if is_on("reach") {
            reach.reach(field, &planes, seams, &pyramid.bands, image, threads);
        }
    }

    /// Regions whose pixels touch are merged as well.
    fn join_contacts(&mut self, threads: usize) {
        let Runner { regions, image, reach, contacts, .. } = self;
        contacts.join(reach.touching(), &mut regions.all, image, threads);
    }

    /// Group, select, fit: connected pieces of one region, those that are large enough, and their planes.
    fn finish<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        noise: &NoiseModel,
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        let Runner { params, field, image, finisher, pieces, .. } = self;
        let ids = planes::of_image(image, field)?;
        let wanted =
            Wanted { min: params.min, min_area: params.min_area, noise: Some(noise), valid_pixels: field.valid_pixels };
        let threads = job.threads;
        let join = |grouper: &mut Grouper| {
            if is_on("pieces") {
                pieces.join(field, image, grouper, threads);
            }
        };
        finisher.finish_united(map, &ids, &wanted, join, job, out)
    }
}
