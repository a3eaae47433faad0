//! One frame from a map to planes: [`Runner::planar`] is the method, a line for each step.

use super::assign::assign;
use super::curvature::Shown;
use super::curved::{Facets, Optics};
use super::curved_regions::{curved_of, join_facets};
use super::extend::{Contacts, Reach};
use super::grow::Regions;
use super::layout::Field;
use super::merge::Merger;
use super::parameters::Planar;
use super::pyramid::Pyramid;
use super::redundant::Explainer;
use super::refine::Refiner;
use super::region::{Region, find_boxes, of_image};
use super::thresholds::SHOWN_MOST;
use crate::camera::Measure;
use crate::components::Grouper;
use crate::components::boundary::Boundary;
use crate::components::gaps::{Bridge, Measured};
use crate::detection::{Curved, Detection};
use crate::error::Result;
use crate::map::{DepthView, Pixel};
use crate::methods::finish::{Finisher, Wanted};
use crate::methods::method::Job;
use crate::methods::rays::Rays;
use crate::noise::scales::{Errors, Scales};
use crate::noise::{NoiseModel, Rounding, RoundingFinder, Space};
use crate::util::parallel::side_by_side;
use crate::util::switches::is_on;

/// The method with its memory.
#[derive(Default)]
pub(super) struct Runner {
    pub(super) params: Planar,
    pub(super) field: Field,
    pub(super) pyramid: Pyramid,
    pub(super) rounding: RoundingFinder,
    pub(super) scales: Scales,
    pub(super) regions: Regions,
    pub(super) refiner: Refiner,
    pub(super) merger: Merger,
    pub(super) facets: Facets,
    pub(super) shown: Shown,
    pub(super) explainer: Explainer,
    pub(super) image: Vec<u16>,
    pub(super) boundary: Boundary,
    pub(super) reach: Reach,
    pub(super) contacts: Contacts,
    /// For each region of tiles one that is a facet of the same surface, or itself.
    pub(super) facet_surfaces: Vec<u16>,
    pub(super) finisher: Finisher,
    pub(super) bridge: Bridge,
}

/// Places of a run where [`explain`] looks at what there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Moment {
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
pub(super) type Watch<'a> = dyn FnMut(Moment, &Runner, &NoiseModel) + 'a;

impl Runner {
    /// The method: a line for each step, in the order of docs/planar.md.
    pub(super) fn planar<T: Pixel>(
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
            true => Some(self.find_curved(&map, job, &noise, out.curved.take())?),
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
        self.pyramid.show(&mut self.scales);
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
            self.refiner.refine(&mut self.pyramid, &mut self.regions.all, threads);
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
                find_boxes(tiles, &regions.all, boxes);
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
        let goes = |region: &Region| explained.next() == Some(&true) || region.is_edge_on(measure);
        merger.drop(&mut pyramid.grids[0], regions, threads, goes);
    }

    /// Assign: the region of every pixel: its plane, or its curved region; while planes are sought, all curved ones as
    /// [`super::region::BENT`].
    pub(super) fn assign(&mut self, noise: &NoiseModel, curved: bool, threads: usize) {
        let Runner { params, field, pyramid, regions, image, .. } = self;
        image.resize(field.q.len(), 0);
        pyramid.hand_up(threads);
        let [tiles, blocks, ..] = &pyramid.grids;
        let planes = params.planes(&regions.all, noise, curved);
        assign(field, [tiles, blocks], &planes, threads, image);
    }

    /// Planes reach on along strips that are too thin for a tile; those that touch are listed.
    fn reach(&mut self, noise: &NoiseModel, threads: usize) {
        let Runner { params, field, pyramid, regions, image, boundary, reach, contacts, .. } = self;
        let planes = params.planes(&regions.all, noise, false);
        boundary.find(image, field.stride, threads);
        contacts.list(boundary, image, threads);
        if is_on("reach") {
            reach.reach(field, &planes, boundary, &pyramid.bands, image, threads);
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
        let Runner { params, field, image, finisher, bridge, .. } = self;
        let ids = of_image(image, field)?;
        let wanted =
            Wanted { min: params.min, min_area: params.min_area, noise: Some(noise), valid_pixels: field.valid_pixels };
        let threads = job.threads;
        let join = |grouper: &mut Grouper| {
            if is_on("pieces") {
                bridge.join(
                    Measured { numbers: &field.q, stride: field.stride, height: field.height },
                    image,
                    grouper,
                    threads,
                );
            }
        };
        finisher.finish_united(map, &ids, &wanted, join, job, out)
    }

    /// Curved regions, where they are wanted; overwrites the region image. `old`: memory to reuse.
    fn find_curved<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        job: &Job<'_>,
        noise: &NoiseModel,
        old: Option<Curved>,
    ) -> Result<Curved> {
        self.assign(noise, true, job.threads);
        let Runner { params, field, pyramid, regions, merger, image, finisher, facet_surfaces, .. } = self;
        join_facets(&regions.all, &merger.pairs, noise, facet_surfaces, image, pyramid.grids[0].len());
        curved_of(finisher, map, &of_image(image, field)?, params.min, job, old)
    }
}
