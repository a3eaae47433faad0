//! One frame from a map to planes: [`Runner::planar`] is the method, a line for each step.

use super::assign::assign;
use super::curvature::Shown;
use super::curved::{CurvatureTest, Sensing, join_facets};
use super::extend::{Contacts, Flood};
use super::grow::Regions;
use super::layout::AffineMap;
use super::merge::Merger;
use super::parameters::Planar;
use super::pyramid::Pyramid;
use super::redundant::Redundancy;
use super::refine::Refiner;
use super::region::{Region, find_boxes, of_image};
use super::thresholds::SHOWN_MOST;
use crate::components::ConnectedComponents;
use crate::components::boundary::Boundary;
use crate::components::gaps::{Bridge, Measured};
use crate::detection::{Curved, Detection};
use crate::error::Result;
use crate::map::{DepthView, Pixel};
use crate::methods::extraction::{Extraction, Wanted};
use crate::methods::method::Job;
use crate::methods::rays::Rays;
use crate::noise::errors::Errors;
use crate::noise::scales::Scales;
use crate::noise::{NoiseModel, Rounding, RoundingFinder, Space};
use crate::util::parallel::join;
use crate::util::switches::is_on;

/// The method with its memory.
#[derive(Default)]
pub(super) struct Runner {
    pub(super) params: Planar,
    pub(super) affine: AffineMap,
    pub(super) pyramid: Pyramid,
    pub(super) rounding: RoundingFinder,
    pub(super) scales: Scales,
    pub(super) regions: Regions,
    pub(super) refiner: Refiner,
    pub(super) merger: Merger,
    pub(super) curvature: CurvatureTest,
    pub(super) shown: Shown,
    pub(super) redundancy: Redundancy,
    pub(super) image: Vec<u16>,
    pub(super) boundary: Boundary,
    pub(super) flood: Flood,
    pub(super) contacts: Contacts,
    /// For each region of tiles one that is a facet of the same surface, or itself.
    pub(super) facet_surfaces: Vec<u16>,
    pub(super) extraction: Extraction,
    pub(super) bridge: Bridge,
}

/// Places of a run where `explain` looks at what there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Checkpoint {
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

/// Told of each checkpoint of a run.
pub(super) type Observer<'a> = dyn FnMut(Checkpoint, &Runner, &NoiseModel) + 'a;

impl Runner {
    /// The method: a line for each step, in the order of docs/planar.md.
    pub(super) fn planar<T: Pixel>(
        &mut self,
        map: DepthView<'_, T>,
        job: &mut Job<'_>,
        out: &mut Detection,
        observe: &mut Observer<'_>,
    ) -> Result<()> {
        if self.params.min_area > 0.0 {
            job.sensor.check_metric("min-area")?;
        }
        let (rays, threads) = (&Rays::of(&job.sensor, map.width(), map.height()), job.threads);

        self.sum_tiles(&map, job);
        let (mut noise, wide) = self.estimate_noise(&map, job);
        job.done("tiles");

        self.grow(&noise, threads);
        self.refine_borders(threads);
        observe(Checkpoint::Grown, self, &noise);
        job.done("grow");

        self.merge(rays, threads);
        observe(Checkpoint::Merged, self, &noise);
        self.drop_small(threads)?;
        if let Some(times) = self.smooth_times_shown(wide, rays, job) {
            noise = noise.with_smooth_times(times);
            self.merge_again(times, rays, threads)?;
            observe(Checkpoint::Shown, self, &noise);
        }
        job.done("merge");

        self.find_redundant(&noise, threads);
        self.mark_curved(Sensing { noise: &noise, rays }, threads);
        observe(Checkpoint::Judged, self, &noise);
        self.drop_what_is_no_plane(rays, threads);
        job.done("judge");

        self.assign(&noise, false, threads);
        self.flood(&noise, threads);
        observe(Checkpoint::Assigned, self, &noise);
        self.merge_touching(threads);
        job.done("assign");

        self.extract(&map, &noise, job, out)?;
        out.curved = match job.curved {
            true => Some(self.find_curved(&map, job, &noise, &out.labels, out.curved.take())?),
            false => None,
        };
        if job.curved {
            job.done("label");
        }
        Ok(())
    }

    /// Tiles: the map in the space where planes are affine, and the sums of its cells.
    fn sum_tiles<T: Pixel>(&mut self, map: &DepthView<'_, T>, job: &Job<'_>) {
        self.affine.prepare(map);
        self.pyramid.sum(map, Space::of(job.sensor.value_kind), job.threads, &mut self.affine);
    }

    /// The noise to expect: stated, or as the cells show it; and how many times its smooth part the cells show with the
    /// longer waves.
    fn estimate_noise<T: Pixel>(&mut self, map: &DepthView<'_, T>, job: &Job<'_>) -> (NoiseModel, f64) {
        let space = Space::of(job.sensor.value_kind);
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
    fn refine_borders(&mut self, threads: usize) {
        if is_on("refine") {
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
    fn smooth_times_shown(&mut self, wide: f64, rays: &Rays, job: &Job<'_>) -> Option<f64> {
        let Runner { params, pyramid, regions, curvature, shown, .. } = self;
        pyramid.propagate_up(job.threads);
        curvature.bows.measure(pyramid, &regions.all);
        let by_regions = shown.times(&regions.all, &curvature.bows, rays, pyramid.grids[0].len());
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
    fn find_redundant(&mut self, noise: &NoiseModel, threads: usize) {
        let Runner { params, affine, pyramid, regions, merger, curvature, redundancy, .. } = self;
        pyramid.propagate_up(threads);
        let planes = params.planes(&regions.all, noise, false);
        let (CurvatureTest { bows, boxes, .. }, tiles) = (&mut *curvature, &pyramid.grids[0]);
        join(
            threads,
            || {
                find_boxes(tiles, &regions.all, boxes);
                redundancy.find(affine, tiles, &planes, &merger.edges, boxes, threads);
            },
            || bows.measure(pyramid, &regions.all),
        );
    }

    /// Marks the regions that are facets of curved surfaces.
    fn mark_curved(&mut self, sensing: Sensing<'_>, threads: usize) {
        let Runner { pyramid, regions, merger, curvature, redundancy, .. } = self;
        curvature.mark(pyramid, regions, &merger.edges, &redundancy.is_redundant, sensing, threads);
    }

    /// Leaves out regions that larger ones explain, and those that are seen edge-on.
    fn drop_what_is_no_plane(&mut self, rays: &Rays, threads: usize) {
        let Runner { pyramid, regions, merger, redundancy, .. } = self;
        let mut redundant = redundancy.is_redundant.iter();
        let goes = |region: &Region| redundant.next() == Some(&true) || region.is_edge_on(rays);
        merger.drop(&mut pyramid.grids[0], regions, threads, goes);
    }

    /// Assign: the region of every pixel: its plane, or its curved region; while planes are sought, all curved ones as
    /// [`super::region::CURVED_LABEL`].
    pub(super) fn assign(&mut self, noise: &NoiseModel, curved: bool, threads: usize) {
        let Runner { params, affine, pyramid, regions, image, .. } = self;
        image.resize(affine.q.len(), 0);
        pyramid.propagate_up(threads);
        let [tiles, blocks, ..] = &pyramid.grids;
        let planes = params.planes(&regions.all, noise, curved);
        assign(affine, [tiles, blocks], &planes, threads, image);
    }

    /// Planes reach on along strips that are too thin for a tile; those that touch are listed.
    fn flood(&mut self, noise: &NoiseModel, threads: usize) {
        let Runner { params, affine, pyramid, regions, image, boundary, flood, contacts, .. } = self;
        let planes = params.planes(&regions.all, noise, false);
        boundary.find(image, affine.stride, threads);
        contacts.list(boundary, image, threads);
        if is_on("flood") {
            flood.flood(affine, &planes, boundary, &pyramid.bands, image, threads);
        }
    }

    /// Regions whose pixels touch are merged as well.
    fn merge_touching(&mut self, threads: usize) {
        let Runner { regions, image, flood, contacts, .. } = self;
        contacts.join(flood.touching(), &mut regions.all, image, threads);
    }

    /// Group, select, fit: connected pieces of one region, those that are large enough, and their planes.
    fn extract<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        noise: &NoiseModel,
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        let Runner { params, affine, image, extraction, bridge, .. } = self;
        let ids = of_image(image, affine)?;
        let wanted = Wanted {
            min_pixels: params.min_pixels,
            min_area: params.min_area,
            noise: Some(noise),
            valid_pixels: affine.valid_pixels,
        };
        let threads = job.threads;
        let bridge_gaps = |components: &mut ConnectedComponents| {
            if is_on("gaps") {
                bridge.join(
                    Measured { numbers: &affine.q, stride: affine.stride, height: affine.height },
                    image,
                    components,
                    threads,
                );
            }
        };
        extraction.extract_united(map, &ids, &wanted, bridge_gaps, job, out)
    }

    /// Curved regions, where they are wanted, of pixels that have no plane; overwrites the region image. `old`: memory to
    /// reuse.
    fn find_curved<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        job: &Job<'_>,
        noise: &NoiseModel,
        planes: &[u16],
        old: Option<Curved>,
    ) -> Result<Curved> {
        self.assign(noise, true, job.threads);
        let Runner { params, affine, pyramid, regions, merger, image, extraction, facet_surfaces, .. } = self;
        join_facets(&regions.all, &merger.edges, noise, facet_surfaces, image, pyramid.grids[0].len());
        // Bridges over gaps, strips and regions that touch give pixels to planes after they were assigned.
        for (ids, labels) in image.chunks_exact_mut(affine.stride).zip(planes.chunks_exact(map.width())) {
            ids.iter_mut().zip(labels).filter(|(_, label)| **label > 0).for_each(|(id, _)| *id = 0);
        }
        extraction.extract_curved(map, &of_image(image, affine)?, params.min_pixels, |_| (), job, old)
    }

    /// The label that most of a region's pixels have, 0 for none.
    pub(super) fn label_of(&self, out: &Detection, id: u32) -> u16 {
        let own_label = self.contacts.label(id);
        let mut counts = vec![0u32; out.planes.len() + 1];
        for (ids, labels) in self.image.chunks_exact(self.affine.stride).zip(out.labels.chunks_exact(out.width)) {
            let own = ids.iter().zip(labels).filter(|(own, label)| **own == own_label && **label > 0);
            own.for_each(|(_, &label)| counts[usize::from(label)] += 1);
        }
        let best = (0..counts.len()).rev().max_by_key(|&label| counts[label]).filter(|&label| counts[label] > 0);
        best.unwrap_or(0) as u16
    }
}
